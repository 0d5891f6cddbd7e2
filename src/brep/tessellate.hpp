// The triangles and polylines that Open CASCADE's mesher makes of a model, for pictures.
#pragma once

#include "insym/point_set.hpp"

#include "brep/model_shape.hpp"

namespace insym {

/// Faces and edges with the ids of read_model.hpp, lengths in the unit of the file. Seams and what the mesher
/// fails on are left out. Vertices are shared within a face.
Tessellation tessellate(const ModelShape& model);

}  // namespace insym
