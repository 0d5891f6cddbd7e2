// The result as a JSON report (schema insym.report/1) and as a table for people.
#pragma once

#include "insym/detect.hpp"
#include "insym/export.hpp"

#include <iosfwd>
#include <string>

namespace insym {

/// What the report says beyond the result itself.
struct ReportContext {
    std::string path;                 ///< of the input
    std::string format;               ///< of the input
    std::optional<std::string> unit;  ///< of all lengths
    std::string points = "points";    ///< what they stand for: "points", "representative", "edges,faces", ...
    double load_s = 0;                ///< time to read the input
};

/// Writes the report; all lengths in the input's unit, angles in degrees. Linear in its size.
INSYM_EXPORT void write_json(std::ostream& out, const DetectResult& result, const ReportContext& context);

/// Writes a ranked table of the first `limit` symmetries (0: all) with units, for people. Those that follow
/// from others (implied_by) are only counted unless `all` is set.
INSYM_EXPORT void write_table(std::ostream& out, const DetectResult& result, const ReportContext& context,
                              int limit, bool all = false);

/// Writes from which tolerance to which the set of significant symmetries that nothing implies stays the same
/// (plateaus), and which come and go between.
INSYM_EXPORT void write_levels(std::ostream& out, const DetectResult& result, const ReportContext& context);

}  // namespace insym
