// All chains of four points that satisfy C1: the pieces that every longer chain is made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "cycles/seeds.hpp"
#include "run_monitor.hpp"
#include "scene.hpp"

namespace insym {

/// Where the fourth points of a seed are stored, among those of its apex.
using SeedLink = std::uint32_t;
constexpr SeedLink kUnknownLink = ~SeedLink{0};

/// A point that a chain can take at an end, and E_min of the longer chain.
struct Candidate {
    double tolerance = 0;
    int point = 0;
    SeedLink next = kUnknownLink;  ///< of the last three points once it is taken

    friend bool operator==(const Candidate& x, const Candidate& y) {
        return x.tolerance == y.tolerance && x.point == y.point;
    }
    friend bool operator<(const Candidate& x, const Candidate& y) {
        return x.tolerance < y.tolerance || (x.tolerance == y.tolerance && x.point < y.point);
    }
};

/// For each seed (A, B, C) its fourth points D. As every part of a valid chain is valid at the same
/// tolerance (definitions, section 3), what a longer chain can take at an end is among the fourth points of
/// its last three: short lists in the place of scans over all points. Immutable after construction.
///
/// Cost: a chain of four is two triangles with a common side (B, C): for each side the apexes A and D are
/// sorted by their distance to the far end, which must agree. O(n^2) sides with a handful of apexes each,
/// plus the result. Where the result would take more than `most_stored` items (large tolerances on many
/// points), nothing is stored and each list is made when it is asked for.
class Fourths {
public:
    using List = std::vector<Candidate>;

    /// With more than `most_chains` chains of four it gives up, and says so; 0: it does not. More than
    /// `most_stored` items, of 16 bytes, are not kept.
    Fourths(const Scene& scene, const Seeds& seeds, std::size_t most_chains, RunMonitor& monitor,
            std::size_t most_stored);
    /// Stores nothing, for few questions.
    explicit Fourths(const Scene& scene) : scene_(scene) {}

    bool too_many() const { return too_many_; }

    /// The points D for which (a, b, c, D) satisfies C1, least E_min first, ties by index. The list ends with
    /// nobody, at an infinite E_min. It may lie in `scratch`.
    const Candidate* of(int a, int b, int c, List& scratch) const;
    /// The same where it is known where they are stored.
    const Candidate* of(int b, SeedLink link) const {
        return apexes_[static_cast<std::size_t>(b)].fourths.data() + link;
    }
    /// They are asked for soon, if it is known where they are.
    void prefetch(int b, SeedLink link) const {
#if defined(__GNUC__)
        if (link != kUnknownLink) __builtin_prefetch(of(b, link));
#endif
    }
    /// Where they are stored, if they are.
    SeedLink link(int a, int b, int c) const {
        if (!stored_) return kUnknownLink;
        const Apex& apex = apexes_[static_cast<std::size_t>(b)];
        const SeedLink known = apex.square.empty() ? find(a, b, c) : apex.square[in_square(a, c)];
        return known == kEmpty && listed_ != nullptr && listed_->superfluous(a, b, c) ? kUnknownLink : known;
    }

    bool stored() const {
        return stored_;
    }
    /// Calls visit(a, c, link) for each seed (a, b, c) whose fourth points are stored, in both directions;
    /// those of one c one after the other, as what is asked about them lies close together.
    template <class Visit>
    void visit_seeds(int b, Visit visit) const {
        for (const Slot& seed : apexes_[static_cast<std::size_t>(b)].seeds) visit(seed.a, seed.c, seed.first);
    }
    /// How many items are stored about `b`: links are below that.
    std::size_t stored_about(int b) const {
        return apexes_[static_cast<std::size_t>(b)].fourths.size();
    }
    static constexpr Candidate kNobody{std::numeric_limits<double>::infinity(), -1};
    static constexpr SeedLink kEmpty = 0;  ///< an empty list, the first of each apex

private:
    /// Up to so many points the links of one apex are a square, of larger sets an open hash table over (a,
    /// c).
    static constexpr int kMostInSquare = 160;

    /// A seed (a, b, c) with one b.
    struct Slot {
        int a = -1;  // -1: free
        int c = -1;
        SeedLink first = 0;
    };
    struct Apex {
        std::vector<Slot> seeds;  // by c
        std::vector<SeedLink> square;
        std::vector<Slot> slots;  // a power of two, or none
        List fourths;
    };

    class Mates;
    void build_all(std::size_t most_chains, RunMonitor& monitor);
    void build(int b, const Mates& mates, RunMonitor& monitor);
    void build_listed(int b, RunMonitor& monitor);
    void link_seeds(int b);
    void fill_table(Apex& apex) const;
    SeedLink find(int a, int b, int c) const;
    void make(int a, int b, int c, List& list) const;
    std::size_t in_square(int a, int c) const {
        return static_cast<std::size_t>(a) * static_cast<std::size_t>(scene_.size()) +
               static_cast<std::size_t>(c);
    }
    static std::size_t place(int a, int c, std::size_t mask) {
        const auto key = static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(c);
        return (key * 0x9E3779B97F4A7C15ULL >> 32) & mask;
    }

    const Scene& scene_;
    const Seeds* listed_ = nullptr;  // the seeds, where they are not all there are
    std::size_t most_stored_ = 0;
    bool stored_ = false;
    bool too_many_ = false;
    std::vector<Apex> apexes_;
};

}  // namespace insym
