// Faces that stand alone, each with edges and vertices of its own, into shells and solids that share them.
#pragma once

#include <TopoDS_Shape.hxx>

#include "brep/model_shape.hpp"

namespace insym {

/// The shape with the loose faces of each compound sewn where their edges are nearer than `tolerance`, and
/// closed shells made solids with the material inside. Faces of a shell keep their order; `names` follow.
TopoDS_Shape sewn(const TopoDS_Shape& shape, double tolerance, PartNames& names);

}  // namespace insym
