// How a run may be steered: cancel, deadline, progress. Never timed but for "it does stop".
//
// Oracle: the contract in run_context.hpp and detect.hpp; the definitions for what a run that
// stopped early has found.
#include "insym/detect.hpp"

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "property/support/oracle.hpp"
#include "property/support/results.hpp"
#include "property/support/shapes.hpp"

namespace insym::property {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Far more work than any test waits for: chance cycles at the paper's widest tolerance.
PointSet endless_set() {
    PointSet points = noisy_set(3, 20, 300, 1e-3, 7);
    points.labels.clear();
    return points;
}

/// Some seconds of work in many small pieces.
PointSet long_set() {
    PointSet points = noisy_set(3, 4, 50, 1e-3, 7);
    points.labels.clear();
    return points;
}

DetectOptions wide_options() {
    DetectOptions options;
    options.method = Method::paper;
    options.max_tolerance = 0.05;
    return options;
}

PointSet small_set() {
    return noisy_set(3, 4, 10, 1e-4, 3);
}

void expect_valid(const DetectResult& result) {
    const auto found = violations(result, false);
    EXPECT_TRUE(found.empty()) << found.size() << " violations, the first: " << found.front();
}

/// Everything that a callback was told, and whether two callbacks ever ran at once.
class Recorder {
public:
    RunContext context(int threads, std::chrono::milliseconds interval) {
        RunContext context;
        context.threads = threads;
        context.progress_interval = interval;
        context.on_progress = [this](const Progress& progress) { record(progress); };
        return context;
    }
    struct Item {
        std::string stage;
        double done = 0;
    };
    const std::vector<Item>& items() const { return items_; }
    bool overlapped() const { return overlapped_; }
    Clock::time_point first() const { return first_; }

private:
    void record(const Progress& progress) {
        if (inside_.exchange(true)) overlapped_ = true;
        if (items_.empty()) first_ = Clock::now();
        items_.push_back({std::string(progress.stage), progress.done});
        std::this_thread::sleep_for(100us);
        inside_ = false;
    }

    std::vector<Item> items_;
    Clock::time_point first_;
    std::atomic<bool> inside_ = false;
    std::atomic<bool> overlapped_ = false;
};

}  // namespace

TEST(Cancel, from_another_thread_stops_the_run_and_leaves_a_valid_result) {
    RunContext context;
    context.threads = 2;
    std::thread other([token = context.cancel] {
        std::this_thread::sleep_for(200ms);
        token.request();
    });
    const DetectResult result = detect(endless_set(), wide_options(), context);
    other.join();
    EXPECT_EQ(result.status, RunStatus::cancelled);
    expect_valid(result);
}

TEST(Cancel, from_the_progress_callback_stops_the_run) {
    RunContext context;
    context.threads = 2;
    context.progress_interval = 0ms;
    context.on_progress = [token = context.cancel](const Progress&) { token.request(); };
    const DetectResult result = detect(long_set(), wide_options(), context);
    EXPECT_EQ(result.status, RunStatus::cancelled);
    expect_valid(result);
}

TEST(Cancel, before_the_run_gives_a_valid_result_at_once) {
    RunContext context;
    context.cancel.request();
    const DetectResult result = detect(endless_set(), wide_options(), context);
    EXPECT_EQ(result.status, RunStatus::cancelled);
    EXPECT_EQ(result.points.size(), endless_set().size());
    expect_valid(result);
}

TEST(Cancel, leaves_other_runs_alone) {
    const DetectResult alone = detect(small_set(), {}, {});
    RunContext cancelled;
    cancelled.cancel.request();
    DetectResult stopped;
    std::thread other([&] { stopped = detect(small_set(), {}, cancelled); });
    const DetectResult result = detect(small_set(), {}, {});
    other.join();
    EXPECT_EQ(stopped.status, RunStatus::cancelled);
    EXPECT_EQ(result.status, RunStatus::complete);
    EXPECT_EQ(difference_in_bits(alone, result), "");
}

