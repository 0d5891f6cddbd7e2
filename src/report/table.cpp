#include "insym/report.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <ostream>
#include <string_view>
#include <utility>

// The table for people. Lengths are rounded where the points stop being exact: a digit below the
// tolerance says nothing about the part. Numbers never depend on the locale.
namespace insym {
namespace {

// Numbers as text -----------------------------------------------------------------------------

std::string to_text(double value, std::chars_format format, int precision) {
    std::array<char, 512> buffer{};
    const auto [end, error] =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision);
    return error == std::errc() ? std::string(buffer.data(), end) : std::string("?");
}

/// `value` with at most `decimals` digits after the point: 2.5, not 2.500; 0, not -0.
std::string fixed_text(double value, int decimals) {
    std::string text = to_text(value, std::chars_format::fixed, decimals);
    if (text.find('.') != text.npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.ends_with('.')) text.pop_back();
    }
    return text == "-0" ? "0" : text;
}

/// How many decimals a length has that is known to within `uncertainty`.
int decimals_for(double uncertainty) {
    constexpr int kMost = 12;
    if (!(uncertainty > 0)) return kMost;
    return std::clamp(static_cast<int>(std::ceil(-std::log10(uncertainty) - 1e-9)), 0, kMost);
}

/// Three significant digits, without an exponent unless the number would be all zeros.
std::string short_text(double value) {
    if (std::isinf(value)) return "∞";
    const double size = std::abs(value);
    if (size == 0) return "0";
    if (size < 1e-7 || size >= 1e9) return to_text(value, std::chars_format::general, 3);
    return fixed_text(value, std::max(0, 2 - static_cast<int>(std::floor(std::log10(size)))));
}

std::string seconds_text(double seconds) {
    return seconds < 0.01 ? "under 0.01 s" : fixed_text(seconds, seconds < 10 ? 2 : 0) + " s";
}

/// "1 cycle", "2 cycles".
std::string count_text(std::size_t count, std::string_view one, std::string_view many) {
    return std::to_string(count).append(" ").append(count == 1 ? one : many);
}

/// A share of the whole in percent; only the whole itself is 100 %.
std::string percent_text(double share) {
    const double percent = 100 * share;
    return (percent < 100 && percent > 99.9 ? "99.9" : fixed_text(percent, 1)) + " %";
}

// Geometry as text ----------------------------------------------------------------------------

/// Writes the lengths of one symmetry, each to the digits that its deviation leaves meaningful.
class GeometryText {
public:
    GeometryText(const DetectResult& result, const ReportContext& context, const Symmetry& symmetry)
        : dimension_(static_cast<std::size_t>(result.points.dimension)),
          unit_(context.unit ? " " + *context.unit : ""),
          symmetry_(symmetry) {
        const double uncertainty = std::max(result.resolution, symmetry.deviation.max);
        decimals_ = decimals_for(uncertainty);
        // The same error seen as an angle from the middle of the part.
        const double angle_deg = result.diameter > 0 ? uncertainty / result.diameter * 115 : 0;
        angle_decimals_ = std::min(decimals_for(angle_deg), 4);
    }

    /// What one step of the symmetry does: "90°", "2.54 mm", "30°, 1.5 mm".
    std::string motion() const {
        const Isometry& f = symmetry_.isometry;
        switch (symmetry_.type) {
            case SymmetryType::translation:
            case SymmetryType::glide_reflection:
                return length(f.step);
            case SymmetryType::screw:
                return angle(f.angle_deg) + ", " + length(f.step);
            case SymmetryType::rotation:
            case SymmetryType::half_turn:
            case SymmetryType::rotation_reflection:
                return angle(f.angle_deg);
            default:
                return "";
        }
    }

