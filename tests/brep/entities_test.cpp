// The special points of vertices, edges and faces: where they are, what they are called, and that they go
// with the model. Shapes are made, moved, mirrored, cut up and written by Open CASCADE.
#include "insym/error.hpp"
#include "insym/read_model.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BinTools.hxx>
#include <IGESControl_Writer.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeUpgrade_ShapeDivideAngle.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <gmock/gmock.h>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>
#include <gtest/gtest.h>

#include "brep/step_files.hpp"

namespace insym {
namespace {

using test::ScratchFolder;
using test::step_text;
using ::testing::HasSubstr;

double distance(const Point& p, const Point& q) {
    return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

double diameter(const std::vector<Point>& points) {
    double longest = 0;
    for (const Point& p : points)
        for (const Point& q : points) longest = std::max(longest, distance(p, q));
    return longest;
}

Input read(const TopoDS_Shape& shape, const ReadModelOptions& options = {}) {
    const ScratchFolder folder;
    return read_model_file(folder.write("shape.step", step_text(shape)), options);
}

TopoDS_Shape plain_read(const std::string& path) {
    STEPControl_Reader reader;
    if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) throw std::runtime_error(path);
    reader.TransferRoots();
    return reader.OneShape();
}

/// Entities of that description: "face cylinder hole".
std::vector<std::size_t> find(const PointSet& points, EntityKind kind, const std::string& geometry,
                              EntityRole role = EntityRole::none) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Entity& e = points.entities[i];
        if (e.kind == kind && e.geometry == geometry && e.role == role) found.push_back(i);
    }
    return found;
}

/// The one entity of that description and where it is expected.
const Entity& expect_one(const Input& input, EntityKind kind, const std::string& geometry, EntityRole role,
                         const Point& where) {
    const auto found = find(input.points, kind, geometry, role);
    EXPECT_EQ(found.size(), 1U) << geometry;
    const std::size_t i = found.empty() ? 0 : found.front();
    EXPECT_LE(distance(input.points.positions[i], where), 1e-9) << geometry;
    return input.points.entities[i];
}

std::size_t count(const Input& input, EntityKind kind) {
    return static_cast<std::size_t>(std::count_if(input.points.entities.begin(), input.points.entities.end(),
                                                  [&](const Entity& e) { return e.kind == kind; }));
}

// ---- Known answers ----

// Oracle: geometry. A box of 20 x 20 x 10 with a hole of radius 3 through its middle.
TEST(Entities, APlateWithAHole) {
    const gp_Ax2 axis(gp_Pnt(10, 10, -1), gp_Dir(0, 0, 1), gp_Dir(0.6, 0.8, 0));
    const Input input = read(BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(20, 20, 10).Shape(),
                                             BRepPrimAPI_MakeCylinder(axis, 3, 12).Shape())
                                 .Shape());
    EXPECT_EQ(count(input, EntityKind::vertex), 8U);  // not those where the circles begin
    EXPECT_EQ(count(input, EntityKind::edge), 14U);   // 12 lines, 2 circles, no seam
    EXPECT_EQ(count(input, EntityKind::face), 7U);
    const Entity& hole = expect_one(input, EntityKind::face, "cylinder", EntityRole::hole, {10, 10, 5});
    EXPECT_NEAR(*hole.radius, 3, 1e-12);
    EXPECT_NEAR(*hole.area, 2 * std::numbers::pi * 3 * 10, 1e-6);
    const auto circles = find(input.points, EntityKind::edge, "circle");
    ASSERT_EQ(circles.size(), 2U);
    for (const std::size_t i : circles) {
        EXPECT_NEAR(*input.points.entities[i].length, 6 * std::numbers::pi, 1e-9);
        EXPECT_NEAR(input.points.positions[i][0], 10, 1e-9);
    }
    for (const std::size_t i : find(input.points, EntityKind::face, "plane")) {
        const Point& p = input.points.positions[i];  // top and bottom lose the hole, about their middles
        const bool pierced = p[2] == 0 || p[2] == 10;
        if (pierced) {
            EXPECT_NEAR(*input.points.entities[i].area, 400 - 9 * std::numbers::pi, 1e-9);
        }
    }
    // The 8 corners have one label, so have the 8 long lines, the 4 short ones, the 2 circles, ...
    EXPECT_EQ(std::set<int>(input.points.labels.begin(), input.points.labels.end()).size(), 7U);
}

