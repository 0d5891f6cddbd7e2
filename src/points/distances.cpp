#include "points/distances.hpp"

#include <algorithm>
#include <numeric>

#include "parallel_for.hpp"
#include "points/diameter.hpp"

namespace insym {

Distances::Distances(const std::vector<Point>& positions)
    : n_(static_cast<int>(positions.size())),
      steps_(std::max(n_, 16)),
      // Every distance falls inside the directory, the diameter just so.
      directory_scale_(steps_ / (diameter(positions) * (1 + 1e-9))),
      matrix_(start(n_, n_)),
      sorted_(start(n_, n_ - 1)),
      order_(start(n_, n_ - 1)),
      directory_(start(n_, steps_)) {
    parallel_for(n_, [&](int i) {
        double* out = matrix_.data() + start(i, n_);
        for (std::size_t j = 0; j < positions.size(); ++j)
            out[j] = distance(positions[static_cast<std::size_t>(i)], positions[j]);

        int* others = order_.data() + start(i, n_ - 1);
        std::iota(others, others + i, 0);
        std::iota(others + i, others + n_ - 1, i + 1);
        std::sort(others, others + n_ - 1,
                  [out](int a, int b) { return out[a] != out[b] ? out[a] < out[b] : a < b; });

        double* sorted = sorted_.data() + start(i, n_ - 1);
        int* directory = directory_.data() + start(i, steps_);
        int step = 0;
        for (int k = 0; k < n_ - 1; ++k) {
            sorted[k] = out[others[k]];
            for (; step < steps_ && step <= sorted[k] * directory_scale_; ++step) directory[step] = k;
        }
        for (; step < steps_; ++step) directory[step] = n_ - 1;
    });
}

}  // namespace insym
