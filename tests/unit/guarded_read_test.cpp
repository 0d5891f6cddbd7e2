// Oracle: what the interface promises for a reader that returns, refuses, crashes, hangs, eats memory or ends
// the process: the result, its error, or cannot_read with a sentence in time; and this process goes on.
#include "insym/guarded_read.hpp"

#include "insym/error.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace insym {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Input sample() {
    Input input;
    input.path = "a.step";
    input.format = "step";
    input.unit = "mm";
    input.diagnostics = {{"code", "sentence"}};
    Entity entity{EntityKind::face, 7, "cylinder"};
    entity.ids = {7, 9};
    entity.role = EntityRole::hole;
    entity.radius = 0.1;
    entity.area = 1e-300;
    entity.part = "assembly/part#2";
    input.points.positions = {{1, 2, 3}, {-1e300, 0.1, 5e-324}};
    input.points.labels = {3, -4};
    input.points.entities = {entity, {}};
    input.tessellation = {
        {{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}, {{0, 1, 2}}, {7}, {{{0, 1, 0}, 5}, {{2, 1}, 0}}};
    return input;
}

/// The error of a guarded reader that does that; the test fails where there is none.
Error error_of(const std::function<Input()>& read, const ReadLimits& limits = {}) {
    try {
        read_guarded("file.step", read, limits);
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
        return error;
    }
    ADD_FAILURE() << "it was read";
    return {ErrorCode::cannot_write, ""};
}

TEST(GuardedRead, TheResultComesBackWhole) {
    const Input input = read_guarded("a.step", sample), expected = sample();
    EXPECT_EQ(input.path, expected.path);
    EXPECT_EQ(input.format, expected.format);
    EXPECT_EQ(input.unit, expected.unit);
    EXPECT_EQ(input.points.dimension, 3);
    EXPECT_EQ(input.points.positions, expected.points.positions);
    EXPECT_EQ(input.points.labels, expected.points.labels);
    ASSERT_EQ(input.diagnostics.size(), 1U);
    EXPECT_EQ(input.diagnostics[0].message, "sentence");
    ASSERT_EQ(input.points.entities.size(), 2U);
    const Entity &a = input.points.entities[0], &b = expected.points.entities[0];
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.geometry, b.geometry);
    EXPECT_EQ(a.ids, b.ids);
    EXPECT_EQ(a.role, b.role);
    EXPECT_EQ(a.radius, b.radius);
    EXPECT_EQ(a.minor_radius, b.minor_radius);
    EXPECT_EQ(a.length, b.length);
    EXPECT_EQ(a.area, b.area);
    EXPECT_EQ(a.part, b.part);
    EXPECT_EQ(input.tessellation.vertices, expected.tessellation.vertices);
    EXPECT_EQ(input.tessellation.triangles, expected.tessellation.triangles);
    EXPECT_EQ(input.tessellation.faces, expected.tessellation.faces);
    ASSERT_EQ(input.tessellation.lines.size(), 2U);
    EXPECT_EQ(input.tessellation.lines[0].vertices, expected.tessellation.lines[0].vertices);
    EXPECT_EQ(input.tessellation.lines[0].edge, 5);
}

// More than a pipe holds at once.
TEST(GuardedRead, LargeResults) {
    const auto read = [] {
        Input input;
        for (int i = 0; i < 200000; ++i) input.points.positions.push_back({double(i), 0, 0});
        return input;
    };
    const Input input = read_guarded("a.step", read);
    ASSERT_EQ(input.points.size(), 200000U);
    EXPECT_EQ(input.points.positions.back()[0], 199999);
}

TEST(GuardedRead, ErrorsComeBack) {
    const Error error =
        error_of([]() -> Input { throw Error(ErrorCode::invalid_input, "file.step: no geometry"); });
    EXPECT_EQ(error.code(), ErrorCode::invalid_input);
    EXPECT_STREQ(error.what(), "file.step: no geometry");
    EXPECT_EQ(error_of([]() -> Input { throw std::runtime_error("odd"); }).code(), ErrorCode::cannot_read);
    EXPECT_EQ(error_of([]() -> Input { throw 7; }).code(), ErrorCode::cannot_read);
}

TEST(GuardedRead, ACrash) {
    for (const int number : {SIGSEGV, SIGABRT, SIGFPE, SIGKILL}) {
        const Error error = error_of([=]() -> Input {
            std::signal(number, SIG_DFL);  // a sanitizer would catch some of them
            raise(number);
            return {};
        });
        EXPECT_EQ(error.code(), ErrorCode::cannot_read);
        EXPECT_THAT(error.what(), AllOf(StartsWith("file.step: "), HasSubstr("crashed")));
    }
}

TEST(GuardedRead, AnEndOfTheProcess) {
    for (const int status : {0, 1}) {
        const Error error = error_of([=]() -> Input { _exit(status); });
        EXPECT_THAT(error.what(), AllOf(StartsWith("file.step: "), HasSubstr("without a result")));
    }
}

TEST(GuardedRead, AHang) {
    const auto start = std::chrono::steady_clock::now();
    const Error error = error_of(
        []() -> Input {
            for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
        },
        {.time_s = 0.2});
    EXPECT_EQ(error.code(), ErrorCode::cannot_read);
    EXPECT_THAT(error.what(), HasSubstr("longer than the import limit of 0.2 s"));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(GuardedRead, TooMuchMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers reserve all memory, so it is not limited";
#endif
    const Error error = error_of(
        []() -> Input {
            std::vector<std::vector<char>> all;
            for (;;) all.emplace_back(std::size_t{1} << 20, 'x');
        },
        {.memory_bytes = std::size_t{100} << 20});
    EXPECT_EQ(error.code(), ErrorCode::cannot_read);
    EXPECT_THAT(error.what(), HasSubstr("more memory than the import limit of 100 MiB"));
}

TEST(GuardedRead, NothingIsPrinted) {
    testing::internal::CaptureStdout();
    read_guarded("a.step", [] {
        std::system("echo noise");  // what C libraries print cannot be told to be silent
        return Input{};
    });
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(GuardedRead, LimitsOutOfRange) {
    EXPECT_EQ(error_of(sample, {.memory_bytes = 0}).code(), ErrorCode::invalid_option);
    EXPECT_EQ(error_of(sample, {.time_s = 0}).code(), ErrorCode::invalid_option);
}

}  // namespace
}  // namespace insym