// Oracle: geometry. One primitive each; where seams and poles are does not show.
TEST(Entities, RoundSolids) {
    const gp_Ax2 axis(gp_Pnt(1, 2, 3), gp_Dir(1, 2, 2), gp_Dir(2, 1, -2));
    const auto along = [](double t) { return Point{1 + t / 3, 2 + 2 * t / 3, 3 + 2 * t / 3}; };

    const Input sphere = read(BRepPrimAPI_MakeSphere(axis, 5).Shape());
    EXPECT_EQ(sphere.points.size(), 1U);
    EXPECT_NEAR(*expect_one(sphere, EntityKind::face, "sphere", EntityRole::round, along(0)).radius, 5, 1e-9);

    const Input torus = read(BRepPrimAPI_MakeTorus(axis, 9, 2).Shape());
    EXPECT_EQ(torus.points.size(), 1U);
    const Entity& ring = expect_one(torus, EntityKind::face, "torus", EntityRole::round, along(0));
    EXPECT_NEAR(*ring.radius, 9, 1e-9);
    EXPECT_NEAR(*ring.minor_radius, 2, 1e-9);
    EXPECT_NEAR(*ring.area, 4 * std::numbers::pi * std::numbers::pi * 18, 1e-3);

    const Input cylinder = read(BRepPrimAPI_MakeCylinder(axis, 4, 9).Shape());
    expect_one(cylinder, EntityKind::face, "cylinder", EntityRole::boss, along(4.5));
    EXPECT_EQ(cylinder.points.size(), 5U);  // itself, two planes, two circles

    const Input cone = read(BRepPrimAPI_MakeCone(axis, 4, 0, 6).Shape());
    expect_one(cone, EntityKind::face, "cone", EntityRole::boss, along(3));
    expect_one(cone, EntityKind::vertex, "point", EntityRole::none, along(6));  // the apex
    EXPECT_EQ(cone.points.size(), 4U);                                          // and plane and circle
}

// Oracle: the options' meaning.
TEST(Entities, WhatIsChosen) {
    const TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(4, 9).Shape();
    const auto sizes = [&](bool vertices, bool edges, bool faces) {
        const Input input = read(shape, {vertices, edges, faces, {}});
        return std::vector{count(input, EntityKind::vertex), count(input, EntityKind::edge),
                           count(input, EntityKind::face)};
    };
    EXPECT_EQ(sizes(true, false, false), (std::vector<std::size_t>{2, 0, 0}));  // all there are
    EXPECT_EQ(sizes(true, true, false), (std::vector<std::size_t>{0, 2, 0}));   // the circles stand for them
    EXPECT_EQ(sizes(false, false, true), (std::vector<std::size_t>{0, 0, 3}));
    EXPECT_THROW(sizes(false, false, false), Error);
    EXPECT_TRUE(read(shape, {true, true, true, {LabelBy::none}}).points.labels.empty());
    EXPECT_EQ(read(shape, {true, true, true, {LabelBy::kind}}).points.labels, (std::vector{0, 0, 1, 1, 1}));
}

// ---- Covariance ----

/// True if `b` is `a` carried by the map, each point to one of its label, to that length.
std::string difference(const PointSet& a, const gp_Trsf& map, const PointSet& b, double tolerance) {
    if (a.size() != b.size()) return std::to_string(a.size()) + " points and " + std::to_string(b.size());
    std::vector<char> taken(b.size(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        gp_Pnt image(a.positions[i][0], a.positions[i][1], a.positions[i][2]);
        image.Transform(map);
        const Point p = {image.X(), image.Y(), image.Z()};
        std::size_t nearest = b.size();
        for (std::size_t j = 0; j < b.size(); ++j)
            if (taken[j] == 0 && a.labels[i] == b.labels[j] &&
                (nearest == b.size() || distance(p, b.positions[j]) < distance(p, b.positions[nearest])))
                nearest = j;
        const Entity& e = a.entities[i];
        const std::string name = e.geometry + " " + std::to_string(e.id);
        if (nearest == b.size()) return name + " has no counterpart";
        // Centroids of B-splines are as good as the curves in parameters that Open CASCADE puts in for the
        // file's.
        const double reach = e.geometry == "surface" ? 10 * tolerance : tolerance;
        if (const double off = distance(p, b.positions[nearest]); off > reach)
            return name + " is off by " + std::to_string(off);
        taken[nearest] = 1;
    }
    return "";
}

gp_Trsf moved_and_turned() {
    gp_Trsf turn, shift;
    turn.SetRotation(gp_Ax1(gp_Pnt(3, 1, 4), gp_Dir(1, 5, 9)), 2.6);
    shift.SetTranslation(gp_Vec(53.5, -8.9, 7.9));
    return shift * turn;
}

gp_Trsf mirrored() {
    gp_Trsf mirror;
    mirror.SetMirror(gp_Ax2(gp_Pnt(3, 2, 3), gp_Dir(8, 4, 6)));
    return moved_and_turned() * mirror;
}

std::vector<std::filesystem::path> models() {
    std::vector<std::filesystem::path> paths;
    for (const auto& folder : {std::filesystem::path(INSYM_SOURCE_DIR) / "examples",
                               std::filesystem::path(INSYM_SHARED_DIR) / "data"})
        if (std::filesystem::is_directory(folder))
            for (const auto& entry : std::filesystem::directory_iterator(folder)) {
                const std::string ending = entry.path().extension();
                if (ending == ".step" || ending == ".stp") paths.push_back(entry.path());
            }
    std::sort(paths.begin(), paths.end());
    return paths;
}

class Model : public testing::TestWithParam<std::filesystem::path> {
protected:
    /// With a sanitizer these take minutes, and reach no other code.
    static bool too_slow() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        return std::filesystem::file_size(GetParam()) > 300'000;
#else
        return false;
#endif
    }
};

