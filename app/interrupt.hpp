// Ctrl-C and SIGTERM: the first asks the run to stop with a valid report, the second ends at once.
#pragma once

#include "insym/run_context.hpp"

namespace insym::app {

/// Lets the first SIGINT or SIGTERM request `cancel`; the next one has its usual effect, after a
/// temporary file named by remove_on_interrupt() is removed.
void cancel_on_interrupt(const CancelToken& cancel);

/// The file to remove if the program is ended by a signal; nullptr for none. `path` must live on.
void remove_on_interrupt(const char* path);

}  // namespace insym::app
