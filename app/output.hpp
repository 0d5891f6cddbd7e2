// Where results go: standard output, or a file that appears under its name only when it is whole.
#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace insym::app {

/// Writes the content of an output to the stream it is given.
using Writer = std::function<void(std::ostream&)>;

/// Makes sure, before the long work, that `target` can be written; "-" is standard output.
/// Throws Error(cannot_write). Leaves nothing behind.
void check_output(const std::string& target);

/// Writes `target`: a regular file by way of a temporary file beside it, anything else (standard
/// output, pipes, devices) directly. A reader that closes its end early has had enough: no error.
/// Throws Error(cannot_write), for instance on a full disk; no partial file is left.
void write_output(const std::string& target, const Writer& write);

}  // namespace insym::app
