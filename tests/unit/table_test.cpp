// Oracle: known answers for what a row says of a hand-made result, and the definition of a table: in
// every line each column begins (or, flush right, ends) at the same character.
#include <clocale>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/results.hpp"

namespace insym {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing_support::flat_result;
using testing_support::ring_result;

const ReportContext kContext = {"a.xyz", "xyz", "mm", "points", 0};

std::string table_of(const DetectResult& result, int limit = 0, const ReportContext& context = kContext) {
    std::ostringstream out;
    write_table(out, result, context, limit, /*all=*/true);
    return out.str();
}

std::vector<std::u32string> lines_of(const std::string& text) {
    std::vector<std::u32string> lines(1);
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if (byte == '\n')
            lines.emplace_back();
        else if ((byte & 0xC0) != 0x80)
            lines.back() += static_cast<char32_t>(byte);  // one unit for each character
    }
    return lines;
}

/// The lines from the heading on to the next empty line.
std::vector<std::u32string> rows_of(const std::string& text) {
    std::vector<std::u32string> rows;
    for (const auto& line : lines_of(text)) {
        if (rows.empty() ? line.find(U"coverage") != line.npos : !line.empty())
            rows.push_back(line);
        else if (!rows.empty())
            break;
    }
    return rows;
}

/// The row of that id; two blanks part columns.
std::string row(const std::string& text, const std::string& id) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(id + "  ")) return line;
    return "";
}

TEST(Table, SaysFirstWhatWasRead) {
    DetectResult ring = ring_result();
    ring.options.method = Method::paper;
    const std::string text = table_of(ring);
    EXPECT_THAT(text, HasSubstr("a.xyz: 4 points in 3D, diameter 2 mm, lengths equal within 0.000002 mm\n"));
    EXPECT_THAT(text,
                HasSubstr("2 symmetries, 1 cycle, tolerance up to 0.1 mm (5 % of the diameter), 0.75 s\n"));
    // Method robust has no list of cycles.
    EXPECT_THAT(table_of(ring_result()), HasSubstr("2 symmetries, tolerance up to 0.1 mm"));
    DetectResult automatic = ring_result();
    automatic.options.max_tolerance.reset();
    EXPECT_THAT(table_of(automatic), HasSubstr("(5 % of the diameter, chosen by auto)"));
}

TEST(Table, RowsSayWhatTheSymmetryIs) {
    const std::string text = table_of(ring_result());
    for (const char* part :
         {"C rotation", " 4 ", "1 × 4", "90°", "exact – ∞", "100 %", "-7.2", "axis z at x = 0, y = 0"})
        EXPECT_THAT(row(text, "1"), HasSubstr(part));
    for (const char* part : {"M mirror", "1 × 2", "0.0123 – 0.0625", "0.0025", "75 %", "1.5",
                             "plane x = 0.063", "1 empty slot; follows from 1; part of a larger one"})
        EXPECT_THAT(row(text, "2"), HasSubstr(part));
    EXPECT_THAT(text, Not(HasSubstr("e-0")));  // no exponents
}

TEST(Table, RowsSayWhatTheSymmetryIsMadeOf) {
    DetectResult result = ring_result();
    EXPECT_THAT(table_of(result), Not(HasSubstr("made of")));
    Entity hole{EntityKind::face, 1, "cylinder"};
    hole.role = EntityRole::hole;
    hole.radius = 3.2;
    Entity line{EntityKind::edge, 1, "line"};
    line.length = 12.5;
    result.points.entities = {hole, line, hole, line};
    result.points.labels = {1, 0, 1, 0};
    result.symmetries[0].cycles = {{{0, 2}, true}, {{1, 3}, true}};
    result.symmetries[1].cycles = {{{0, 1}, true}};
    const ReportContext context = {"a.step", "step", "mm", "representative", 0};
    const std::string text = table_of(result, 0, context);
    EXPECT_THAT(text, HasSubstr("4 points (representative) in 3D"));
    EXPECT_THAT(row(text, "1"), HasSubstr("  2 holes, radius 3.2 mm; 2 lines, length 12.5 mm"));
    EXPECT_THAT(row(text, "2"), HasSubstr("  1 of 2 holes, radius 3.2 mm; 1 of 2 lines, length 12.5 mm"));
}

TEST(Table, StepsHaveUnits) {
    DetectResult result = ring_result();
    Symmetry& row_of_pins = result.symmetries[0];
    row_of_pins.type = SymmetryType::translation;
    row_of_pins.isometry.step = 2.54;
    row_of_pins.isometry.translation = {0, -2.54, 0};
    row_of_pins.isometry.axis.reset();
    EXPECT_THAT(row(table_of(result), "1"), testing::AllOf(HasSubstr("2.54 mm"), HasSubstr("along -y")));
    row_of_pins.type = SymmetryType::screw;
    row_of_pins.isometry.angle_deg = 22.5;
    EXPECT_THAT(row(table_of(result), "1"), HasSubstr("22.5°, 2.54 mm"));
    EXPECT_THAT(row(table_of(result, 0, {"a.xyz", "xyz", {}, "points", 0}), "1"), HasSubstr("22.5°, 2.54 "));
}

TEST(Table, SlantedAxesAndPlanesHaveAPointAndADirection) {
    DetectResult result = ring_result();
    result.symmetries[0].isometry.axis = Axis{{1, 2, 3.0000001}, {0, -0.6, 0.8}};
    result.symmetries[1].isometry.plane = Plane{{1, 2, 3.0001}, {0.8, 0.6, 0}};
    EXPECT_THAT(row(table_of(result), "1"), HasSubstr("axis (0, -0.6, 0.8) through (1, 2, 3)"));
    EXPECT_THAT(row(table_of(result), "2"), HasSubstr("plane normal to (0.8, 0.6, 0) through (1, 2, 3)"));
}

