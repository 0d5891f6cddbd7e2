#include "cycles/tolerance_interval.hpp"

#include <algorithm>
#include <vector>

namespace insym {
namespace {

ToleranceInterval interval_of_many(std::span<const Span> spans, double eps, double limit) {
    for (const Span& span : spans) eps = std::max(eps, span.spread());
    if (eps > limit) return {detail::kInfinity, detail::kInfinity};
    thread_local std::vector<Span> ends;
    ends.assign(spans.begin(), spans.end());
    const auto lower = [](const Span& a, const Span& b) { return a.low < b.low; };
    // In straight rows they are in order.
    if (!std::is_sorted(ends.begin(), ends.end(), lower)) std::sort(ends.begin(), ends.end(), lower);
    // The highest end so far does as well as the sorted ones: where there is a gap, they agree.
    for (std::size_t i = 1; i < ends.size(); ++i) ends[i].high = std::max(ends[i].high, ends[i - 1].high);
    return detail::join_classes(ends.data(), ends.size(), eps, limit);
}

}  // namespace

ToleranceInterval tolerance_interval(std::span<const Span> spans, double floor, double limit) {
    switch (spans.size()) {
        case 1:
            return detail::interval_of_few<1>(spans.data(), floor, limit);
        case 2:
            return detail::interval_of_few<2>(spans.data(), floor, limit);
        case 3:
            return detail::interval_of_few<3>(spans.data(), floor, limit);
        case 4:
            return detail::interval_of_few<4>(spans.data(), floor, limit);
        case 5:
            return detail::interval_of_few<5>(spans.data(), floor, limit);
        case 6:
            return detail::interval_of_few<6>(spans.data(), floor, limit);
        case 7:
            return detail::interval_of_few<7>(spans.data(), floor, limit);
        default:
            return interval_of_many(spans, floor, limit);
    }
}

}  // namespace insym
