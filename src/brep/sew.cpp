#include "brep/sew.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Circle.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <gce_MakeCirc.hxx>
#include <gp.hxx>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>
#include <gp_Vec.hxx>

namespace insym {
namespace {

/// The circle that the curve is on [first, last] to that length, with the angle for its parameter; null if it
/// is none.
Handle(Geom_Circle)
    find_circle(const Handle(Geom_Curve) & curve, double first, double last, double tolerance) {
    const auto point = [&](double share) { return curve->Value(first + share * (last - first)); };
    const gce_MakeCirc through(point(0), point(1. / 3), point(2. / 3));
    if (!through.IsDone()) return {};
    const gp_Pnt centre = through.Value().Location();
    const gp_Vec start(centre, point(0)), normal = start.Crossed(gp_Vec(centre, point(1. / 3)));
    if (normal.Magnitude() <= gp::Resolution()) return {};
    gp_Ax2 frame(centre, gp_Dir(normal), gp_Dir(start));
    frame.Rotate(frame.Axis(), -first);
    Handle(Geom_Circle) circle = new Geom_Circle(frame, through.Value().Radius());
    constexpr int kSamples = 16;
    for (int i = 0; i <= kSamples; ++i) {
        const double t = first + i * (last - first) / kSamples;
        if (circle->Value(t).Distance(curve->Value(t)) > tolerance) return {};
    }
    return circle;
}

/// Open CASCADE's reader makes splines of circles that it has found by the parameters of a surface alone.
void restore_circles(const TopoDS_Shape& shape, double tolerance) {
    for (TopExp_Explorer explorer(shape, TopAbs_EDGE); explorer.More(); explorer.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(explorer.Current());
        TopLoc_Location place;
        double first = 0, last = 0;
        const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, place, first, last);
        if (Handle(Geom_BSplineCurve)::DownCast(curve).IsNull()) continue;
        if (const auto circle = find_circle(curve, first, last, tolerance); !circle.IsNull())
            BRep_Builder().UpdateEdge(edge, circle, place, BRep_Tool::Tolerance(edge));
    }
}

/// Numbers the faces of one compound, and finds these numbers again after sewing.
class LooseFaces {
public:
    void add(const TopoDS_Shape& shape) {
        for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
            if (!faces_.Contains(face.Current())) faces_.Add(face.Current());
    }
    bool empty() const { return faces_.IsEmpty(); }

    /// Shells or solids, and the faces that touch no other.
    std::vector<TopoDS_Shape> sew(double tolerance) {
        BRepBuilderAPI_Sewing sewing(tolerance);
        for (int i = 1; i <= faces_.Extent(); ++i) sewing.Add(faces_(i));
        sewing.Perform();
        for (int i = 1; i <= faces_.Extent(); ++i)
            sewn_.Add(sewing.IsModified(faces_(i)) ? sewing.Modified(faces_(i)) : faces_(i));
        std::vector<std::pair<int, TopoDS_Shape>> found;
        const TopoDS_Shape& result = sewing.SewedShape();
        for (TopExp_Explorer shell(result, TopAbs_SHELL); shell.More(); shell.Next())
            found.push_back(in_order(TopoDS::Shell(shell.Current())));
        for (TopExp_Explorer face(result, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next())
            found.emplace_back(sewn_.FindIndex(face.Current()), face.Current());
        std::stable_sort(found.begin(), found.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        std::vector<TopoDS_Shape> shapes;
        shapes.reserve(found.size());
        for (const auto& [first, shape] : found) shapes.push_back(shape);
        return shapes;
    }

private:
    /// The least number of its faces and the shell with these in their order, as a solid if it is closed.
    std::pair<int, TopoDS_Shape> in_order(const TopoDS_Shell& shell) const {
        std::vector<std::pair<int, TopoDS_Shape>> faces;
        for (TopoDS_Iterator face(shell); face.More(); face.Next())
            faces.emplace_back(sewn_.FindIndex(face.Value()), face.Value());
        std::stable_sort(faces.begin(), faces.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        const BRep_Builder builder;
        TopoDS_Shell ordered;
        builder.MakeShell(ordered);
        for (const auto& [number, face] : faces) builder.Add(ordered, face);
        const int first = faces.empty() ? 0 : faces.front().first;
        if (!BRep_Tool::IsClosed(ordered)) return {first, ordered};
        ordered.Closed(true);
        TopoDS_Solid solid;
        builder.MakeSolid(solid);
        builder.Add(solid, ordered);
        BRepLib::OrientClosedSolid(solid);
        return {first, solid};
    }

    TopTools_IndexedMapOfShape faces_, sewn_;
};

TopoDS_Shape with_name_of(const TopoDS_Shape& old, const TopoDS_Shape& changed, PartNames& names) {
    if (const auto name = names.find(old.TShape().get()); name != names.end())
        names.emplace(changed.TShape().get(), std::string(name->second));
    return changed;
}

}  // namespace

TopoDS_Shape sewn(const TopoDS_Shape& shape, double tolerance, PartNames& names) {
    if (shape.ShapeType() == TopAbs_SOLID || shape.ShapeType() > TopAbs_FACE) return shape;
    const BRep_Builder builder;
    TopoDS_Compound result;
    builder.MakeCompound(result);
    LooseFaces loose;
    if (shape.ShapeType() > TopAbs_SOLID)
        loose.add(shape);
    else
        for (TopoDS_Iterator child(shape); child.More(); child.Next()) {
            const TopAbs_ShapeEnum type = child.Value().ShapeType();
            if (type == TopAbs_SHELL || type == TopAbs_FACE)
                loose.add(child.Value());
            else
                builder.Add(result, sewn(child.Value(), tolerance, names));
        }
    if (!loose.empty())
        for (const TopoDS_Shape& part : loose.sew(tolerance)) {
            restore_circles(part, tolerance);
            builder.Add(result, part);
        }
    return with_name_of(shape, result, names);
}

}  // namespace insym
