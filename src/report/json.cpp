#include "insym/report.hpp"
#include "insym/version.hpp"

#include <array>
#include <cstddef>
#include <ostream>
#include <string_view>

#include <nlohmann/json.hpp>

// The report is written member by member and list item by list item, one item on each line, so that
// no second copy of the result is built in memory. The order of the keys is that of the schema.
namespace insym {
namespace {

using Json = nlohmann::ordered_json;

/// A path may hold any bytes; the report is UTF-8 all the same.
std::string text_of(const Json& value) {
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string_view word(RunStatus status) {
    constexpr std::array<std::string_view, 4> words = {"complete", "time_limit", "cancelled", "result_limit"};
    return words[static_cast<std::size_t>(status)];
}

std::string_view word(Method method) {
    constexpr std::array<std::string_view, 2> words = {"robust", "paper"};
    return words[static_cast<std::size_t>(method)];
}

std::string_view word(EntityKind kind) {
    constexpr std::array<std::string_view, 3> words = {"vertex", "edge", "face"};
    return words[static_cast<std::size_t>(kind)];
}

template <class Item, class Convert>
Json null_or(const std::optional<Item>& item, Convert convert) {
    return item ? Json(convert(*item)) : Json(nullptr);
}

/// The first two or three coordinates.
Json coordinates(const Point& point, int dimension) {
    return Json(std::vector<double>(point.begin(), point.begin() + dimension));
}

Json matrix(const Isometry& isometry) {
    const auto dimension = static_cast<std::size_t>(isometry.dimension);
    std::vector<std::vector<double>> rows(dimension + 1, std::vector<double>(dimension + 1));
    for (std::size_t i = 0; i < dimension; ++i) {
        for (std::size_t j = 0; j < dimension; ++j) rows[i][j] = isometry.linear[i][j];
        rows[i][dimension] = isometry.translation[i];
    }
    rows[dimension][dimension] = 1;
    return Json(rows);
}

Json json_of(const Isometry& isometry) {
    const auto place = [&](const Point& point) { return coordinates(point, isometry.dimension); };
    return {
        {"matrix", matrix(isometry)},
        {"angle_deg", isometry.angle_deg},
        {"step", isometry.step},
        {"axis", null_or(isometry.axis,
                         [&](const Axis& axis) {
                             return Json{{"point", place(axis.point)}, {"direction", place(axis.direction)}};
                         })},
        {"plane", null_or(isometry.plane,
                          [&](const Plane& plane) {
                              return Json{{"point", place(plane.point)}, {"normal", place(plane.normal)}};
                          })},
        {"center", null_or(isometry.center, place)}};
}

/// An infinite or unknown number becomes null: the JSON library does so.
Json json_of(const ToleranceInterval& tolerance) {
    return {{"min", tolerance.min}, {"max", tolerance.max}};
}

Json json_of(const Orbit& orbit) {
    return {{"points", orbit.points}, {"closed", orbit.closed}};
}

std::string_view word(EntityRole role) {
    constexpr std::array<std::string_view, 5> words = {"", "hole", "boss", "hollow", "round"};
    return words[static_cast<std::size_t>(role)];
}

/// What is not known is left out.
Json json_of(const Entity& entity) {
    Json json = {{"kind", word(entity.kind)}, {"id", entity.id}, {"geometry", entity.geometry}};
    if (!entity.ids.empty()) json["ids"] = entity.ids;
    if (entity.role != EntityRole::none) json["role"] = word(entity.role);
    if (entity.radius) json["radius"] = *entity.radius;
    if (entity.minor_radius) json["minor_radius"] = *entity.minor_radius;
    if (entity.length) json["length"] = *entity.length;
    if (entity.area) json["area"] = *entity.area;
    if (!entity.part.empty()) json["part"] = entity.part;
    return json;
}

Json json_of(const Diagnostic& diagnostic) {
    return {{"code", diagnostic.code}, {"message", diagnostic.message}};
}

Json json_of(const Cycle& cycle) {
    Json types = Json::array();
    for (const SymmetryType type : kAllSymmetryTypes)
        if (cycle.types.contains(type)) types.push_back(letter(type));
    return {{"points", cycle.points},
            {"closed", cycle.closed},
            {"types", types},
            {"tolerance", json_of(cycle.tolerance)}};
}

Json json_of(const Symmetry& symmetry) {
    Json cycles = Json::array(), missing = Json::array();
    for (const Orbit& orbit : symmetry.cycles) cycles.push_back(json_of(orbit));
    for (const Point& slot : symmetry.missing)
        missing.push_back({{"position", coordinates(slot, symmetry.isometry.dimension)}});
    return {{"id", symmetry.id},
            {"type", letter(symmetry.type)},
            {"order", null_or(symmetry.order, [](int order) { return order; })},
            {"isometry", json_of(symmetry.isometry)},
            {"cycles", std::move(cycles)},
            {"tolerance", json_of(symmetry.tolerance)},
            {"deviation", {{"rms", symmetry.deviation.rms}, {"max", symmetry.deviation.max}}},
            {"coverage", symmetry.coverage},
            {"fixed_points", symmetry.fixed_points},
            {"missing", std::move(missing)},
            {"significance", symmetry.significance},
            {"maximal", symmetry.maximal},
            {"implied_by", symmetry.implied_by}};
}

/// Lengths as used, not as given.
Json options_of(const DetectResult& result, const std::string& points) {
    Json types = Json::array();
    for (const SymmetryType type : kAllSymmetryTypes)
        if (result.options.types.contains(type)) types.push_back(option_letter(type));
    return {{"method", word(result.options.method)},
            {"types", types},
            {"resolution", result.resolution},
            {"max_tolerance", result.max_tolerance},
            {"points", points}};
}

/// Writes the members of the one outer object.
class Writer {
public:
    explicit Writer(std::ostream& out) : out_(out) { out_ << "{"; }
    void close() { out_ << "\n}\n"; }

    void member(std::string_view key, const Json& value) { begin(key) << text_of(value); }

    template <class Items, class Convert>
    void list(std::string_view key, const Items& items, Convert convert) {
        begin(key) << '[';
        bool first = true;
        for (const auto& item : items) {
            out_ << (first ? "\n" : ",\n") << text_of(convert(item));
            first = false;
        }
        out_ << ']';
    }

    /// The same, null where there are no items.
    template <class Items, class Convert>
    void list_or_null(std::string_view key, const Items& items, Convert convert) {
        items.empty() ? member(key, nullptr) : list(key, items, convert);
    }

private:
    std::ostream& begin(std::string_view key) {
        out_ << (first_ ? "\n" : ",\n") << '"' << key << "\": ";
        first_ = false;
        return out_;
    }

    std::ostream& out_;
    bool first_ = true;
};

}  // namespace

void write_json(std::ostream& out, const DetectResult& result, const ReportContext& context) {
    const int dimension = result.points.dimension;
    const auto convert = [](const auto& item) { return json_of(item); };
    Writer writer(out);
    writer.member("schema", "insym.report/1");
    writer.member("generator", {{"name", "insym"}, {"version", INSYM_VERSION}});
    writer.member("status", word(result.status));
    writer.member("input", {{"path", context.path},
                            {"format", context.format},
                            {"unit", null_or(context.unit, [](const std::string& unit) { return unit; })},
                            {"dimension", dimension},
                            {"diameter", result.diameter},
                            {"merged_points", result.merged_points}});
    writer.member("options", options_of(result, context.points));
    writer.list("points", result.points.positions,
                [&](const Point& point) { return coordinates(point, dimension); });
    writer.member("labels", result.points.labels.empty() ? Json(nullptr) : Json(result.points.labels));
    writer.list_or_null("entities", result.points.entities, convert);
    writer.list("cycles", result.cycles, convert);
    writer.list("symmetries", result.symmetries, convert);
    writer.member("group", null_or(result.group, [&](const PointGroup& group) {
                      return Json{{"schoenflies", group.schoenflies},
                                  {"hermann_mauguin", group.hermann_mauguin},
                                  {"center", coordinates(group.center, dimension)},
                                  {"empty_slots", group.empty_slots}};
                  }));
    writer.member("stats", {{"seeds", result.stats.seeds},
                            {"cycles", result.stats.cycles},
                            {"symmetries", result.stats.symmetries}});
    writer.member("timing", {{"load_s", context.load_s},
                             {"cycles_s", result.timing.cycles_s},
                             {"symmetries_s", result.timing.symmetries_s},
                             {"detect_s", result.timing.detect_s}});
    writer.list("diagnostics", result.diagnostics, convert);
    writer.close();
}

}  // namespace insym
