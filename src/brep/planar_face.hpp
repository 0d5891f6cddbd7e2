// Area and centroid of flat faces from their edges in space.
#pragma once

#include <TopoDS_Face.hxx>
#include <gp_Ax1.hxx>
#include <gp_XYZ.hxx>

namespace insym {

/// Adds the area of a face in the plane through and normal to `axis`, and the area times its centroid. By
/// Green's theorem, from the edges themselves: exact to rounding for lines and circles, where Open CASCADE's
/// integrals are good for about six digits and need curves in parameters.
void add_planar_integrals(const TopoDS_Face& face, const gp_Ax1& axis, double& area, gp_XYZ& moment);

}  // namespace insym
