#include "brep/curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GC_MakeEllipse.hxx>
#include <GProp_GProps.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_Ellipse.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Circ.hxx>
#include <gp_Elips.hxx>

namespace insym {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

const char* name_of(GeomAbs_CurveType type) {
    switch (type) {
        case GeomAbs_Line:
            return "line";
        case GeomAbs_Hyperbola:
            return "hyperbola";
        case GeomAbs_Parabola:
            return "parabola";
        case GeomAbs_BezierCurve:
        case GeomAbs_BSplineCurve:
            return "spline";
        default:
            return "curve";
    }
}

/// The point halfway along the curve by its length.
gp_Pnt halfway(const BRepAdaptor_Curve& curve, double length) {
    const double first = curve.FirstParameter();
    if (curve.GetType() == GeomAbs_Line) return curve.Value((first + curve.LastParameter()) / 2);
    const GCPnts_AbscissaPoint point(curve, length / 2, first, (first + curve.LastParameter()) / 2,
                                     1e-9 * length);
    return curve.Value(point.IsDone() ? point.Parameter() : (first + curve.LastParameter()) / 2);
}

/// The least value of a function on [a, b] that has one minimum there (golden section).
double least_value(const std::function<double(double)>& f, double a, double b) {
    constexpr double kGolden = 0.6180339887498949;
    double x = b - kGolden * (b - a), y = a + kGolden * (b - a);
    double fx = f(x), fy = f(y);
    for (int step = 0; step < 40; ++step) {
        if (fx < fy) {
            b = y, y = x, fy = fx;
            fx = f(x = b - kGolden * (b - a));
        } else {
            a = x, x = y, fx = fy;
            fy = f(y = a + kGolden * (b - a));
        }
    }
    return std::min(fx, fy);
}

}  // namespace

std::pair<gp_Pnt, Entity> describe_curve(const TopoDS_Edge& edge) {
    const BRepAdaptor_Curve curve(edge);
    Entity entity;
    entity.kind = EntityKind::edge;
    entity.geometry = name_of(curve.GetType());
    if (Precision::IsInfinite(curve.FirstParameter()) || Precision::IsInfinite(curve.LastParameter())) {
        entity.length = std::numeric_limits<double>::infinity();
        return {gp_Pnt(), entity};
    }
    const double length = GCPnts_AbscissaPoint::Length(curve);
    entity.length = length;
    TopoDS_Vertex first, last;
    TopExp::Vertices(edge, first, last);
    if (first.IsNull() || !first.IsSame(last)) return {halfway(curve, length), entity};
    GProp_GProps line;  // where a closed curve begins means nothing
    BRepGProp::LinearProperties(edge, line);
    return {line.CentreOfMass(), entity};
}

bool is_conic(const TopoDS_Edge& edge) {
    const GeomAbs_CurveType type = BRepAdaptor_Curve(edge).GetType();
    return type == GeomAbs_Circle || type == GeomAbs_Ellipse;
}

Conic::Conic(const TopoDS_Edge& edge) {
    const BRepAdaptor_Curve curve(edge);
    if (curve.GetType() == GeomAbs_Circle) {
        frame_ = curve.Circle().Position();
        major_ = minor_ = curve.Circle().Radius();
    } else {
        frame_ = curve.Ellipse().Position();
        major_ = curve.Ellipse().MajorRadius();
        minor_ = curve.Ellipse().MinorRadius();
    }
    arcs_.emplace_back(curve.FirstParameter(), curve.LastParameter());
}

bool Conic::same_curve(const Conic& other, double tolerance) const {
    if (center().Distance(other.center()) > tolerance || std::abs(major_ - other.major_) > tolerance ||
        std::abs(minor_ - other.minor_) > tolerance)
        return false;
    const auto apart = [&](const gp_Dir& a, const gp_Dir& b) {
        return gp_Vec(a).Crossed(gp_Vec(b)).Magnitude();
    };
    return major_ * apart(frame_.Direction(), other.frame_.Direction()) <= tolerance &&
           (major_ - minor_) * apart(frame_.XDirection(), other.frame_.XDirection()) <= tolerance;
}

