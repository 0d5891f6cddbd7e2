#include "brep/surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <BRepAdaptor_Surface.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <GeomAdaptor_SurfaceOfLinearExtrusion.hxx>
#include <GeomAdaptor_SurfaceOfRevolution.hxx>
#include <Precision.hxx>
#include <ShapeFix_Face.hxx>
#include <ShapeFix_Wire.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Circ.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>

#include "brep/curves.hpp"
#include "brep/planar_face.hpp"

namespace insym {
namespace {

const char* name_of(SurfaceType type) {
    switch (type) {
        case SurfaceType::plane:
            return "plane";
        case SurfaceType::cylinder:
            return "cylinder";
        case SurfaceType::cone:
            return "cone";
        case SurfaceType::sphere:
            return "sphere";
        case SurfaceType::torus:
            return "torus";
        case SurfaceType::other:
            break;
    }
    return "surface";
}

/// The face as Open CASCADE's integrals need it: STEP files mostly leave out the curves in the surface's
/// parameters, and some the seam. What else the healer would look for takes most of its time and is not
/// needed.
TopoDS_Shape with_parameter_curves(const TopoDS_Face& face, double precision) {
    bool complete = true;
    for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next()) {
        double first = 0, last = 0;
        complete &= !BRep_Tool::CurveOnSurface(TopoDS::Edge(edge.Current()), face, first, last).IsNull();
    }
    if (complete) return face;
    ShapeFix_Face fix(face);
    fix.SetPrecision(precision);
    fix.FixIntersectingWiresMode() = fix.FixLoopWiresMode() = fix.FixSmallAreaWireMode() = 0;
    ShapeFix_Wire& wire = *fix.FixWireTool();
    wire.FixSelfIntersectionMode() = wire.FixNotchedEdgesMode() = wire.FixTailMode() = wire.FixSmallMode() =
        0;
    wire.FixGaps2dMode() = wire.FixGaps3dMode() = wire.FixSameParameterMode() = 0;
    fix.Perform();
    return fix.Result();
}

/// Area and centroid of a face that need not be flat.
void add_integrals(const TopoDS_Shape& face, double& area, gp_XYZ& moment) {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(face, properties);
    const double mass = std::abs(properties.Mass());
    area += mass;
    moment += properties.CentreOfMass().XYZ() * mass;
}

/// What the edges of a round patch say: how far it reaches along its axis and how far round it.
class Reach {
public:
    explicit Reach(const gp_Ax1& axis) : frame_(axis.Location(), axis.Direction()), axis_(axis) {}

    void add(const TopoDS_Shape& face) {
        for (TopExp_Explorer explorer(face, TopAbs_EDGE); explorer.More(); explorer.Next()) {
            const TopoDS_Edge& edge = TopoDS::Edge(explorer.Current());
            if (BRep_Tool::Degenerated(edge)) {
                for (TopExp_Explorer vertex(edge, TopAbs_VERTEX); vertex.More(); vertex.Next())
                    include(height(BRep_Tool::Pnt(TopoDS::Vertex(vertex.Current()))));
                continue;
            }
            const auto [low, high] = extent_along(edge, axis_);
            include(low);
            include(high);
            for (const gp_Pnt& point : sample(edge, kSamples)) angles_.push_back(angle(point));
        }
    }

    bool empty() const { return low_ > high_; }
    gp_Pnt middle() const {
        return axis_.Location().Translated(gp_Vec(axis_.Direction()) * ((low_ + high_) / 2));
    }

    /// At least three quarters of the way round the axis.
    bool surrounds() {
        if (angles_.empty()) return true;
        std::sort(angles_.begin(), angles_.end());
        double gap = angles_.front() + 2 * std::numbers::pi - angles_.back();
        for (std::size_t i = 1; i < angles_.size(); ++i) gap = std::max(gap, angles_[i] - angles_[i - 1]);
        return gap <= std::numbers::pi / 2;
    }

private:
    static constexpr int kSamples = 8;

    double height(const gp_Pnt& point) const {
        return gp_Vec(axis_.Location(), point).Dot(gp_Vec(axis_.Direction()));
    }
    double angle(const gp_Pnt& point) const {
        const gp_Vec off(axis_.Location(), point);
        return std::atan2(off.Dot(gp_Vec(frame_.YDirection())), off.Dot(gp_Vec(frame_.XDirection())));
    }
    void include(double value) {
        low_ = std::min(low_, value);
        high_ = std::max(high_, value);
    }

    gp_Ax2 frame_;
    gp_Ax1 axis_;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
    std::vector<double> angles_;
};

bool has_axis(SurfaceType type) {
    return type == SurfaceType::cylinder || type == SurfaceType::cone;
}

EntityRole role_of(const Surface& surface, bool surrounds) {
    if (surrounds) return surface.outward ? EntityRole::boss : EntityRole::hole;
    return surface.outward ? EntityRole::round : EntityRole::hollow;
}

}  // namespace

Surface::Surface(const TopoDS_Face& face) {
    const BRepAdaptor_Surface surface(face, false);
    bool direct = true;
    if (surface.GetType() == GeomAbs_SurfaceOfRevolution || surface.GetType() == GeomAbs_SurfaceOfExtrusion) {
        // What a line or a circle makes has no better description in some formats.
        if (surface.GetType() == GeomAbs_SurfaceOfRevolution)
            assign_revolution(surface);
        else
            assign(GeomAdaptor_SurfaceOfLinearExtrusion(surface.BasisCurve(), surface.Direction()));
        direct = normal_is_outward(face);
    } else {
        direct = assign(surface);
    }
    outward = direct == (face.Orientation() != TopAbs_REVERSED);
}

