// The reader of STEP files. Files are written by Open CASCADE, or are such files with the text changed.
#include "insym/read_model.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Vertex.hxx>
#include <gmock/gmock.h>
#include <gp_Ax1.hxx>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "brep/step_files.hpp"

namespace insym {
namespace {

using test::box_corners;
using test::kVertices;
using test::replaced;
using test::same_points;
using test::ScratchFolder;
using test::step_text;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

TopoDS_Shape make_box(const Point& high) {
    return BRepPrimAPI_MakeBox(high[0], high[1], high[2]).Shape();
}

TopoDS_Compound compound(const std::vector<TopoDS_Shape>& shapes) {
    const BRep_Builder builder;
    TopoDS_Compound result;
    builder.MakeCompound(result);
    for (const TopoDS_Shape& shape : shapes) builder.Add(result, shape);
    return result;
}

gp_Trsf shift(double x, double y, double z) {
    gp_Trsf translation;
    translation.SetTranslation(gp_Vec(x, y, z));
    return translation;
}

std::vector<Point> carried(std::vector<Point> points, const gp_Trsf& by) {
    for (Point& p : points) {
        const gp_Pnt q = gp_Pnt(p[0], p[1], p[2]).Transformed(by);
        p = {q.X(), q.Y(), q.Z()};
    }
    return points;
}

/// Points no two of which are closer than `resolution`, by looking at all pairs.
std::size_t count_distinct(const std::vector<Point>& points, double share_of_diameter) {
    const auto distance = [](const Point& p, const Point& q) {
        return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    };
    double diameter = 0;
    for (const Point& p : points)
        for (const Point& q : points) diameter = std::max(diameter, distance(p, q));
    std::vector<Point> kept;
    for (const Point& p : points)
        if (std::none_of(kept.begin(), kept.end(),
                         [&](const Point& q) { return distance(p, q) <= share_of_diameter * diameter; }))
            kept.push_back(p);
    return kept.size();
}

/// The error of reading that file; the test fails where there is none.
Error error_of(const std::string& path) {
    try {
        read_model_file(path, kVertices);
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << path << " was read";
    return {ErrorCode::cannot_write, ""};
}

// ---- What is read ----

// Oracle: a round trip. Points only, no faces; 1e-9 because Open CASCADE writes about 13 digits.
TEST(ReadModel, VerticesComeBackAsTheyWereWritten) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-100, 100);
    std::vector<Point> points(200);
    std::vector<TopoDS_Shape> vertices;
    for (Point& p : points) {
        p = {uniform(random), uniform(random), uniform(random)};
        vertices.push_back(BRepBuilderAPI_MakeVertex(gp_Pnt(p[0], p[1], p[2])).Vertex());
    }
    const ScratchFolder folder;
    const Input input =
        read_model_file(folder.write("points.step", step_text(compound(vertices))), kVertices);
    EXPECT_TRUE(same_points(input.points.positions, points, 1e-9));
}

// Oracle: the definition of a box; the interface's promises of path, format, unit and entities.
TEST(ReadModel, ABoxHasEightVertices) {
    const ScratchFolder folder;
    const std::string path = folder.write("box.STEP", step_text(make_box({2, 3, 4})));
    const Input input = read_model_file(path, kVertices);
    EXPECT_TRUE(same_points(input.points.positions, box_corners({0, 0, 0}, {2, 3, 4}), 1e-12));
    EXPECT_EQ(input.path, path);
    EXPECT_EQ(input.format, "step");
    EXPECT_EQ(input.unit, "mm");
    EXPECT_EQ(input.points.dimension, 3);
    EXPECT_TRUE(input.points.labels.empty());
    ASSERT_EQ(input.points.entities.size(), 8U);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(input.points.entities[i].kind, EntityKind::vertex);
        EXPECT_EQ(input.points.entities[i].id, static_cast<std::int64_t>(i) + 1);
        EXPECT_EQ(input.points.entities[i].geometry, "point");
    }
}