    /// Where it is: axis, plane, centre or direction, whichever its type is known by.
    std::string place() const {
        const Isometry& f = symmetry_.isometry;
        const std::string axis = f.axis ? axis_text(*f.axis) : "";
        std::string center = f.center ? "centre " + position(*f.center) : "";
        std::string mirror = f.plane ? plane(*f.plane) : "";
        switch (symmetry_.type) {
            case SymmetryType::mirror:
                return mirror;
            case SymmetryType::glide_reflection:
                return f.plane ? mirror + ", along " + direction(across(f.translation, f.plane->normal)) : "";
            case SymmetryType::translation:
                return "along " + direction(f.translation);
            case SymmetryType::inversion:
                return center;
            case SymmetryType::rotation_reflection:
                return axis + ", " + center;
            default:
                return f.axis ? axis : center;  // in 2D a rotation has a centre
        }
    }

private:
    std::string length(double value) const { return fixed_text(value, decimals_) + unit_; }
    std::string angle(double value) const { return fixed_text(value, angle_decimals_) + "°"; }

    std::string position(const Point& point) const { return tuple(point, decimals_); }

    std::string tuple(const Point& point, int decimals) const {
        std::string text;
        for (std::size_t i = 0; i < dimension_; ++i)
            text += (i == 0 ? "" : ", ") + fixed_text(point[i], decimals);
        return "(" + text + ")";
    }

    /// The coordinate axis (0, 1, 2) that `vector` is along to within the digits shown, or -1.
    int coordinate_axis(const Point& unit_vector) const {
        for (std::size_t i = 0; i < dimension_; ++i)
            if (1 - std::abs(unit_vector[i]) < 5e-9) return static_cast<int>(i);
        return -1;
    }

    /// "z", "-x" or "(0.577, 0.577, 0.577)".
    std::string direction(const Point& vector) const {
        const Point unit = normalized(vector);
        const int axis = coordinate_axis(unit);
        if (axis < 0) return tuple(unit, 4);
        std::string text = unit[static_cast<std::size_t>(axis)] < 0 ? "-" : "";
        return text += "xyz"[axis];
    }

    /// "axis z at x = 90, y = 75" where it is that simple.
    std::string axis_text(const Axis& axis) const {
        const std::string text = "axis " + direction(axis.direction);
        const int along = coordinate_axis(normalized(axis.direction));
        if (along < 0) return text + " through " + position(axis.point);
        std::string place;
        for (int i = 0; i < static_cast<int>(dimension_); ++i)
            if (i != along) place += (place.empty() ? " at " : ", ") + coordinate(axis.point, i);
        return text + place;
    }

    /// "x = 2.5".
    std::string coordinate(const Point& point, int i) const {
        return std::string(1, "xyz"[i]) + " = " + fixed_text(point[static_cast<std::size_t>(i)], decimals_);
    }

    /// "plane x = 2.5" where it is that simple; in 2D the mirror is a line.
    std::string plane(const Plane& plane) const {
        const std::string noun = dimension_ == 2 ? "line " : "plane ";
        const int axis = coordinate_axis(normalized(plane.normal));
        if (axis >= 0) return noun + coordinate(plane.point, axis);
        return noun + "normal to " + direction(plane.normal) + " through " + position(plane.point);
    }

    static Point normalized(const Point& vector) {
        const double length = std::hypot(vector[0], vector[1], vector[2]);
        return length > 0 ? Point{vector[0] / length, vector[1] / length, vector[2] / length} : vector;
    }

    /// The part of `vector` at right angles to `normal`.
    static Point across(const Point& vector, const Point& normal) {
        const double along = vector[0] * normal[0] + vector[1] * normal[1] + vector[2] * normal[2];
        return {vector[0] - along * normal[0], vector[1] - along * normal[1], vector[2] - along * normal[2]};
    }

    std::size_t dimension_;
    std::string unit_;
    const Symmetry& symmetry_;
    int decimals_ = 0;
    int angle_decimals_ = 0;
};

// The rows ------------------------------------------------------------------------------------

