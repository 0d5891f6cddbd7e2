// The chance that a scattered set has a point near a given place (docs/significance.md).
#pragma once

#include <array>
#include <vector>

#include "scene.hpp"

namespace insym {

/// The background of the a-contrario count: points are scattered as densely, and in as many directions, as
/// they lie around each point of the set: in space, in a plane, along a line or in between. Immutable.
class Background {
public:
    explicit Background(const PointScene& scene);

    /// The mean chance that one more point falls within `reach` of a place where the set has points; 0..1.
    double chance(double reach) const;

private:
    static constexpr int kSteps = 200;
    double low_ = 0;        // the least reach of the table
    double log_ratio_ = 0;  // of one step of it
    std::vector<double> chance_;
};

}  // namespace insym
