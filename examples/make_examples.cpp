// Makes the example models of this folder with Open CASCADE: insym_make_examples FOLDER.
//
// The symmetry of each part is meant to be seen in its vertices. A round hole has vertices only where its
// seam is, so holes are made by turning one tool about the axis of the pattern: their seams turn with them.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GProp_GProps.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_StepModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pln.hxx>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>

namespace {

using Shapes = std::vector<TopoDS_Shape>;
using Points = std::vector<gp_Pnt>;

const gp_Ax1 kZAxis(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));

double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

// ---- Solids ----

TopoDS_Shape box(const gp_Pnt& low, const gp_Pnt& high) {
    return BRepPrimAPI_MakeBox(low, high).Shape();
}

/// Upright; its seam looks along x.
TopoDS_Shape cylinder(const gp_Pnt& base, double radius, double height) {
    return BRepPrimAPI_MakeCylinder(gp_Ax2(base, gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)), radius, height).Shape();
}

TopoDS_Wire polygon(const Points& corners) {
    BRepBuilderAPI_MakePolygon wire;
    for (const gp_Pnt& corner : corners) wire.Add(corner);
    wire.Close();
    return wire.Wire();
}

TopoDS_Shape prism(const TopoDS_Wire& outline, const gp_Vec& along) {
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline).Face(), along).Shape();
}

/// The solid with these flat faces: indices into `corners`, anticlockwise as seen from outside.
TopoDS_Shape polyhedron(const Points& corners, const std::vector<std::vector<std::size_t>>& faces) {
    const BRep_Builder builder;
    std::vector<TopoDS_Vertex> vertices(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) builder.MakeVertex(vertices[i], corners[i], 1e-7);
    std::map<std::pair<std::size_t, std::size_t>, TopoDS_Edge> edges;  // each is shared by two faces
    TopoDS_Shell shell;
    builder.MakeShell(shell);
    for (const auto& face : faces) {
        BRepBuilderAPI_MakeWire wire;
        for (std::size_t k = 0; k < face.size(); ++k) {
            const std::size_t from = face[k];
            const std::size_t to = face[(k + 1) % face.size()];
            TopoDS_Edge& edge = edges[std::minmax(from, to)];
            if (edge.IsNull()) edge = BRepBuilderAPI_MakeEdge(vertices[from], vertices[to]).Edge();
            wire.Add(edge);
        }
        const gp_Vec normal =
            gp_Vec(corners[face[0]], corners[face[1]]) ^ gp_Vec(corners[face[0]], corners[face[2]]);
        builder.Add(shell, BRepBuilderAPI_MakeFace(gp_Pln(corners[face[0]], normal), wire.Wire()).Face());
    }
    shell.Closed(true);
    TopoDS_Solid solid;
    builder.MakeSolid(solid);
    builder.Add(solid, shell);
    return solid;
}

TopoDS_Shape moved(const TopoDS_Shape& shape, const gp_Trsf& by) {
    return BRepBuilderAPI_Transform(shape, by, true).Shape();
}

gp_Trsf turn(double degrees, double lift = 0) {
    gp_Trsf rotation;
    rotation.SetRotation(kZAxis, radians(degrees));
    rotation.SetTranslationPart(gp_Vec(0, 0, lift));
    return rotation;
}

gp_Trsf shift(double x, double y, double z) {
    gp_Trsf translation;
    translation.SetTranslation(gp_Vec(x, y, z));
    return translation;
}

template <typename Operation>
TopoDS_Shape combine(const TopoDS_Shape& body, const Shapes& tools) {
    TopTools_ListOfShape arguments;
    arguments.Append(body);
    TopTools_ListOfShape others;
    for (const TopoDS_Shape& tool : tools) others.Append(tool);
    Operation operation;
    operation.SetArguments(arguments);
    operation.SetTools(others);
    operation.Build();
    if (!operation.IsDone()) throw std::runtime_error("a boolean operation failed");
    operation.SimplifyResult(true, true);  // faces that lie in one plane become one
    return operation.Shape();
}

TopoDS_Shape cut(const TopoDS_Shape& body, const Shapes& tools) {
    return combine<BRepAlgoAPI_Cut>(body, tools);
}

TopoDS_Shape fuse(const TopoDS_Shape& body, const Shapes& tools) {
    return combine<BRepAlgoAPI_Fuse>(body, tools);
}

// ---- Parts: dimensions in README.md ----

