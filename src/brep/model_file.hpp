// What the readers of the three formats share: the bytes of the file, sentences about what is wrong with it.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace insym {

[[noreturn]] void fail_reading(const std::string& path, const std::string& why);

/// A message of Open CASCADE as part of a sentence: one line, no runs of blanks.
std::string in_one_line(const char* message);

/// The whole file. `check_start` sees the first bytes as soon as they are there, because what is no model may
/// be endless, and throws where they cannot be those of its format. `kind` is for messages: "a STEP file".
std::string read_whole_file(const std::string& path, std::string_view kind,
                            const std::function<void(std::string_view)>& check_start);

}  // namespace insym
