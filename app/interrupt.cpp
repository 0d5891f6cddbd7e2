#include "interrupt.hpp"

#include <atomic>
#include <csignal>

#include <unistd.h>

namespace insym::app {
namespace {

// A signal handler reaches nothing but globals; both are set before they can be used.
const CancelToken* cancel_token = nullptr;
std::atomic<const char*> temporary_path = nullptr;

/// Async-signal-safe: lock-free atomics, unlink, signal and raise only.
extern "C" void on_interrupt(int number) {
    if (cancel_token != nullptr && !cancel_token->requested()) {
        cancel_token->request();
        return;
    }
    if (const char* path = temporary_path.load()) unlink(path);
    std::signal(number, SIG_DFL);
    std::raise(number);
}

/// Also where the signal was ignored until now, as in the background of a script: `kill -INT` must work.
void handle(int number) {
    struct sigaction action {};
    action.sa_handler = on_interrupt;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, nullptr);
}

}  // namespace

void cancel_on_interrupt(const CancelToken& cancel) {
    static CancelToken token;
    token = cancel;
    cancel_token = &token;
    handle(SIGINT);
    handle(SIGTERM);
}

void remove_on_interrupt(const char* path) {
    temporary_path = path;
}

}  // namespace insym::app
