// Oracle: a round trip (the report is parsed again by an independent parser and compared with the
// result it was made from) and the key order as the schema in report.md lists it.
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "unit/results.hpp"

namespace insym {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing_support::flat_result;
using testing_support::ring_result;

std::string text_of(const DetectResult& result, const ReportContext& context) {
    std::ostringstream out;
    write_json(out, result, context);
    return out.str();
}

Json report_of(const DetectResult& result, const ReportContext& context = {}) {
    return Json::parse(text_of(result, context));
}

std::vector<std::string> keys(const Json& object) {
    std::vector<std::string> names;
    for (const auto& [key, value] : object.items()) names.push_back(key);
    return names;
}

TEST(Json, KeysStandInTheOrderOfTheSchema) {
    const Json report = report_of(ring_result());
    EXPECT_THAT(keys(report),
                ElementsAre("schema", "generator", "status", "input", "options", "points", "labels",
                            "entities", "cycles", "symmetries", "group", "stats", "timing", "diagnostics"));
    EXPECT_THAT(keys(report["generator"]), ElementsAre("name", "version"));
    EXPECT_THAT(keys(report["input"]),
                ElementsAre("path", "format", "unit", "dimension", "diameter", "merged_points"));
    EXPECT_THAT(keys(report["options"]),
                ElementsAre("method", "types", "resolution", "max_tolerance", "points"));
    EXPECT_THAT(keys(report["cycles"][0]), ElementsAre("points", "closed", "types", "tolerance"));
    const Json& symmetry = report["symmetries"][0];
    EXPECT_THAT(keys(symmetry),
                ElementsAre("id", "type", "order", "isometry", "cycles", "tolerance", "deviation", "coverage",
                            "fixed_points", "missing", "significance", "maximal", "implied_by"));
    EXPECT_THAT(keys(symmetry["isometry"]),
                ElementsAre("matrix", "angle_deg", "step", "axis", "plane", "center"));
    EXPECT_THAT(keys(symmetry["isometry"]["axis"]), ElementsAre("point", "direction"));
    EXPECT_THAT(keys(symmetry["cycles"][0]), ElementsAre("points", "closed"));
    EXPECT_THAT(keys(symmetry["tolerance"]), ElementsAre("min", "max"));
    EXPECT_THAT(keys(symmetry["deviation"]), ElementsAre("rms", "max"));
    EXPECT_THAT(keys(report["symmetries"][1]["isometry"]["plane"]), ElementsAre("point", "normal"));
    EXPECT_THAT(keys(report["stats"]), ElementsAre("seeds", "cycles", "symmetries"));
    EXPECT_THAT(keys(report["timing"]), ElementsAre("load_s", "cycles_s", "symmetries_s", "detect_s"));
}

TEST(Json, ValuesComeBack) {
    DetectResult result = ring_result();
    result.merged_points = 3;
    result.diagnostics = {{"merged", "3 points were merged"}};
    const Json report = report_of(result, {"dir/a.step", "step", "mm", "vertices", 0.125});
    EXPECT_EQ(report["schema"], "insym.report/1");
    EXPECT_EQ(report["generator"]["name"], "insym");
    EXPECT_EQ(report["status"], "complete");
    EXPECT_EQ(report["input"], Json::parse(R"({"path": "dir/a.step", "format": "step", "unit": "mm",
        "dimension": 3, "diameter": 2.0, "merged_points": 3})"));
    EXPECT_EQ(report["options"],
              Json::parse(R"({"method": "robust", "types": ["M", "I", "C2", "C", "T", "Z", "S", "W"],
        "resolution": 2e-6, "max_tolerance": 0.1, "points": "vertices"})"));
    EXPECT_EQ(report["points"], Json::parse("[[1.0,0.0,0.5],[0.0,1.0,0.5],[-1.0,0.0,0.5],[0.0,-1.0,0.5]]"));
    EXPECT_EQ(report["cycles"], Json::parse(R"([{"points": [0,1,2,3], "closed": true, "types": ["C", "S"],
        "tolerance": {"min": 2e-6, "max": null}}])"));
    EXPECT_EQ(report["symmetries"][0], Json::parse(R"({"id": 1, "type": "C", "order": 4,
        "isometry": {"matrix": [[0.0,-1.0,0.0,0.125],[1.0,0.0,0.0,0.25],[0.0,0.0,1.0,0.0],[0.0,0.0,0.0,1.0]],
                     "angle_deg": 90.0, "step": 0.0, "axis": {"point": [0.0,0.0,0.5], "direction": [0.0,0.0,1.0]},
                     "plane": null, "center": null},
        "cycles": [{"points": [0,1,2,3], "closed": true}], "tolerance": {"min": 2e-6, "max": null},
        "deviation": {"rms": 0.0, "max": 0.0}, "coverage": 1.0, "fixed_points": [], "missing": [],
        "significance": -7.25, "maximal": true, "implied_by": []})"));
    EXPECT_EQ(report["symmetries"][1]["missing"], Json::parse(R"([{"position": [5.0,6.0,7.0]}])"));
    EXPECT_EQ(report["symmetries"][1]["order"], nullptr);
    EXPECT_EQ(report["symmetries"][1]["fixed_points"], Json::parse("[1,3]"));
    EXPECT_EQ(report["symmetries"][1]["implied_by"], Json::parse("[1]"));
    EXPECT_EQ(report["symmetries"][1]["maximal"], false);
    EXPECT_EQ(report["group"], nullptr);
    EXPECT_EQ(report["stats"], Json::parse(R"({"seeds": 12, "cycles": 1, "symmetries": 2})"));
    EXPECT_EQ(report["timing"],
              Json::parse(R"({"load_s": 0.125, "cycles_s": 0.25, "symmetries_s": 0.5, "detect_s": 0.75})"));
    EXPECT_EQ(report["diagnostics"],
              Json::parse(R"([{"code": "merged", "message": "3 points were merged"}])"));
}

