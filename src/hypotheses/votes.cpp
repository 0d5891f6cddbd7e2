#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

#include "hypotheses/cells.hpp"
#include "hypotheses/generators.hpp"

namespace insym {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

RigidMap map_of(SymmetryType type, const Vector3d& a, const Vector3d& b, int dimension) {
    return fit_of_type(type, {{a, b}}, dimension);
}

/// The votes of one kind, counted.
class Count {
public:
    Count(const Cloud& cloud, SymmetryType type, const PointPairs& pairs)
        : cloud_(cloud), type_(type), pairs_(pairs), outside_(outside_of(cloud)), alive_(pairs.size()) {
        std::iota(alive_.begin(), alive_.end(), 0);
    }

    /// The fullest cells of this size, the fullest last. What was alone in a wider cell is not asked again.
    /// `joined`: with the cells beside, as what votes for the same may stand on either side of a border.
    void fullest(double size, bool joined, std::size_t most, std::vector<Hypothesis>& out) {
        std::vector<Ranked> ranked = joined ? count_joined(size) : count(size);
        keep_fullest(ranked, most);
        for (std::size_t k = ranked.size(); k-- > 0;) out.push_back(hypothesis(ranked[k].first, size));
    }

private:
    std::vector<Ranked> count(double size) const {
        auto ranked = full_cells(alive_.size(), size, [this](std::size_t k) { return place(alive_[k]); });
        for (Ranked& r : ranked) r.first = alive_[static_cast<std::size_t>(r.first)];
        return ranked;
    }

    std::vector<Ranked> count_joined(double size) {
        Cells cells(alive_.size());
        std::vector<std::uint32_t> keys;
        keys.reserve(alive_.size());
        for (const int b : alive_) keys.push_back(Cell(place(b), size).key());
        constexpr std::size_t kAhead = 16;
        const auto expect = [&](std::size_t k) {
            if (k < keys.size()) cells.expect(keys[k]);
        };
        for (std::size_t k = 0; k < keys.size(); ++k) {
            expect(k + kAhead);
            cells.add(keys[k], alive_[k]);
        }
        std::vector<Ranked> ranked;
        std::vector<int> company;
        for (std::size_t k = 0; k < alive_.size(); ++k) {
            expect(k + kAhead);
            const int b = alive_[k];
            const Cells::Slot& own = cells.at(keys[k]);
            const bool leads = own.first == b;  // the others of its cell need not look further
            if (!leads && own.count >= kFewVotes) {
                company.push_back(b);
                continue;
            }
            // A cell is joined with the seven whose borders the vote is nearest to.
            const Cell home(place(b), size);
            int votes = own.count, fullest = own.count;
            for (unsigned corner = 1; corner < 8; ++corner) {
                const int near = cells.count(home.key_beside(corner));
                votes += near;
                fullest = std::max(fullest, near);
            }
            if (votes < kFewVotes) continue;
            company.push_back(b);
            if (leads && own.count == fullest) ranked.push_back({votes, b});
        }
        alive_ = std::move(company);
        return ranked;
    }

    /// Where in the space of isometries.
    Vector3d place(int ballot) const {
        const auto& [from, to] = pairs_[static_cast<std::size_t>(ballot)];
        return ballot_place(type_, cloud_[from], cloud_[to], outside_);
    }

    Hypothesis hypothesis(int ballot, double size) const {
        const auto& [from, to] = pairs_[static_cast<std::size_t>(ballot)];
        Hypothesis h;
        h.type = type_;
        h.map = map_of(type_, cloud_[from], cloud_[to], cloud_.dimension());
        h.center = (cloud_[from] + cloud_[to]) / 2;
        h.radius = (cloud_[from] - cloud_[to]).norm() / 2;
        h.off = size / 4;
        h.from[0] = from;
        h.to[0] = to;
        return h;
    }

    const Cloud& cloud_;
    SymmetryType type_;
    const PointPairs& pairs_;  // the ballots
    Vector3d outside_;
    std::vector<int> alive_;  // those that are not alone in a wider cell
};

}  // namespace

PointPairs spread_pairs(const Cloud& cloud, const SearchGroup& points, std::size_t most) {
    std::map<int, std::vector<int>> classes;
    for (const int i : points) classes[cloud.label(i)].push_back(i);
    double total = 0;
    for (const auto& [label, members] : classes)
        total += static_cast<double>(members.size()) * static_cast<double>(members.size() - 1) / 2;
    const double share = std::min(1.0, static_cast<double>(most) / std::max(1.0, total));
    PointPairs pairs;
    pairs.reserve(static_cast<std::size_t>(std::min(total, 1.1 * static_cast<double>(most))));
    for (auto& [label, members] : classes) {
        const std::size_t m = members.size();
        std::stable_sort(members.begin(), members.end(),
                         [&](int a, int b) { return cloud[a].squaredNorm() < cloud[b].squaredNorm(); });
        if (share >= 1) {
            for (std::size_t i = 0; i < m; ++i)
                for (std::size_t j = i + 1; j < m; ++j) pairs.emplace_back(members[i], members[j]);
            continue;
        }
        // With an anchor at either end of a share 1 - (1 - a)^2 of the pairs.
        const auto anchors = std::clamp<std::size_t>(
            static_cast<std::size_t>(share / 2 * static_cast<double>(m)), std::min<std::size_t>(m, 8), m);
        std::vector<std::size_t> anchor;
        for (std::size_t k = 0; k < anchors; ++k) anchor.push_back((k * m + m / 2) / anchors);
        auto next = anchor.begin();
        for (std::size_t i = 0; i < m; ++i) {
            // Mates under a symmetry of the whole stand side by side in this order.
            constexpr std::size_t kBeside = 3;
            const bool with_all = next != anchor.end() && *next == i;
            const std::size_t beside = with_all ? m : std::min(m, i + kBeside + 1);
            for (std::size_t j = i + 1; j < beside; ++j) pairs.emplace_back(members[i], members[j]);
            if (with_all) ++next;
            for (auto a = std::lower_bound(next, anchor.end(), beside); a != anchor.end(); ++a)
                pairs.emplace_back(members[i], members[*a]);
        }
    }
    return pairs;
}

PointPairs pairs_within(const SearchGroup& group, const Focus& focus) {
    PointPairs pairs;
    pairs.reserve(group.size() * group.size() / 2);
    for (std::size_t i = 0; i < group.size(); ++i)
        for (std::size_t j = i + 1; j < group.size(); ++j)
            if (in(focus, group[i]) || in(focus, group[j])) pairs.emplace_back(group[i], group[j]);
    return pairs;
}

std::vector<Hypothesis> vote(const Cloud& cloud, SymmetryType type, const PointPairs& pairs, double reach,
                             std::size_t most) {
    Count count(cloud, type, pairs);
    std::vector<Hypothesis> out;  // the widest cells first, and last turned round
    const double finest = 8 * cloud.scene().resolution;
    double size = 2 * reach;
    while (size > finest) {
        count.fullest(size, true, most, out);
        size /= 8;
    }
    // What is exact is much smaller than a cell; what is not came up in wider ones.
    count.fullest(finest, false, most, out);
    std::reverse(out.begin(), out.end());
    return out;
}

}  // namespace insym