// Oracle: Open CASCADE itself, used in the plainest way: the id is the place in its map of vertices.
TEST(ReadModel, IdsFollowTheMapOfVertices) {
    const ScratchFolder folder;
    const std::string path = folder.write(
        "boxes.step", step_text(compound({make_box({1, 2, 3}), make_box({9, 8, 7}).Moved(shift(20, 0, 0))})));
    const Input input = read_model_file(path, kVertices);

    STEPControl_Reader reader;
    ASSERT_EQ(reader.ReadFile(path.c_str()), IFSelect_RetDone);
    reader.TransferRoots();
    TopTools_IndexedMapOfShape map;
    TopExp::MapShapes(reader.OneShape(), TopAbs_VERTEX, map);
    ASSERT_EQ(static_cast<int>(input.points.size()), map.Extent());
    for (std::size_t i = 0; i < input.points.size(); ++i) {
        const auto id = static_cast<int>(input.points.entities[i].id);
        const gp_Pnt expected = BRep_Tool::Pnt(TopoDS::Vertex(map(id)));
        const Point& p = input.points.positions[i];
        EXPECT_LE(expected.Distance(gp_Pnt(p[0], p[1], p[2])), 1e-12) << "vertex " << id;
    }
}

/// A tube as one face without a seam edge, as some systems write it: two circles that begin at (0, 5) and at
/// (-5, 0), on a cylinder whose seam is at (5, 0).
std::string seamless_tube_text() {
    constexpr std::string_view kTube = R"(SHELL_BASED_SURFACE_MODEL('',(#9001));
#9001=OPEN_SHELL('',(#9002));
#9002=ADVANCED_FACE('',(#9101,#9201),#9003,.T.);
#9003=CYLINDRICAL_SURFACE('',#9004,5.);
#9004=AXIS2_PLACEMENT_3D('',#9108,#9011,#9012);
#9011=DIRECTION('',(0.,0.,1.));
#9012=DIRECTION('',(1.,0.,0.));
#9013=DIRECTION('',(0.,1.,0.));
#9014=DIRECTION('',(-1.,0.,0.));
#9101=FACE_BOUND('',#9102,.T.);
#9102=EDGE_LOOP('',(#9103));
#9103=ORIENTED_EDGE('',*,*,#9104,.T.);
#9104=EDGE_CURVE('',#9105,#9105,#9107,.T.);
#9105=VERTEX_POINT('',#9106);
#9106=CARTESIAN_POINT('',(0.,5.,0.));
#9107=CIRCLE('',#9109,5.);
#9108=CARTESIAN_POINT('',(0.,0.,0.));
#9109=AXIS2_PLACEMENT_3D('',#9108,#9011,#9013);
#9201=FACE_BOUND('',#9202,.T.);
#9202=EDGE_LOOP('',(#9203));
#9203=ORIENTED_EDGE('',*,*,#9204,.F.);
#9204=EDGE_CURVE('',#9205,#9205,#9207,.T.);
#9205=VERTEX_POINT('',#9206);
#9206=CARTESIAN_POINT('',(-5.,0.,10.));
#9207=CIRCLE('',#9209,5.);
#9208=CARTESIAN_POINT('',(0.,0.,10.));
#9209=AXIS2_PLACEMENT_3D('',#9208,#9011,#9014))";
    return replaced(step_text(make_box({1, 1, 1})), "MANIFOLD_SOLID_BREP('',#16)", kTube);
}

// Oracle: the two vertices in the file; Open CASCADE's healing, on here for comparison, adds others.
TEST(ReadModel, NoVerticesAreAdded) {
    const ScratchFolder folder;
    const std::string path = folder.write("tube.step", seamless_tube_text());
    EXPECT_TRUE(
        same_points(read_model_file(path, kVertices).points.positions, {{0, 5, 0}, {-5, 0, 10}}, 1e-12));

    STEPControl_Reader healing;
    ASSERT_EQ(healing.ReadFile(path.c_str()), IFSelect_RetDone);
    healing.TransferRoots();
    TopTools_IndexedMapOfShape vertices;
    TopExp::MapShapes(healing.OneShape(), TopAbs_VERTEX, vertices);
    EXPECT_GT(vertices.Extent(), 2);
}

struct Model {
    std::string file;
    std::size_t distinct_vertices;
};

void PrintTo(const Model& model, std::ostream* out) {
    *out << model.file;
}

class SharedModel : public testing::TestWithParam<Model> {};

// Oracle: the known answers of shared/data/README.md, found there by an independent prototype.
TEST_P(SharedModel, HasTheKnownNumberOfDistinctVertices) {
    const std::filesystem::path path = std::filesystem::path(INSYM_SHARED_DIR) / "data" / GetParam().file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    const Input input = read_model_file(path.string(), kVertices);
    EXPECT_EQ(count_distinct(input.points.positions, 1e-6), GetParam().distinct_vertices);
    EXPECT_EQ(input.unit, "mm");
}

