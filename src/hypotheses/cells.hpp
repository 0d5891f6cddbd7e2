// Places in space counted by cells: what many pairs say alike falls into one of them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "hypotheses/places.hpp"
#include "parallel_for.hpp"
#include "points/cloud.hpp"

namespace insym {

constexpr int kFewVotes = 3;  ///< chance does as well with less

/// A point outside the set, whose images tell mirrors apart.
inline Eigen::Vector3d outside_of(const Cloud& cloud) {
    Eigen::Vector3d outside = 2.2 * cloud.radius() * kOutside.normalized();
    if (cloud.dimension() == 2) outside.z() = 0;
    return outside;
}

/// What a pair votes for, as a point: a translation's vector, an inversion's centre, a mirror's image of a
/// point far outside (which no plane through the set comes near).
inline Eigen::Vector3d ballot_place(SymmetryType type, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& outside) {
    if (type == SymmetryType::translation)
        return (b - a).dot(kAskew) < 0 ? Eigen::Vector3d(a - b) : Eigen::Vector3d(b - a);
    Eigen::Vector3d middle = (a + b) / 2;
    if (type == SymmetryType::inversion || type == SymmetryType::half_turn) return middle;
    const Eigen::Vector3d normal = b - a;
    const double square = normal.squaredNorm();
    if (!(square > 0)) return middle;  // too small a set for squares
    return outside - normal * (2 * normal.dot(outside - middle) / square);
}

/// Moves places off the borders of cells of this size, where the coordinates of aligned models lie.
inline Eigen::Vector3d off_borders(double size) {
    return size * Eigen::Vector3d(0.37, 0.41, 0.43);
}

/// A cell of the space of isometries, and the side of each axis on which the next one is nearer.
class Cell {
public:
    Cell(const Eigen::Vector3d& place, double size) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double at = place[static_cast<Eigen::Index>(axis)] / size;
            auto low = static_cast<std::int64_t>(at);  // a call of floor takes longer
            if (at < static_cast<double>(low)) --low;
            sum_ += static_cast<std::uint64_t>(low) * kFactors[axis];
            beside_[axis] = at - static_cast<double>(low) < 0.5 ? 0 - kFactors[axis] : kFactors[axis];
        }
    }

    std::uint32_t key() const { return key_of(sum_); }

    /// Of the seven cells whose borders are nearest: `corner` 1 to 7, a bit for each axis.
    std::uint32_t key_beside(unsigned corner) const {
        std::uint64_t there = sum_;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if ((corner >> axis & 1U) != 0) there += beside_[axis];
        return key_of(there);
    }

private:
    static constexpr std::array<std::uint64_t, 3> kFactors{0xD1B54A32D192ED03ULL, 0xAEF17502108EF2D9ULL,
                                                           0x9FB21C651E98DF25ULL};
    static std::uint32_t key_of(std::uint64_t sum) {
        return static_cast<std::uint32_t>(mixed(sum, 0) >> 32U);
    }

    std::uint64_t sum_ = 0;
    std::array<std::uint64_t, 3> beside_{};
};

/// Votes by cell: a hash table with open addresses. Most cells beside a cell are empty, which a small set of
/// bits tells without a look at the table. Two cells of one key among so many are rare, and would only be
/// tried in vain.
class Cells {
public:
    explicit Cells(std::size_t most) {
        std::size_t size = 16;
        while (size < 2 * most) size *= 2;
        mask_ = size - 1;
        slots_.resize(size);
        filled_.resize(size / 8);
    }

    struct Slot {
        std::uint32_t key = 0;
        int count = 0;
        int first = 0;  // of the ballots
    };

    void add(std::uint32_t key, int ballot) {
        Slot& s = slots_[place(key)];
        if (s.count++ == 0) {
            s.key = key;
            s.first = ballot;
            filled_[word(key)] |= bit(key);
        }
    }
    /// Starts to fetch what add and at of this key will look at: the table is larger than a cache.
    void expect(std::uint32_t key) const { __builtin_prefetch(&slots_[key & mask_], 1); }

    /// An empty slot where there are no votes.
    const Slot& at(std::uint32_t key) const { return slots_[place(key)]; }
    int count(std::uint32_t key) const { return (filled_[word(key)] & bit(key)) != 0 ? at(key).count : 0; }

private:
    std::size_t place(std::uint32_t key) const {
        std::size_t k = key & mask_;
        while (slots_[k].count > 0 && slots_[k].key != key) k = (k + 1) & mask_;
        return k;
    }
    std::size_t word(std::uint32_t key) const { return (key >> 6U) & (filled_.size() - 1); }
    static std::uint64_t bit(std::uint32_t key) { return std::uint64_t{1} << (key & 63U); }

