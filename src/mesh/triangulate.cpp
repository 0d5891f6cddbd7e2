#include "mesh/triangulate.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace insym {
namespace {

using Eigen::Vector3d;

/// The corners of one polygon, of which ears are cut until a triangle is left.
class EarClipper {
public:
    EarClipper(const std::vector<Vector3d>& vertices, std::vector<int> polygon)
        : vertices_(vertices), polygon_(std::move(polygon)), normal_(0, 0, 0) {
        for (std::size_t i = 0; i < polygon_.size(); ++i) normal_ += at(i).cross(at(i + 1));
    }

    std::vector<std::array<int, 3>> clip() {
        std::vector<std::array<int, 3>> triangles;
        while (polygon_.size() >= 3) {
            std::size_t ear = 0;
            while (ear < polygon_.size() && !is_ear(ear)) ++ear;
            if (ear == polygon_.size()) ear = 0;  // it crosses itself
            triangles.push_back({corner(ear + polygon_.size() - 1), corner(ear), corner(ear + 1)});
            polygon_.erase(polygon_.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        return triangles;
    }

private:
    int corner(std::size_t i) const { return polygon_[i % polygon_.size()]; }
    const Vector3d& at(std::size_t i) const { return vertices_[static_cast<std::size_t>(corner(i))]; }

    /// On which side of the line from a to b, seen along the normal, c is.
    double side(const Vector3d& a, const Vector3d& b, const Vector3d& c) const {
        return normal_.dot((b - a).cross(c - a));
    }

    bool is_ear(std::size_t i) const {
        if (polygon_.size() == 3) return true;
        const std::size_t n = polygon_.size();
        const Vector3d &a = at(i + n - 1), &b = at(i), &c = at(i + 1);
        if (side(a, b, c) <= 0) return false;
        for (std::size_t k = i + 2; k + 1 < i + n; ++k) {
            const Vector3d& p = at(k);
            if (side(a, b, p) >= 0 && side(b, c, p) >= 0 && side(c, a, p) >= 0) return false;
        }
        return true;
    }

    const std::vector<Vector3d>& vertices_;
    std::vector<int> polygon_;
    Vector3d normal_;  ///< of Newell, of any length
};

}  // namespace

std::vector<std::array<int, 3>> triangulate(const std::vector<Vector3d>& vertices, std::vector<int> polygon) {
    return EarClipper(vertices, std::move(polygon)).clip();
}

}  // namespace insym
