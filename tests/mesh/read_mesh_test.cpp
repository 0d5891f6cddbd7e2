// The reader of meshes. Oracles: the geometry of the shapes that are written here, and that all formats hold
// the same.
#include "insym/read_mesh.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace insym {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Mesh {
    std::vector<Point> vertices;
    std::vector<std::array<int, 3>> triangles;

    void add_quad(int a, int b, int c, int d) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
    }
};

Mesh box(double x, double y, double z) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) mesh.vertices.push_back({(i & 1) * x, (i >> 1 & 1) * y, (i >> 2) * z});
    mesh.add_quad(0, 2, 3, 1);
    mesh.add_quad(4, 5, 7, 6);
    mesh.add_quad(0, 1, 5, 4);
    mesh.add_quad(2, 6, 7, 3);
    mesh.add_quad(0, 4, 6, 2);
    mesh.add_quad(1, 3, 7, 5);
    return mesh;
}

/// A prism over a closed outline, from z = 0 to height; the lids are fans about (0, 0).
Mesh prism(const std::vector<Point>& outline, double height) {
    Mesh mesh;
    const int n = static_cast<int>(outline.size());
    for (const double z : {0.0, height})
        for (const Point& p : outline) mesh.vertices.push_back({p[0], p[1], z});
    mesh.vertices.push_back({0, 0, 0});
    mesh.vertices.push_back({0, 0, height});
    for (int i = 0; i < n; ++i) {
        const int j = (i + 1) % n;
        mesh.add_quad(i, j, j + n, i + n);
        mesh.triangles.push_back({2 * n, j, i});
        mesh.triangles.push_back({2 * n + 1, i + n, j + n});
    }
    return mesh;
}

/// Two half circles of radius r about (-a, 0) and (a, 0), and the straight lines between them.
std::vector<Point> slot(double a, double r, int segments) {
    std::vector<Point> outline;
    for (const int side : {1, -1})
        for (int i = 0; i <= segments; ++i) {
            const double angle = std::numbers::pi * (double(i) / segments - 0.5);
            outline.push_back({side * (a + r * std::cos(angle)), side * r * std::sin(angle), 0});
        }
    return outline;
}

std::vector<Point> circle(double r, int segments) {
    std::vector<Point> outline;
    for (int i = 0; i < segments; ++i) {
        const double angle = 2 * std::numbers::pi * i / segments;
        outline.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    }
    return outline;
}

// Writers ---------------------------------------------------------------------------------------

std::string text(const Point& p, const std::string& end) {
    std::ostringstream out;
    out.precision(9);
    out << p[0] << ' ' << p[1] << ' ' << p[2] << end;
    return out.str();
}

std::string to_stl(const Mesh& mesh) {
    std::string out = "solid part\n";
    for (const auto& t : mesh.triangles) {
        out += "facet normal 0 0 0\nouter loop\n";
        for (const int i : t) out += "vertex " + text(mesh.vertices[std::size_t(i)], "\n");
        out += "endloop\nendfacet\n";
    }
    return out + "endsolid part\n";
}

template <class Number>
void put(std::string& out, Number number) {
    static_assert(std::endian::native == std::endian::little);
    out.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string to_binary_stl(const Mesh& mesh) {
    std::string out(80, ' ');
    put(out, std::uint32_t(mesh.triangles.size()));
    for (const auto& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) put(out, 0.F);
        for (const int i : t)
            for (const double x : mesh.vertices[std::size_t(i)]) put(out, float(x));
        put(out, std::uint16_t{0});
    }
    return out;
}

std::string to_off(const Mesh& mesh) {
    std::string out =
        "OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n";
    for (const Point& p : mesh.vertices) out += text(p, "\n");
    for (const auto& t : mesh.triangles)
        out += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
    return out;
}

/// As Geomview has it: big-endian, after each face the number of its colours and the colours.
template <class Number>
void put_big(std::string& out, Number number) {
    std::string bytes;
    put(bytes, number);
    out.append(bytes.rbegin(), bytes.rend());
}

