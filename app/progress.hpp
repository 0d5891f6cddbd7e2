// One line on the terminal that says how far the run is; gone without a trace at the end.
#pragma once

#include "insym/run_context.hpp"

#include <string_view>

namespace insym::app {

/// Shows nothing where standard error is no terminal, or if not `wanted`.
class ProgressLine {
public:
    explicit ProgressLine(bool wanted);
    ~ProgressLine() { clear(); }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    bool shown() const { return shown_; }
    void show(const Progress& progress);
    void show(std::string_view text);
    void clear();

private:
    bool shown_;
    bool dirty_ = false;
};

}  // namespace insym::app
