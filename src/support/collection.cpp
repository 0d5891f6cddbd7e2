#include "support/collection.hpp"

#include <algorithm>
#include <utility>

namespace insym {
namespace {

bool improper(SymmetryType type) {
    return is_improper(type, 3);
}

bool may_be(SymmetryType suggested, SymmetryType kept) {
    if (suggested == kept) return true;
    if (suggested == SymmetryType::screw) return !improper(kept);
    if (suggested == SymmetryType::rotation) return kept == SymmetryType::half_turn;
    if (suggested == SymmetryType::rotation_reflection) return improper(kept);
    return false;
}

}  // namespace

bool has_link(const Support& support, int from, int to) {
    return std::binary_search(support.links.begin(), support.links.end(), std::pair(from, to));
}

bool Collection::explains(const Hypothesis& h) const {
    if (h.from[0] < 0) return false;
    bool explained = false;
    by_link_.visit(h.from[0], h.to[0], [&](int id) {
        const Support& s = supports_[static_cast<std::size_t>(id)];
        if (explained || !may_be(h.type, s.type)) return;
        bool forward = true, backward = true;
        for (std::size_t k = 0; k < h.from.size() && h.from[k] >= 0; ++k) {
            forward = forward && has_link(s, h.from[k], h.to[k]);
            backward = backward && has_link(s, h.to[k], h.from[k]);
        }
        explained = forward || backward;
    });
    return explained;
}

bool Collection::knows(const RigidMap& map, double radius) const {
    return std::any_of(supports_.begin(), supports_.end(), [&](const Support& s) {
        return (s.map.linear - map.linear).norm() * radius + (s.map.shift - map.shift).norm() <= s.tolerance;
    });
}

int Collection::same(const Support& support) const {
    constexpr double kShare = 0.8;
    const auto size = static_cast<double>(support.links.size());
    // How many of the links each support shares, in either direction.
    std::vector<int> shared(supports_.size(), 0), met;
    for (const auto& [from, to] : support.links)
        by_link_.visit(from, to, [&](int id) {
            if (shared[static_cast<std::size_t>(id)]++ == 0) met.push_back(id);
        });
    int first = -1;
    for (const int id : met) {
        if (first >= 0 && id > first) continue;
        const int count = shared[static_cast<std::size_t>(id)];
        const Support& other = supports_[static_cast<std::size_t>(id)];
        // The links of one, or nearly so, among those of the other of the same kind: a part of it.
        const auto larger = std::max(size, static_cast<double>(other.links.size()));
        const double smaller = std::min(size, static_cast<double>(other.links.size()));
        const double needed = kShare * (other.type == support.type ? smaller : larger);
        if (smaller < needed || count < needed) continue;
        int forward = 0, backward = 0;
        for (const auto& [from, to] : support.links) {
            forward += has_link(other, from, to) ? 1 : 0;
            backward += has_link(other, to, from) ? 1 : 0;
        }
        if (std::max(forward, backward) >= needed) first = id;
    }
    return first;
}

void Collection::enter(int id) {
    for (const auto& [from, to] : supports_[static_cast<std::size_t>(id)].links) by_link_.add(from, to, id);
}

bool Collection::add(Support support) {
    const int id = same(support);
    if (id < 0) {
        supports_.push_back(std::move(support));
        enter(static_cast<int>(supports_.size()) - 1);
        return true;
    }
    Support& kept = supports_[static_cast<std::size_t>(id)];
    if (worth(kept, 3) <= worth(support, 3)) return false;
    kept = std::move(support);
    enter(id);
    return true;
}

}  // namespace insym
