// Sets of points at a distance from a point, as bits.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "points/distances.hpp"

namespace insym {

/// For each point and each number k the set of the k points nearest to it; a shell is the difference of two
/// of those. Immutable after construction, reading is thread-safe. For up to kMostPoints points: n^3 / 8
/// bytes. Of larger sets it keeps nothing.
class Shells {
public:
    static constexpr int kMostPoints = 256;
    using Set = std::array<std::uint64_t, kMostPoints / 64>;

    explicit Shells(const Distances& distances) : distances_(distances) {
        const int n = distances.size();
        if (n > kMostPoints) return;
        nearest_.resize(static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
        for (int i = 0; i < n; ++i) {
            Set* set = &nearest_[place(i, 0)];
            *set = {};
            for (const int p : distances.nearest_first(i)) {
                set[1] = set[0];
                ++set;
                (*set)[static_cast<std::size_t>(p) / 64] |= std::uint64_t{1}
                                                            << (static_cast<unsigned>(p) % 64U);
            }
        }
    }

    bool stored() const { return !nearest_.empty(); }

    /// Leaves in `set` only those whose distance to i is in [low, high]; i is not. False if none is left.
    bool keep(int i, double low, double high, Set& set) const {
        const auto [first, end] = distances_.shell(i, low, high);
        const Set &inner = nearest_[place(i, first)], &all = nearest_[place(i, end)];
        std::uint64_t any = 0;
        for (std::size_t w = 0; w < set.size(); ++w) any |= set[w] &= all[w] & ~inner[w];
        return any != 0;
    }

    template <class Visit>
    static void visit(const Set& set, Visit visit) {
        for (std::size_t w = 0; w < set.size(); ++w)
            for (std::uint64_t bits = set[w]; bits != 0; bits &= bits - 1)
                visit(static_cast<int>(64 * w) + std::countr_zero(bits));
    }

private:
    std::size_t place(int i, int count) const {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(distances_.size()) +
               static_cast<std::size_t>(count);
    }

    const Distances& distances_;
    std::vector<Set> nearest_;
};

}  // namespace insym
