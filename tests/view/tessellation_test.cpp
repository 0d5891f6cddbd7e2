// Oracle: the area of each plane face as its reader knows it; the volume inside the triangles, which is that
// of the shape and above 0 if all of them are seen counter-clockwise from outside; ids that the entities
// have, too.
#include "insym/read_mesh.hpp"
#include "insym/read_model.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace insym {
namespace {

using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

const Point& corner(const Tessellation& model, const std::array<int, 3>& triangle, std::size_t k) {
    return model.vertices.at(static_cast<std::size_t>(triangle[k]));
}

double area(const Tessellation& model, const std::array<int, 3>& triangle) {
    const Point &a = corner(model, triangle, 0), &b = corner(model, triangle, 1),
                &c = corner(model, triangle, 2);
    const Vector n = cross({b[0] - a[0], b[1] - a[1], b[2] - a[2]}, {c[0] - a[0], c[1] - a[1], c[2] - a[2]});
    return std::sqrt(dot(n, n)) / 2;
}

std::map<std::int64_t, double> areas(const Tessellation& model) {
    std::map<std::int64_t, double> sums;
    for (std::size_t t = 0; t < model.triangles.size(); ++t)
        sums[model.faces.at(t)] += area(model, model.triangles[t]);
    return sums;
}

double volume(const Tessellation& model) {
    double sum = 0;
    for (const auto& t : model.triangles)
        sum += dot(corner(model, t, 0), cross(corner(model, t, 1), corner(model, t, 2))) / 6;
    return sum;
}

std::set<std::int64_t> ids(const Input& input, EntityKind kind) {
    std::set<std::int64_t> ids;
    for (const Entity& entity : input.points.entities) {
        if (entity.kind != kind) continue;
        ids.insert(entity.id);
        ids.insert(entity.ids.begin(), entity.ids.end());
    }
    return ids;
}

void expect_planes_as_known(const Input& input, double share) {
    const auto sums = areas(input.tessellation);
    int planes = 0;
    for (const Entity& entity : input.points.entities) {
        if (entity.kind != EntityKind::face || entity.geometry != "plane" || entity.ids.size() > 1) continue;
        ASSERT_TRUE(sums.contains(entity.id)) << "face " << entity.id;
        EXPECT_NEAR(sums.at(entity.id), entity.area.value(), share * *entity.area) << "face " << entity.id;
        ++planes;
    }
    EXPECT_GT(planes, 2);
}

TEST(Tessellation, OfAModelWithHoles) {
    ReadModelOptions options;
    options.tessellate = true;
    const Input input = read_model_file(INSYM_SOURCE_DIR "/examples/flange.step", options);
    expect_planes_as_known(input, 0.01);
    // Plate, neck (a frustum), less the bore, seven holes and their spot faces, as examples/README.md has
    // them.
    const double pi = std::acos(-1.0);
    const double solid = pi * (80 * 80 * 18 + (42 * 42 + 42 * 33 + 33 * 33) * 32 / 3.0 - 25 * 25 * 50 -
                               7 * (7 * 7 * 16 + 13 * 13 * 2));
    EXPECT_NEAR(volume(input.tessellation), solid, 0.02 * solid);
    const auto edges = ids(input, EntityKind::edge);
    int known = 0;
    for (const Tessellation::Line& line : input.tessellation.lines) {
        EXPECT_GE(line.vertices.size(), 2U);
        known += edges.contains(line.edge) ? 1 : 0;
    }
    EXPECT_GE(known, 28);  // the circles of seven holes and spot faces
}

TEST(Tessellation, IsMadeOnlyWhenAskedFor) {
    const Input input = read_model_file(INSYM_SOURCE_DIR "/examples/bracket.step");
    EXPECT_TRUE(input.tessellation.vertices.empty() && input.tessellation.triangles.empty());
}

TEST(Tessellation, OfAMesh) {
    const std::string path =
        (std::filesystem::temp_directory_path() / ("insym-box-" + std::to_string(getpid()) + ".off"))
            .string();
    std::ofstream(path) << "OFF\n8 6 0\n0 0 0\n1 0 0\n0 2 0\n1 2 0\n0 0 3\n1 0 3\n0 2 3\n1 2 3\n"
                           "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
    ReadMeshOptions options;
    options.model.tessellate = true;
    const Input input = read_mesh_file(path, options);
    std::remove(path.c_str());
    EXPECT_EQ(input.tessellation.triangles.size(), 12U);
    EXPECT_NEAR(volume(input.tessellation), 6, 1e-9);
    expect_planes_as_known(input, 1e-9);
    EXPECT_EQ(input.tessellation.lines.size(), 12U);
    const auto edges = ids(input, EntityKind::edge);
    for (const Tessellation::Line& line : input.tessellation.lines) EXPECT_TRUE(edges.contains(line.edge));
}

}  // namespace
}  // namespace insym