// Oracle: the isometry, applied to the points of the model as it is.
TEST_P(Model, PointsGoWithTheModel) {
    if (too_slow()) GTEST_SKIP() << "too slow with a sanitizer";
    const Input original = read_model_file(GetParam().string());
    const TopoDS_Shape shape = plain_read(GetParam().string());
    const double tolerance = 1e-6 * diameter(original.points.positions);
    for (const gp_Trsf& map : {moved_and_turned(), mirrored()}) {
        const Input copy = read(BRepBuilderAPI_Transform(shape, map, true).Shape());
        EXPECT_EQ(difference(original.points, map, copy.points, tolerance), "");
    }
}

// Oracle: the same solid, its round faces and their edges cut at every quarter turn.
TEST_P(Model, CuttingCirclesIntoArcsChangesNothing) {
    if (too_slow()) GTEST_SKIP() << "too slow with a sanitizer";
    const TopoDS_Shape shape = plain_read(GetParam().string());
    const Input original = read(shape);
    for (const Entity& e : original.points.entities)
        if (e.geometry == "surface" || e.geometry == "spline")
            GTEST_SKIP() << "has B-splines, which are cut with the round faces";
    ShapeUpgrade_ShapeDivideAngle divide(std::numbers::pi / 2, shape);
    divide.Perform();
    const Input cut = read(divide.Result());
    EXPECT_EQ(difference(original.points, gp_Trsf(), cut.points, 1e-6 * diameter(original.points.positions)),
              "");
}

/// The largest distance by which the model's own curves miss the vertices that they end at.
double largest_gap(const TopoDS_Shape& shape) {
    double largest = 0;
    for (TopExp_Explorer vertex(shape, TopAbs_VERTEX); vertex.More(); vertex.Next())
        largest = std::max(largest, BRep_Tool::Tolerance(TopoDS::Vertex(vertex.Current())));
    return largest;
}

// Oracle: the same model in STEP. In IGES each face stands alone, with edges of its own and no vertices: a
// vertex is where the curves end, so only faces are left to compare, to that distance, where these miss it.
TEST_P(Model, FacesOfIgesAreSewn) {
    if (too_slow()) GTEST_SKIP() << "too slow with a sanitizer";
    if (std::filesystem::file_size(GetParam()) > 1'000'000) GTEST_SKIP() << "takes 10 s";
    const TopoDS_Shape shape = plain_read(GetParam().string());
    const ScratchFolder folder;
    IGESControl_Writer writer("MM", 0);  // 0: trimmed surfaces
    writer.AddShape(shape);
    ASSERT_TRUE(writer.Write(folder.path("faces.igs").c_str()));
    const double size = diameter(read_model_file(GetParam().string()).points.positions);
    const double gap = largest_gap(shape);
    const bool has_gaps = gap > 1e-6 * size;
    if (GetParam().parent_path().filename() == "examples") {
        EXPECT_FALSE(has_gaps);
    }
    const ReadModelOptions options = {!has_gaps, !has_gaps, true, {}};
    const Input step = read_model_file(GetParam().string(), options);
    const Input iges = read_model_file(folder.path("faces.igs"), options);
    EXPECT_EQ(difference(step.points, gp_Trsf(), iges.points, std::max(gap, 1e-6 * size)), "");
    if (!has_gaps) {
        EXPECT_EQ(read_model_file(folder.path("faces.igs"), test::kVertices).points.size(),
                  read_model_file(GetParam().string(), test::kVertices).points.size());
    }
}

