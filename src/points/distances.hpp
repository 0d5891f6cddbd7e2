// All distances of a point set, and for each point the others in order of distance.
#pragma once

#include "insym/point_set.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace insym {

/// Immutable after construction; reading is thread-safe. Memory 13 n^2 bytes, time O(n^2 log n); 8 n^2 and
/// O(n^2) for the points that are not sorted about.
class Distances {
public:
    explicit Distances(const std::vector<Point>& positions)
        : Distances(positions, std::vector<char>(positions.size(), 1)) {}
    /// `sorted`: about which points the others are wanted in order.
    Distances(const std::vector<Point>& positions, const std::vector<char>& sorted);

    int size() const { return n_; }
    double operator()(int i, int j) const { return row(i)[static_cast<std::size_t>(j)]; }

    /// The distances of point i to all points, by index.
    std::span<const double> row(int i) const {
        return {matrix_.get() + start(i, n_), static_cast<std::size_t>(n_)};
    }
    /// All points but i itself, nearest first, equal distances by index. Of a sorted point only, as below.
    std::span<const int> nearest_first(int i) const {
        return {order_.get() + start(place_of(i), n_ - 1), static_cast<std::size_t>(n_ - 1)};
    }

    /// Calls visit(point, distance) for every other point whose distance to i is in [low, high], nearest
    /// first, until it returns false. O(1) to find the first.
    template <class Visit>
    void visit_shell(int i, double low, double high, Visit visit) const {
        const double* d = row(i).data();
        const int* point = nearest_first(i).data();
        for (int k = first_at(i, low); k < n_ - 1 && d[point[k]] <= high; ++k)
            if (!visit(point[k], d[point[k]])) return;
    }

    /// The places in nearest_first(i) of those points: from the first to before the second.
    std::pair<int, int> shell(int i, double low, double high) const {
        const double* d = row(i).data();
        const int* point = nearest_first(i).data();
        const int first = first_at(i, low);
        int end = std::max(first, first_in_step(i, high));
        while (end < n_ - 1 && d[point[end]] <= high) ++end;
        return {first, end};
    }

private:
    struct Coordinates;
    void fill_row(int i, const Coordinates& of);
    void sort_row(int i);
    /// The place of the first point in the step of the directory that `distance` is in.
    int first_in_step(int i, double distance) const {
        const double step = distance * directory_scale_;
        if (step >= steps_) return n_ - 1;
        return step > 0 ? directory_[start(place_of(i), steps_) + static_cast<std::size_t>(step)] : 0;
    }
    /// The place of the first point that is not nearer than `low`.
    int first_at(int i, double low) const {
        const double* d = row(i).data();
        const int* point = nearest_first(i).data();
        int k = first_in_step(i, low);
        while (k < n_ - 1 && d[point[k]] < low) ++k;
        return k;
    }
    int place_of(int i) const { return place_[static_cast<std::size_t>(i)]; }

    static std::size_t start(int i, int width) {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(width);
    }

    int n_ = 0;
    int steps_ = 0;  // of distance, whose first points are known
    double directory_scale_ = 0;
    // Not initialised: the threads that fill them touch their pages first.
    std::unique_ptr<double[]> matrix_;
    std::vector<int> place_;  // of each sorted point in what follows
    std::unique_ptr<int[]> order_;
    std::unique_ptr<int[]> directory_;  // for each point and step: the first place in its order at or beyond
};

}  // namespace insym
