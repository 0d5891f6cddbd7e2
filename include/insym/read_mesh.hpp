// Reader for triangle meshes (component `mesh`, which needs Assimp).
#pragma once

#include "insym/export.hpp"
#include "insym/point_set.hpp"
#include "insym/read_model.hpp"

#include <string>

namespace insym {

struct ReadMeshOptions {
    ReadModelOptions model{};     ///< which features give points, and how they are labelled
    double sharp_angle_deg = 30;  ///< an edge is sharp where its faces turn by more, in (0, 180)
};

/// Reads the feature points of a mesh: STL, OBJ, PLY or OFF, text or binary.
///
/// Equal vertices are welded: those nearer than 1e-6 of the diagonal of the mesh's box. Vertices: the corners
/// of the lines of sharp edges, where three or more meet, one ends, or the line turns by more than the sharp
/// angle. Edges: the lines between corners and the closed ones; a circle or arc by its centre, with the
/// radius fitted to it; a straight one by its midpoint; another by its midpoint by length, or its centroid if
/// closed. Faces: flat regions, by their centroid; not those below 1e-4 of the whole area, nor the facets of
/// a curved face, which go on smoothly into others like them; what is within 2e-3 of the diagonal of a plane
/// between its sharp edges is one flat region.
///
/// Meshes have no unit. Ids are 1-based: for vertices the index after welding, in the order of the file; for
/// lines and regions their own order, which follows the file. Thread-safe. O(n log n) for n triangles. Throws
/// Error: cannot_read (no such file, damaged, another format), invalid_input (no triangles, no features),
/// invalid_option (nothing chosen, an angle or label tolerance out of range).
INSYM_EXPORT Input read_mesh_file(const std::string& path, const ReadMeshOptions& options = {});

/// True if the ending of `path` is one that read_mesh_file() takes.
INSYM_EXPORT bool is_mesh_path(const std::string& path);

}  // namespace insym
