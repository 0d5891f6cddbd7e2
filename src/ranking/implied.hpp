// What follows from what: powers and products of better-ranked symmetries (definitions, section 7).
#pragma once

#include "points/cloud.hpp"
#include "run_monitor.hpp"

namespace insym {

/// Puts the generator before its powers: a symmetry of which a more significant one is a power on the same
/// points is the same pattern said with the smaller step, and takes its place. Call before rank().
/// O(symmetries^2 * points) at worst; past the deadline the rest stays as it is, here and below.
void promote_generators(const Cloud& cloud, std::vector<Symmetry>& symmetries, RunMonitor& monitor);

/// Fills implied_by of ranked symmetries: those which, on all the points they carry, are a power or a product
/// of two powers of better-ranked ones that carry (or leave in place) these points too.
void mark_implied(const Cloud& cloud, std::vector<Symmetry>& symmetries, RunMonitor& monitor);

}  // namespace insym