// Oracle: geometry. What a line or a circle makes about an axis or along a line is named as what it is, and
// inside and outside are told apart, also where the parameters run the other way.
TEST(Entities, SweptSurfaces) {
    const TopoDS_Shape ring = BRepPrimAPI_MakeTorus(9, 2).Shape();
    const TopoDS_Shape part =
        BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(-20, -20, -5), 40, 40, 9).Shape(),
                        BRepAlgoAPI_Fuse(ring, BRepPrimAPI_MakeSphere(3).Shape()).Shape())
            .Shape();
    const ScratchFolder folder;
    IGESControl_Writer writer("MM", 0);
    writer.AddShape(BRepBuilderAPI_Transform(part, moved_and_turned(), true).Shape());
    ASSERT_TRUE(writer.Write(folder.path("part.igs").c_str()));
    const Input step = read(part);
    EXPECT_EQ(find(step.points, EntityKind::face, "sphere", EntityRole::hollow).size(), 1U);
    EXPECT_EQ(
        difference(step.points, moved_and_turned(), read_model_file(folder.path("part.igs")).points, 1e-4),
        "");
}

// Oracle: Open CASCADE's own reader and maps. Every face is in one entity, every edge but seams and such.
void expect_all_entities(const std::string& path) {
    const auto start = std::chrono::steady_clock::now();
    const Input input = read_model_file(path);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const TopoDS_Shape shape = plain_read(path);
    TopTools_IndexedMapOfShape vertices, edges, faces;
    TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
    TopExp::MapShapes(shape, TopAbs_EDGE, edges);
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    TopTools_IndexedDataMapOfShapeListOfShape faces_of;
    TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of);

    std::multiset<std::int64_t> seen_edges, seen_faces;
    std::size_t corners = 0;
    for (const Entity& e : input.points.entities) {
        const std::vector<std::int64_t> ids = e.ids.empty() ? std::vector{e.id} : e.ids;
        auto& seen = e.kind == EntityKind::edge ? seen_edges : seen_faces;
        if (e.kind == EntityKind::vertex) ++corners;
        if (e.kind != EntityKind::vertex) seen.insert(ids.begin(), ids.end());
    }
    EXPECT_EQ(static_cast<int>(seen_faces.size()), faces.Extent()) << path;
    for (int i = 1; i <= faces.Extent(); ++i) EXPECT_EQ(seen_faces.count(i), 1U) << path << ": face " << i;
    int left_out = 0;
    for (int i = 1; i <= edges.Extent(); ++i) {
        EXPECT_LE(seen_edges.count(i), 1U) << path << ": edge " << i;
        if (seen_edges.contains(i)) continue;
        ++left_out;  // nothing, or a line within one round face or between two parts of it
        const bool inside = faces_of.FindFromKey(edges(i)).Extent() >= 2;
        EXPECT_TRUE(BRep_Tool::Degenerated(TopoDS::Edge(edges(i))) || inside) << path << ": edge " << i;
    }
    const auto all_vertices = read_model_file(path, test::kVertices).points.size();
    EXPECT_EQ(static_cast<int>(all_vertices), vertices.Extent()) << path;
    std::cout << std::filesystem::path(path).filename().string() << ": " << faces.Extent() << " faces, "
              << edges.Extent() << " edges (" << left_out << " of them seams), " << vertices.Extent()
              << " vertices (" << corners << " of them corners); " << input.points.size() << " points in "
              << seconds << " s\n";
}

TEST_P(Model, NoEntityIsLost) {
    if (too_slow()) GTEST_SKIP() << "too slow with a sanitizer";
    expect_all_entities(GetParam().string());
}

INSTANTIATE_TEST_SUITE_P(Entities, Model, testing::ValuesIn(models()), [](const auto& suite) {
    std::string name = suite.param.stem().string();
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
});

// The same for KiCad's models: INSYM_KICAD names the folder 3dmodels of Debian's kicad-packages3d.
TEST(Kicad, NoEntityIsLost) {
    const char* folder = std::getenv("INSYM_KICAD");
    std::ifstream list(std::filesystem::path(INSYM_SHARED_DIR) / "bench" / "kicad_dev.txt");
    if (folder == nullptr || !list) GTEST_SKIP() << "INSYM_KICAD or shared/bench/kicad_dev.txt is not there";
    std::string count, pitch, name;
    while (list >> count >> pitch && std::getline(list >> std::ws, name))
        expect_all_entities((std::filesystem::path(folder) / name).string());
}

// ---- The other formats ----