    std::size_t mask_ = 0;
    std::vector<Slot> slots_;
    std::vector<std::uint64_t> filled_;
};

/// How many votes a cell has, and the first of the ballots; the fullest cell comes first.
struct Ranked {
    int votes;
    int first;
    bool operator<(const Ranked& o) const { return votes != o.votes ? votes > o.votes : first < o.first; }
};

/// Votes in parts by their cells, which can be counted each by itself, in a table that a cache holds.
class VoteParts {
public:
    static constexpr std::size_t kParts = 16;

    template <class Place>
    VoteParts(std::size_t ballots, double size, Place place) : votes_(ballots) {
        starts_.resize((ballots + kRun - 1) / kRun);
        const auto part_of = [](std::uint32_t key) { return key >> 28U; };
        parallel_for(starts_.size(), [&](std::size_t run) {
            const std::size_t begin = run * kRun, end = std::min(begin + kRun, ballots);
            std::array<std::uint32_t, kRun> keys;
            auto& start = starts_[run];
            start.fill(0);
            for (std::size_t k = begin; k < end; ++k) {
                keys[k - begin] = Cell(place(k), size).key();
                ++start[part_of(keys[k - begin]) + 1];
            }
            start[0] = begin;
            std::partial_sum(start.begin(), start.end(), start.begin());
            auto next = start;
            for (std::size_t k = begin; k < end; ++k)
                votes_[next[part_of(keys[k - begin])]++] = {keys[k - begin], static_cast<int>(k)};
        });
    }

    /// The cells of a part with enough votes. Most hold too few, which a small table of counts tells.
    std::vector<Ranked> count(std::size_t part) const {
        std::size_t places = 16;
        while (places < 4 * size(part)) places *= 2;
        std::vector<std::uint8_t> votes(places, 0);
        visit(part, [&](const Vote& vote) {
            std::uint8_t& v = votes[vote.key & (places - 1)];
            v = static_cast<std::uint8_t>(std::min(v + 1, kFewVotes));
        });
        std::vector<Vote> left;
        visit(part, [&](const Vote& vote) {
            if (votes[vote.key & (places - 1)] >= kFewVotes) left.push_back(vote);
        });
        Cells cells(left.size());
        for (const Vote& vote : left) cells.add(vote.key, vote.ballot);
        std::vector<Ranked> ranked;
        for (const Vote& vote : left) {
            const Cells::Slot& own = cells.at(vote.key);
            if (own.first == vote.ballot && own.count >= kFewVotes)
                ranked.push_back({own.count, vote.ballot});
        }
        return ranked;
    }

private:
    static constexpr std::size_t kRun = 8192;

    struct Vote {
        std::uint32_t key;
        int ballot;
    };

    template <class Visit>
    void visit(std::size_t part, Visit visit) const {
        for (const auto& start : starts_)
            for (std::size_t k = start[part]; k < start[part + 1]; ++k) visit(votes_[k]);
    }
    std::size_t size(std::size_t part) const {
        std::size_t sum = 0;
        for (const auto& start : starts_) sum += start[part + 1] - start[part];
        return sum;
    }

    std::vector<Vote> votes_;  // runs of the ballots in their order, each run by parts
    std::vector<std::array<std::size_t, kParts + 1>> starts_;  // of the parts of each run
};

/// The cells of this size with at least kFewVotes of the places place(0) to place(ballots - 1), in any order;
/// the ballots go by their numbers. On all threads; time and memory linear in the ballots.
template <class Place>
std::vector<Ranked> full_cells(std::size_t ballots, double size, Place place) {
    const VoteParts parts(ballots, size, place);
    std::array<std::vector<Ranked>, VoteParts::kParts> ranked;
    parallel_for(VoteParts::kParts, [&](std::size_t part) { ranked[part] = parts.count(part); });
    std::vector<Ranked> out;
    for (const std::vector<Ranked>& r : ranked) out.insert(out.end(), r.begin(), r.end());
    return out;
}

/// The first `most`, in their order.
inline void keep_fullest(std::vector<Ranked>& ranked, std::size_t most) {
    if (ranked.size() > most) {
        std::nth_element(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(most), ranked.end());
        ranked.resize(most);
    }
    std::sort(ranked.begin(), ranked.end());
}

}  // namespace insym
