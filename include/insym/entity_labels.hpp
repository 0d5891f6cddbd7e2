// Labels that keep unlike parts of a model apart: a cycle of points never mixes them.
#pragma once

#include "insym/export.hpp"
#include "insym/point_set.hpp"

#include <vector>

namespace insym {

/// What has to agree for two points to be alike.
enum class LabelBy {
    entity,  ///< kind, geometry, role, and radius, length and area within a tolerance
    kind,    ///< vertex, edge or face
    none,    ///< nothing: points have no labels
};

struct LabelOptions {
    LabelBy by = LabelBy::entity;
    /// Share of its value by which a radius, length or area may differ from the next one and still count as
    /// equal, in [0, 1). One per cent lets the features of a scanned or triangulated part match, and keeps
    /// holes of neighbouring sizes (3.2 and 3.3 mm) apart.
    double tolerance = 0.01;
};

/// One label for each entity, 0, 1, ...; no labels for LabelBy::none.
///
/// Values are sorted and parted where the next is larger by more than the tolerance. So the labels depend
/// neither on the order of the entities nor on the pose of the model, and are the same for its mirror image.
/// O(n log n). Throws Error(invalid_option) for a tolerance out of range.
INSYM_EXPORT std::vector<int> label_entities(const std::vector<Entity>& entities,
                                             const LabelOptions& options = {});

}  // namespace insym
