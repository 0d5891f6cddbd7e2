// Reading that cannot take the program down: models come from anywhere, and their readers are large.
#pragma once

#include "insym/export.hpp"
#include "insym/point_set.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace insym {

/// What reading one file may use.
struct ReadLimits {
    std::size_t memory_bytes = std::size_t{4} << 30;  ///< of address space beyond the caller's; > 0
    double time_s = 300;                              ///< wall-clock time; > 0
};

/// Calls `read` in a child process and returns its result, or throws its Error. A crash, a hang or more
/// memory than allowed inside of it becomes Error(cannot_read) with a sentence that begins with `name`, the
/// file's.
///
/// The child is a fork of the calling process with standard output and standard error closed to it; nothing
/// else that `read` changes comes back. Call it before threads hold locks that `read` needs. Costs a few
/// milliseconds and a copy of the points. Builds with address or thread sanitizer do not limit memory, for
/// these reserve all of it. Throws Error: what `read` throws; invalid_option for limits out of range;
/// cannot_read also if no process can be made.
INSYM_EXPORT Input read_guarded(const std::string& name, const std::function<Input()>& read,
                                const ReadLimits& limits = {});

}  // namespace insym
