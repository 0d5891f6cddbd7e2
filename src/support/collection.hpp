// The supports found so far, each isometry once.
#pragma once

#include <vector>

#include "support/link_index.hpp"
#include "support/support.hpp"

namespace insym {

/// Not thread-safe. Kept in the order of arrival.
class Collection {
public:
    /// True if a support that is kept holds all the links that suggest this hypothesis, in one direction.
    bool explains(const Hypothesis& hypothesis) const;

    /// True if a support that is kept moves no point of a ball of `radius` about the origin by more than its
    /// tolerance otherwise than `map`.
    bool knows(const RigidMap& map, double radius) const;

    /// Keeps a support; where one of the same links, or their inverses, is kept already, the more significant
    /// stays. False if nothing changed.
    bool add(Support support);

    const std::vector<Support>& supports() const { return supports_; }

private:
    int same(const Support& support) const;
    void enter(int id);

    std::vector<Support> supports_;
    LinkIndex by_link_;
};

/// True if `support` carries `from` to `to`.
bool has_link(const Support& support, int from, int to);

}  // namespace insym
