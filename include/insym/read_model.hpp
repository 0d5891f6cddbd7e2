// Reader for boundary models (component `brep`, which needs Open CASCADE).
#pragma once

#include "insym/export.hpp"
#include "insym/point_set.hpp"

#include <string>

namespace insym {

/// Reads the distinct vertices of a STEP file (AP203, AP214, AP242), assemblies placed.
///
/// Lengths are in `unit` of the result. Entities are the vertices, their ids 1-based in the order
/// of Open CASCADE's map of the whole shape's vertices. Not thread-safe: Open CASCADE's readers
/// keep global state; calls are serialised inside.
/// Throws Error: cannot_read (no such file, not STEP, damaged), invalid_input (no geometry).
INSYM_EXPORT Input read_model_file(const std::string& path);

/// True if the ending of `path` is one that read_model_file() takes.
INSYM_EXPORT bool is_model_path(const std::string& path);

}  // namespace insym
