#include "progress.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include <unistd.h>

namespace insym::app {
namespace {

// Narrow enough for any terminal: a line that wraps could not be taken back.
constexpr std::size_t kWidth = 40;

}  // namespace

ProgressLine::ProgressLine(bool wanted) : shown_(wanted && isatty(STDERR_FILENO) != 0) {}

void ProgressLine::show(const Progress& progress) {
    const int percent = std::clamp(static_cast<int>(100 * progress.done), 0, 100);
    show(std::string(progress.stage) + " " + std::to_string(percent) + " %");
}

void ProgressLine::show(std::string_view text) {
    if (!shown_) return;
    std::string line = "\rinsym: " + std::string(text.substr(0, kWidth - 8));
    line.resize(kWidth + 1, ' ');
    std::fwrite(line.data(), 1, line.size(), stderr);
    std::fflush(stderr);
    dirty_ = true;
}

void ProgressLine::clear() {
    if (!dirty_) return;
    std::fprintf(stderr, "\r%*s\r", static_cast<int>(kWidth), "");
    std::fflush(stderr);
    dirty_ = false;
}

}  // namespace insym::app