TEST(Table, DigitsFollowTheDeviation) {
    DetectResult result = ring_result();
    result.symmetries[0].isometry.angle_deg = 360.0 / 7;
    EXPECT_THAT(row(table_of(result), "1"), HasSubstr(" 51.4286° "));
    result.symmetries[0].deviation.max = 0.01;  // half a degree seen from the middle
    EXPECT_THAT(row(table_of(result), "1"), HasSubstr(" 51.4° "));
}

TEST(Table, PlaneSpeaksOfLinesAndCentres) {
    const std::string text = table_of(flat_result());
    EXPECT_THAT(text, HasSubstr("4 points in 2D"));
    EXPECT_THAT(row(text, "1"), HasSubstr("centre (0.5, -0.5)"));
    EXPECT_THAT(row(text, "2"), HasSubstr("line x = 0.063"));
}

TEST(Table, ColumnsAlignByCharacters) {
    DetectResult result = ring_result();
    for (int i = 0; i < 12; ++i) {  // three-digit counts, more symbols, longer words
        result.symmetries.push_back(result.symmetries[static_cast<std::size_t>(i % 2)]);
        result.symmetries.back().id = i + 3;
        result.symmetries.back().cycles.assign(static_cast<std::size_t>(i * 30 + 1), {{0, 1}, true});
    }
    result.symmetries[5].type = SymmetryType::rotation_reflection;
    const auto rows = rows_of(table_of(result));
    ASSERT_EQ(rows.size(), 15U);
    const auto ends_at = [&](const std::u32string& heading) {
        return rows[0].find(heading) + heading.size();
    };
    for (std::size_t i = 1; i < rows.size(); ++i) {
        for (const auto& heading : {U"order", U"cycles", U"turn, step", U"tolerance [mm]", U"deviation [mm]",
                                    U"coverage", U"significance"}) {
            const std::size_t end = ends_at(heading);
            ASSERT_GT(rows[i].size(), end);
            EXPECT_EQ(rows[i].substr(end, 2), U"  ") << i;
        }
        EXPECT_NE(rows[i][ends_at(U"coverage") - 1], U' ') << i;
        EXPECT_NE(rows[i][rows[0].find(U"type")], U' ') << i;
        EXPECT_EQ(rows[i].substr(rows[0].find(U"type") - 2, 2), U"  ") << i;
        EXPECT_NE(rows[i][rows[0].find(U"where")], U' ') << i;
        EXPECT_EQ(rows[i].substr(rows[0].find(U"where") - 2, 2), U"  ") << i;
        EXPECT_NE(rows[i].back(), U' ') << i;
    }
}

TEST(Table, ColumnsWithoutTextAreLeftOut) {
    DetectResult result = ring_result();
    EXPECT_THAT(table_of(result), HasSubstr("notes"));
    result.symmetries.pop_back();
    EXPECT_THAT(table_of(result), Not(HasSubstr("notes")));
}

TEST(Table, LimitSaysHowManyMore) {
    const std::string text = table_of(ring_result(), 1);
    EXPECT_NE(row(text, "1"), "");
    EXPECT_EQ(row(text, "2"), "");
    EXPECT_THAT(text, HasSubstr("\n1 more; --limit 0 shows all\n"));
    for (const int limit : {0, 2, 100}) EXPECT_THAT(table_of(ring_result(), limit), Not(HasSubstr("more;")));
}

TEST(Table, SaysWhenNothingIsFoundAndWhenStoppedEarly) {
    DetectResult result = ring_result();
    result.symmetries.clear();
    EXPECT_THAT(table_of(result), HasSubstr("\nNo symmetries found; a larger --max-tolerance"));
    result.status = RunStatus::time_limit;
    EXPECT_THAT(table_of(result), HasSubstr("Stopped at the time limit"));
    EXPECT_THAT(table_of(result), HasSubstr("No symmetries found yet."));
    result.status = RunStatus::cancelled;
    EXPECT_THAT(table_of(result), HasSubstr("Stopped by an interrupt"));
}

TEST(Table, NamesCannotBreakTheLines) {
    const std::string text = table_of(ring_result(), 0, {"a\nb\x1b[2J.xyz", "xyz", {}, "points", 0});
    EXPECT_THAT(text, HasSubstr("a?b?[2J.xyz: 4 points"));
    EXPECT_THAT(table_of(ring_result(), 0, {"-", "txt", {}, "points", 0}),
                HasSubstr("standard input: 4 points"));
}

/// Digits in groups and decimal commas, as a program around the library may have set them.
struct GroupedDigits : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    std::string do_grouping() const override { return "\1"; }
};

TEST(Table, DoesNotDependOnTheLocale) {
    DetectResult result = ring_result();
    result.symmetries[0].id = 1234;
    std::ostringstream plain, grouped;
    grouped.imbue(std::locale(std::locale::classic(), new GroupedDigits));
    write_table(plain, result, kContext, 1);
    write_table(grouped, result, kContext, 1);
    EXPECT_EQ(grouped.str(), plain.str());
    std::ostringstream plain_json, grouped_json;
    grouped_json.imbue(grouped.getloc());
    write_json(plain_json, result, kContext);
    write_json(grouped_json, result, kContext);
    EXPECT_EQ(grouped_json.str(), plain_json.str());
}

}  // namespace
}  // namespace insym
