// Oracle: the model itself. A mesh of a part, made by Open CASCADE with a deflection of 0.1 % of the
// diameter, has the same first symmetries as the part, to within the deflection.
#include "insym/detect.hpp"
#include "insym/read_mesh.hpp"
#include "insym/read_model.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <BRepMesh_IncrementalMesh.hxx>
#include <STEPControl_Reader.hxx>
#include <StlAPI_Writer.hxx>
#include <TopoDS_Shape.hxx>
#include <gtest/gtest.h>

#include "brep/step_files.hpp"

namespace insym {
namespace {

double distance(const Point& p, const Point& q) {
    return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

/// One isometry, or one and the inverse of the other, to that length on these points.
bool same(const Symmetry& a, const Symmetry& b, const std::vector<Point>& points, double length) {
    if (a.type != b.type) return false;
    double direct = 0, inverse = 0;
    for (const Point& p : points) {
        direct = std::max(direct, distance(a.isometry.apply(p), b.isometry.apply(p)));
        inverse = std::max(inverse, distance(a.isometry.apply(b.isometry.apply(p)), p));
    }
    return std::min(direct, inverse) <= length;
}

/// How many of the list are among its first `count`, those as significant as the last of them included.
std::size_t with_ties(const std::vector<Symmetry>& list, std::size_t count) {
    std::size_t end = std::min(count, list.size());
    while (end < list.size() && list[end].significance <= list[end - 1].significance + 1e-6) ++end;
    return end;
}

class MeshOfExample : public testing::TestWithParam<std::string> {};

TEST_P(MeshOfExample, HasTheFirstSymmetriesOfTheModel) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    // A thousand symmetries each; with a sanitizer these take minutes, and reach no other code.
    if (GetParam() == "slotted_plate" || GetParam() == "staggered_connector")
        GTEST_SKIP() << "too slow with a sanitizer";
#endif
    const std::string path = std::string(INSYM_SOURCE_DIR) + "/examples/" + GetParam() + ".step";
    const DetectResult model = detect(read_model_file(path).points);
    const double deflection = 1e-3 * model.diameter;

    STEPControl_Reader reader;
    ASSERT_EQ(reader.ReadFile(path.c_str()), IFSelect_RetDone);
    reader.TransferRoots();
    const TopoDS_Shape shape = reader.OneShape();
    const BRepMesh_IncrementalMesh mesher(shape, deflection);
    const test::ScratchFolder folder;
    ASSERT_TRUE(StlAPI_Writer().Write(shape, folder.path("mesh.stl").c_str()));
    const DetectResult mesh = detect(read_mesh_file(folder.path("mesh.stl")).points);

    ASSERT_GE(mesh.symmetries.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t end = with_ties(model.symmetries, 3);
        const Symmetry& s = mesh.symmetries[i];
        const bool found =
            std::any_of(model.symmetries.begin(), model.symmetries.begin() + static_cast<std::ptrdiff_t>(end),
                        [&](const Symmetry& m) { return same(m, s, model.points.positions, deflection); });
        EXPECT_TRUE(found) << "number " << i + 1 << ", type " << letter(s.type) << ", "
                           << s.isometry.angle_deg << " degrees, step " << s.isometry.step;
    }
}

INSTANTIATE_TEST_SUITE_P(Mesh, MeshOfExample,
                         testing::Values("flange", "slotted_plate", "staggered_connector", "spiral_stair",
                                         "antiprism", "bracket", "bracket_approximate"),
                         [](const auto& suite) { return suite.param; });

}  // namespace
}  // namespace insym