std::string type_text(SymmetryType type) {
    constexpr std::array<std::string_view, 8> words = {
        "mirror",      "inversion", "half-turn",           "rotation",
        "translation", "glide",     "rotation-reflection", "screw"};
    return std::string(letter(type)).append(" ").append(words[static_cast<std::size_t>(type)]);
}

/// "8 × 4": eight cycles of four points; the two most frequent lengths are named.
std::string cycles_text(const Symmetry& symmetry) {
    std::map<std::size_t, std::size_t, std::greater<>> times;
    for (const Orbit& cycle : symmetry.cycles) ++times[cycle.points.size()];
    std::vector<std::pair<std::size_t, std::size_t>> kinds(times.begin(), times.end());
    std::stable_sort(kinds.begin(), kinds.end(), [](auto a, auto b) { return a.second > b.second; });
    std::string text;
    for (std::size_t i = 0; i < kinds.size() && i < 2; ++i)
        text +=
            (i == 0 ? "" : ", ") + std::to_string(kinds[i].second) + " × " + std::to_string(kinds[i].first);
    return kinds.size() > 2 ? text + ", …" : text;
}

std::string tolerance_text(const DetectResult& result, const ToleranceInterval& tolerance) {
    const bool exact = tolerance.min <= result.resolution * (1 + 1e-9);
    return (exact ? "exact" : short_text(tolerance.min)) + " – " + short_text(tolerance.max);
}

std::string deviation_text(const DetectResult& result, const Deviation& deviation) {
    return deviation.max <= result.resolution ? "exact" : short_text(deviation.max);
}

// What a pattern is made of -------------------------------------------------------------------

/// "hole", "holes": what entities of that sort are called.
struct Noun {
    std::string one, many;
    int rank;  ///< the more telling, the less
};

Noun noun_of(const Entity& entity) {
    if (entity.kind == EntityKind::vertex) return {"vertex", "vertices", 8};
    if (entity.kind == EntityKind::edge) {
        if (entity.geometry == "circle") return {"circle", "circles", 5};
        return {entity.geometry, entity.geometry + "s", 6};
    }
    if (entity.role == EntityRole::hole) return {"hole", "holes", 0};
    if (entity.role == EntityRole::boss) return {"boss", "bosses", 1};
    if (entity.role == EntityRole::hollow) return {"hollow", "hollows", 2};
    if (entity.role == EntityRole::round) return {"round", "rounds", 2};
    return {entity.geometry, entity.geometry + "s", entity.geometry == "plane" ? 4 : 3};
}

/// ", radius 3.2 mm": the size that a designer knows an entity by.
std::string size_text(const Entity& entity, const std::string& unit) {
    if (entity.minor_radius)
        return ", radii " + short_text(*entity.radius) + " and " + short_text(*entity.minor_radius) + unit;
    if (entity.radius) return ", radius " + short_text(*entity.radius) + unit;
    if (entity.length) return ", length " + short_text(*entity.length) + unit;
    if (entity.area) return ", area " + short_text(*entity.area) + (unit.empty() ? "" : unit + "²");
    return "";
}

/// Says of symmetries which entities their points stand for: "6 of 7 holes, radius 3.2 mm".
class Makeup {
public:
    Makeup(const DetectResult& result, const ReportContext& context)
        : points_(result.points), unit_(context.unit ? " " + *context.unit : "") {
        if (points_.entities.empty()) return;
        for (std::size_t i = 0; i < points_.size(); ++i) ++all_[label(i)];
    }