TEST(Json, PlaneHasTwoCoordinatesEverywhere) {
    const Json report = report_of(flat_result());
    EXPECT_EQ(report["input"]["dimension"], 2);
    EXPECT_EQ(report["points"][0], Json::parse("[1.0,0.0]"));
    const Json& turn = report["symmetries"][0]["isometry"];
    EXPECT_EQ(turn["matrix"], Json::parse("[[0.0,-1.0,0.125],[1.0,0.0,0.25],[0.0,0.0,1.0]]"));
    EXPECT_EQ(turn["center"], Json::parse("[0.5,-0.5]"));
    EXPECT_EQ(turn["axis"], nullptr);
    const Json& mirror = report["symmetries"][1];
    EXPECT_EQ(mirror["isometry"]["plane"], Json::parse(R"({"point": [0.0631,0.0], "normal": [1.0,0.0]})"));
    EXPECT_EQ(mirror["missing"], Json::parse(R"([{"position": [5.0,6.0]}])"));
}

TEST(Json, AbsentListsAreNullAndEmptyListsEmpty) {
    DetectResult result = ring_result();
    result.symmetries.clear();
    result.cycles.clear();
    Json report = report_of(result);
    EXPECT_EQ(report["labels"], nullptr);
    EXPECT_EQ(report["entities"], nullptr);
    EXPECT_EQ(report["input"]["unit"], nullptr);
    EXPECT_EQ(report["symmetries"], Json::array());
    EXPECT_EQ(report["cycles"], Json::array());
    EXPECT_EQ(report["diagnostics"], Json::array());
    result.points.labels = {7, -1, 7, 7};
    result.points.entities.assign(4, {EntityKind::edge, 12345678901, "circle"});
    report = report_of(result);
    EXPECT_EQ(report["labels"], Json::parse("[7,-1,7,7]"));
    EXPECT_EQ(report["entities"].size(), 4U);
    EXPECT_EQ(report["entities"][3],
              Json::parse(R"({"kind": "edge", "id": 12345678901, "geometry": "circle"})"));
    EXPECT_THAT(keys(report["entities"][0]), ElementsAre("kind", "id", "geometry"));
}

TEST(Json, HalfTurnIsCWithOrderTwo) {
    DetectResult result = ring_result();
    result.symmetries[0].type = SymmetryType::half_turn;
    result.symmetries[0].order = 2;
    const Json report = report_of(result);
    EXPECT_EQ(report["symmetries"][0]["type"], "C");
    EXPECT_EQ(report["symmetries"][0]["order"], 2);
}

TEST(Json, StatusHasTheWordsOfTheSchema) {
    DetectResult result = ring_result();
    const std::vector<std::pair<RunStatus, std::string>> words = {{RunStatus::complete, "complete"},
                                                                  {RunStatus::time_limit, "time_limit"},
                                                                  {RunStatus::cancelled, "cancelled"},
                                                                  {RunStatus::result_limit, "result_limit"}};
    for (const auto& [status, word] : words) {
        result.status = status;
        EXPECT_EQ(report_of(result)["status"], word);
    }
}

TEST(Json, NumbersComeBackBitForBit) {
    DetectResult result = ring_result();
    result.diameter = 0.1 + 0.2;
    result.points.positions[0] = {1.0 / 3, 5e-324, 1.7976931348623157e308};
    const Json report = report_of(result);
    EXPECT_EQ(report["input"]["diameter"].get<double>(), 0.1 + 0.2);
    EXPECT_EQ(report["points"][0].get<std::vector<double>>(),
              (std::vector<double>{1.0 / 3, 5e-324, 1.7976931348623157e308}));
}

TEST(Json, AnyPathGivesValidUtf8) {
    const std::string path = "caf\xC3\xA9/\xFF\xC3\"\\\n.xyz";
    const std::string text = text_of(ring_result(), {path, "xyz", {}, "points", 0});
    // The parser refuses invalid UTF-8; what was valid is kept, the rest becomes U+FFFD.
    EXPECT_EQ(Json::parse(text)["input"]["path"], "caf\xC3\xA9/\xEF\xBF\xBD\xEF\xBF\xBD\"\\\n.xyz");
}

TEST(Json, SameResultGivesTheSameBytes) {
    EXPECT_EQ(text_of(ring_result(), {}), text_of(ring_result(), {}));
}

}  // namespace
}  // namespace insym
