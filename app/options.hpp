// The command line: what was asked for, checked, in the library's words.
#pragma once

#include "insym/detect.hpp"
#include "insym/guarded_read.hpp"
#include "insym/read_mesh.hpp"
#include "insym/read_points.hpp"

#include <optional>
#include <string>

namespace insym::app {

struct Options {
    std::string input;            ///< a path, or "-" for standard input
    std::string json;             ///< a path, "-" for standard output, empty for no report
    std::string html, gltf, png;  ///< paths, empty for none
    bool view = false;            ///< show the page in the browser
    int shown = 0;                ///< symmetries in the page, 0: all
    DetectOptions detect;
    ReadPointsOptions read_points;
    ReadMeshOptions read_mesh;  ///< of models, too
    ReadLimits limits;          ///< of reading a model
    std::string points;  ///< what stands for a model, as in the report: "representative", "edges,faces", ...
    int limit = 0;       ///< symmetries in the table, 0: all
    int threads = 0;     ///< 0: all cores
    std::optional<double> time_limit_s;
    bool all = false;     ///< also what follows from other symmetries
    bool levels = false;  ///< the table of tolerances as well
    bool quiet = false;
};

/// What to do: run with `options`, or, if `text` is not empty, print it (help, version).
struct Command {
    Options options;
    std::string text;
};

/// Throws Error(invalid_option) with a sentence that names the option and what it takes.
Command parse_command_line(int argc, const char* const* argv);

}  // namespace insym::app