/// Asymmetric, and with all kinds of faces but spheres.
TopoDS_Shape sample_part() {
    const TopoDS_Shape block = BRepPrimAPI_MakeBox(30, 20, 10).Shape();
    const auto axis = [](double x, double y) { return gp_Ax2(gp_Pnt(x, y, -1), gp_Dir(0, 0, 1)); };
    const TopoDS_Shape once =
        BRepAlgoAPI_Cut(block, BRepPrimAPI_MakeCylinder(axis(7, 8), 3, 12).Shape()).Shape();
    const TopoDS_Shape twice =
        BRepAlgoAPI_Cut(once, BRepPrimAPI_MakeCone(axis(20, 12), 2, 5, 12).Shape()).Shape();
    return BRepAlgoAPI_Cut(twice, BRepPrimAPI_MakeCylinder(axis(30, 0), 4, 12).Shape()).Shape();
}

// Oracle: the same part in STEP.
TEST(OtherFormats, BrepIsAsStep) {
    const TopoDS_Shape part = sample_part();
    const ScratchFolder folder;
    BRepTools::Write(part, folder.path("part.brep").c_str());
    BinTools::Write(part, folder.path("part.brp").c_str());
    const Input step = read(part);
    for (const char* name : {"part.brep", "part.brp"}) {
        const Input brep = read_model_file(folder.path(name));
        EXPECT_EQ(difference(step.points, gp_Trsf(), brep.points, 1e-9), "") << name;
        EXPECT_EQ(brep.format, "brep");
        EXPECT_EQ(brep.unit, "mm");
    }
}

// Oracle: the same part in STEP; lengths are in the unit that the file names.
TEST(OtherFormats, IgesIsAsStep) {
    const TopoDS_Shape part = sample_part();
    const ScratchFolder folder;
    const Input step = read(part);
    for (const std::string unit : {"MM", "INCH", "M"}) {
        IGESControl_Writer writer(unit.c_str(), 1);  // 1: solids, with shared edges
        writer.AddShape(part);
        ASSERT_TRUE(writer.Write(folder.path("part.igs").c_str()));
        const Input iges = read_model_file(folder.path("part.igs"));
        const double millimetres = unit == "MM" ? 1 : unit == "INCH" ? 25.4 : 1000;
        EXPECT_EQ(iges.unit, unit == "MM" ? "mm" : unit == "INCH" ? "inch" : "m");
        EXPECT_EQ(iges.format, "iges");
        gp_Trsf scale;
        scale.SetScale(gp_Pnt(0, 0, 0), 1 / millimetres);
        EXPECT_EQ(difference(step.points, scale, iges.points, 1e-6 / millimetres), "") << unit;
    }
}

TEST(OtherFormats, Damage) {
    const ScratchFolder folder;
    const TopoDS_Shape part = sample_part();
    BRepTools::Write(part, folder.path("part.brep").c_str());
    const std::string whole = test::read_text(folder.path("part.brep"));
    const auto refused = [&](const std::string& name, const std::string& text, const std::string& says) {
        try {
            read_model_file(folder.write(name, text));
            ADD_FAILURE() << name << " was read";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::cannot_read);
            EXPECT_THAT(error.what(), HasSubstr(says));
        }
    };
    refused("cut.brep", whole.substr(0, whole.size() / 2), "damaged");
    refused("letter.brep", "Dear Sir", "not a BREP file");
    refused("empty.brep", "", "empty");
    refused("letter.igs", "Dear Sir", "not an IGES file");
    IGESControl_Writer writer("MM", 1);
    writer.AddShape(part);
    ASSERT_TRUE(writer.Write(folder.path("part.igs").c_str()));
    const std::string iges = test::read_text(folder.path("part.igs"));
    refused("cut.igs", iges.substr(0, iges.size() / 2), "damaged");
}

// ---- Assemblies ----

// Oracle: the names and the structure in the text of the file.
TEST(Parts, HaveNamePaths) {
    const std::filesystem::path path = std::filesystem::path(INSYM_SHARED_DIR) / "data" / "as1-oc-214.stp";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    std::set<std::string> parts;
    for (const Entity& e : read_model_file(path.string()).points.entities) parts.insert(e.part);
    EXPECT_EQ(parts.size(), 18U);  // solids placed
    EXPECT_TRUE(parts.contains("as1/plate")) << testing::PrintToString(parts);
    EXPECT_TRUE(parts.contains("as1/l-bracket-assembly#2/nut-bolt-assembly#3/bolt"))
        << testing::PrintToString(parts);
    EXPECT_TRUE(parts.contains("as1/rod-assembly/nut#1")) << testing::PrintToString(parts);
}

}  // namespace
}  // namespace insym