TEST(Deadline, stops_the_run_and_leaves_a_valid_result) {
    RunContext context;
    context.threads = 2;
    const auto start = Clock::now();
    context.deadline = start + 300ms;
    const DetectResult result = detect(endless_set(), wide_options(), context);
    const auto spent = Clock::now() - start;
    EXPECT_EQ(result.status, RunStatus::time_limit);
    EXPECT_GE(spent, 300ms);
    EXPECT_LT(spent, 30s);  // "it does stop", on a loaded machine too
    expect_valid(result);
}

TEST(Deadline, in_the_past_gives_a_valid_result_at_once) {
    RunContext context;
    context.deadline = Clock::now() - 1s;
    const DetectResult result = detect(endless_set(), wide_options(), context);
    EXPECT_EQ(result.status, RunStatus::time_limit);
    expect_valid(result);
}

TEST(Deadline, far_away_changes_nothing) {
    RunContext context;
    context.deadline = Clock::now() + 1h;
    EXPECT_EQ(difference_in_bits(detect(small_set(), {}, {}), detect(small_set(), {}, context)), "");
}

TEST(Progress, rises_within_each_stage_and_comes_one_call_at_a_time) {
    Recorder recorder;
    RunContext context = recorder.context(4, 0ms);
    PointSet points = noisy_set(3, 8, 40, 2e-4, 5);
    DetectOptions options;
    options.method = Method::paper;
    options.max_tolerance = 5e-3;
    const DetectResult result = detect(points, options, context);
    EXPECT_EQ(result.status, RunStatus::complete);
    ASSERT_FALSE(recorder.items().empty());
    EXPECT_FALSE(recorder.overlapped());
    std::vector<std::string> stages;
    double last = 0;
    for (const Recorder::Item& item : recorder.items()) {
        EXPECT_FALSE(item.stage.empty());
        EXPECT_GE(item.done, 0);
        EXPECT_LE(item.done, 1);
        if (stages.empty() || stages.back() != item.stage) {
            for (const std::string& stage : stages) EXPECT_NE(stage, item.stage) << "a stage came back";
            stages.push_back(item.stage);
            last = 0;
        }
        EXPECT_GE(item.done, last) << item.stage;
        last = item.done;
    }
}

TEST(Progress, comes_at_most_once_in_its_interval) {
    constexpr auto kInterval = 50ms;
    Recorder recorder;
    RunContext context = recorder.context(2, kInterval);
    const auto start = Clock::now();
    context.deadline = start + 600ms;
    detect(long_set(), wide_options(), context);
    const auto spent = Clock::now() - start;
    EXPECT_FALSE(recorder.items().empty());
    EXPECT_LE(recorder.items().size(), static_cast<std::size_t>(spent / kInterval) + 1);
}

// A user who waits for minutes must see within seconds that the run is alive.
TEST(Progress, begins_early_in_a_long_run) {
    Recorder recorder;
    RunContext context = recorder.context(2, 0ms);
    context.deadline = Clock::now() + 3s;
    EXPECT_EQ(detect(endless_set(), wide_options(), context).status, RunStatus::time_limit);
    ASSERT_FALSE(recorder.items().empty());
    EXPECT_LT(recorder.first(), *context.deadline);
}

TEST(Progress, and_log_do_not_change_the_result) {
    Recorder recorder;
    RunContext context = recorder.context(2, 0ms);
    std::atomic<int> lines = 0;
    context.on_log = [&lines](LogLevel, std::string_view) { ++lines; };
    EXPECT_EQ(difference_in_bits(detect(small_set(), {}, {}), detect(small_set(), {}, context)), "");
}

TEST(Silence, nothing_is_printed) {
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    detect(small_set(), {}, {});
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

// Libraries below must not speak either; each warns once in a process, and each test is one.
TEST(Silence, nothing_is_printed_for_more_threads_than_cores) {
    RunContext context;
    context.threads = 64;
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    detect(small_set(), {}, context);
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace insym::property
