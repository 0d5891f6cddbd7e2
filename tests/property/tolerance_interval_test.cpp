// The tolerance interval of distance orbits (definitions, section 3).
//
// Oracles: the definition itself, by scanning every candidate for E_min; and reference.interval,
// carried over literally.
#include "cycles/tolerance_interval.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "property/support/oracle.hpp"

namespace insym::property {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> all_distances(const std::vector<Span>& spans) {
    std::set<double> distances;
    for (const Span& span : spans) distances.insert({span.first, span.second});
    return {distances.begin(), distances.end()};
}

bool is_transitive(const std::vector<double>& distances, double eps) {
    const auto related = [eps](double a, double b) { return std::abs(a - b) <= eps; };
    for (double a : distances)
        for (double b : distances)
            for (double c : distances)
                if (related(a, b) && related(b, c) && !related(a, c)) return false;
    return true;
}

bool is_valid(const std::vector<Span>& spans, const std::vector<double>& distances, double eps) {
    return std::all_of(spans.begin(), spans.end(),
                       [eps](const Span& span) { return span.second - span.first <= eps; }) &&
           is_transitive(distances, eps);
}

/// E_min can only be the floor or a difference of two distances; E_max is the least difference of
/// two that E_min keeps apart.
ToleranceInterval defined_interval(const std::vector<Span>& spans, double floor) {
    const std::vector<double> distances = all_distances(spans);
    std::set<double> candidates = {floor};
    for (double a : distances)
        for (double b : distances)
            if (b - a > floor) candidates.insert(b - a);
    const auto least = std::find_if(candidates.begin(), candidates.end(),
                                    [&](double eps) { return is_valid(spans, distances, eps); });
    double end = kInfinity;
    for (double a : distances)
        for (double b : distances)
            if (b - a > *least) end = std::min(end, b - a);
    return {*least, end};
}

ToleranceInterval library_interval(const std::vector<Span>& spans, double floor, double limit = kInfinity) {
    std::vector<insym::Span> given;
    for (const Span& span : spans) given.push_back({span.first, span.second});
    return tolerance_interval(given, floor, limit);
}

std::string text(const ToleranceInterval& interval) {
    return "[" + std::to_string(interval.min) + ", " + std::to_string(interval.max) + ")";
}

/// Spans on a grid of eighths, where differences are exact and ties are common.
std::vector<Span> gridded_spans() {
    const auto low = rc::gen::inRange(0, 200);
    const auto width = rc::gen::weightedOneOf<int>({{3, rc::gen::just(0)}, {2, rc::gen::inRange(0, 9)}});
    const auto item = rc::gen::map(rc::gen::pair(low, width), [](const std::pair<int, int>& p) {
        return Span{p.first / 8.0, (p.first + p.second) / 8.0};
    });
    return *rc::gen::nonEmpty(rc::gen::container<std::vector<Span>>(item));
}

}  // namespace

RC_GTEST_PROP(ToleranceInterval, is_the_one_the_definition_names, ()) {
    const std::vector<Span> spans = gridded_spans();
    const double floor = *rc::gen::inRange(1, 9) / 8.0;
    RC_ASSERT(text(library_interval(spans, floor)) == text(defined_interval(spans, floor)));
}

RC_GTEST_PROP(ToleranceInterval, is_the_reference_one_to_the_last_bit, ()) {
    std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
    const std::size_t count = 1 + random() % 40;
    const double spread = std::pow(10, -static_cast<double>(random() % 6));
    std::vector<Span> spans;
    for (std::size_t k = 0; k < count; ++k) {
        const double low = static_cast<double>(random() >> 11U) * 0x1p-53;
        spans.emplace_back(low, low + spread * static_cast<double>(random() % 1000) / 1000);
    }
    const auto wanted = reference_interval(spans, 1e-6);
    const auto got = library_interval(spans, 1e-6);
    RC_ASSERT(got.min == wanted.min);
    RC_ASSERT(got.max == wanted.max);
}

RC_GTEST_PROP(ToleranceInterval, gives_up_above_the_limit_and_only_there, ()) {
    const std::vector<Span> spans = gridded_spans();
    const double limit = *rc::gen::inRange(1, 80) / 8.0;
    const auto wanted = reference_interval(spans, 0.125);
    const auto got = library_interval(spans, 0.125, limit);
    RC_ASSERT(text(got) == (wanted.min <= limit ? text(wanted) : text({kInfinity, kInfinity})));
}

// "E_min of a part of a chain is never above E_min of the whole": fewer distances, lower E_min. The
// spans of a part lie inside those of the whole.
RC_GTEST_PROP(ToleranceInterval, grows_with_the_chain, ()) {
    const std::vector<Span> spans = gridded_spans();
    std::vector<Span> part(spans.begin(), spans.end() - 1);
    for (Span& span : part) span.second -= (span.second - span.first) / 2;
    if (part.empty()) part.push_back(spans.front());
    RC_ASSERT(library_interval(part, 0.125).min <= library_interval(spans, 0.125).min);
}

}  // namespace insym::property
