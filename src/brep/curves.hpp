// Edges: what a curve is, its length and its special point; arcs of one circle or ellipse put together.
#pragma once

#include "insym/point_set.hpp"

#include <utility>
#include <vector>

#include <BRepAdaptor_Curve.hxx>
#include <TopoDS_Edge.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pnt.hxx>

namespace insym {

/// The special point of an edge that is no circle or ellipse, and what is known of it (ids apart). An
/// infinite curve has none: its length is then not finite.
std::pair<gp_Pnt, Entity> describe_curve(const TopoDS_Edge& edge);

/// True for edges on a circle or an ellipse.
bool is_conic(const TopoDS_Edge& edge);

/// A circle or ellipse with the part of it that its arcs cover.
class Conic {
public:
    explicit Conic(const TopoDS_Edge& edge);

    /// True if both are arcs of one curve, to that length.
    bool same_curve(const Conic& other, double tolerance) const;
    /// Takes over the arcs of the other, which must be of the same curve. Arcs may lie over one another.
    void absorb(const Conic& other);

    const gp_Pnt& center() const { return frame_.Location(); }
    double radius() const { return major_; }
    Entity describe() const;

private:
    double angle_of(const gp_Pnt& point) const;
    double covered_length() const;

    gp_Ax2 frame_;
    double major_ = 0, minor_ = 0;
    std::vector<std::pair<double, double>> arcs_;  ///< from, to in the frame's angle; 0 <= from < 2 pi
};

/// The least and the greatest value of the coordinate along `axis` over the edge.
std::pair<double, double> extent_along(const TopoDS_Edge& edge, const gp_Ax1& axis);

/// Points along the edge, its ends included.
std::vector<gp_Pnt> sample(const TopoDS_Edge& edge, int intervals);

}  // namespace insym
