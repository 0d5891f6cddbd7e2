#include "brep/planar_face.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <BRepAdaptor_Curve.hxx>
#include <BRep_Tool.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pnt.hxx>

namespace insym {
namespace {

/// Nodes and weights of Gauss and Legendre on [-1, 1], the positive half: exact for polynomials of degree 19.
constexpr std::array<std::array<double, 2>, 5> kGauss = {{{0.1488743389816312, 0.2955242247147529},
                                                          {0.4333953941292472, 0.2692667193099963},
                                                          {0.6794095682990244, 0.2190863625159820},
                                                          {0.8650633666889845, 0.1494513491505806},
                                                          {0.9739065285171717, 0.0666713443086881}}};

/// Where to part the curve: at its knots, and an arc so that no piece turns far.
std::vector<double> break_points(const BRepAdaptor_Curve& curve) {
    TColStd_Array1OfReal knots(1, curve.NbIntervals(GeomAbs_CN) + 1);
    curve.Intervals(knots, GeomAbs_CN);
    std::vector<double> breaks = {knots.First()};
    for (int i = 2; i <= knots.Length(); ++i) {
        const double from = knots(i - 1), to = knots(i);
        int pieces = 2;
        if (curve.GetType() == GeomAbs_Line) pieces = 1;
        if (curve.GetType() == GeomAbs_Circle || curve.GetType() == GeomAbs_Ellipse)
            pieces = static_cast<int>(std::ceil((to - from) / (std::numbers::pi / 4)));
        for (int k = 1; k <= pieces; ++k) breaks.push_back(from + (to - from) * k / pieces);
    }
    return breaks;
}

/// In the plane's coordinates from its origin: the integrals of 1, x and y over the region, each a sum over
/// edges of the integrals of (x dy - y dx) / 2, x (x dy - y dx) / 3, y (x dy - y dx) / 3.
struct Integrals {
    double area = 0, x = 0, y = 0;

    void add(const BRepAdaptor_Curve& curve, const gp_Ax2& frame, double sign) {
        const std::vector<double> breaks = break_points(curve);
        for (std::size_t i = 1; i < breaks.size(); ++i)
            for (const auto& [node, weight] : kGauss)
                for (const double side : {-1.0, 1.0}) {
                    const double half = (breaks[i] - breaks[i - 1]) / 2;
                    add_node(curve, frame, (breaks[i] + breaks[i - 1]) / 2 + side * node * half,
                             sign * weight * half);
                }
    }

private:
    void add_node(const BRepAdaptor_Curve& curve, const gp_Ax2& frame, double t, double weight) {
        gp_Pnt point;
        gp_Vec speed;
        curve.D1(t, point, speed);
        const gp_Vec off(frame.Location(), point), u(frame.XDirection()), v(frame.YDirection());
        const double px = off.Dot(u), py = off.Dot(v);
        const double swept = weight * (px * speed.Dot(v) - py * speed.Dot(u));
        area += swept / 2;
        x += px * swept / 3;
        y += py * swept / 3;
    }
};

/// Of the region inside a closed wire, whichever way round it runs.
Integrals integrals_of(const TopoDS_Shape& wire, const gp_Ax2& frame) {
    Integrals sums;
    for (TopExp_Explorer edge(wire.Oriented(TopAbs_FORWARD), TopAbs_EDGE); edge.More(); edge.Next()) {
        const TopoDS_Edge& current = TopoDS::Edge(edge.Current());
        if (BRep_Tool::Degenerated(current)) continue;
        sums.add(BRepAdaptor_Curve(current), frame, current.Orientation() == TopAbs_REVERSED ? -1 : 1);
    }
    if (sums.area < 0) sums = {-sums.area, -sums.x, -sums.y};
    return sums;
}

/// An origin for the sums. Where edges do not quite meet, these depend on it: it must go with the face,
/// wherever its edges begin. Being near also keeps the digits of a small face.
gp_Pnt middle_of_edges(const TopoDS_Face& face) {
    gp_XYZ sum(0, 0, 0);
    int count = 0;
    for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next()) {
        if (BRep_Tool::Degenerated(TopoDS::Edge(edge.Current()))) continue;
        const BRepAdaptor_Curve curve(TopoDS::Edge(edge.Current()));
        const gp_Pnt ends[] = {curve.Value(curve.FirstParameter()), curve.Value(curve.LastParameter())};
        sum += ends[0].XYZ() + ends[1].XYZ();
        count += 2;
    }
    return gp_Pnt(count > 0 ? sum / count : sum);
}

}  // namespace

void add_planar_integrals(const TopoDS_Face& face, const gp_Ax1& axis, double& area, gp_XYZ& moment) {
    const gp_Ax2 frame(middle_of_edges(face), axis.Direction());
    std::vector<Integrals> loops;
    for (TopExp_Explorer wire(face, TopAbs_WIRE); wire.More(); wire.Next())
        loops.push_back(integrals_of(wire.Current(), frame));
    // The outer loop is the largest and the others are cut out, also where a file has some the wrong way
    // round.
    const auto smaller = [](const Integrals& a, const Integrals& b) { return a.area < b.area; };
    const auto outer = std::max_element(loops.begin(), loops.end(), smaller);
    for (auto loop = loops.begin(); loop != loops.end(); ++loop) {
        const double sign = loop == outer ? 1 : -1;
        area += sign * loop->area;
        moment += (frame.Location().XYZ() * loop->area + frame.XDirection().XYZ() * loop->x +
                   frame.YDirection().XYZ() * loop->y) *
                  sign;
    }
}

}  // namespace insym
