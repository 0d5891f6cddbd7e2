// All chains of four points that satisfy C1: the pieces that every longer chain is made of.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "run_monitor.hpp"
#include "scene.hpp"

namespace insym {

/// A point that a chain can take at an end, and E_min of the longer chain.
struct Candidate {
    double tolerance = 0;
    int point = 0;
    friend auto operator<=>(const Candidate&, const Candidate&) = default;
};

/// For each seed (A, B, C) its fourth points D. As every part of a valid chain is valid at the same
/// tolerance (definitions, section 3), what a longer chain can take at an end is among the fourth points of
/// its last three: short lists in the place of scans over all points. Immutable after construction.
///
/// Cost: a chain of four is two triangles with a common side (B, C): for each side the apexes A and D are
/// sorted by their distance to the far end, which must agree. O(n^2) sides with a handful of apexes each,
/// plus the result. Where the result would take more than `kMostStored` items (large tolerances on many
/// points), nothing is stored and each list is made when it is asked for.
class Fourths {
public:
    using List = std::vector<Candidate>;

    Fourths(const Scene& scene, RunMonitor& monitor);
    /// Stores nothing, for few questions.
    explicit Fourths(const Scene& scene) : scene_(scene) {}

    /// The points D for which (a, b, c, D) satisfies C1, least E_min first, ties by index. The list may
    /// lie in `scratch`.
    std::span<const Candidate> of(int a, int b, int c, List& scratch) const;

    /// The number of the seed (a, b, c), one way round, in [0, seeds()); -1 if it has no fourth points or if
    /// nothing is stored.
    std::ptrdiff_t seed(int a, int b, int c) const;
    std::size_t seeds() const { return seeds_; }

private:
    static constexpr std::size_t kMostStored = std::size_t{1} << 25;  // of 16 bytes

    /// The seeds (a, b, c) with one b: an open hash table over (a, c).
    struct Slot {
        int a = -1;  // -1: free
        int c = -1;
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };
    struct Apex {
        std::vector<Slot> slots;  // a power of two, or none
        std::size_t first = 0;    // the number of the first slot
        List fourths;
    };

    void build(int b, RunMonitor& monitor);
    void fill_table(Apex& apex, const std::vector<Slot>& seeds) const;
    const Slot* find(int a, int b, int c) const;
    void make(int a, int b, int c, List& list) const;
    static std::size_t place(int a, int c, std::size_t mask) {
        const auto key = static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(c);
        return (key * 0x9E3779B97F4A7C15ULL >> 32) & mask;
    }

    const Scene& scene_;
    bool stored_ = false;
    std::size_t seeds_ = 0;
    std::vector<Apex> apexes_;
};

}  // namespace insym