    /// The two most telling sorts; nothing where the points are no model's.
    std::string text(const Symmetry& symmetry) const {
        if (points_.entities.empty()) return "";
        std::map<int, Sort> sorts;
        for (const Orbit& cycle : symmetry.cycles)
            for (const int point : cycle.points) {
                const auto i = static_cast<std::size_t>(point);
                ++sorts.try_emplace(label(i), Sort{i, 0}).first->second.count;
            }
        std::vector<Sort> order;
        order.reserve(sorts.size());
        for (const auto& [label, sort] : sorts) order.push_back(sort);
        std::stable_sort(order.begin(), order.end(), [&](const Sort& a, const Sort& b) {
            return std::pair(noun_of(entity(a)).rank, b.count) < std::pair(noun_of(entity(b)).rank, a.count);
        });
        std::string text;
        constexpr std::size_t kMost = 2;
        for (std::size_t k = 0; k < std::min(order.size(), kMost); ++k)
            text += (k == 0 ? "" : "; ") + sort_text(order[k]);
        return text + (order.size() > kMost ? "; …" : "");
    }

private:
    struct Sort {
        std::size_t example;
        std::size_t count;
    };

    const Entity& entity(const Sort& sort) const { return points_.entities[sort.example]; }

    /// Points without labels are of one sort where they are of one kind.
    int label(std::size_t i) const {
        return points_.labels.empty() ? static_cast<int>(points_.entities[i].kind) : points_.labels[i];
    }

    std::string sort_text(const Sort& sort) const {
        const std::size_t all = all_.at(label(sort.example));
        const Noun noun = noun_of(entity(sort));
        const std::string count =
            std::to_string(sort.count) + (sort.count < all ? " of " + std::to_string(all) : "");
        return count + " " + (all == 1 ? noun.one : noun.many) + size_text(entity(sort), unit_);
    }

    const PointSet& points_;
    std::string unit_;
    std::map<int, std::size_t> all_;
};

// The rest ------------------------------------------------------------------------------------

/// What the numbers of the row do not say.
std::string notes_text(const Symmetry& symmetry) {
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
    if (!symmetry.missing.empty()) add(count_text(symmetry.missing.size(), "empty slot", "empty slots"));
    if (!symmetry.implied_by.empty()) {
        constexpr std::size_t kMost = 3;
        std::string ids;
        for (std::size_t i = 0; i < std::min(symmetry.implied_by.size(), kMost); ++i)
            ids += (i == 0 ? "" : ", ") + std::to_string(symmetry.implied_by[i]);
        add("follows from " + ids + (symmetry.implied_by.size() > kMost ? ", …" : ""));
    }
    if (!symmetry.maximal) add("part of a larger one");
    return text;
}

/// Columns of text of equal width; a column without any text is left out.
class TextTable {
public:
    struct Heading {
        std::string text;
        bool right = false;  ///< flush right, for numbers
    };

    explicit TextTable(std::vector<Heading> headings)
        : headings_(std::move(headings)), widths_(headings_.size(), 0) {}

    void add(std::vector<std::string> row) {
        for (std::size_t i = 0; i < row.size(); ++i) widths_[i] = std::max(widths_[i], width(row[i]));
        rows_.push_back(std::move(row));
    }