INSTANTIATE_TEST_SUITE_P(ReadModel, SharedModel,
                         testing::Values(Model{"spinner4.stp", 84}, Model{"spinner2.stp", 88},
                                         Model{"as1-oc-214.stp", 212}, Model{"Ventilator.stp", 489},
                                         Model{"linkrods.step", 74}, Model{"dsub37.step", 436}),
                         [](const auto& suite) {
                             std::string name = suite.param.file.substr(0, suite.param.file.find('.'));
                             name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                             return name;
                         });

// ---- Assemblies ----

// Oracle: the placements, applied to the corners here.
TEST(ReadModel, EveryPlacedOccurrenceOfAPartCounts) {
    gp_Trsf turn;
    turn.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(1, 1, 1)), 0.7);
    const std::vector<gp_Trsf> places = {gp_Trsf(), shift(10, 0, 0), turn * shift(0, 30, 5)};
    const TopoDS_Shape part = make_box({2, 3, 4});
    std::vector<TopoDS_Shape> placed;
    std::vector<Point> expected;
    for (const gp_Trsf& place : places) {
        placed.push_back(part.Located(TopLoc_Location(place)));
        for (const Point& p : carried(box_corners({0, 0, 0}, {2, 3, 4}), place)) expected.push_back(p);
    }
    const std::string text = step_text(compound(placed));
    ASSERT_THAT(text, HasSubstr("NEXT_ASSEMBLY_USAGE_OCCURRENCE"));
    const ScratchFolder folder;
    const Input input = read_model_file(folder.write("assembly.step", text), kVertices);
    EXPECT_TRUE(same_points(input.points.positions, expected, 1e-9));
}

// Oracle: the product of the placements. A pair of boxes, itself placed twice.
TEST(ReadModel, AssembliesNest) {
    const TopoDS_Shape part = make_box({1, 1, 1});
    const TopoDS_Shape pair = compound({part, part.Moved(shift(3, 0, 0))});
    gp_Trsf turn;
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 1.0);
    const gp_Trsf place = shift(0, 0, 50) * turn;
    std::vector<Point> expected;
    for (const gp_Trsf& outer : {gp_Trsf(), place})
        for (const gp_Trsf& inner : {gp_Trsf(), shift(3, 0, 0)})
            for (const Point& p : carried(box_corners({0, 0, 0}, {1, 1, 1}), outer * inner))
                expected.push_back(p);
    const ScratchFolder folder;
    const Input input = read_model_file(
        folder.write("nested.step", step_text(compound({pair, pair.Moved(TopLoc_Location(place))}))),
        kVertices);
    EXPECT_TRUE(same_points(input.points.positions, expected, 1e-9));
}

// ---- Units ----

struct Unit {
    std::string name;
    std::string declaration;
};

void PrintTo(const Unit& unit, std::ostream* out) {
    *out << unit.name;
}

/// A unit that is so many millimetres, declared through conversion.
std::string by_conversion(const std::string& millimetres) {
    return "( CONVERSION_BASED_UNIT('ANY NAME',#90001) LENGTH_UNIT() NAMED_UNIT(#90002) );\n"
           "#90001 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(" +
           millimetres +
           "),#90003);\n"
           "#90002 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n"
           "#90003 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );";
}

/// A box of 2 x 3 x 4 units of that declaration.
std::string box_text(const std::string& declaration) {
    std::string text = step_text(make_box({2, 3, 4}));
    const std::size_t start = text.find("( LENGTH_UNIT()");
    const std::size_t stop = text.find(';', start);
    if (start == std::string::npos) throw std::runtime_error("no unit of length");
    return text.replace(start, stop + 1 - start, declaration);
}

class DeclaredUnit : public testing::TestWithParam<Unit> {};

// Oracle: the numbers in the file, which the declaration of the unit does not change.
TEST_P(DeclaredUnit, CoordinatesAreInTheUnitOfTheFile) {
    const ScratchFolder folder;
    const Input input =
        read_model_file(folder.write("box.step", box_text(GetParam().declaration)), kVertices);
    EXPECT_EQ(input.unit, GetParam().name);
    EXPECT_TRUE(same_points(input.points.positions, box_corners({0, 0, 0}, {2, 3, 4}), 1e-12));
}

