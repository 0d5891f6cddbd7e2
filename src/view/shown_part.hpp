// What pictures show of a result, and where its middle is.
#pragma once

#include "insym/detect.hpp"

namespace insym {

/// The result with the first `limit` symmetries (0: all) and without the list of cycles, which is long and
/// not shown. `stats` still counts everything.
DetectResult shown_part(const DetectResult& result, int limit);

/// The middle of the box around the points and the model.
Point middle_of(const DetectResult& result, const Tessellation& model);

}  // namespace insym
