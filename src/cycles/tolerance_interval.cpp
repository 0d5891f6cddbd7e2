#include "cycles/tolerance_interval.hpp"

#include <algorithm>

namespace insym {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void sort_by_low(std::span<Span> spans) {
    constexpr std::size_t kInsertionSortLimit = 24;
    const auto lower = [](const Span& a, const Span& b) { return a.low < b.low; };
    if (spans.size() > kInsertionSortLimit) {
        std::sort(spans.begin(), spans.end(), lower);
        return;
    }
    for (std::size_t i = 1; i < spans.size(); ++i) {
        const Span moving = spans[i];
        std::size_t k = i;
        for (; k > 0 && moving.low < spans[k - 1].low; --k) spans[k] = spans[k - 1];
        spans[k] = moving;
    }
}

/// Joins neighbours that lie at most `gap` apart; returns how many classes are left.
std::size_t join_classes(std::span<Span> classes, double gap) {
    std::size_t last = 0;
    for (std::size_t i = 1; i < classes.size(); ++i) {
        if (classes[i].low - classes[last].high <= gap)
            classes[last].high = std::max(classes[last].high, classes[i].high);
        else
            classes[++last] = classes[i];
    }
    return last + 1;
}

}  // namespace

ToleranceInterval tolerance_interval(std::span<Span> spans, double floor, double limit) {
    sort_by_low(spans);
    // Orbits that overlap are one class at any tolerance; mostly the classes then stay apart.
    double eps = floor;
    double least_gap = kInfinity;
    std::size_t last = 0;
    for (std::size_t i = 1; i < spans.size(); ++i) {
        const double gap = spans[i].low - spans[last].high;
        if (gap <= 0) {
            spans[last].high = std::max(spans[last].high, spans[i].high);
        } else {
            eps = std::max(eps, spans[last].spread());
            least_gap = std::min(least_gap, gap);
            spans[++last] = spans[i];
        }
    }
    eps = std::max(eps, spans[last].spread());
    for (std::size_t count = last + 1;;) {
        if (eps > limit) return {kInfinity, kInfinity};
        if (eps < least_gap) return {eps, least_gap};
        count = join_classes(spans.first(count), eps);
        least_gap = kInfinity;
        for (std::size_t i = 0; i < count; ++i) {
            eps = std::max(eps, spans[i].spread());
            if (i > 0) least_gap = std::min(least_gap, spans[i].low - spans[i - 1].high);
        }
    }
}

}  // namespace insym
