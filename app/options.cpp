#include "options.hpp"

#include "insym/error.hpp"
#include "insym/version.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "suggest.hpp"

namespace insym::app {
namespace {

constexpr const char* kHelpHint = "; see 'insym detect --help'";

constexpr const char* kMainFooter = R"(Examples:
  insym detect part.step                      the symmetries of a model, as a table
  insym detect points.xyz --json report.json  the table, and a full report in a file
  insym view part.step                        the same to look at, in the browser

Exit status: 0 done, also when nothing is found; 1 a defect of the program; 2 wrong usage, or an
output that cannot be written; 3 the input cannot be read; 4 the input is read but invalid; 5 stopped
early by a time limit or an interrupt, with a valid report of what was found. See insym detect --help.)";

constexpr const char* kDetectFooter =
    R"(Input: models (STEP .step .stp, IGES .iges .igs, BREP .brep), meshes (.stl, .obj, .ply, .off), or points as
text (.xyz, .csv, .txt, others): 2 columns are x y, 3 are x y z, 4 are x y z label (a whole number; only points
of one label are matched).
The chemists' .xyz is read too: elements become labels. Lines that begin with # are comments.

Models and meshes are read in a process of their own: what crashes there, hangs, or goes beyond --import-memory or
--import-time ends with status 3 and a sentence.
--points: a list of vertices, edges and faces, each entity with one point (the centre of a circle, the
middle of a hole's axis, ...); representative, the default, is all three. Of meshes: corners, rims and other sharp
lines, large flat regions.
--labels: what must agree for points to be matched: entity (kind, geometry, hole or boss, and radius, length and
area to within --label-tolerance), kind (vertex, edge, face), none.

Output: without --json -, a ranked table on standard output; progress and notes on standard error.
--html: one file to look at and to pass on; it needs no network and nothing installed. --png: a still picture of
the first symmetries. --gltf: the model and the cycles of the first symmetry as a scene (.glb) for other programs.
A file appears under its name only when it is whole. A reader of standard output that closes it
early (insym ... | head -1) is no error. The first Ctrl-C stops the search and writes what was found
(status 5), the second ends the program at once.

Examples:
  insym detect part.step
  insym detect points.xyz --max-tolerance 0.001 --types C,M
  insym detect scan.csv --columns x,y,label --json report.json --quiet
  insym detect part.step --html part.html --png part.png
  generate | insym detect - --json - | jq .symmetries[0]

Exit status: 0 done, also when nothing is found; 1 a defect of the program; 2 wrong usage; 3 the input
cannot be read; 4 the input is invalid; 5 stopped early, the report is valid and says so.)";

/// The options as they were typed; empty: not given.
struct Typed {
    std::string input, json, html, gltf, png, columns, time_limit, limit, max_symmetries, max_chains, regions;
    std::string points = "representative", labels = "entity", label_tolerance = "0.01", sharp_angle = "30";
    std::string import_memory = "4096", import_time = "300";
    std::string method = "robust", types = "M,I,C2,C,T,Z,S,W";
    std::string max_tolerance = "auto", resolution = "1e-6", threads = "0";
    bool quiet = false, view = false, all = false, levels = false;
};

constexpr int kTableLimit = 20, kPageLimit = 5000;

[[noreturn]] void fail(const std::string& sentence) {
    throw Error(ErrorCode::invalid_option, sentence);
}

[[noreturn]] void fail_value(const std::string& option, const std::string& value, const std::string& wanted) {
    fail(option + " " + value + ": " + wanted);
}

/// The nearest of the names, or where all of them are explained.
std::string hint_for(std::string_view word, const std::vector<std::string>& names) {
    const std::string hint = did_you_mean(word, names);
    return hint.empty() ? kHelpHint : hint;
}

// The values ----------------------------------------------------------------------------------

template <class Number>
std::optional<Number> to_number(const std::string& text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

int parse_count(const std::string& option, const std::string& text, int most) {
    const auto value = to_number<int>(text);
    if (!value || *value < 0 || *value > most)
        fail_value(option, text, "a whole number from 0 to " + std::to_string(most) + " is needed");
    return *value;
}

std::optional<double> parse_max_tolerance(const std::string& text) {
    if (text == "auto") return std::nullopt;
    const auto value = to_number<double>(text);
    if (!value || !(*value > 0 && *value <= 1))
        fail_value("--max-tolerance", text,
                   "a share of the diameter is needed, above 0 and at most 1, such as 0.01, or auto");
    return value;
}

double parse_resolution(const std::string& text) {
    const auto value = to_number<double>(text);
    if (!value || !(*value > 0 && *value < 1))
        fail_value("--resolution", text,
                   "a share of the diameter is needed, above 0 and below 1, such as 1e-6");
    return *value;
}

double parse_seconds(const std::string& option, const std::string& text) {
    const auto value = to_number<double>(text);
    if (!value || !(*value > 0 && std::isfinite(*value)))
        fail_value(option, text, "a number of seconds above 0 is needed");
    return *value;
}

std::size_t parse_mebibytes(const std::string& option, const std::string& text) {
    constexpr int kLeast = 16, kMost = 1 << 24;
    const auto value = to_number<int>(text);
    if (!value || *value < kLeast || *value > kMost)
        fail_value(option, text,
                   "a whole number of MiB from " + std::to_string(kLeast) + " to " + std::to_string(kMost) +
                       " is needed");
    return static_cast<std::size_t>(*value) << 20;
}

double parse_label_tolerance(const std::string& text) {
    const auto value = to_number<double>(text);
    if (!value || !(*value >= 0 && *value < 1))
        fail_value("--label-tolerance", text, "a share is needed, from 0 to below 1, such as 0.01");
    return *value;
}

double parse_sharp_angle(const std::string& text) {
    const auto value = to_number<double>(text);
    if (!value || !(*value > 0 && *value < 180))
        fail_value("--sharp-angle", text, "an angle in degrees is needed, above 0 and below 180");
    return *value;
}

std::vector<std::string> split_at_commas(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        words.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return words;
}

std::vector<std::string> type_letters() {
    std::vector<std::string> letters;
    letters.reserve(kAllSymmetryTypes.size());
    for (const SymmetryType type : kAllSymmetryTypes) letters.emplace_back(option_letter(type));
    return letters;
}

SymmetryType parse_type(const std::string& text) {
    const std::vector<std::string> letters = type_letters();
    for (std::size_t i = 0; i < letters.size(); ++i)
        if (text == letters[i]) return kAllSymmetryTypes[i];
    // Words and small letters are what people type instead.
    constexpr std::array<std::string_view, 8> words = {
        "mirror",      "inversion", "half-turn",           "rotation",
        "translation", "glide",     "rotation-reflection", "screw"};
    std::string lower;
    for (const char c : text) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    std::string capital;
    for (const char c : text) capital += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    std::string hint;
    for (std::size_t i = 0; i < letters.size(); ++i)
        if (capital == letters[i] || lower == words[i]) hint = "; did you mean " + letters[i] + "?";
    fail("unknown type '" + text + "' in --types, which takes M,I,C2,C,T,Z,S,W" + hint);
}

TypeSet parse_types(const std::string& text) {
    TypeSet types;
    for (const std::string& word : split_at_commas(text)) types.insert(parse_type(word));
    return types;
}

/// --regions: N or N,x|y|z.
Regions parse_regions(const std::string& text) {
    constexpr int kMost = 10000;
    const std::vector<std::string> words = split_at_commas(text);
    const auto count = to_number<int>(words.front());
    const std::size_t axis = words.size() == 2 ? std::string_view("xyz").find(words.back()) : 0;
    if (!count || *count < 1 || *count > kMost || words.size() > 2 ||
        (words.size() == 2 && (words.back().size() != 1 || axis == std::string_view::npos)))
        fail_value("--regions", text,
                   "a whole number from 1 to " + std::to_string(kMost) +
                       " is needed, and the axis x, y or z if wanted, such as 8 or 8,z");
    return {*count, words.size() == 2 ? std::optional(static_cast<int>(axis)) : std::nullopt};
}

Method parse_method(const std::string& text) {
    if (text == "robust") return Method::robust;
    if (text == "paper") return Method::paper;
    fail("unknown value '" + text + "' of --method" + hint_for(text, {"robust", "paper"}));
}

/// --points: which entities of a model; and the words for the report, in a fixed order.
void parse_points(const std::string& text, Options& options) {
    ReadModelOptions& model = options.read_mesh.model;
    model.vertices = model.edges = model.faces = false;
    const std::vector<std::string> known = {"representative", "vertices", "edges", "faces"};
    for (const std::string& word : split_at_commas(text)) {
        if (std::find(known.begin(), known.end(), word) == known.end())
            fail("unknown value '" + word +
                 "' of --points, which takes representative, or a list of vertices, edges, faces" +
                 did_you_mean(word, known));
        const bool all = word == "representative";
        model.vertices |= all || word == "vertices";
        model.edges |= all || word == "edges";
        model.faces |= all || word == "faces";
    }
    if (model.vertices && model.edges && model.faces) {
        options.points = "representative";
        return;
    }
    for (const auto& [chosen, word] : {std::pair(model.vertices, "vertices"), std::pair(model.edges, "edges"),
                                       std::pair(model.faces, "faces")})
        if (chosen) options.points += (options.points.empty() ? "" : ",") + std::string(word);
}

LabelBy parse_labels(const std::string& text) {
    const std::vector<std::string> known = {"entity", "kind", "none"};
    const auto found = std::find(known.begin(), known.end(), text);
    if (found == known.end()) fail("unknown value '" + text + "' of --labels" + hint_for(text, known));
    return static_cast<LabelBy>(found - known.begin());
}

// The command line ----------------------------------------------------------------------------

void declare(CLI::App& detect, Typed& typed) {
    detect.add_option("INPUT", typed.input, "Model or points; - reads points from standard input")
        ->required()
        ->type_name("");
    const auto add = [&](const char* name, std::string& value, const char* takes, const char* text) {
        detect.add_option(name, value, text)->type_name(takes);
    };
    add("--json", typed.json, "FILE|-", "Write the full report; - is standard output");
    add("--html", typed.html, "FILE", "Write an interactive page, one file that works offline");
    add("--png", typed.png, "FILE", "Write a picture of the first symmetries");
    add("--gltf", typed.gltf, "FILE", "Write the model with the first symmetry as a scene (binary glTF)");
    add("--method", typed.method, "robust|paper", "Definition of a symmetry (default: robust)");
    add("--types", typed.types, "M,I,C2,...", "Kinds to look for, see below (default: all)");
    add("--points", typed.points, "LIST",
        "Entities of a model that give points, see below (default: representative)");
    add("--labels", typed.labels, "entity|kind|none",
        "What tells points of a model apart, see below (default: entity)");
    add("--label-tolerance", typed.label_tolerance, "F",
        "Share by which equal radii, lengths and areas may differ (default: 0.01)");
    add("--sharp-angle", typed.sharp_angle, "DEG",
        "Edges of a mesh that turn by more are sharp (default: 30)");
    add("--import-memory", typed.import_memory, "MIB",
        "Most memory to read a model with (default: 4096 MiB)");
    add("--import-time", typed.import_time, "S", "Most time to read a model in (default: 300 seconds)");
    add("--max-tolerance", typed.max_tolerance, "F|auto",
        "Largest tolerance, a share of the diameter (default: auto)");
    add("--resolution", typed.resolution, "F",
        "Lengths this near are equal, a share of the diameter (default: 1e-6)");
    add("--limit", typed.limit, "N", "Symmetries in the table and the page (default: 20 and 5000; 0: all)");
    add("--max-symmetries", typed.max_symmetries, "N",
        "Symmetries in the report, the best of them (default: all)");
    add("--max-chains", typed.max_chains, "N",
        "Method paper: lower the tolerance until there are at most N chains of four points (default: "
        "2000000; 0: never)");
    add("--threads", typed.threads, "N", "Most threads to use (default: 0, all cores)");
    add("--time-limit", typed.time_limit, "S",
        "Stop after so many seconds since the start, with what is found");
    add("--regions", typed.regions, "N[,x|y|z]",
        "Method paper: cycles inside N slabs of equal height only (default: 1, along the longest extent)");
    add("--columns", typed.columns, "x,y,label", "Meaning of the columns of points: x, y, z, label or skip");
    detect.add_flag("--all", typed.all, "List what follows from others as well");
    detect.add_flag("--levels", typed.levels,
                    "List, too, from which tolerance to which each set of symmetries holds");
    detect.add_flag("--quiet", typed.quiet, "No progress, no notes; with a file no table either");
}

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/// What CLI11 has left over: an unknown command, an unknown option or one input too many.
[[noreturn]] void fail_extras(const CLI::App& app, const CLI::App& detect) {
    const std::vector<std::string> extras = app.remaining(true);
    const auto option = std::find_if(extras.begin(), extras.end(), [](const std::string& word) {
        return word.size() > 1 && word[0] == '-';
    });
    const CLI::App& where = detect.parsed() ? detect : app;
    if (option != extras.end()) {
        const std::string name = option->substr(0, option->find('='));
        fail("unknown option " + name + hint_for(name, option_names(where)));
    }
    if (!detect.parsed()) {
        const std::string hint = did_you_mean(extras.front(), {"detect", "view"});
        fail("unknown command '" + extras.front() + "'" +
             (hint.empty() ? "; did you mean insym detect " + extras.front() + "?" : hint));
    }
    fail("one INPUT is read at a time, but '" + extras.front() + "' is given as well" + kHelpHint);
}

[[noreturn]] void fail_parse(const CLI::ParseError& error, const CLI::App& app, const CLI::App& detect) {
    if (!app.remaining(true).empty()) fail_extras(app, detect);
    const std::string what = error.what();
    // CLI11 begins this one with the name of the option and a colon.
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
        fail(what.substr(0, what.find(':')) + " takes exactly one value" + kHelpHint);
    fail(what + kHelpHint);
}

/// CLI11 takes the word after an option as its value, even where that is another option or empty.
void check_values(const CLI::App& detect) {
    for (const CLI::Option* option : detect.get_options())
        for (const std::string& value : option->results()) {
            if (value.empty()) fail(option->get_name() + " is empty" + kHelpHint);
            if (option->nonpositional() && value.starts_with("--"))
                fail(option->get_name() + " needs a value, but the option " + value + " follows" + kHelpHint);
        }
}

/// Where the results go. Before the long work: can they be made at all, and does each have a file of its own?
void take_outputs(const Typed& typed, Options& options) {
    options.json = typed.json == "/dev/stdout" ? "-" : typed.json;
    options.html = typed.html;
    options.gltf = typed.gltf;
    options.png = typed.png;
    options.view = typed.view;
    [[maybe_unused]] const bool wanted =
        options.view || !options.html.empty() || !options.gltf.empty() || !options.png.empty();
#ifndef INSYM_WITH_VIEW
    if (wanted) fail("this program was built without pages and pictures; build it with INSYM_BUILD_VIEW=ON");
#endif
    options.read_mesh.model.tessellate = wanted;
    std::map<std::string, std::string> outputs;
    for (const auto& [option, file] : {std::pair("--json", options.json), std::pair("--html", options.html),
                                       std::pair("--png", options.png), std::pair("--gltf", options.gltf)}) {
        if (file == "-" && option != std::string_view("--json"))
            fail(std::string(option) + " takes a file, not standard output");
        const auto [same, is_new] = outputs.try_emplace(file, option);
        if (!file.empty() && !is_new) fail(same->second + " and " + option + " name the same file, " + file);
    }
}

Options checked(const Typed& typed) {
    Options options;
    options.detect.method = parse_method(typed.method);
    options.input = typed.input;
    take_outputs(typed, options);
    options.detect.types = parse_types(typed.types);
    options.detect.max_tolerance = parse_max_tolerance(typed.max_tolerance);
    options.detect.resolution = parse_resolution(typed.resolution);
    if (options.detect.max_tolerance && *options.detect.max_tolerance < options.detect.resolution)
        fail("--max-tolerance " + typed.max_tolerance + " is below the resolution of " + typed.resolution +
             "; raise it, or lower --resolution");
    if (!typed.regions.empty()) {
        options.detect.regions = parse_regions(typed.regions);
        if (options.detect.method != Method::paper)
            fail("--regions " + typed.regions +
                 ": only method paper searches region by region; add --method paper");
    }
    if (!typed.columns.empty()) options.read_points.columns = parse_columns(typed.columns);
    constexpr int kMostListed = 1000000000, kMostThreads = 1024;
    options.limit = typed.limit.empty() ? kTableLimit : parse_count("--limit", typed.limit, kMostListed);
    options.shown = typed.limit.empty() ? kPageLimit : options.limit;
    if (!typed.max_symmetries.empty())
        options.detect.max_symmetries =
            static_cast<std::size_t>(parse_count("--max-symmetries", typed.max_symmetries, kMostListed));
    if (!typed.max_chains.empty())
        options.detect.max_chains =
            static_cast<std::size_t>(parse_count("--max-chains", typed.max_chains, kMostListed));
    options.threads = parse_count("--threads", typed.threads, kMostThreads);
    if (!typed.time_limit.empty()) options.time_limit_s = parse_seconds("--time-limit", typed.time_limit);
    parse_points(typed.points, options);
    options.read_mesh.model.labels = {parse_labels(typed.labels),
                                      parse_label_tolerance(typed.label_tolerance)};
    options.read_mesh.sharp_angle_deg = parse_sharp_angle(typed.sharp_angle);
    options.limits = {parse_mebibytes("--import-memory", typed.import_memory),
                      parse_seconds("--import-time", typed.import_time)};
    options.all = typed.all;
    options.levels = typed.levels;
    options.quiet = typed.quiet;
    return options;
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
    CLI::App app("Finds the approximate incomplete symmetries of models and point sets.", "insym");
    app.set_version_flag("--version", std::string("insym ") + INSYM_VERSION);
    app.footer(kMainFooter);
    Typed typed;
    CLI::App& detect = *app.add_subcommand("detect", "Find the symmetries of a model or of points");
    CLI::App& view = *app.add_subcommand("view", "Find the symmetries and show them in the browser");
    for (CLI::App* command : {&detect, &view}) {
        command->footer(kDetectFooter);
        declare(*command, typed);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return {{}, app.help()};
    } catch (const CLI::CallForVersion& version) {
        return {{}, std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& error) {
        fail_parse(error, app, view.parsed() ? view : detect);
    }
    typed.view = view.parsed();
    if (!detect.parsed() && !view.parsed()) fail("no command is given; see 'insym --help'");
    check_values(view.parsed() ? view : detect);
    return {checked(typed), {}};
}

}  // namespace insym::app
