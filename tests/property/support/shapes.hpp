// Exact point sets whose symmetries group theory knows.
#pragma once

#include "insym/point_set.hpp"

#include <string>
#include <vector>

namespace insym::property {

struct Shape {
    std::string name;
    int dimension = 3;
    std::vector<Point> points;
};

Shape tetrahedron();
Shape cube();
Shape octahedron();
Shape icosahedron();
Shape dodecahedron();

/// The 27 points of a 3 x 3 x 3 grid.
Shape grid27();

/// Two rings of n points, the upper one turned by `twist` times the pitch 360 / n degrees. The
/// height keeps every accidental equality of lengths away (checked by the brute-force tests).
Shape two_rings(const std::string& name, int n, double twist);
Shape prism(int n);
Shape antiprism(int n);
Shape twisted_prism(int n);

/// A regular polygon in the plane (dimension 2).
Shape polygon(int n);

/// All of the above, rings of order 3 to 12.
std::vector<Shape> all_shapes();

/// Longest distance between two points.
double diameter(const std::vector<Point>& points);

/// Root of the sum of squares, as reference.py computes it: ties are decided by the last bit.
double distance(const Point& a, const Point& b);

}  // namespace insym::property