TopoDS_Shape make_flange() {
    const Points profile = {{25, 0, 0}, {80, 0, 0}, {80, 0, 18}, {42, 0, 18}, {33, 0, 50}, {25, 0, 50}};
    const TopoDS_Shape body =
        BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(polygon(profile)).Face(), kZAxis).Shape();
    const gp_Pnt first(62.5, 0, -1);
    Shapes tools;
    for (int k = 1; k < 8; ++k) {  // slot 0 of the bolt circle stays empty
        tools.push_back(moved(cylinder(first, 7, 30), turn(45.0 * k)));
        tools.push_back(moved(cylinder({62.5, 0, 16}, 13, 10), turn(45.0 * k)));
    }
    return cut(body, tools);
}

/// A slot with round ends, along x about the origin.
TopoDS_Wire slot_outline(double length, double width) {
    const double x = (length - width) / 2;
    const double r = width / 2;
    const std::array<gp_Pnt, 4> p = {gp_Pnt(-x, -r, 0), {x, -r, 0}, {x, r, 0}, {-x, r, 0}};
    BRepBuilderAPI_MakeWire wire;
    wire.Add(BRepBuilderAPI_MakeEdge(p[0], p[1]).Edge());
    wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(p[1], gp_Pnt(x + r, 0, 0), p[2]).Value()).Edge());
    wire.Add(BRepBuilderAPI_MakeEdge(p[2], p[3]).Edge());
    wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(p[3], gp_Pnt(-x - r, 0, 0), p[0]).Value()).Edge());
    return wire.Wire();
}

TopoDS_Shape make_slotted_plate() {
    const Points outline = {{-96, -30, 0}, {96, -30, 0}, {100, -26, 0}, {100, 26, 0},
                            {96, 30, 0},   {-96, 30, 0}, {-100, 26, 0}, {-100, -26, 0}};
    const TopoDS_Shape slot = prism(slot_outline(12, 5), gp_Vec(0, 0, 5));
    Shapes tools;
    for (int k = 0; k < 11; ++k) {
        tools.push_back(moved(slot, shift(16.0 * (k - 5), 15, 0)));
        if (k != 3) tools.push_back(moved(slot, shift(16.0 * (k - 5), -15, 0)));
    }
    return cut(prism(polygon(outline), gp_Vec(0, 0, 5)), tools);
}

/// A square pin on the plane z = 0 with a tapered tip.
TopoDS_Shape make_pin(double width, double height, double taper) {
    Points corners;
    for (const auto& [half, z] :
         {std::pair(width / 2, 0.0), std::pair(width / 2, height - taper), std::pair(width / 4, height)})
        for (const auto& [x, y] : {std::pair(-half, -half), {half, -half}, {half, half}, {-half, half}})
            corners.emplace_back(x, y, z);
    std::vector<std::vector<std::size_t>> faces = {{3, 2, 1, 0}, {8, 9, 10, 11}};
    for (const std::size_t layer : {0U, 4U})
        for (std::size_t k = 0; k < 4; ++k)
            faces.push_back({layer + k, layer + (k + 1) % 4, layer + (k + 1) % 4 + 4, layer + k + 4});
    return polyhedron(corners, faces);
}

/// The D of a D-sub connector: a trapezium about the pins, its long side up.
TopoDS_Wire d_outline(double margin, double z) {
    return polygon({{-11.2 - margin, -3.2 - margin, z},
                    {11.2 + margin, -3.2 - margin, z},
                    {12.4 + margin, 3.2 + margin, z},
                    {-12.4 - margin, 3.2 + margin, z}});
}

TopoDS_Shape make_staggered_connector() {
    const double pitch = 2.77;
    const TopoDS_Shape hood =
        cut(prism(d_outline(0.5, 0), gp_Vec(0, 0, 6)), {prism(d_outline(0, 1), gp_Vec(0, 0, 6))});
    const TopoDS_Shape screw_hole = cylinder({0, 0, -2}, 1.6, 4);
    const TopoDS_Shape ear =
        cut(box({-19.6, -6.2, -1}, {19.6, 6.2, 0}),
            {moved(screw_hole, shift(-16.65, 0, 0)), moved(screw_hole, shift(16.65, 0, 0))});
    Shapes parts = {hood};
    const TopoDS_Shape pin = make_pin(1, 5, 0.6);
    for (int k = 0; k < 8; ++k) parts.push_back(moved(pin, shift(pitch * (k - 3.5), 1.42, 1)));
    for (int k = 0; k < 7; ++k) parts.push_back(moved(pin, shift(pitch * (k - 3), -1.42, 1)));
    return fuse(ear, parts);
}

