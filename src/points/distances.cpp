#include "points/distances.hpp"

#include <algorithm>
#include <numeric>

#include "parallel_for.hpp"
#include "points/diameter.hpp"

namespace insym {

Distances::Distances(const std::vector<Point>& positions, const std::vector<char>& sorted)
    : n_(static_cast<int>(positions.size())),
      steps_(std::max(n_, 16)),
      // Every distance falls inside the directory, the diameter just so.
      directory_scale_(steps_ / (diameter(positions) * (1 + 1e-9))),
      matrix_(start(n_, n_)),
      place_(positions.size()) {
    int places = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) place_[i] = sorted[i] != 0 ? places++ : -1;
    sorted_.resize(start(places, n_ - 1));
    order_.resize(start(places, n_ - 1));
    directory_.resize(start(places, steps_));
    parallel_for(n_, [&](int i) {
        double* out = matrix_.data() + start(i, n_);
        for (std::size_t j = 0; j < positions.size(); ++j)
            out[j] = distance(positions[static_cast<std::size_t>(i)], positions[j]);
        if (place_of(i) >= 0) sort_row(i);
    });
}

/// Into the steps of the directory first, where few are left to be told apart.
void Distances::sort_row(int i) {
    const std::span<const double> distance = row(i);
    const int place = place_of(i);
    double* sorted = sorted_.data() + start(place, n_ - 1);
    int* order = order_.data() + start(place, n_ - 1);
    int* directory = directory_.data() + start(place, steps_);
    const auto step_of = [&](int j) {
        return static_cast<std::size_t>(distance[static_cast<std::size_t>(j)] * directory_scale_);
    };
    std::vector<int> next(static_cast<std::size_t>(steps_) + 1, 0);
    for (int j = 0; j < n_; ++j)
        if (j != i) ++next[step_of(j) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::copy(next.begin(), next.end() - 1, directory);
    for (int j = 0; j < n_; ++j)
        if (j != i) order[next[step_of(j)]++] = j;
    const auto before = [&](int a, int b) {
        const double x = distance[static_cast<std::size_t>(a)], y = distance[static_cast<std::size_t>(b)];
        return x != y ? x < y : a < b;
    };
    for (int s = 0; s < steps_; ++s) {
        int *first = order + directory[s], *last = order + next[static_cast<std::size_t>(s)];
        if (last - first > 1 && !std::is_sorted(first, last, before)) std::sort(first, last, before);
    }
    for (int k = 0; k < n_ - 1; ++k) sorted[k] = distance[static_cast<std::size_t>(order[k])];
}

}  // namespace insym
