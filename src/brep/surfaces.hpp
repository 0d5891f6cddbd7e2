// Faces: what a surface is, and the special point of faces that make up one patch of it.
#pragma once

#include "insym/point_set.hpp"

#include <utility>
#include <vector>

#include <TopoDS_Face.hxx>
#include <gp_Ax1.hxx>
#include <gp_Pnt.hxx>

class Adaptor3d_Surface;

namespace insym {

enum class SurfaceType { plane, cylinder, cone, sphere, torus, other };

/// The surface of a face, as far as it is needed to tell whether another face continues it.
struct Surface {
    SurfaceType type = SurfaceType::other;
    gp_Ax1 axis;            ///< of cylinder, cone and torus; of a sphere only the location, its centre
    double radius = 0;      ///< of cylinder and sphere, the major one of a torus
    double minor = 0;       ///< of a torus
    double half_angle = 0;  ///< of a cone, whose axis begins at the apex
    bool outward = true;    ///< the face's outer side is away from the axis or centre

    explicit Surface(const TopoDS_Face& face);

    /// True for round surfaces that are the same to that length: what parts them is no edge of the shape.
    bool continues(const Surface& other, double tolerance) const;

private:
    bool assign(const Adaptor3d_Surface& surface);
    void assign_revolution(const Adaptor3d_Surface& surface);
    bool normal_is_outward(const TopoDS_Face& face) const;
};

/// The special point of the faces, which lie on one surface and adjoin, and what is known of them (ids
/// apart).
std::pair<gp_Pnt, Entity> describe_patch(const Surface& surface, const std::vector<TopoDS_Face>& faces,
                                         double tolerance);

}  // namespace insym
