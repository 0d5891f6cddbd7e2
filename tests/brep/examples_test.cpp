// The example models: that the committed files are what the generator makes, and that the symmetry which
// examples/README.md promises is there in the vertices.
#include "insym/read_model.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "brep/step_files.hpp"

namespace insym {
namespace {

using test::read_text;
using test::ScratchFolder;

using Map = std::function<Point(const Point&)>;

const std::filesystem::path kExamples = std::filesystem::path(INSYM_SOURCE_DIR) / "examples";
const std::vector<std::string> kNames = {"flange",    "slotted_plate", "staggered_connector", "spiral_stair",
                                         "antiprism", "bracket",       "bracket_approximate"};

std::vector<Point> vertices_of(const std::string& name) {
    return read_model_file((kExamples / (name + ".step")).string(), test::kVertices).points.positions;
}

double distance(const Point& p, const Point& q) {
    return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

double diameter(const std::vector<Point>& points) {
    double longest = 0;
    for (const Point& p : points)
        for (const Point& q : points) longest = std::max(longest, distance(p, q));
    return longest;
}

/// How many points the map takes to a point, within that share of the diameter. Fixed points do not count.
int count_carried(const std::vector<Point>& points, const Map& map, double share = 1e-6) {
    const double tolerance = share * diameter(points);
    return static_cast<int>(std::count_if(points.begin(), points.end(), [&](const Point& p) {
        const Point image = map(p);
        return distance(image, p) > tolerance &&
               std::any_of(points.begin(), points.end(),
                           [&](const Point& q) { return distance(image, q) <= tolerance; });
    }));
}

/// Turn about the z axis, then a step along it.
Map turn(double angle_deg, double step = 0) {
    const double c = std::cos(angle_deg * std::numbers::pi / 180);
    const double s = std::sin(angle_deg * std::numbers::pi / 180);
    return [=](const Point& p) { return Point{c * p[0] - s * p[1], s * p[0] + c * p[1], p[2] + step}; };
}

/// The number that begins here, if one does.
std::optional<double> number_at(std::string_view& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

/// Where the two texts first differ by more than blanks, line breaks and the last digits of numbers, which
/// the mathematical functions of another machine may round otherwise; empty if nowhere.
std::string first_difference(std::string_view a, std::string_view b) {
    const auto skip_blanks = [](std::string_view& text) {
        while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0)
            text.remove_prefix(1);
    };
    for (;;) {
        skip_blanks(a);
        skip_blanks(b);
        if (a.empty() && b.empty()) return "";
        std::string place(a.substr(0, 40));
        place.append(" and ").append(b.substr(0, 40));
        const auto x = number_at(a);
        const auto y = number_at(b);
        if (x.has_value() != y.has_value()) return place;
        if (x) {
            if (std::abs(*x - *y) > 1e-9 * std::max(1.0, std::abs(*x))) return place;
        } else {
            if (a.empty() || b.empty() || a.front() != b.front()) return place;
            a.remove_prefix(1);
            b.remove_prefix(1);
        }
    }
}

void make_examples(const std::string& folder) {
    const std::string command = std::string(INSYM_MAKE_EXAMPLES) + " '" + folder + "' > /dev/null";
    const int status = std::system(command.c_str());
    ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command;
}

// Oracle: the generator. Twice it gives the same bytes, and they say what the committed files say.
TEST(Examples, FilesAreWhatTheGeneratorMakes) {
    const ScratchFolder first;
    const ScratchFolder second;
    make_examples(first.path(""));
    make_examples(second.path(""));
    for (const std::string& name : kNames) {
        const std::string made = read_text(first.path(name + ".step"));
        const std::string committed = read_text(kExamples / (name + ".step"));
        EXPECT_EQ(made, read_text(second.path(name + ".step"))) << name;
        EXPECT_EQ(first_difference(committed, made), "") << name;
        EXPECT_LT(committed.size(), 300'000U) << name;
    }
}

// Oracle: the examples listed here. A model that no test knows would go unchecked.
TEST(Examples, NoOthersAreThere) {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(kExamples))
        if (entry.path().extension() == ".step") found.push_back(entry.path().stem().string());
    std::vector<std::string> expected = kNames;
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(found, expected);
}

// Oracles of all below: the dimensions in examples/README.md, from which the counts follow.

TEST(Examples, FlangeHasSevenOfEightHoles) {
    const auto points = vertices_of("flange");
    EXPECT_EQ(points.size(), 34U);                      // 4 for each hole, 6 on the seam of the body
    EXPECT_EQ(count_carried(points, turn(45)), 4 * 6);  // six holes have a next one
    EXPECT_EQ(count_carried(points, turn(22.5)), 0);
}

TEST(Examples, SlottedPlateHasRowsOfElevenAndOfTen) {
    const auto points = vertices_of("slotted_plate");
    EXPECT_EQ(points.size(), 16U + 8 * 21);
    const Map next = [](const Point& p) { return Point{p[0] + 16, p[1], p[2]}; };
    EXPECT_EQ(count_carried(points, next), 8 * (10 + 8));
}

TEST(Examples, ConnectorsPinsAlternate) {
    const auto points = vertices_of("staggered_connector");
    const Map glide = [](const Point& p) { return Point{p[0] + 2.77 / 2, -p[1], p[2]}; };
    EXPECT_EQ(points.size(), 208U);
    EXPECT_EQ(count_carried(points, glide), 12 * 14);
}

TEST(Examples, StairHasFifteenSteps) {
    const auto points = vertices_of("spiral_stair");
    EXPECT_EQ(points.size(), 2U + 16 * 15);
    EXPECT_EQ(count_carried(points, turn(24, 190)), 16 * 14);
    EXPECT_EQ(count_carried(points, turn(24)), 0);
}

TEST(Examples, AntiprismNeedsTheRotationReflection) {
    const auto points = vertices_of("antiprism");
    const Map turn_45 = turn(45);
    const Map reflected = [&](const Point& p) {
        const Point q = turn_45(p);
        return Point{q[0], q[1], -q[2]};
    };
    EXPECT_EQ(points.size(), 8U + 16 + 8 * 8);
    EXPECT_EQ(count_carried(points, reflected), 88);
    EXPECT_EQ(count_carried(points, turn_45), 16);  // only the bore
    for (int k = 0; k < 8; ++k) {                   // all planes that are mirrors of the antiprism itself
        const double two_phi = 2 * k * 22.5 * std::numbers::pi / 180;
        const Map mirror = [=](const Point& p) {
            return Point{std::cos(two_phi) * p[0] + std::sin(two_phi) * p[1],
                         std::sin(two_phi) * p[0] - std::cos(two_phi) * p[1], p[2]};
        };
        EXPECT_LE(count_carried(points, mirror), 8 + 16) << k;  // corners and bore, never a pocket
    }
}

const Map kLeftRight = [](const Point& p) { return Point{-p[0], p[1], p[2]}; };

TEST(Examples, BracketIsMirroredButForANotch) {
    const auto points = vertices_of("bracket");
    EXPECT_EQ(points.size(), 72U);
    EXPECT_EQ(count_carried(points, kLeftRight), 72 - 8);
}

TEST(Examples, ApproximateBracketIsTheBracketMovedByAThousandth) {
    const auto exact = vertices_of("bracket");
    const auto points = vertices_of("bracket_approximate");
    ASSERT_EQ(points.size(), exact.size());
    const double most = 0.001 * diameter(exact);
    double largest = 0;
    for (const Point& p : exact) {
        double nearest = 1e300;
        for (const Point& q : points) nearest = std::min(nearest, distance(p, q));
        EXPECT_GT(nearest, 0);
        largest = std::max(largest, nearest);
    }
    EXPECT_LE(largest, most);
    EXPECT_GT(largest, most / 2);
    EXPECT_EQ(count_carried(points, kLeftRight), 0);
    EXPECT_EQ(count_carried(points, kLeftRight, 0.002), 72 - 8);
}

}  // namespace
}  // namespace insym
