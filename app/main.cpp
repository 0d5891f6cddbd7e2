// insym: the command line. Reads the input, calls the library, writes the results; the contract for
// options, report and exit status is what `insym detect --help` says.
#include "insym/detect.hpp"
#include "insym/error.hpp"
#include "insym/guarded_read.hpp"
#include "insym/read_mesh.hpp"
#include "insym/read_model.hpp"
#include "insym/read_points.hpp"
#include "insym/report.hpp"
#include "insym/view.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "browser.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "output.hpp"
#include "progress.hpp"

namespace insym::app {
namespace {

using Clock = std::chrono::steady_clock;

// The exit statuses of the contract.
constexpr int kDone = 0, kDefect = 1, kUsage = 2, kCannotRead = 3, kInvalidInput = 4, kStoppedEarly = 5;

int exit_status(ErrorCode code) {
    switch (code) {
        case ErrorCode::invalid_option:
        case ErrorCode::cannot_write:
            return kUsage;
        case ErrorCode::cannot_read:
            return kCannotRead;
        case ErrorCode::invalid_input:
            return kInvalidInput;
    }
    return kDefect;
}

/// One line on standard error, whatever bytes a file name in it holds.
void say(std::string sentence) {
    for (char& c : sentence)
        if ((c >= '\0' && c < ' ') || c == 0x7f) c = '?';
    sentence = "insym: " + sentence + "\n";
    std::fwrite(sentence.data(), 1, sentence.size(), stderr);
}

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

Clock::time_point deadline(Clock::time_point start, double limit_s) {
    constexpr double kForever = 1e9;  // 30 years; more would overflow the clock
    return start + std::chrono::duration_cast<Clock::duration>(
                       std::chrono::duration<double>(std::min(limit_s, kForever)));
}

// The input -----------------------------------------------------------------------------------

std::string ending_of(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

/// Models and meshes that this program does not read: better said than tried as points.
void refuse_unknown_models(const std::string& path) {
    static const std::map<std::string, std::string> kinds = {// and the option that builds the reader
                                                             {".step", "INSYM_BUILD_BREP"},
                                                             {".stp", "INSYM_BUILD_BREP"},
                                                             {".p21", "INSYM_BUILD_BREP"},
                                                             {".iges", "INSYM_BUILD_BREP"},
                                                             {".igs", "INSYM_BUILD_BREP"},
                                                             {".brep", "INSYM_BUILD_BREP"},
                                                             {".brp", "INSYM_BUILD_BREP"},
                                                             {".bbrep", "INSYM_BUILD_BREP"},
                                                             {".stl", "INSYM_BUILD_MESH"},
                                                             {".obj", "INSYM_BUILD_MESH"},
                                                             {".ply", "INSYM_BUILD_MESH"},
                                                             {".off", "INSYM_BUILD_MESH"},
                                                             {".gltf", ""},
                                                             {".glb", ""},
                                                             {".3mf", ""},
                                                             {".sldprt", ""},
                                                             {".fcstd", ""}};
    const auto kind = kinds.find(ending_of(path));
    if (kind == kinds.end()) return;
    throw Error(ErrorCode::cannot_read,
                path + (kind->second.empty()
                            ? ": this format is not read; save the model as STEP or the mesh as STL"
                            : ": this program was built without the reader of this format; build it with " +
                                  kind->second + "=ON"));
}

/// The reader of the model or mesh, as far as this program has one; none for points.
std::function<Input()> model_reader([[maybe_unused]] const Options& options) {
#ifdef INSYM_WITH_BREP
    if (is_model_path(options.input))
        return [&] { return read_model_file(options.input, options.read_mesh.model); };
#endif
#ifdef INSYM_WITH_MESH
    if (is_mesh_path(options.input)) return [&] { return read_mesh_file(options.input, options.read_mesh); };
#endif
    return {};
}

struct LoadedInput {
    Input input;
    bool is_model = false;
};

LoadedInput load(const Options& options) {
    if (options.input == "-") return {read_points(std::cin, "-", options.read_points), false};
    if (const auto read = model_reader(options)) {
        if (!options.read_points.columns.empty())
            throw Error(ErrorCode::invalid_option, "--columns is for points in text, not for a model");
        return {read_guarded(options.input, read, options.limits), true};
    }
    refuse_unknown_models(options.input);
    return {read_points_file(options.input, options.read_points), false};
}

// The run -------------------------------------------------------------------------------------

bool wants_table(const Options& options) {
    const bool other =
        !options.json.empty() || !options.html.empty() || !options.png.empty() || !options.gltf.empty();
    return options.json != "-" && !options.view && !(options.quiet && other);
}

/// Fails now rather than after the long work.
void check_outputs(const Options& options) {
    if (wants_table(options)) check_output("-");
    for (const std::string& target : {options.json, options.html, options.png, options.gltf}) {
        if (target.empty()) continue;
        check_output(target);
        std::error_code ignored;
        if (target != "-" && std::filesystem::equivalent(target, options.input, ignored) &&
            std::filesystem::is_regular_file(target, ignored))
            throw Error(ErrorCode::cannot_write, target + ": is the input itself; name another file");
    }
}

/// The files asked for, with what writes each.
std::vector<std::pair<std::string, Writer>> files_of(const Options& options, const DetectResult& result,
                                                     const ReportContext& context,
                                                     [[maybe_unused]] const Tessellation& model) {
    std::vector<std::pair<std::string, Writer>> files;
    const auto add = [&](const std::string& path, const Writer& write) {
        if (!path.empty()) files.emplace_back(path, write);
    };
    add(options.json, [&](std::ostream& out) { write_json(out, result, context); });
#ifdef INSYM_WITH_VIEW
    add(options.html, [&](std::ostream& out) { write_page(out, result, context, model, options.shown); });
    add(options.gltf, [&](std::ostream& out) { write_gltf(out, result, context, model); });
    add(options.png, [&](std::ostream& out) { write_png(out, result, context, model, options.threads); });
#endif
    return files;
}

/// The files first, as a reader of the table, such as a pager, may take its time; the others and the table
/// also where one cannot be saved, so that the work is not lost.
void write_results(const Options& options, const DetectResult& result, const ReportContext& context,
                   const Tessellation& model) {
    std::exception_ptr failure;
    for (const auto& [path, write] : files_of(options, result, context, model)) {
        try {
            write_output(path, write);
        } catch (const Error&) {
            if (!failure) failure = std::current_exception();
        }
    }
    if (wants_table(options))
        write_output("-", [&](std::ostream& out) {
            write_table(out, result, context, options.limit, options.all);
            if (options.levels) write_levels(out, result, context);
        });
    if (failure) std::rethrow_exception(failure);
}

/// Why the run ended early; empty if it did not.
std::string early_end(RunStatus status) {
    switch (status) {
        case RunStatus::time_limit:
            return "stopped at the time limit; the results are what was found until then";
        case RunStatus::cancelled:
            return "stopped by an interrupt; the results are what was found until then";
        case RunStatus::result_limit:
            return "not all of the results are there, as a limit on them was met";
        case RunStatus::complete:
            break;
    }
    return "";
}

/// detect() knows no file; its complaints about the points are given the name.
DetectResult detect_in(const Input& input, const DetectOptions& options, const RunContext& context) {
    try {
        return detect(input.points, options, context);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::invalid_input) throw;
        throw Error(error.code(), (input.path == "-" ? "standard input" : input.path) + ": " + error.what());
    }
}

/// `insym view`: the path of the page, whether or not there is a browser to open it with.
void show(const Options& options) {
    write_output("-", [&](std::ostream& out) { out << options.html << '\n'; });
    if (!open_in_browser(options.html) && !options.quiet)
        say("no browser could be opened; open the page above with one");
}

int run(Options options, Clock::time_point start) {
    check_outputs(options);
    RunContext context;
    context.threads = options.threads;
    if (options.time_limit_s) context.deadline = deadline(start, *options.time_limit_s);
    // Standard input may never end: there, an interrupt while reading ends the program at once.
    if (options.input != "-") cancel_on_interrupt(context.cancel);

    ProgressLine progress(!options.quiet);
    progress.show("reading");
    auto [input, is_model] = load(options);
    const double load_s = seconds_since(start);
    if (options.input == "-") cancel_on_interrupt(context.cancel);

    if (progress.shown()) context.on_progress = [&](const Progress& now) { progress.show(now); };
    DetectResult result = detect_in(input, options.detect, context);
    result.diagnostics.insert(result.diagnostics.begin(), input.diagnostics.begin(), input.diagnostics.end());
    progress.clear();

    if (options.view && options.html.empty()) options.html = temporary_page(options.input);
    write_results(options, result,
                  {input.path, input.format, input.unit, is_model ? options.points : "points", load_s},
                  input.tessellation);
    if (options.view) show(options);
    if (!options.quiet) {
        for (const Diagnostic& diagnostic : result.diagnostics) say(diagnostic.message);
        if (result.status != RunStatus::complete) say(early_end(result.status));
    }
    return result.status == RunStatus::complete ? kDone : kStoppedEarly;
}

int main_checked(int argc, char** argv, Clock::time_point start) {
    try {
        const Command command = parse_command_line(argc, argv);
        if (command.text.empty()) return run(command.options, start);
        write_output("-", [&](std::ostream& out) { out << command.text; });
        return kDone;
    } catch (const Error& error) {
        say(error.what());
        return exit_status(error.code());
    } catch (const std::bad_alloc&) {
        say("out of memory; use a smaller --max-tolerance or fewer points");
    } catch (const std::exception& error) {
        say(std::string("a defect of the program, please report it: ") + error.what());
    } catch (...) {
        say("a defect of the program, please report it");
    }
    return kDefect;
}

}  // namespace
}  // namespace insym::app

int main(int argc, char** argv) {
    const auto start = std::chrono::steady_clock::now();
    // A closed pipe and a file beyond the allowed size are error numbers, not the end of the program.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    return insym::app::main_checked(argc, argv, start);
}
