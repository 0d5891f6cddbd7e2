#include "brep/representative_points.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include <BRepBndLib.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>

#include "brep/bodies.hpp"
#include "brep/curves.hpp"
#include "brep/surfaces.hpp"

namespace insym {
namespace {

/// What an edge or a vertex of a body stands for.
constexpr int kNothing = -1;

/// Open CASCADE's numbers of all vertices, edges and faces of the model.
struct ShapeMaps {
    TopTools_IndexedMapOfShape vertices, edges, faces;

    explicit ShapeMaps(const TopoDS_Shape& shape) {
        TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
        TopExp::MapShapes(shape, TopAbs_EDGE, edges);
        TopExp::MapShapes(shape, TopAbs_FACE, faces);
    }
};

/// Sets of items that were found to belong together.
class Groups {
public:
    explicit Groups(int size) : parent_(static_cast<std::size_t>(size)) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    /// The least item of the set.
    int find(int i) {
        int& parent = parent_[static_cast<std::size_t>(i)];
        return parent == i ? i : parent = find(parent);
    }
    void join(int i, int j) {
        const int a = find(i), b = find(j);
        parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }

private:
    std::vector<int> parent_;
};

/// The entities of one body. Its items are numbered from 1 here, as in its own maps.
class BodyEntities {
public:
    BodyEntities(const Body& body, const ShapeMaps& all, double tolerance)
        : body_(body), all_(all), tolerance_(tolerance), patch_(0) {
        TopExp::MapShapes(body.shape, TopAbs_FACE, faces_);
        TopExp::MapShapes(body.shape, TopAbs_EDGE, edges_);
        TopExp::MapShapesAndAncestors(body.shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edge_);
        TopExp::MapShapesAndAncestors(body.shape, TopAbs_VERTEX, TopAbs_EDGE, edges_of_vertex_);
        find_patches();
        find_curves();
    }

    void append_faces(std::vector<RepresentativePoint>& points);
    void append_edges(std::vector<RepresentativePoint>& points);
    /// All of them, or those that edges do not stand for.
    void append_vertices(bool all, std::vector<RepresentativePoint>& points) const;

private:
    void find_patches();
    void find_curves();
    void join_conics(const std::vector<int>& conics);
    bool is_seam(int edge);
    bool is_apex(const TopoDS_Shape& vertex) const;
    bool stands_for_itself(int vertex) const;
    void append(const gp_Pnt& position, Entity entity, std::vector<std::int64_t> ids,
                std::vector<RepresentativePoint>& points) const;

