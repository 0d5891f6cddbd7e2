// Lines of sharp edges from corner to corner, and what curve each is.
#pragma once

#include "insym/point_set.hpp"

#include <utility>
#include <vector>

#include "mesh/mesh_edges.hpp"

namespace insym {

struct FeatureLine {
    std::vector<int> vertices;  ///< along the line
    bool closed = false;        ///< the last is followed by the first, and no corner is among them
};

struct FeatureLines {
    std::vector<int> corners;  ///< vertices, ascending
    std::vector<FeatureLine> lines;
};

FeatureLines find_feature_lines(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges,
                                double sharp_angle_deg);

/// The special point of a line and what it is (id apart).
std::pair<Eigen::Vector3d, Entity> describe_line(const TriangleMesh& mesh, const FeatureLine& line);

}  // namespace insym