/// `keyword`: with C, N and ST a vertex has a colour, a normal and a place in a texture, with 4 a weight.
std::string to_binary_off(const Mesh& mesh, const std::string& keyword = "OFF", int colours = 0) {
    const auto has = [&](char prefix) {
        return keyword.substr(0, keyword.find("OFF")).find(prefix) != std::string::npos;
    };
    std::string out = "# a comment\n" + keyword + " BINARY\n";
    for (const std::size_t n : {mesh.vertices.size(), mesh.triangles.size(), std::size_t{0}})
        put_big(out, std::int32_t(n));
    for (const Point& p : mesh.vertices) {
        const float weight = has('4') ? 2 : 1;
        for (const double x : p) put_big(out, float(x) * weight);
        if (has('4')) put_big(out, weight);
        for (int i = (has('N') ? 3 : 0) + (has('C') ? 4 : 0) + (has('S') ? 2 : 0); i > 0; --i)
            put_big(out, 0.25F);
    }
    for (const auto& t : mesh.triangles) {
        put_big(out, std::int32_t{3});
        for (const int i : t) put_big(out, std::int32_t{i});
        put_big(out, std::int32_t{colours});
        for (int i = 0; i < colours; ++i) put_big(out, 0.5F);
    }
    return out;
}

std::string to_obj(const Mesh& mesh) {
    std::string out = "mtllib no_such_file.mtl\n";
    for (const Point& p : mesh.vertices) out += "v " + text(p, "\n");
    for (const auto& t : mesh.triangles)
        out += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
               std::to_string(t[2] + 1) + "\n";
    return out;
}

std::string to_ply(const Mesh& mesh, bool binary) {
    std::string out = std::string("ply\nformat ") + (binary ? "binary_little_endian" : "ascii") +
                      " 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(mesh.triangles.size()) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Point& p : mesh.vertices) {
        if (!binary) out += text(p, "\n");
        if (binary)
            for (const double x : p) put(out, float(x));
    }
    for (const auto& t : mesh.triangles) {
        if (binary) put(out, std::uint8_t{3});
        if (!binary) out += "3";
        for (const int i : t) binary ? put(out, std::int32_t{i}) : void(out += " " + std::to_string(i));
        if (!binary) out += "\n";
    }
    return out;
}

class Folder {
public:
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "insym_mesh_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder");
        path_ = name;
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string write(const std::string& name, const std::string& content) const {
        std::ofstream(path_ / name, std::ios::binary) << content;
        return (path_ / name).string();
    }

private:
    std::filesystem::path path_;
};

Input read(const Mesh& mesh, const ReadMeshOptions& options = {}) {
    return read_mesh_file(Folder().write("mesh.stl", to_stl(mesh)), options);
}

std::multiset<std::string> sorts_of(const PointSet& points) {
    const std::array<std::string, 3> kinds = {"vertex", "edge", "face"};
    std::multiset<std::string> sorts;
    for (const Entity& e : points.entities) sorts.insert(kinds[std::size_t(e.kind)] + " " + e.geometry);
    return sorts;
}

bool has_point(const PointSet& points, EntityKind kind, const Point& p) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& q = points.positions[i];
        if (points.entities[i].kind == kind && std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) < 1e-5)
            return true;
    }
    return false;
}

// What is read ----------------------------------------------------------------------------------

TEST(ReadMesh, ABoxInAllFormats) {
    const Folder folder;
    const Mesh mesh = box(2, 3, 5);
    const std::vector<std::pair<std::string, std::string>> files = {
        {"a.stl", to_stl(mesh)},       {"b.STL", to_binary_stl(mesh)}, {"a.off", to_off(mesh)},
        {"a.obj", to_obj(mesh)},       {"a.ply", to_ply(mesh, false)}, {"b.ply", to_ply(mesh, true)},
        {"b.off", to_binary_off(mesh)}};
    for (const auto& [name, content] : files) {
        ASSERT_TRUE(is_mesh_path(name));
        const Input input = read_mesh_file(folder.write(name, content));
        const PointSet& points = input.points;
        const auto sorts = sorts_of(points);
        EXPECT_EQ(sorts.size(), 26U) << name;
        EXPECT_EQ(sorts.count("vertex point"), 8U) << name;
        EXPECT_EQ(sorts.count("edge line"), 12U) << name;
        EXPECT_EQ(sorts.count("face plane"), 6U) << name;
        EXPECT_TRUE(has_point(points, EntityKind::vertex, {2, 3, 5})) << name;
        EXPECT_TRUE(has_point(points, EntityKind::edge, {2, 0, 2.5})) << name;
        EXPECT_TRUE(has_point(points, EntityKind::face, {2, 1.5, 2.5})) << name;
        EXPECT_EQ(std::set<int>(points.labels.begin(), points.labels.end()).size(), 1U + 3 + 3) << name;
        EXPECT_FALSE(input.unit) << name;
    }
}