    const Body& body_;
    const ShapeMaps& all_;
    double tolerance_;
    TopTools_IndexedMapOfShape faces_, edges_;
    TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge_, edges_of_vertex_;
    std::vector<Surface> surfaces_;
    Groups patch_;            // of faces on one surface that adjoin
    std::vector<int> curve_;  // of each edge: the least edge of its circle, ellipse or itself, or kNothing
    std::map<int, Conic> conics_;
};

void BodyEntities::find_patches() {
    patch_ = Groups(faces_.Extent() + 1);
    for (int i = 1; i <= faces_.Extent(); ++i) surfaces_.emplace_back(TopoDS::Face(faces_(i)));
    for (int i = 1; i <= faces_of_edge_.Extent(); ++i) {
        const TopTools_ListOfShape& faces = faces_of_edge_(i);
        for (const TopoDS_Shape& face : faces) {
            const int a = faces_.FindIndex(faces.First()), b = faces_.FindIndex(face);
            const auto surface = [&](int k) { return surfaces_[static_cast<std::size_t>(k - 1)]; };
            if (a != b && surface(a).continues(surface(b), tolerance_)) patch_.join(a, b);
        }
    }
}

/// An edge inside of a patch: where a round face meets itself or its other half.
bool BodyEntities::is_seam(int edge) {
    const TopTools_ListOfShape& faces = faces_of_edge_.FindFromKey(edges_(edge));
    if (faces.Extent() < 2) return false;  // the ancestors of a seam hold its face twice
    const int first = patch_.find(faces_.FindIndex(faces.First()));
    return std::all_of(faces.begin(), faces.end(), [&](const TopoDS_Shape& face) {
        return patch_.find(faces_.FindIndex(face)) == first;
    });
}

void BodyEntities::find_curves() {
    curve_.assign(static_cast<std::size_t>(edges_.Extent()) + 1, kNothing);
    std::vector<int> conics;
    for (int i = 1; i <= edges_.Extent(); ++i) {
        const TopoDS_Edge& edge = TopoDS::Edge(edges_(i));
        double first = 0, last = 0;
        if (BRep_Tool::Degenerated(edge) || BRep_Tool::Curve(edge, first, last).IsNull() || is_seam(i))
            continue;
        curve_[static_cast<std::size_t>(i)] = i;
        if (is_conic(edge)) conics.push_back(i);
    }
    join_conics(conics);
}

/// Arcs of one curve have one centre, so only neighbours in the order of a coordinate of it need to be
/// compared; the coordinate is along a direction that patterns do not have.
void BodyEntities::join_conics(const std::vector<int>& conics) {
    const gp_XYZ direction = gp_XYZ(0.5346, 0.7023, 0.4699);
    std::vector<std::tuple<double, int, Conic>> order;
    for (const int i : conics) {
        const Conic conic(TopoDS::Edge(edges_(i)));
        order.emplace_back(conic.center().XYZ().Dot(direction), i, conic);
    }
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
        return std::tie(std::get<0>(a), std::get<1>(a)) < std::tie(std::get<0>(b), std::get<1>(b));
    });
    Groups groups(edges_.Extent() + 1);
    for (std::size_t a = 0; a < order.size(); ++a)
        for (std::size_t b = a + 1; b < order.size(); ++b) {
            if (std::get<0>(order[b]) - std::get<0>(order[a]) > tolerance_) break;
            if (std::get<2>(order[a]).same_curve(std::get<2>(order[b]), tolerance_))
                groups.join(std::get<1>(order[a]), std::get<1>(order[b]));
        }
    for (const auto& [place, i, conic] : order) {
        const int leader = groups.find(i);
        curve_[static_cast<std::size_t>(i)] = leader;
        const auto [found, added] = conics_.try_emplace(leader, conic);
        if (!added) found->second.absorb(conic);
    }
}

void BodyEntities::append(const gp_Pnt& position, Entity entity, std::vector<std::int64_t> ids,
                          std::vector<RepresentativePoint>& points) const {
    std::sort(ids.begin(), ids.end());
    entity.id = ids.front();
    if (ids.size() > 1) entity.ids = std::move(ids);
    entity.part = body_.part;
    points.push_back({position, std::move(entity)});
}

void BodyEntities::append_faces(std::vector<RepresentativePoint>& points) {
    std::map<int, std::vector<int>> patches;
    for (int i = 1; i <= faces_.Extent(); ++i) patches[patch_.find(i)].push_back(i);
    for (const auto& [leader, members] : patches) {
        std::vector<TopoDS_Face> faces;
        std::vector<std::int64_t> ids;
        for (const int i : members) {
            faces.push_back(TopoDS::Face(faces_(i)));
            ids.push_back(all_.faces.FindIndex(faces_(i)));
        }
        const auto [position, entity] =
            describe_patch(surfaces_[static_cast<std::size_t>(leader - 1)], faces, tolerance_);
        append(position, entity, ids, points);
    }
}

