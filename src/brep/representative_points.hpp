// One special point for each vertex, edge and face (section 1 of the paper), as read_model.hpp describes
// them.
#pragma once

#include "insym/point_set.hpp"
#include "insym/read_model.hpp"

#include <vector>

#include <gp_Pnt.hxx>

#include "brep/model_shape.hpp"

namespace insym {

struct RepresentativePoint {
    gp_Pnt position;
    Entity entity;
};

/// In the order of vertices, edges, faces and of ids, all lengths in millimetres.
std::vector<RepresentativePoint> representative_points(const ModelShape& model,
                                                       const ReadModelOptions& options);

}  // namespace insym