/// Returns whether the surface's own normal is away from its axis or centre.
bool Surface::assign(const Adaptor3d_Surface& surface) {
    switch (surface.GetType()) {
        case GeomAbs_Plane:
            type = SurfaceType::plane;
            axis = surface.Plane().Axis();
            return true;
        case GeomAbs_Cylinder:
            type = SurfaceType::cylinder;
            axis = surface.Cylinder().Axis();
            radius = surface.Cylinder().Radius();
            return surface.Cylinder().Direct();
        case GeomAbs_Cone:
            type = SurfaceType::cone;
            axis = gp_Ax1(surface.Cone().Apex(), surface.Cone().Axis().Direction());
            half_angle = std::abs(surface.Cone().SemiAngle());
            return surface.Cone().Direct();
        case GeomAbs_Sphere:
            type = SurfaceType::sphere;
            axis.SetLocation(surface.Sphere().Location());
            radius = surface.Sphere().Radius();
            return surface.Sphere().Direct();
        case GeomAbs_Torus:
            type = SurfaceType::torus;
            axis = surface.Torus().Axis();
            radius = surface.Torus().MajorRadius();
            minor = surface.Torus().MinorRadius();
            return surface.Torus().Direct();
        default:
            return true;
    }
}

/// Open CASCADE does not say torus where the circle reaches the axis.
void Surface::assign_revolution(const Adaptor3d_Surface& surface) {
    const gp_Ax1 about = surface.AxeOfRevolution();
    const auto curve = surface.BasisCurve();
    assign(GeomAdaptor_SurfaceOfRevolution(curve, about));
    if (type != SurfaceType::other || curve->GetType() != GeomAbs_Circle) return;
    const gp_Circ circle = curve->Circle();
    const gp_Lin line(about);
    const double major_radius = line.Distance(circle.Location());
    const bool in_plane = line.Direction().IsNormal(circle.Axis().Direction(), Precision::Angular()) &&
                          gp_Pln(circle.Position()).Distance(about.Location()) <= Precision::Confusion();
    if (!in_plane || major_radius < circle.Radius() - Precision::Confusion()) return;
    type = SurfaceType::torus;
    axis = gp_Ax1(
        about.Location().Translated(gp_Vec(about.Direction()) *
                                    gp_Vec(about.Location(), circle.Location()).Dot(about.Direction())),
        about.Direction());
    radius = major_radius;
    minor = circle.Radius();
}

/// The same for a surface whose parameters may run in any direction, seen at the middle of the face.
bool Surface::normal_is_outward(const TopoDS_Face& face) const {
    const BRepAdaptor_Surface surface(face, true);
    gp_Pnt point;
    gp_Vec along_u, along_v;
    surface.D1((surface.FirstUParameter() + surface.LastUParameter()) / 2,
               (surface.FirstVParameter() + surface.LastVParameter()) / 2, point, along_u, along_v);
    gp_Vec off(axis.Location(), point);
    const gp_Vec direction(axis.Direction());
    if (type != SurfaceType::sphere) off -= direction * off.Dot(direction);
    if (type == SurfaceType::torus && off.Magnitude() > 0)
        off = gp_Vec(axis.Location().Translated(off.Normalized() * radius), point);
    return along_u.Crossed(along_v).Dot(off) >= 0;
}

bool Surface::continues(const Surface& other, double tolerance) const {
    if (type != other.type || type == SurfaceType::plane || type == SurfaceType::other) return false;
    if (std::abs(radius - other.radius) > tolerance || std::abs(minor - other.minor) > tolerance ||
        outward != other.outward)
        return false;
    const gp_Pnt& center = other.axis.Location();
    if (type == SurfaceType::sphere) return axis.Location().Distance(center) <= tolerance;
    constexpr double kParallel = 1e-6;  // rad
    if (gp_Vec(axis.Direction()).Crossed(gp_Vec(other.axis.Direction())).Magnitude() > kParallel)
        return false;
    if (type == SurfaceType::cylinder) return gp_Lin(axis).Distance(center) <= tolerance;
    return axis.Location().Distance(center) <= tolerance &&
           std::abs(half_angle - other.half_angle) <= kParallel;
}

std::pair<gp_Pnt, Entity> describe_patch(const Surface& surface, const std::vector<TopoDS_Face>& faces,
                                         double tolerance) {
    Entity entity;
    entity.kind = EntityKind::face;
    entity.geometry = name_of(surface.type);
    if (surface.radius > 0) entity.radius = surface.radius;
    if (surface.minor > 0) entity.minor_radius = surface.minor;

    double area = 0;
    gp_XYZ moment(0, 0, 0);
    Reach reach(surface.axis);
    for (const TopoDS_Face& face : faces) {
        if (surface.type == SurfaceType::plane) {
            add_planar_integrals(face, surface.axis, area, moment);
            continue;
        }
        const TopoDS_Shape complete = with_parameter_curves(face, tolerance);
        add_integrals(complete, area, moment);
        if (has_axis(surface.type)) reach.add(complete);
    }
    entity.area = area;
    const gp_Pnt centroid(area > 0 ? moment / area : surface.axis.Location().XYZ());
    if (surface.type == SurfaceType::sphere || surface.type == SurfaceType::torus) {
        entity.role = role_of(surface, false);
        return {surface.axis.Location(), entity};
    }
    if (!has_axis(surface.type)) return {centroid, entity};
    entity.role = role_of(surface, reach.surrounds());
    return {reach.empty() ? centroid : reach.middle(), entity};
}

}  // namespace insym