void BodyEntities::append_edges(std::vector<RepresentativePoint>& points) {
    std::map<int, std::vector<std::int64_t>> curves;
    for (int i = 1; i <= edges_.Extent(); ++i)
        if (const int leader = curve_[static_cast<std::size_t>(i)]; leader != kNothing)
            curves[leader].push_back(all_.edges.FindIndex(edges_(i)));
    for (const auto& [leader, ids] : curves) {
        if (const auto conic = conics_.find(leader); conic != conics_.end()) {
            append(conic->second.center(), conic->second.describe(), ids, points);
            continue;
        }
        const auto [position, entity] = describe_curve(TopoDS::Edge(edges_(leader)));
        if (std::isfinite(*entity.length)) append(position, entity, ids, points);
    }
}

/// A vertex where a face shrinks to a point, other than the poles of a sphere, which are nothing special.
bool BodyEntities::is_apex(const TopoDS_Shape& vertex) const {
    for (const TopoDS_Shape& edge : edges_of_vertex_.FindFromKey(vertex)) {
        if (!BRep_Tool::Degenerated(TopoDS::Edge(edge))) continue;
        for (const TopoDS_Shape& face : faces_of_edge_.FindFromKey(edge))
            if (surfaces_[static_cast<std::size_t>(faces_.FindIndex(face) - 1)].type != SurfaceType::sphere)
                return true;
    }
    return false;
}

/// Not so a vertex that only begins or divides one circle, ellipse or other closed curve, or a seam.
bool BodyEntities::stands_for_itself(int vertex) const {
    const TopoDS_Shape& shape = edges_of_vertex_.FindKey(vertex);
    const TopTools_ListOfShape& edges = edges_of_vertex_(vertex);
    if (edges.IsEmpty()) return true;
    std::optional<int> only;
    for (const TopoDS_Shape& edge : edges) {
        const int curve = curve_[static_cast<std::size_t>(edges_.FindIndex(edge))];
        if (curve == kNothing) continue;
        if (only && *only != curve) return true;
        only = curve;
    }
    if (!only) return is_apex(shape);
    TopoDS_Vertex first, last;
    TopExp::Vertices(TopoDS::Edge(edges_(*only)), first, last);
    return !conics_.contains(*only) && !first.IsSame(last);
}

void BodyEntities::append_vertices(bool all, std::vector<RepresentativePoint>& points) const {
    for (int i = 1; i <= edges_of_vertex_.Extent(); ++i) {
        if (!all && !stands_for_itself(i)) continue;
        Entity entity;
        entity.kind = EntityKind::vertex;
        entity.geometry = "point";
        const TopoDS_Vertex& vertex = TopoDS::Vertex(edges_of_vertex_.FindKey(i));
        append(BRep_Tool::Pnt(vertex), entity, {all_.vertices.FindIndex(vertex)}, points);
    }
}

/// Lengths up to which two curves or surfaces are one: files give about six digits after the point.
double model_tolerance(const TopoDS_Shape& shape) {
    Bnd_Box box;
    BRepBndLib::AddClose(shape, box);
    return box.IsVoid() || box.IsOpen() ? 1e-6 : std::max(1e-6, 1e-6 * std::sqrt(box.SquareExtent()));
}

}  // namespace

std::vector<RepresentativePoint> representative_points(const ModelShape& model,
                                                       const ReadModelOptions& options) {
    const ShapeMaps all(model.shape);
    const double tolerance = model_tolerance(model.shape);
    std::vector<RepresentativePoint> points;
    for (const Body& body : find_bodies(model)) {
        BodyEntities entities(body, all, tolerance);
        if (options.vertices) entities.append_vertices(!options.edges, points);
        if (options.edges) entities.append_edges(points);
        if (options.faces) entities.append_faces(points);
    }
    const auto key = [](const RepresentativePoint& p) { return std::pair(p.entity.kind, p.entity.id); };
    std::stable_sort(points.begin(), points.end(),
                     [&](const auto& a, const auto& b) { return key(a) < key(b); });
    // What two bodies share is one entity, that of the first.
    points.erase(std::unique(points.begin(), points.end(),
                             [&](const auto& a, const auto& b) { return key(a) == key(b); }),
                 points.end());
    return points;
}

}  // namespace insym
