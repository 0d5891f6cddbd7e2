#include "brep/tessellate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Poly_Polygon3D.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Trsf.hxx>

namespace insym {
namespace {

constexpr double kDeflectionShare = 1e-3;  ///< of the diagonal: distance of a triangle from its face
constexpr double kDeflectionAngle = 0.26;  ///< radians: a circle has at least 24 sides

class Tessellator {
public:
    explicit Tessellator(const ModelShape& model) : unit_(model.unit.millimetres), shape_(model.shape) {}

    Tessellation run() {
        Bnd_Box box;
        BRepBndLib::AddClose(shape_, box);
        if (box.IsVoid() || box.IsOpen()) return {};
        const double diagonal = std::sqrt(box.SquareExtent());
        if (!(diagonal > 0) || !std::isfinite(diagonal)) return {};
        const BRepMesh_IncrementalMesh mesher(shape_, kDeflectionShare * diagonal, Standard_False,
                                              kDeflectionAngle);
        TopTools_IndexedMapOfShape faces, edges;
        TopExp::MapShapes(shape_, TopAbs_FACE, faces);
        TopExp::MapShapes(shape_, TopAbs_EDGE, edges);
        TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;
        TopExp::MapShapesAndAncestors(shape_, TopAbs_EDGE, TopAbs_FACE, faces_of_edge);
        for (int i = 1; i <= faces.Extent(); ++i) append_face(TopoDS::Face(faces(i)), i);
        for (int i = 1; i <= edges.Extent(); ++i)
            if (!is_seam(TopoDS::Edge(edges(i)), faces_of_edge)) append_edge(TopoDS::Edge(edges(i)), i);
        return std::move(result_);
    }

private:
    static bool is_seam(const TopoDS_Edge& edge, const TopTools_IndexedDataMapOfShapeListOfShape& faces) {
        if (BRep_Tool::Degenerated(edge)) return true;
        if (!faces.Contains(edge)) return false;
        const TopTools_ListOfShape& around = faces.FindFromKey(edge);
        return std::any_of(around.begin(), around.end(), [&](const TopoDS_Shape& face) {
            return BRep_Tool::IsClosed(edge, TopoDS::Face(face));
        });
    }

    int append_vertex(const gp_Pnt& node, const gp_Trsf& place) {
        const gp_Pnt p = node.Transformed(place);
        result_.vertices.push_back({p.X() / unit_, p.Y() / unit_, p.Z() / unit_});
        return static_cast<int>(result_.vertices.size()) - 1;
    }

    bool last_is_finite(std::size_t first) const {
        return std::all_of(
            result_.vertices.begin() + static_cast<std::ptrdiff_t>(first), result_.vertices.end(),
            [](const Point& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); });
    }

    void append_face(const TopoDS_Face& face, std::int64_t id) {
        TopLoc_Location location;
        const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
        if (mesh.IsNull()) return;
        const gp_Trsf& place = location.Transformation();
        const std::size_t first = result_.vertices.size();
        for (int i = 1; i <= mesh->NbNodes(); ++i) append_vertex(mesh->Node(i), place);
        if (!last_is_finite(first)) {
            result_.vertices.resize(first);
            return;
        }
        // A placement that mirrors turns the triangles over as well.
        const bool turned = (face.Orientation() == TopAbs_REVERSED) != place.IsNegative();
        for (int i = 1; i <= mesh->NbTriangles(); ++i) {
            std::array<int, 3> corners{};
            mesh->Triangle(i).Get(corners[0], corners[1], corners[2]);
            for (int& corner : corners) corner += static_cast<int>(first) - 1;
            if (turned) std::swap(corners[1], corners[2]);
            result_.triangles.push_back(corners);
            result_.faces.push_back(id);
        }
    }

    void append_edge(const TopoDS_Edge& edge, std::int64_t id) {
        Tessellation::Line line;
        line.edge = id;
        const std::size_t first = result_.vertices.size();
        TopLoc_Location location;
        Handle(Poly_PolygonOnTriangulation) polygon;
        Handle(Poly_Triangulation) mesh;
        BRep_Tool::PolygonOnTriangulation(edge, polygon, mesh, location);
        if (!polygon.IsNull() && !mesh.IsNull()) {
            for (int i = 1; i <= polygon->NbNodes(); ++i)
                line.vertices.push_back(
                    append_vertex(mesh->Node(polygon->Node(i)), location.Transformation()));
        } else if (const Handle(Poly_Polygon3D) free = BRep_Tool::Polygon3D(edge, location); !free.IsNull()) {
            for (int i = 1; i <= free->NbNodes(); ++i)
                line.vertices.push_back(append_vertex(free->Nodes()(i), location.Transformation()));
        }
        if (line.vertices.size() > 1 && last_is_finite(first))
            result_.lines.push_back(std::move(line));
        else
            result_.vertices.resize(first);
    }

    double unit_;
    TopoDS_Shape shape_;
    Tessellation result_;
};

}  // namespace

Tessellation tessellate(const ModelShape& model) {
    return model.shape.IsNull() ? Tessellation{} : Tessellator(model).run();
}

}  // namespace insym