// Oracle: the same mesh as text. What else vertices and faces have changes nothing.
TEST(ReadMesh, BinaryOffIsAsText) {
    const Folder folder;
    const Mesh mesh = prism(slot(10, 3, 16), 5);
    const Input text = read_mesh_file(folder.write("a.off", to_off(mesh)));
    for (const std::string keyword : {"OFF", "COFF", "NOFF", "STCNOFF", "4OFF", "CN4OFF"})
        for (const int colours : {0, 1, 3, 4}) {
            const Input binary = read_mesh_file(folder.write("b.off", to_binary_off(mesh, keyword, colours)));
            ASSERT_EQ(binary.points.size(), text.points.size()) << keyword << colours;
            EXPECT_EQ(binary.points.labels, text.points.labels) << keyword << colours;
            for (std::size_t i = 0; i < text.points.size(); ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    EXPECT_NEAR(binary.points.positions[i][k], text.points.positions[i][k], 1e-5);
        }
}

// Oracle: geometry. The lid of a prism is flat where its corners are off the plane by 0.1 % of the diagonal,
// and is not where they are off by 1 %; nor is the narrow round of an edge, however near to a plane it is.
TEST(ReadMesh, NearlyFlatIsFlat) {
    const auto with_rough_lid = [](double share) {
        Mesh mesh = prism(circle(10, 6), 20);
        const double diagonal = std::hypot(20.0, 20.0, 20.0);
        for (int i = 0; i < 6; ++i)
            mesh.vertices[std::size_t(i)][2] += (i % 2 == 0 ? 1 : -1) * share * diagonal;
        return sorts_of(read(mesh).points).count("face plane");
    };
    EXPECT_EQ(with_rough_lid(0), 8U);
    EXPECT_EQ(with_rough_lid(1e-3), 8U);
    EXPECT_LT(with_rough_lid(1e-2), 8U);

    std::vector<Point> outline;  // a square of 20 whose corner at (10, 10) is rounded by 0.04
    for (int i = 0; i <= 8; ++i) {
        const double angle = std::numbers::pi / 16 * i;
        outline.push_back({9.96 + 0.04 * std::cos(angle), 9.96 + 0.04 * std::sin(angle), 0});
    }
    for (const Point& corner : {Point{-10, 10, 0}, Point{-10, -10, 0}, Point{10, -10, 0}})
        outline.push_back(corner);
    EXPECT_EQ(sorts_of(read(prism(outline, 20)).points).count("face plane"), 6U);
}

TEST(ReadMesh, RimsAreCircles) {
    const PointSet points = read(prism(circle(7, 48), 20)).points;
    EXPECT_EQ(sorts_of(points),
              (std::multiset<std::string>{"edge circle", "edge circle", "face plane", "face plane"}));
    EXPECT_TRUE(has_point(points, EntityKind::edge, {0, 0, 0}));
    EXPECT_TRUE(has_point(points, EntityKind::edge, {0, 0, 20}));
    for (const Entity& e : points.entities) EXPECT_NEAR(e.radius.value_or(7), 7, 1e-5);
}

// A prism over few corners is one; the angle decides.
TEST(ReadMesh, TheSharpAngleDecides) {
    const Mesh hexagon = prism(circle(7, 6), 20);
    EXPECT_EQ(sorts_of(read(hexagon).points).count("vertex point"), 12U);
    EXPECT_EQ(sorts_of(read(hexagon, {.sharp_angle_deg = 70}).points).count("edge circle"), 2U);
    EXPECT_EQ(sorts_of(read(prism(circle(7, 48), 20), {.sharp_angle_deg = 5}).points).count("vertex point"),
              96U);
}

TEST(ReadMesh, ASlotIsTwoArcsAndTwoLines) {
    const PointSet points = read(prism(slot(10, 3, 16), 5)).points;
    const auto sorts = sorts_of(points);
    EXPECT_EQ(sorts.count("edge circle"), 4U);
    EXPECT_EQ(sorts.count("edge line"), 4U);
    EXPECT_EQ(sorts.count("vertex point"), 8U);
    EXPECT_EQ(sorts.count("face plane"), 4U);  // two lids, two flat sides; not the facets of the round ones
    EXPECT_TRUE(has_point(points, EntityKind::edge, {10, 0, 5}));
    EXPECT_TRUE(has_point(points, EntityKind::edge, {0, 3, 5}));
    EXPECT_TRUE(has_point(points, EntityKind::vertex, {10, -3, 0}));
}

// A polygon that is not convex: a U, 3 wide and 2 high, with a notch of 1 by 1; its area and centroid by
// hand.
TEST(ReadMesh, PolygonsNeedNotBeConvex) {
    const std::string text =
        "OFF\n8 1 0\n0 0 0\n3 0 0\n3 2 0\n2 2 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n8 0 1 2 3 4 5 6 7\n";
    const PointSet points = read_mesh_file(Folder().write("u.off", text)).points;
    EXPECT_EQ(sorts_of(points).count("vertex point"), 8U);
    EXPECT_EQ(sorts_of(points).count("face plane"), 1U);
    EXPECT_NEAR(points.entities.back().area.value_or(0), 5, 1e-6);
    EXPECT_TRUE(has_point(points, EntityKind::face, {1.5, (3 * 0.5 + 2 * 1.5) / 5, 0}));
}

// ---- What cannot be read ----

Error error_of(const std::string& path, const ReadMeshOptions& options = {}) {
    try {
        read_mesh_file(path, options);
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << path << " was read";
    return {ErrorCode::cannot_write, ""};
}

TEST(ReadMeshErrors, DamagedFiles) {
    const Folder folder;
    const Mesh mesh = box(1, 2, 3);
    const auto refused = [&](const std::string& name, const std::string& content, ErrorCode code,
                             const std::string& says) {
        const Error error = error_of(folder.write(name, content));
        EXPECT_EQ(error.code(), code) << name << error.what();
        EXPECT_THAT(error.what(), AllOf(HasSubstr(name), HasSubstr(says)));
    };
    const auto half = [](const std::string& whole) { return whole.substr(0, whole.size() / 2); };
    refused("cut.stl", half(to_stl(mesh)), ErrorCode::cannot_read, "damaged");
    refused("cut_binary.stl", half(to_binary_stl(mesh)), ErrorCode::cannot_read, "damaged");
    refused("cut.off", half(to_off(mesh)), ErrorCode::cannot_read, "damaged");
    refused("cut.ply", to_ply(mesh, false).substr(0, to_ply(mesh, false).size() - 60), ErrorCode::cannot_read,
            "");
    refused("cut_binary.ply", to_ply(mesh, true).substr(0, to_ply(mesh, true).size() - 60),
            ErrorCode::cannot_read, "");
    const std::string off = to_binary_off(mesh);
    const std::size_t head = off.find("BINARY\n") + 7, vertices = head + 12, faces = vertices + 96;
    for (std::size_t size = head; size < off.size(); ++size)
        refused("cut_binary.off", off.substr(0, size), ErrorCode::cannot_read, "damaged");
    const auto with = [&](std::size_t at, std::int32_t number) {
        std::string word, changed = off;
        put_big(word, number);
        return changed.replace(at, word.size(), word);
    };
    for (const std::int32_t lie : {-1, 9, 1 << 30, std::numeric_limits<std::int32_t>::max()}) {
        refused("vertices.off", with(head, lie), ErrorCode::cannot_read, "damaged");
        refused("faces.off", with(head + 4, lie), ErrorCode::cannot_read, "damaged");
        refused("corners.off", with(faces, lie), ErrorCode::cannot_read, "damaged");
        refused("index.off", with(faces + 4, lie), ErrorCode::cannot_read, "damaged");
        refused("colours.off", with(faces + 16, lie), ErrorCode::cannot_read, "damaged");
    }
    refused("infinite.off",
            with(vertices, std::bit_cast<std::int32_t>(std::numeric_limits<float>::infinity())),
            ErrorCode::cannot_read, "finite");
    refused("more.off", off + "....", ErrorCode::cannot_read, "goes on");
    refused("dimensions.off", to_binary_off(mesh, "nOFF"), ErrorCode::cannot_read, "not of a mesh in space");
    refused("none.off", to_binary_off({}), ErrorCode::invalid_input, "no triangles");
    refused("empty.ply", "", ErrorCode::cannot_read, "empty");
    refused("letter.stl", "Dear Sir", ErrorCode::cannot_read, "not an STL file");
    refused("none.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", ErrorCode::invalid_input, "no triangles");
    refused("line.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n2 0 1\n", ErrorCode::invalid_input, "no triangles");
    EXPECT_THAT(error_of("/no/such.stl").what(), HasSubstr("No such file"));
}

TEST(ReadMeshErrors, Options) {
    EXPECT_EQ(error_of("a.stl", {.sharp_angle_deg = 180}).code(), ErrorCode::invalid_option);
    EXPECT_EQ(error_of("a.stl", {.model = {false, false, false, {}}}).code(), ErrorCode::invalid_option);
}

}  // namespace
}  // namespace insym
