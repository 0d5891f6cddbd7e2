// How a call runs: threads, deadline, cancelling, progress, log. Never what it finds.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

namespace insym {

/// A copyable handle on one shared flag; request() may be called from any thread and, as it is a
/// lock-free store, from a signal handler.
class CancelToken {
public:
    CancelToken() : flag_(std::make_shared<std::atomic<bool>>(false)) {}
    void request() const noexcept { flag_->store(true, std::memory_order_relaxed); }
    bool requested() const noexcept { return flag_->load(std::memory_order_relaxed); }

private:
    std::shared_ptr<std::atomic<bool>> flag_;
};

/// Where a run is: the stage's name and the share of its work that is done, 0..1.
struct Progress {
    std::string_view stage;
    double done = 0;
};

enum class LogLevel { debug, info, warning };

/// Passed by reference to detect(); one context may serve several calls, one after another or at
/// once (then the callbacks must be thread-safe). Callbacks come from worker threads, one at a
/// time for each call, and must not throw.
struct RunContext {
    int threads = 0;  ///< upper limit of threads used, >= 1; 0: all cores
    std::optional<std::chrono::steady_clock::time_point> deadline;  ///< stop early at this time
    CancelToken cancel;
    std::function<void(const Progress&)> on_progress;        ///< empty: no progress
    std::chrono::milliseconds progress_interval{100};        ///< at most one call in this time
    std::function<void(LogLevel, std::string_view)> on_log;  ///< empty: silent
};

}  // namespace insym
