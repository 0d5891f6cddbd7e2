#include "property/support/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace insym::property {

namespace {

constexpr double kHeight = 0.7;  // of prisms and anti-prisms over rings of radius 1
constexpr double kTwist = 0.3;   // of twisted prisms, in pitches: neither prism nor anti-prism

/// Every choice of signs and every cyclic shift of (x, y, z), each point once.
std::vector<Point> signed_shifts(const Point& p) {
    std::set<Point> found;
    for (std::size_t shift = 0; shift < 3; ++shift)
        for (unsigned signs = 0; signs < 8; ++signs) {
            Point q{};
            for (std::size_t i = 0; i < 3; ++i) {
                const double value = p[(i + shift) % 3];
                q[i] = value == 0 || (signs >> i & 1U) == 0 ? value : -value;
            }
            found.insert(q);
        }
    return {found.begin(), found.end()};
}

Point on_ring(int n, double place, double z) {
    const double angle = 2 * std::numbers::pi * place / n;
    return {std::cos(angle), std::sin(angle), z};
}

}  // namespace

double distance(const Point& a, const Point& b) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
}

double diameter(const std::vector<Point>& points) {
    double longest = 0;
    for (const Point& a : points)
        for (const Point& b : points) longest = std::max(longest, distance(a, b));
    return longest;
}

Shape tetrahedron() {
    return {"tetrahedron", 3, {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};
}

Shape cube() {
    return {"cube", 3, signed_shifts({1, 1, 1})};
}

Shape octahedron() {
    return {"octahedron", 3, signed_shifts({1, 0, 0})};
}

Shape icosahedron() {
    return {"icosahedron", 3, signed_shifts({0, 1, std::numbers::phi})};
}

Shape dodecahedron() {
    Shape shape{"dodecahedron", 3, signed_shifts({1, 1, 1})};
    const auto rest = signed_shifts({0, 1 / std::numbers::phi, std::numbers::phi});
    shape.points.insert(shape.points.end(), rest.begin(), rest.end());
    return shape;
}

Shape grid27() {
    Shape shape{"grid27", 3, {}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) shape.points.push_back({double(i), double(j), double(k)});
    return shape;
}

Shape two_rings(const std::string& name, int n, double twist) {
    Shape shape{name + std::to_string(n), 3, {}};
    for (int k = 0; k < n; ++k) shape.points.push_back(on_ring(n, k, -kHeight / 2));
    for (int k = 0; k < n; ++k) shape.points.push_back(on_ring(n, k + twist, kHeight / 2));
    return shape;
}

Shape prism(int n) {
    return two_rings("prism", n, 0);
}

Shape antiprism(int n) {
    return two_rings("antiprism", n, 0.5);
}

Shape twisted_prism(int n) {
    return two_rings("twisted_prism", n, kTwist);
}

Shape polygon(int n) {
    Shape shape{"polygon" + std::to_string(n), 2, {}};
    for (int k = 0; k < n; ++k) shape.points.push_back(on_ring(n, k, 0));
    return shape;
}

std::vector<Shape> all_shapes() {
    std::vector<Shape> shapes = {tetrahedron(), cube(),         octahedron(),
                                 icosahedron(), dodecahedron(), grid27()};
    for (int n = 3; n <= 12; ++n) {
        shapes.push_back(prism(n));
        shapes.push_back(antiprism(n));
        shapes.push_back(twisted_prism(n));
        shapes.push_back(polygon(n));
    }
    return shapes;
}

}  // namespace insym::property
