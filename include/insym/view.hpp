// Results to look at (component `view`, which needs Embree, Cairo and tinygltf): a page, a scene, a picture.
#pragma once

#include "insym/detect.hpp"
#include "insym/export.hpp"
#include "insym/point_set.hpp"
#include "insym/report.hpp"

#include <iosfwd>

namespace insym {

/// Writes one HTML file that shows `model` and the first `limit` symmetries (0: all) interactively: it needs
/// no network and no other file, works from disk, and treats every name in the input as text. About 0.6 MB
/// and the data: the report without its list of cycles, and 16 bytes for each vertex and triangle.
/// Thread-safe.
INSYM_EXPORT void write_page(std::ostream& out, const DetectResult& result, const ReportContext& context,
                             const Tessellation& model, int limit = 0);

/// Writes the model with the first symmetry as a scene in binary glTF 2.0 (.glb), for Blender, f3d,
/// PowerPoint and others: the faces, edges and points of each cycle in a colour, the axis or plane, the empty
/// slots. In metres where the unit is known, y up. Thread-safe.
INSYM_EXPORT void write_gltf(std::ostream& out, const DetectResult& result, const ReportContext& context,
                             const Tessellation& model);

/// Writes a still picture (PNG) of the first symmetries, up to four that no other implies, each with a line
/// of words. A few seconds; uses up to `threads` threads (0: all cores), which do not change it.
INSYM_EXPORT void write_png(std::ostream& out, const DetectResult& result, const ReportContext& context,
                            const Tessellation& model, int threads = 0);

}  // namespace insym