/// An assembly: one tread and one post, each placed fifteen times, about a column.
TopoDS_Shape make_spiral_stair() {
    const TopoDS_Shape tread =
        prism(polygon({{60, -25, 160}, {900, -210, 160}, {900, 210, 160}, {60, 25, 160}}), gp_Vec(0, 0, 40));
    const TopoDS_Shape post = box({850, 160, 200}, {880, 190, 1100});
    const BRep_Builder builder;
    TopoDS_Compound stair;
    builder.MakeCompound(stair);
    builder.Add(stair, cylinder({0, 0, 0}, 60, 4000));
    for (int k = 0; k < 15; ++k) {
        const TopLoc_Location place(turn(24.0 * k, 190.0 * k));
        builder.Add(stair, tread.Located(place));
        builder.Add(stair, post.Located(place));
    }
    return stair;
}

TopoDS_Shape make_antiprism() {
    const double radius = 30;
    const double half_height = 18;
    Points corners;
    for (int k = 0; k < 8; ++k)  // even corners up, odd ones down
        corners.emplace_back(radius * std::cos(radians(45.0 * k)), radius * std::sin(radians(45.0 * k)),
                             k % 2 == 0 ? half_height : -half_height);
    std::vector<std::vector<std::size_t>> faces = {{0, 2, 4, 6}, {7, 5, 3, 1}};
    for (std::size_t k = 0; k < 8; ++k) {
        if (k % 2 == 0)
            faces.push_back({k, (k + 1) % 8, (k + 2) % 8});
        else
            faces.push_back({(k + 2) % 8, (k + 1) % 8, k});
    }
    const TopoDS_Shape body = polyhedron(corners, faces);

    Points bore;
    for (int k = 0; k < 8; ++k)
        bore.emplace_back(12 * std::cos(radians(45 * k + 22.5)), 12 * std::sin(radians(45 * k + 22.5)),
                          -half_height);
    Shapes tools = {prism(polygon(bore), gp_Vec(0, 0, 2 * half_height))};
    gp_Trsf mirror;
    mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)));
    // A pocket in the face of corners 0, 1 and 2, to one side of that face's own mirror plane (at 45
    // degrees).
    TopoDS_Shape pocket = moved(box({17, 1, 2}, {40, 9, 10}), turn(45));
    for (int k = 0; k < 8; ++k) {
        tools.push_back(pocket);
        pocket = moved(pocket, turn(45) * mirror);
    }
    return cut(body, tools);
}

TopoDS_Shape make_bracket() {
    const TopoDS_Shape base =
        prism(polygon({{-40, 0, 0}, {40, 0, 0}, {40, 40, 0}, {30, 50, 0}, {-30, 50, 0}, {-40, 40, 0}}),
              gp_Vec(0, 0, 6));
    const TopoDS_Shape wall =
        prism(polygon({{-40, 0, 6}, {40, 0, 6}, {40, 0, 50}, {30, 0, 60}, {-30, 0, 60}, {-40, 0, 50}}),
              gp_Vec(0, 6, 0));
    const TopoDS_Shape rib = prism(polygon({{0, 6, 6}, {0, 36, 6}, {0, 6, 44}}), gp_Vec(5, 0, 0));
    const TopoDS_Shape base_window = box({-8, 20, 0}, {8, 28, 6});
    const TopoDS_Shape wall_window = box({-6, 0, 30}, {6, 6, 44});
    const TopoDS_Shape body = fuse(base, {wall, moved(rib, shift(-16, 0, 0)), moved(rib, shift(11, 0, 0))});
    return cut(body, {moved(base_window, shift(-26, 0, 0)), moved(base_window, shift(26, 0, 0)),
                      moved(wall_window, shift(-27, 0, 0)), moved(wall_window, shift(27, 0, 0)),
                      box({35, 12, 0}, {40, 18, 6})});
}

// ---- The approximate copy ----

double diameter(const Points& points) {
    double longest = 0;
    for (const gp_Pnt& p : points)
        for (const gp_Pnt& q : points) longest = std::max(longest, p.Distance(q));
    return longest;
}

/// Uniform in the ball of that radius; the same on every machine, unlike the standard distributions.
gp_Vec random_offset(std::mt19937& random, double radius) {
    const auto next = [&random] { return std::ldexp(static_cast<double>(random()), -31) - 1; };
    for (;;) {
        const double x = next();
        const double y = next();
        const double z = next();
        if (x * x + y * y + z * z <= 1) return radius * gp_Vec(x, y, z);
    }
}

