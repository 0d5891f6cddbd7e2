// Oracle: what the interface promises for the page and the pictures, on points whose symmetries are known:
// the data in the page is the report, no name in it is markup, and threads change nothing. Browsers look at
// the page in tests/browser, Khronos' validator at scenes.
#include "insym/view.hpp"

#include "insym/detect.hpp"

#include <cstdint>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace insym {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kEvil = "</script><img src=x onerror=alert(1)>&lt;\xe2\x80\xa8\xe2\x80\xa9";

DetectResult square() {
    PointSet points;
    points.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    for (int i = 0; i < 4; ++i) {
        Entity entity{EntityKind::vertex, i + 1, "point"};
        entity.part = kEvil;
        points.entities.push_back(entity);
    }
    return detect(points);
}

/// A sheet of two triangles under the square, with its outline.
Tessellation sheet() {
    Tessellation model;
    model.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    model.triangles = {{0, 1, 2}, {0, 2, 3}};
    model.faces = {1, 1};
    model.lines = {{{0, 1, 2, 3, 0}, 1}};
    return model;
}

ReportContext context() {
    ReportContext context;
    context.path = kEvil;
    context.format = "step";
    context.unit = "mm";
    return context;
}

std::string page(int limit = 0) {
    std::ostringstream out;
    write_page(out, square(), context(), sheet(), limit);
    return out.str();
}

std::string between(const std::string& text, const std::string& start, const std::string& end) {
    const std::size_t from = text.find(start) + start.size();
    return text.substr(from, text.find(end, from) - from);
}

nlohmann::json report_in(const std::string& page) {
    return nlohmann::json::parse(
        between(page, R"(<script type="application/json" id="insym-report">)", "</script>"));
}

TEST(Page, HoldsTheReportWithoutItsCycles) {
    std::ostringstream out;
    write_json(out, square(), context());
    nlohmann::json expected = nlohmann::json::parse(out.str());
    nlohmann::json actual = report_in(page());
    for (auto* report : {&expected, &actual}) {
        report->erase("timing");
        report->erase("cycles");
    }
    EXPECT_EQ(nlohmann::json::diff(expected, actual), nlohmann::json::array());
}

TEST(Page, HasTheFirstSymmetriesOnly) {
    const nlohmann::json report = report_in(page(2));
    EXPECT_EQ(report["symmetries"].size(), 2U);
    EXPECT_EQ(report["stats"]["symmetries"], square().symmetries.size());
}

TEST(Page, NamesAreNeverMarkup) {
    const std::string text = page();
    EXPECT_THAT(text, Not(HasSubstr("<img")));
    EXPECT_THAT(text, Not(HasSubstr("\xe2\x80\xa8")));
    EXPECT_THAT(text, Not(HasSubstr("\xe2\x80\xa9")));
    EXPECT_EQ(report_in(text)["input"]["path"], kEvil);
    EXPECT_EQ(report_in(text)["entities"][0]["part"], kEvil);
}

TEST(Page, HasAPolicyThatLoadsNothing) {
    const std::string text = page();
    EXPECT_THAT(text, HasSubstr("default-src 'none'; script-src 'sha256-"));
    EXPECT_THAT(text, Not(HasSubstr("<!--insym:")));
}

std::string png(int threads, const DetectResult& result) {
    std::ostringstream out;
    write_png(out, result, context(), sheet(), threads);
    return out.str();
}

TEST(Picture, IsTheSameForAnyThreads) {
    DetectResult result = square();
    result.symmetries.resize(1);  // one panel, for speed
    const std::string picture = png(1, result);
    EXPECT_THAT(picture, StartsWith("\x89PNG\r\n\x1a\n"));
    EXPECT_EQ(picture, png(2, result));
    EXPECT_NE(picture, png(1, [] {
                  DetectResult nothing = square();
                  nothing.symmetries.clear();
                  return nothing;
              }()));
}

TEST(Scene, HasAPartForEachCycle) {
    const DetectResult result = square();
    std::ostringstream out;
    write_gltf(out, result, context(), sheet());
    const std::string bytes = out.str();
    ASSERT_THAT(bytes, StartsWith("glTF"));
    std::uint32_t size = 0;
    bytes.copy(reinterpret_cast<char*>(&size), sizeof size, 12);
    const auto scene = nlohmann::json::parse(bytes.substr(20, size));
    std::size_t cycles = 0;
    for (const auto& node : scene["nodes"])
        cycles += node["name"].get<std::string>().find("points") != std::string::npos ? 1 : 0;
    EXPECT_EQ(cycles, result.symmetries.front().cycles.size());
    EXPECT_EQ(scene["nodes"][0]["scale"][0], 1e-3);  // millimetres in metres
}

}  // namespace
}  // namespace insym