    void write(std::ostream& out) const {
        std::vector<std::string> titles;
        for (const Heading& heading : headings_) titles.push_back(heading.text);
        std::vector<std::size_t> widths = widths_;
        for (std::size_t i = 0; i < widths.size(); ++i)
            if (widths[i] > 0) widths[i] = std::max(widths[i], width(titles[i]));
        write_row(out, titles, widths);
        for (const auto& row : rows_) write_row(out, row, widths);
    }

private:
    /// The number of characters, which is not that of bytes; continuation bytes of UTF-8 take no room.
    static std::size_t width(std::string_view text) {
        return static_cast<std::size_t>(
            std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
    }

    void write_row(std::ostream& out, const std::vector<std::string>& row,
                   const std::vector<std::size_t>& widths) const {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (widths[i] == 0) continue;
            const std::string padding(widths[i] - width(row[i]), ' ');
            line += (line.empty() ? "" : "  ") + (headings_[i].right ? padding + row[i] : row[i] + padding);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out << line << '\n';
    }

    std::vector<Heading> headings_;
    std::vector<std::size_t> widths_;  ///< of the rows; 0 for a column without text
    std::vector<std::vector<std::string>> rows_;
};

// The parts of the table ----------------------------------------------------------------------

/// A name may hold any bytes; line breaks and the terminal's control codes are not passed on.
std::string printable(std::string text) {
    for (char& c : text)
        if ((c >= '\0' && c < ' ') || c == 0x7f) c = '?';
    return text;
}

/// "0.142 mm (5 % of the diameter)".
std::string tolerance_used(const DetectResult& result, const std::string& unit) {
    const double percent = result.diameter > 0 ? 100 * result.max_tolerance / result.diameter : 0;
    return short_text(result.max_tolerance) + unit + " (" + short_text(percent) + " % of the diameter" +
           (result.options.max_tolerance ? ")" : ", chosen by auto)");
}

void write_summary(std::ostream& out, const DetectResult& result, const ReportContext& context) {
    const std::string unit = context.unit ? " " + *context.unit : "";
    const bool vertices = context.points == "vertices";
    out << (context.path == "-" ? "standard input" : printable(context.path)) << ": "
        << count_text(result.points.size(), vertices ? "vertex" : "point", vertices ? "vertices" : "points")
        << (context.points == "points" || vertices ? "" : " (" + context.points + ")") << " in "
        << std::to_string(result.points.dimension) << "D, diameter "
        << fixed_text(result.diameter, decimals_for(result.resolution)) << unit << ", lengths equal within "
        << short_text(result.resolution) << unit << '\n'
        << count_text(result.symmetries.size(), "symmetry", "symmetries") << ", "
        << (result.options.method == Method::paper
                ? count_text(result.cycles.size(), "cycle", "cycles") + ", "
                : "")
        << "tolerance up to " << tolerance_used(result, unit) << ", "
        << seconds_text(context.load_s + result.timing.detect_s) << '\n';
}

std::string_view early_end(RunStatus status) {
    switch (status) {
        case RunStatus::time_limit:
            return "Stopped at the time limit: what was found until then.\n";
        case RunStatus::cancelled:
            return "Stopped by an interrupt: what was found until then.\n";
        case RunStatus::result_limit:
            return "Not all of the results: a limit on them was met, which the notes tell.\n";
        case RunStatus::complete:
            break;
    }
    return "";
}

std::vector<std::string> row_of(const DetectResult& result, const ReportContext& context,
                                const Makeup& makeup, const Symmetry& symmetry) {
    const GeometryText geometry(result, context, symmetry);
    return {std::to_string(symmetry.id),
            type_text(symmetry.type),
            symmetry.order ? std::to_string(*symmetry.order) : "",
            cycles_text(symmetry),
            geometry.motion(),
            tolerance_text(result, symmetry.tolerance),
            deviation_text(result, symmetry.deviation),
            percent_text(symmetry.coverage),
            fixed_text(symmetry.significance, 1),
            geometry.place(),
            makeup.text(symmetry),
            notes_text(symmetry)};
}

void write_rows(std::ostream& out, const DetectResult& result, const ReportContext& context,
                const std::vector<const Symmetry*>& shown) {
    const std::string unit = context.unit ? " [" + *context.unit + "]" : "";
    TextTable table({{"#", true},
                     {"type"},
                     {"order", true},
                     {"cycles", true},
                     {"turn, step", true},
                     {"tolerance" + unit, true},
                     {"deviation" + unit, true},
                     {"coverage", true},
                     {"significance", true},
                     {"where"},
                     {"made of"},
                     {"notes"}});
    const Makeup makeup(result, context);
    for (const Symmetry* symmetry : shown) table.add(row_of(result, context, makeup, *symmetry));
    table.write(out);
}

void write_group(std::ostream& out, const DetectResult& result) {
    if (!result.group || result.group->schoenflies == "C1") return;
    const PointGroup& group = *result.group;
    out << "point group " << group.schoenflies << " (" << group.hermann_mauguin << ")";
    if (group.empty_slots > 0)
        out << " but for "
            << count_text(static_cast<std::size_t>(group.empty_slots), "empty slot", "empty slots");
    out << '\n';
}

/// A tolerance at which symmetries begin to hold, or turn ambiguous.
struct Change {
    double tolerance;
    int id;
    bool begins;
};

std::vector<Change> changes_of(const DetectResult& result) {
    std::vector<Change> changes;
    for (const Symmetry& s : result.symmetries) {
        if (!s.implied_by.empty() || s.significance >= 0) continue;
        changes.push_back({s.tolerance.min, s.id, true});
        if (std::isfinite(s.tolerance.max)) changes.push_back({s.tolerance.max, s.id, false});
    }
    std::sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
        return a.tolerance != b.tolerance ? a.tolerance < b.tolerance : a.id < b.id;
    });
    return changes;
}