INSTANTIATE_TEST_SUITE_P(
    ReadModel, DeclaredUnit,
    testing::Values(Unit{"mm", "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );"},
                    Unit{"cm", "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.CENTI.,.METRE.) );"},
                    Unit{"m", "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.) );"},
                    Unit{"km", "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.KILO.,.METRE.) );"},
                    Unit{"um", "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MICRO.,.METRE.) );"},
                    Unit{"inch", by_conversion("25.4")}, Unit{"mil", by_conversion("0.0254")},
                    Unit{"ft", by_conversion("304.8")}),
    [](const auto& suite) { return suite.param.name; });

// Oracle: arithmetic. A unit without a name of its own is converted to millimetres.
TEST(ReadModel, AnUnknownUnitIsConvertedToMillimetres) {
    const ScratchFolder folder;
    const Input input = read_model_file(folder.write("box.step", box_text(by_conversion("7."))), kVertices);
    EXPECT_EQ(input.unit, "mm");
    EXPECT_TRUE(same_points(input.points.positions, box_corners({0, 0, 0}, {14, 21, 28}), 1e-9));
}

// Oracle: arithmetic. Of two parts one is in metres; lengths of the whole can only be in one unit.
TEST(ReadModel, MixedUnitsAreConvertedToMillimetres) {
    const TopoDS_Shape far_box = make_box({1, 1, 1});
    std::string text =
        step_text(compound({make_box({2, 3, 4}), far_box.Located(TopLoc_Location(shift(0, 0, 500)))}));
    const std::size_t last = text.rfind("SI_UNIT(.MILLI.,.METRE.)");
    ASSERT_NE(last, text.find("SI_UNIT(.MILLI.,.METRE.)"));
    text.replace(last, std::string("SI_UNIT(.MILLI.,.METRE.)").size(), "SI_UNIT($,.METRE.)");
    const ScratchFolder folder;
    const Input input = read_model_file(folder.write("mixed.step", text), kVertices);
    EXPECT_EQ(input.unit, "mm");
    std::vector<Point> expected = box_corners({0, 0, 0}, {2, 3, 4});
    for (const Point& p : box_corners({0, 0, 500}, {1000, 1000, 1500})) expected.push_back(p);
    EXPECT_TRUE(same_points(input.points.positions, expected, 1e-6));
}

// ---- What cannot be read ----

TEST(ReadModelErrors, NoSuchFile) {
    const ScratchFolder folder;
    const Error error = error_of(folder.path("nothing.step"));
    EXPECT_EQ(error.code(), ErrorCode::cannot_read);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("nothing.step"), HasSubstr("No such file")));
}

TEST(ReadModelErrors, Directory) {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder.path("folder.step"));
    const Error error = error_of(folder.path("folder.step"));
    EXPECT_EQ(error.code(), ErrorCode::cannot_read);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("folder.step"), HasSubstr("directory")));
}

// Root may read everything, so root becomes nobody for the time of the reading.
TEST(ReadModelErrors, NoPermission) {
    const ScratchFolder folder;
    const std::string path = folder.write("secret.step", step_text(make_box({1, 1, 1})));
    ASSERT_EQ(chmod(path.c_str(), 0), 0);
    const uid_t user = geteuid();
    if (user == 0) {
        std::filesystem::permissions(std::filesystem::path(path).parent_path(), std::filesystem::perms::all);
        ASSERT_EQ(seteuid(65534), 0);
    }
    const Error error = error_of(path);
    ASSERT_EQ(seteuid(user), 0);
    EXPECT_EQ(error.code(), ErrorCode::cannot_read);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("secret.step"), HasSubstr("Permission denied")));
}

// A file whose reading fails after it was opened.
TEST(ReadModelErrors, ReadingFails) {
    if (!std::filesystem::exists("/proc/self/mem")) GTEST_SKIP() << "no /proc";
    const Error error = error_of("/proc/self/mem");
    EXPECT_EQ(error.code(), ErrorCode::cannot_read);
    EXPECT_THAT(error.what(), HasSubstr("/proc/self/mem: reading failed"));
}

TEST(ReadModelErrors, Empty) {
    const ScratchFolder folder;
    const Error error = error_of(folder.write("empty.step", ""));
    EXPECT_EQ(error.code(), ErrorCode::cannot_read);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("empty.step"), HasSubstr("is empty")));
}

TEST(ReadModelErrors, OtherText) {
    const ScratchFolder folder;
    const Error error = error_of(folder.write("letter.step", "Dear Sir,\nplease find enclosed 1 2 3\n"));
    EXPECT_EQ(error.code(), ErrorCode::cannot_read);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("letter.step"), HasSubstr("not a STEP file")));
}

