// The order of the list: intent before chance.
#pragma once

#include "insym/detect.hpp"

#include <vector>

namespace insym {

/// Sorts by significance; equals by the number of links, the type and the cycles, so that the order is the
/// same in every run. Numbers them from 1.
void rank(std::vector<Symmetry>& symmetries);

}  // namespace insym