/// " 1, 2, 3, … (12)" with a word before it; empty without ids.
std::string ids_text(std::string_view word, const std::vector<int>& ids) {
    constexpr std::size_t kMost = 6;
    if (ids.empty()) return "";
    std::string text(word);
    for (std::size_t i = 0; i < std::min(ids.size(), kMost); ++i)
        text += (i == 0 ? " " : ", ") + std::to_string(ids[i]);
    return ids.size() > kMost ? text + ", … (" + std::to_string(ids.size()) + ")" : text;
}

}  // namespace

void write_levels(std::ostream& out, const DetectResult& result, const ReportContext& context) {
    constexpr double kTogether = 1.2;  // changes at tolerances nearer than this ratio are one
    const std::string unit = context.unit ? " [" + *context.unit + "]" : "";
    const std::vector<Change> changes = changes_of(result);
    TextTable table({{"tolerance" + unit, true}, {"hold", true}, {"new"}, {"ambiguous"}});
    std::size_t holding = 0;
    for (std::size_t k = 0; k < changes.size();) {
        const double from = changes[k].tolerance;
        std::vector<int> begin, end;
        double last = from;
        while (k < changes.size() && changes[k].tolerance <= last * kTogether) {
            last = changes[k].tolerance;
            (changes[k].begins ? begin : end).push_back(changes[k].id);
            ++k;
        }
        holding += begin.size();
        holding -= end.size();
        const double to = k < changes.size() ? changes[k].tolerance : std::numeric_limits<double>::infinity();
        const bool exact = from <= result.resolution * (1 + 1e-9);
        table.add({(exact ? "exact" : short_text(from)) + " – " + short_text(to), std::to_string(holding),
                   ids_text("", begin), ids_text("", end)});
    }
    out << '\n';
    table.write(out);
}

void write_table(std::ostream& out, const DetectResult& result, const ReportContext& context, int limit,
                 bool all) {
    write_summary(out, result, context);
    out << early_end(result.status);
    write_group(out, result);
    if (result.symmetries.empty()) {
        const bool complete = result.status == RunStatus::complete;
        out << "No symmetries found"
            << (complete ? "; a larger --max-tolerance looks for rougher ones.\n" : " yet.\n");
        return;
    }
    std::vector<const Symmetry*> rows;
    for (const Symmetry& s : result.symmetries)
        if (all || s.implied_by.empty()) rows.push_back(&s);
    const std::size_t folded = result.symmetries.size() - rows.size();
    const std::size_t listed = rows.size();
    if (limit > 0 && listed > static_cast<std::size_t>(limit)) rows.resize(static_cast<std::size_t>(limit));
    out << '\n';
    write_rows(out, result, context, rows);
    if (rows.size() < listed) out << std::to_string(listed - rows.size()) << " more; --limit 0 shows all\n";
    if (folded > 0) out << std::to_string(folded) << " that follow from these; --all lists them too\n";
    out << "\ntolerance: from where it holds to where it turns ambiguous; significance: log10 of the number "
           "of\n"
           "symmetries as good that chance would give; the lower, the surer\n";
}

}  // namespace insym