TEST(ReadModelErrors, BinaryData) {
    const ScratchFolder folder;
    std::string bytes(100000, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7919 % 251);
    EXPECT_EQ(error_of(folder.write("image.stp", bytes)).code(), ErrorCode::cannot_read);
}

// Oracle: what is cut off is missing. Whatever the place of the cut, none of the file is taken.
TEST(ReadModelErrors, CutAnywhere) {
    const std::string whole = step_text(make_box({2, 3, 4}));
    const std::size_t end = whole.rfind("END-ISO-10303-21;") + std::string("END-ISO-10303-21;").size();
    const ScratchFolder folder;
    std::vector<std::size_t> sizes = {1, 12, 13, 14, end - 1, end - 2, end - 17, end - 18, end - 25};
    for (std::size_t size = 100; size < end; size += 101) sizes.push_back(size);
    for (const std::size_t size : sizes) {
        const Error error = error_of(folder.write("cut.step", whole.substr(0, size)));
        EXPECT_EQ(error.code(), ErrorCode::cannot_read) << "cut to " << size << " bytes";
        EXPECT_THAT(error.what(), AllOf(HasSubstr("cut.step"), Not(HasSubstr("\n"))));
    }
    EXPECT_EQ(read_model_file(folder.write("cut.step", whole.substr(0, end)), kVertices).points.size(), 8U);
}

// Oracle: the whole. With an entity of a part lost, the part is refused or still has all its vertices: never
// some of them. (Only what nothing refers to can be missed, such as the category of the product.)
TEST(ReadModelErrors, AnEntityLost) {
    const std::string whole = step_text(make_box({2, 3, 4}));
    const std::size_t end = whole.rfind("ENDSEC;");
    const ScratchFolder folder;
    int refused = 0;
    int accepted = 0;
    std::size_t start = whole.find("DATA;") + 5;
    for (int i = 0; start < end; ++i) {
        const std::size_t stop = whole.find(';', start) + 1;
        if (i % 3 == 0) {  // a third of them, to save time
            const std::string path = folder.write("lost.step", whole.substr(0, start) + whole.substr(stop));
            try {
                EXPECT_EQ(read_model_file(path, kVertices).points.size(), 8U)
                    << whole.substr(start, stop - start);
                ++accepted;
            } catch (const Error&) {
                ++refused;
            }
        }
        start = stop;
    }
    EXPECT_GT(refused, 20 * accepted);
}

// Oracle: the syntax of STEP. The message names the line (Open CASCADE 7.6 the one after it).
TEST(ReadModelErrors, FaultOfSyntax) {
    const std::string text = step_text(make_box({2, 3, 4}));
    const std::size_t middle = text.find("\n#100 ");
    ASSERT_NE(middle, std::string::npos);
    const auto line =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(middle) + 1, '\n') + 1;
    const ScratchFolder folder;
    const Error error =
        error_of(folder.write("typo.step", text.substr(0, middle) + "\n)( ;" + text.substr(middle + 1)));
    EXPECT_EQ(error.code(), ErrorCode::cannot_read);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("typo.step"), HasSubstr("damaged"),
                                    AnyOf(HasSubstr("near line " + std::to_string(line) + ":"),
                                          HasSubstr("near line " + std::to_string(line + 1) + ":"))));
}

// Each is a file that Open CASCADE 7.6 parses and then follows to a null pointer or an infinite place.
TEST(ReadModelErrors, FaultOfGeometry) {
    const std::string text = step_text(make_box({2, 3, 4}));
    const ScratchFolder folder;
    const auto damaged = [&](std::string_view from, std::string_view to) {
        const Error error = error_of(folder.write("bad.step", replaced(text, from, to)));
        EXPECT_EQ(error.code(), ErrorCode::cannot_read) << to;
        EXPECT_THAT(error.what(), HasSubstr("damaged")) << to;
    };
    damaged("CARTESIAN_POINT('',(2.,3.,4.))", "CARTESIAN_POINT('',(2.,3.))");
    damaged("CARTESIAN_POINT('',(2.,3.,4.))", "CARTESIAN_POINT('',(2.,3.,1.E999))");
    damaged("CARTESIAN_POINT('',(2.,3.,4.))", "CARTESIAN_POINT('',$)");
    damaged("CARTESIAN_POINT('',(2.,3.,4.))", "DIRECTION('',(1.,0.,0.))");
    damaged("DIRECTION('',(0.,0.,1.))", "CARTESIAN_POINT('',(0.,0.,1.))");
    damaged("VERTEX_POINT('',#", "VERTEX_POINT('',#9");
}

