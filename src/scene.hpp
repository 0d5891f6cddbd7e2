// What all stages of a detection look at: the merged points, their distances, the two lengths.
#pragma once

#include "insym/detect.hpp"

#include "points/distances.hpp"

namespace insym {

/// Immutable while the detection runs.
struct PointScene {
    const PointSet& points;
    double diameter = 0;
    double resolution = 0;     ///< absolute: lengths that differ by no more are equal
    double max_tolerance = 0;  ///< absolute: nothing above it is looked for

    int size() const { return static_cast<int>(points.size()); }
    int dimension() const { return points.dimension; }
    int label(int i) const { return points.labels.empty() ? 0 : points.labels[static_cast<std::size_t>(i)]; }
    const Point& position(int i) const { return points.positions[static_cast<std::size_t>(i)]; }
};

/// The same with all distances, for method `paper`.
struct Scene : PointScene {
    const Distances& distances;
};

}  // namespace insym
