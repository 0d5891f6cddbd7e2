// What the stages ask while they run: may I go on? And what they tell: how far am I?
#pragma once

#include "insym/detect.hpp"
#include "insym/run_context.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <string_view>

namespace insym {

/// Thread-safe; one for each call of detect(). Once it has said stop it never takes that back.
class RunMonitor {
public:
    explicit RunMonitor(const RunContext& context) : context_(context) {}

    /// True once the run is cancelled or past its deadline. Costs a clock reading: ask once for
    /// some microseconds of work.
    bool should_stop() {
        if (status_.load(std::memory_order_relaxed) != RunStatus::complete) return true;
        if (context_.cancel.requested()) return stop(RunStatus::cancelled);
        if (context_.deadline && std::chrono::steady_clock::now() >= *context_.deadline)
            return stop(RunStatus::time_limit);
        return false;
    }

    RunStatus status() const { return status_.load(std::memory_order_relaxed); }

    void begin_stage(std::string_view name, std::size_t work) {
        const std::scoped_lock lock(mutex_);
        stage_ = name;
        work_ = work;
        reported_ = 0;
        done_.store(0, std::memory_order_relaxed);
        report(0);
    }

    /// One more of the stage's pieces of work is done.
    void advance() {
        const std::size_t done = done_.fetch_add(1, std::memory_order_relaxed) + 1;
        if (!context_.on_progress) return;
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (lock) report(done);
    }

    void log(LogLevel level, std::string_view message) const {
        if (context_.on_log) context_.on_log(level, message);
    }

private:
    bool stop(RunStatus why) {
        RunStatus expected = RunStatus::complete;
        status_.compare_exchange_strong(expected, why);
        return true;
    }

    /// Under the lock; never backwards within a stage.
    void report(std::size_t done) {
        const auto now = std::chrono::steady_clock::now();
        if (!context_.on_progress || now - last_report_ < context_.progress_interval) return;
        last_report_ = now;
        reported_ = std::max(reported_, done);
        context_.on_progress(
            {stage_, static_cast<double>(reported_) / static_cast<double>(std::max<std::size_t>(work_, 1))});
    }

    const RunContext& context_;
    std::atomic<RunStatus> status_{RunStatus::complete};
    std::atomic<std::size_t> done_{0};
    std::mutex mutex_;
    std::string_view stage_;
    std::size_t work_ = 0;
    std::size_t reported_ = 0;
    std::chrono::steady_clock::time_point last_report_{};
};

}  // namespace insym