TEST(ReadModelErrors, NoGeometry) {
    const std::string text = step_text(make_box({2, 3, 4}));
    const std::string header = text.substr(0, text.find("DATA;") + 5);
    const std::string tail = "\nENDSEC;\nEND-ISO-10303-21;\n";
    const ScratchFolder folder;
    for (const std::string data : {"", "\n#1 = CARTESIAN_POINT('',(1.,2.,3.));"}) {
        const Error error = error_of(folder.write("nothing.step", header + data + tail));
        EXPECT_EQ(error.code(), ErrorCode::invalid_input);
        EXPECT_THAT(error.what(), AllOf(HasSubstr("nothing.step"), HasSubstr("no geometry")));
    }
}

// ---- Manners ----

// Oracle: what the process writes to its two streams. Open CASCADE itself does print on such files.
TEST(ReadModelManners, NothingIsPrinted) {
    const std::string text = step_text(make_box({2, 3, 4}));
    const ScratchFolder folder;
    const std::string good = folder.write("good.step", text);
    const std::string bad =
        folder.write("bad.step", replaced(text, "VERTEX_POINT('',#", "VERTEX_POINT('',,#"));
    const auto printed = [](const auto& read) {
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        read();
        const std::string out = testing::internal::GetCapturedStdout();
        return out + testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(printed([&] { read_model_file(good, kVertices); }), "");
    EXPECT_EQ(printed([&] { error_of(bad); }), "");
    EXPECT_NE(printed([&] { STEPControl_Reader().ReadFile(bad.c_str()); }), "");  // its printers are back
}

// Oracle: the same file read before. A program that uses Open CASCADE itself may have set other units.
TEST(ReadModelManners, SettingsOfTheProgramDoNotMatter) {
    const ScratchFolder folder;
    const std::string path = folder.write("box.step", box_text(by_conversion("25.4")));
    Interface_Static::SetCVal("xstep.cascade.unit", "M");
    STEPControl_Reader other;
    ASSERT_EQ(other.ReadFile(path.c_str()), IFSelect_RetDone);
    other.TransferRoots();
    const Input input = read_model_file(path, kVertices);
    EXPECT_STREQ(Interface_Static::CVal("xstep.cascade.unit"), "M");
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    EXPECT_EQ(input.unit, "inch");
    EXPECT_TRUE(same_points(input.points.positions, box_corners({0, 0, 0}, {2, 3, 4}), 1e-9));
}

// Oracle: the same files read one after another.
TEST(ReadModelManners, CallsMayOverlap) {
    const ScratchFolder folder;
    const std::string good = folder.write("good.step", step_text(make_box({2, 3, 4})));
    const std::string bad = folder.write("bad.step", "ISO-10303-21;");
    std::vector<std::thread> threads;
    std::array<int, 4> right{};
    for (int& count : right)
        threads.emplace_back([&] {
            for (int i = 0; i < 10; ++i) {
                count += read_model_file(good, kVertices).points.size() == 8 ? 1 : 0;
                try {
                    read_model_file(bad);
                } catch (const Error&) {
                    ++count;
                }
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_THAT(right, testing::Each(20));
}

TEST(ReadModelManners, PathsMayHoldAnyCharacter) {
    const ScratchFolder folder;
    const std::string path =
        folder.write("Teil \xC3\xA4\xC3\xB6 'x' #1.step", step_text(make_box({2, 3, 4})));
    EXPECT_EQ(read_model_file(path, kVertices).points.size(), 8U);
}

TEST(IsModelPath, KnowsTheEndings) {
    for (const char* path : {"a.step", "a.stp", "A.STEP", "dir.x/a.Stp", "a.b.step", "a.p21", "a.iges",
                             "a.IGS", "a.brep", "a.brp", "a.bbrep"})
        EXPECT_TRUE(is_model_path(path)) << path;
    for (const char* path : {"", "-", "step", ".step/a", "a.xyz", "a.step.txt", "a.stpz", "a.", "dir.step/a"})
        EXPECT_FALSE(is_model_path(path)) << path;
}

}  // namespace
}  // namespace insym
