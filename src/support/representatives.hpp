// Points that stand for the others once the exact symmetries are known.
#pragma once

#include <vector>

#include "hypotheses/generators.hpp"
#include "points/cloud.hpp"
#include "support/support.hpp"

namespace insym {

/// Which points of an orbit stand for it: the outer ones, as its image under any other symmetry has them at
/// its ends, too; or the inner ones, which have others on either side.
enum class Stay { outer, inner };

/// All points but, of those that the exact ones of `supports` carry into one another, one of each `share`,
/// and at least two. Ascending. O(n log n + links).
SearchGroup representatives(const Cloud& cloud, const std::vector<Support>& supports, std::size_t share,
                            Stay stay);

}  // namespace insym
