#include "brep/model_file.hpp"

#include "insym/error.hpp"

#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "brep/model_shape.hpp"

namespace insym {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 18;

constexpr std::array<LengthUnit, 8> kLengthUnits = {kMillimetre,      {"cm", 10},   {"m", 1e3},
                                                    {"km", 1e6},      {"um", 1e-3}, {"inch", 25.4},
                                                    {"mil", 25.4e-3}, {"ft", 304.8}};

std::ifstream open_file(const std::string& path, std::string_view kind) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        fail_reading(path, std::string("is a directory, not ").append(kind));
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (stream) return stream;
    fail_reading(path, "cannot be opened: " + std::generic_category().message(errno != 0 ? errno : ENOENT));
}

}  // namespace

std::optional<LengthUnit> find_unit(double millimetres) {
    for (const LengthUnit& unit : kLengthUnits)
        if (std::abs(millimetres - unit.millimetres) <= 1e-9 * unit.millimetres) return unit;
    return std::nullopt;
}

void fail_reading(const std::string& path, const std::string& why) {
    throw Error(ErrorCode::cannot_read, path + ": " + why);
}

std::string in_one_line(const char* message) {
    std::istringstream words(message);
    std::string line;
    for (std::string word; words >> word;) line += line.empty() ? word : " " + word;
    return line;
}

std::string read_whole_file(const std::string& path, std::string_view kind,
                            const std::function<void(std::string_view)>& check_start) {
    std::ifstream stream = open_file(path, kind);
    std::string text;
    while (stream) {
        const std::size_t start = text.size();
        text.resize(start + kChunk);
        stream.read(text.data() + start, static_cast<std::streamsize>(kChunk));
        text.resize(start + static_cast<std::size_t>(stream.gcount()));
        if (stream.bad()) fail_reading(path, "reading failed part way");
        if (text.empty()) fail_reading(path, "the file is empty");
        if (start == 0) check_start(text);
    }
    return text;
}

}  // namespace insym
