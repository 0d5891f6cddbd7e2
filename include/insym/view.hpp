// Results to look at (component `view`, which needs Embree, Cairo and tinygltf): a page, a scene, a picture.
#pragma once

#include "insym/detect.hpp"
#include "insym/export.hpp"
#include "insym/point_set.hpp"
#include "insym/report.hpp"

#include <iosfwd>

namespace insym {

/// Writes one HTML file that shows `model` and the first `limit` symmetries (0: all) interactively: it needs
/// no network and no other file, works from disk, and treats every name in the input as text. About 0.7 MB
/// and the data: the report without its list of cycles, and 16 bytes for each vertex and triangle.
/// Thread-safe.
INSYM_EXPORT void write_page(std::ostream& out, const DetectResult& result, const ReportContext& context,
                             const Tessellation& model, int limit = 0);

}  // namespace insym