/// The parameter of a point of the curve.
double Conic::angle_of(const gp_Pnt& point) const {
    const gp_Vec off(center(), point);
    const double angle = std::atan2(off.Dot(gp_Vec(frame_.YDirection())) / minor_,
                                    off.Dot(gp_Vec(frame_.XDirection())) / major_);
    return angle < 0 ? angle + kTurn : angle;
}

void Conic::absorb(const Conic& other) {
    const bool same_way = frame_.Direction().Dot(other.frame_.Direction()) > 0;
    const gp_Vec x = gp_Vec(other.frame_.XDirection()) * other.major_;
    const gp_Vec y = gp_Vec(other.frame_.YDirection()) * other.minor_;
    for (const auto& [from, to] : other.arcs_) {
        const double start = same_way ? from : to;
        const double angle = angle_of(other.center().Translated(x * std::cos(start) + y * std::sin(start)));
        arcs_.emplace_back(angle, angle + (to - from));
    }
}

/// The length of the union of the arcs.
double Conic::covered_length() const {
    std::vector<std::pair<double, double>> pieces;
    for (const auto& [from, to] : arcs_) {
        const double start = from - kTurn * std::floor(from / kTurn);
        const double end = start + std::min(to - from, kTurn);
        pieces.emplace_back(start, std::min(end, kTurn));
        if (end > kTurn) pieces.emplace_back(0, end - kTurn);
    }
    std::sort(pieces.begin(), pieces.end());
    const Handle(Geom_Ellipse) ellipse =
        major_ > minor_ ? new Geom_Ellipse(frame_, major_, minor_) : Handle(Geom_Ellipse)();
    double length = 0, reached = 0;
    for (const auto& [from, to] : pieces) {
        const double start = std::max(from, reached);
        if (to <= start) continue;
        length += ellipse.IsNull() ? major_ * (to - start)
                                   : GCPnts_AbscissaPoint::Length(GeomAdaptor_Curve(ellipse), start, to);
        reached = to;
    }
    return length;
}

Entity Conic::describe() const {
    Entity entity;
    entity.kind = EntityKind::edge;
    entity.geometry = major_ > minor_ ? "ellipse" : "circle";
    entity.radius = major_;
    if (major_ > minor_) entity.minor_radius = minor_;
    entity.length = covered_length();
    return entity;
}

std::pair<double, double> extent_along(const TopoDS_Edge& edge, const gp_Ax1& axis) {
    const BRepAdaptor_Curve curve(edge);
    const auto height = [&](double t) {
        return gp_Vec(axis.Location(), curve.Value(t)).Dot(gp_Vec(axis.Direction()));
    };
    constexpr std::size_t kIntervals = 32;
    const double first = curve.FirstParameter(), step = (curve.LastParameter() - first) / kIntervals;
    std::array<double, kIntervals + 1> heights{};
    for (std::size_t i = 0; i <= kIntervals; ++i) heights[i] = height(first + static_cast<double>(i) * step);
    const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
    if (curve.GetType() == GeomAbs_Line || *highest - *lowest < Precision::Confusion())
        return {*lowest, *highest};
    const auto refined = [&](const double* at, double sign) {
        const auto i = static_cast<double>(at - heights.begin());
        return sign * least_value([&](double t) { return sign * height(t); },
                                  first + step * std::max(i - 1, 0.0),
                                  first + step * std::min(i + 1, double{kIntervals}));
    };
    return {std::min(*lowest, refined(lowest, 1)), std::max(*highest, refined(highest, -1))};
}

std::vector<gp_Pnt> sample(const TopoDS_Edge& edge, int intervals) {
    const BRepAdaptor_Curve curve(edge);
    const double first = curve.FirstParameter(), step = (curve.LastParameter() - first) / intervals;
    std::vector<gp_Pnt> points;
    for (int i = 0; i <= intervals; ++i) points.push_back(curve.Value(first + i * step));
    return points;
}

}  // namespace insym
