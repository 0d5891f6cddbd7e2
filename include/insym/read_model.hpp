// Reader for boundary models (component `brep`, which needs Open CASCADE).
#pragma once

#include "insym/entity_labels.hpp"
#include "insym/export.hpp"
#include "insym/point_set.hpp"

#include <string>

namespace insym {

/// Which entities of a model or a mesh give a point, and how the points are labelled.
struct ReadModelOptions {
    bool vertices = true;
    bool edges = true;
    bool faces = true;
    LabelOptions labels{};
    bool tessellate = false;  ///< also fill Input::tessellation, for pictures
};

/// Reads the representative points of a STEP (AP203, AP214, AP242), IGES or BREP (text or binary) file,
/// assemblies placed. Each moves with the model, wherever seams and parameters begin:
/// vertex: its position; edge: line: midpoint; circle, ellipse: centre; another curve: midpoint by length, or
/// centroid if it is closed; face: plane: centroid; cylinder, cone: the point of the axis halfway between
/// the ends of the face; sphere, torus: centre; another surface: centroid of area.
///
/// Arcs of one circle or ellipse in one body are one entity, as are faces of one cylinder, cone, sphere or
/// torus that adjoin. What only begins or divides these gives no point: seams, degenerate edges, and, where
/// edges are chosen, the vertices on one such curve alone. Chosen without edges, all vertices count.
///
/// Faces of an IGES file that stand alone are sewn first, within the resolution that the file names, at least
/// 1e-6 and at most 1e-4 of the diagonal of its box.
///
/// Lengths are in `unit` of the result; BREP files name none and are in mm by Open CASCADE's convention.
/// Ids are 1-based indices into Open CASCADE's maps (TopExp::MapShapes) of the whole shape's vertices, edges
/// and faces, which is how FreeCAD (Face1, Edge1, ...) and CadQuery (faces().vals()) number them. Points come
/// in the order of vertices, edges, faces, and of ids. Not thread-safe: Open CASCADE's readers keep global
/// state; calls are serialised inside. Throws Error: cannot_read (no such file, another format, damaged),
/// invalid_input (no geometry), invalid_option (nothing chosen, a label tolerance out of range).
INSYM_EXPORT Input read_model_file(const std::string& path, const ReadModelOptions& options = {});

/// True if the ending of `path` is one that read_model_file() takes.
INSYM_EXPORT bool is_model_path(const std::string& path);

}  // namespace insym