/// The solid with all faces cut into triangles and every vertex moved by up to `share` of the diameter, as
/// a scan and a reconstruction would leave it. Only for solids with flat faces.
TopoDS_Shape make_approximate(const TopoDS_Shape& exact, double share) {
    const BRepMesh_IncrementalMesh mesher(exact, 1.0);  // leaves the triangles in the shape
    TopTools_IndexedMapOfShape vertices;
    TopExp::MapShapes(exact, TopAbs_VERTEX, vertices);
    Points corners;
    for (int i = 1; i <= vertices.Extent(); ++i)
        corners.push_back(BRep_Tool::Pnt(TopoDS::Vertex(vertices(i))));
    const auto corner_at = [&corners](const gp_Pnt& p) {
        for (std::size_t i = 0; i < corners.size(); ++i)
            if (corners[i].Distance(p) < 1e-6) return i;
        throw std::runtime_error("a triangle has a corner that is no vertex");
    };

    std::vector<std::vector<std::size_t>> triangles;
    for (TopExp_Explorer it(exact, TopAbs_FACE); it.More(); it.Next()) {
        TopLoc_Location place;
        const auto mesh = BRep_Tool::Triangulation(TopoDS::Face(it.Current()), place);
        for (int t = 1; t <= mesh->NbTriangles(); ++t) {
            std::array<int, 3> nodes{};
            mesh->Triangle(t).Get(nodes[0], nodes[1], nodes[2]);
            std::vector<std::size_t> triangle(3);
            for (std::size_t k = 0; k < 3; ++k)
                triangle[k] = corner_at(mesh->Node(nodes[k]).Transformed(place));
            if (it.Current().Orientation() == TopAbs_REVERSED) std::swap(triangle[1], triangle[2]);
            triangles.push_back(triangle);
        }
    }

    std::mt19937 random(2007);
    const double radius = share * diameter(corners);
    for (gp_Pnt& corner : corners) corner.Translate(random_offset(random, radius));
    return polyhedron(corners, triangles);
}

// ---- Files ----

Handle(TCollection_HAsciiString) text(const std::string& string) {
    return new TCollection_HAsciiString(string.c_str());
}

/// Open CASCADE numbers products through the life of the program; named so, each file stands for itself.
void name_products(const StepData_StepModel& model, const std::string& name) {
    int part = 0;
    for (int i = 1; i <= model.NbEntities(); ++i) {
        const auto product = Handle(StepBasic_Product)::DownCast(model.Value(i));
        if (product.IsNull()) continue;
        const auto label = text(part == 0 ? name : name + " part " + std::to_string(part));
        product->SetId(label);
        product->SetName(label);
        ++part;
    }
}

/// The same shape gives the same bytes: no date, no count.
void write_step(const TopoDS_Shape& shape, const std::string& name, const std::filesystem::path& file) {
    GProp_GProps volume;
    BRepGProp::VolumeProperties(shape, volume);
    if (!BRepCheck_Analyzer(shape).IsValid() || volume.Mass() <= 0)
        throw std::runtime_error(name + " is not a valid solid");

    STEPControl_Writer writer;
    Interface_Static::SetIVal("write.surfacecurve.mode", 0);  // no curves in parameters: half the size
    if (writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone)
        throw std::runtime_error(name + " cannot be translated");
    name_products(*writer.Model(), name);
    APIHeaderSection_MakeHeader header(writer.Model());
    header.SetName(text(name));
    header.SetTimeStamp(text("2025-01-01T00:00:00"));
    header.SetAuthorValue(1, text("insym"));
    header.SetOrganizationValue(1, text("insym"));
    if (writer.Write(file.c_str()) != IFSelect_RetDone)
        throw std::runtime_error(file.string() + " cannot be written");
}

void make_all(const std::filesystem::path& folder) {
    const TopoDS_Shape bracket = make_bracket();
    const std::vector<std::pair<std::string, TopoDS_Shape>> parts = {
        {"flange", make_flange()},
        {"slotted_plate", make_slotted_plate()},
        {"staggered_connector", make_staggered_connector()},
        {"spiral_stair", make_spiral_stair()},
        {"antiprism", make_antiprism()},
        {"bracket", bracket},
        {"bracket_approximate", make_approximate(bracket, 0.001)},
    };
    for (const auto& [name, shape] : parts) {
        TopTools_IndexedMapOfShape vertices;
        TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
        const std::filesystem::path file = folder / (name + ".step");
        write_step(shape, name, file);
        std::cout << file.string() << ": " << vertices.Extent() << " vertices\n";
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: insym_make_examples FOLDER\n";
        return 2;
    }
    try {
        Message::DefaultMessenger()->ChangePrinters().Clear();
        make_all(argv[1]);
        return 0;
    } catch (const Standard_Failure& failure) {
        std::cerr << "insym_make_examples: " << failure.DynamicType()->Name() << ": "
                  << failure.GetMessageString() << "\n";
    } catch (const std::exception& failure) {
        std::cerr << "insym_make_examples: " << failure.what() << "\n";
    }
    return 1;
}
