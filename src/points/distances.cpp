#include "points/distances.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "parallel_for.hpp"
#include "points/diameter.hpp"

namespace insym {

/// Each coordinate by itself, so that several points are computed at once.
struct Distances::Coordinates {
    explicit Coordinates(const std::vector<Point>& positions) {
        for (std::size_t k = 0; k < 3; ++k)
            for (const Point& p : positions) axes[k].push_back(p[k]);
    }
    std::array<std::vector<double>, 3> axes;
};

namespace {

/// One for about four points; of small sets, where the search in a step would be all there is to do, more.
int steps_for(int n) {
    constexpr int kEnough = 256, kMostEntries = 1 << 16;
    return std::max(n / 4, std::min(kEnough, kMostEntries / std::max(n, 1)));
}

}  // namespace

Distances::Distances(const std::vector<Point>& positions, const std::vector<char>& sorted)
    : n_(static_cast<int>(positions.size())),
      steps_(steps_for(n_)),
      // Every distance falls inside the directory, the diameter just so.
      directory_scale_(steps_ / (diameter(positions) * (1 + 1e-9))),
      matrix_(std::make_unique_for_overwrite<double[]>(start(n_, n_))),
      place_(positions.size()) {
    int places = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) place_[i] = sorted[i] != 0 ? places++ : -1;
    order_ = std::make_unique_for_overwrite<int[]>(start(places, n_ - 1));
    directory_ = std::make_unique_for_overwrite<int[]>(start(places, steps_));
    const Coordinates coordinates(positions);
    parallel_for(n_, [&](int i) {
        fill_row(i, coordinates);
        if (place_of(i) >= 0) sort_row(i);
    });
}

/// The formula of distance().
void Distances::fill_row(int i, const Coordinates& of) {
    double* out = matrix_.get() + start(i, n_);
    const double *x = of.axes[0].data(), *y = of.axes[1].data(), *z = of.axes[2].data();
    for (int j = 0; j < n_; ++j) {
        const double dx = x[i] - x[j], dy = y[i] - y[j], dz = z[i] - z[j];
        out[j] = std::sqrt(dx * dx + dy * dy + dz * dz);
    }
}

namespace {

using Item = std::pair<double, int>;

/// By distance, equal ones by index, in which order they are given; nearly sorted, or few.
void insert_in_order(Item* first, Item* last) {
    for (Item* next = first + 1; next < last; ++next) {
        const Item item = *next;
        Item* to = next;
        for (; to > first && item.first < (to - 1)->first; --to) *to = *(to - 1);
        *to = item;
    }
}

}  // namespace

/// Into parts of the steps of the directory first, of about one point, where few are left to be told apart.
void Distances::sort_row(int i) {
    constexpr int kFew = 24;
    // A power of two: so a part lies in the step that the same distance is looked up in, whatever is rounded.
    const std::size_t parts = std::bit_floor(static_cast<unsigned>(std::max(1, n_ / steps_)));
    const double part_scale = static_cast<double>(parts) * directory_scale_;
    const std::span<const double> distance = row(i);
    const int place = place_of(i);
    int* order = order_.get() + start(place, n_ - 1);
    int* directory = directory_.get() + start(place, steps_);
    const auto part_of = [&](int j) {
        return static_cast<std::size_t>(distance[static_cast<std::size_t>(j)] * part_scale);
    };
    thread_local std::vector<int> next;
    thread_local std::vector<Item> items;
    next.assign(parts * static_cast<std::size_t>(steps_) + 1, 0);
    items.resize(static_cast<std::size_t>(n_));
    for (int j = 0; j < n_; ++j)
        if (j != i) ++next[part_of(j) + 1];
    const bool crowded = *std::max_element(next.begin(), next.end()) > kFew;
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (int s = 0; s < steps_; ++s) directory[s] = next[parts * static_cast<std::size_t>(s)];
    for (int j = 0; j < n_; ++j)
        if (j != i)
            items[static_cast<std::size_t>(next[part_of(j)]++)] = {distance[static_cast<std::size_t>(j)], j};
    if (crowded) {
        int first = 0;
        // By now `next` is where the parts end.
        for (const int end : std::span(next).first(next.size() - 1)) {
            if (end - first > kFew) std::sort(items.data() + first, items.data() + end);
            first = end;
        }
    }
    insert_in_order(items.data(), items.data() + n_ - 1);
    for (int k = 0; k < n_ - 1; ++k) order[k] = items[static_cast<std::size_t>(k)].second;
}

}  // namespace insym
