#include "view/drawing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "isometry/fit.hpp"
#include "view/shown_part.hpp"
#include "view/solids.hpp"

namespace insym {
namespace {

using Eigen::Vector3f;

// The colours of viewer/src/palette.ts in light.
constexpr Colour kModel{0.835F, 0.851F, 0.878F}, kEdge{0.42F, 0.455F, 0.50F}, kElement{0.69F, 0.14F, 0.43F},
    kInk{0.08F, 0.1F, 0.12F}, kPoint{0.35F, 0.39F, 0.435F};
constexpr std::array<Colour, 2> kHalves = {{{0.737F, 0.843F, 0.933F}, {0.949F, 0.863F, 0.682F}}};
constexpr std::array<Colour, 7> kOrbits = {{{0, 0.447F, 0.698F},
                                            {0.835F, 0.369F, 0},
                                            {0, 0.62F, 0.451F},
                                            {0.8F, 0.475F, 0.655F},
                                            {0.902F, 0.624F, 0},
                                            {0.337F, 0.706F, 0.914F},
                                            {0.478F, 0.318F, 0.584F}}};

// Sizes as shares of the radius.
constexpr float kDot = 0.014F, kPath = 0.006F, kLine = 0.0022F, kReach = 1.15F, kHead = 0.05F,
                kMargin = 0.08F;

/// The lines of a model with more vertices would be more than the model.
constexpr std::size_t kMostLineVertices = 200000;

class Drawer {
public:
    Drawer(const DetectResult& result, const Tessellation& model, const Symmetry* symmetry)
        : result_(result), model_(model), symmetry_(symmetry) {
        drawing_.origin = middle_of(result, model);
        float radius = 0;
        for (const auto* points : {&result.points.positions, &model.vertices})
            for (const Point& p : *points) radius = std::max(radius, place(p).norm());
        if (radius > 0) drawing_.radius = radius;
    }

    Drawing run() {
        draw_model();
        draw_lines();
        if (symmetry_ == nullptr || model_.triangles.empty()) draw_points();
        if (symmetry_ != nullptr) {
            draw_cycles();
            draw_marks();
            draw_elements();
        }
        return std::move(drawing_);
    }

private:
    Vector3f place(const Point& p) const { return (to_vector(p) - to_vector(drawing_.origin)).cast<float>(); }
    static Vector3f direction(const Point& d) { return to_vector(d).cast<float>().normalized(); }
    Vector3f position(int i) const { return place(result_.points.positions[static_cast<std::size_t>(i)]); }
    float size(float share) const { return share * drawing_.radius; }

    void add(const std::string& name, PartKind kind, const Colour& colour, ShadedMesh mesh) {
        if (!mesh.triangles.empty()) drawing_.parts.push_back({name, kind, colour, std::move(mesh)});
    }

    /// The cycle that each face or edge is in.
    std::map<std::int64_t, std::size_t> cycle_of(EntityKind kind) const {
        std::map<std::int64_t, std::size_t> cycles;
        if (symmetry_ == nullptr || result_.points.entities.empty()) return cycles;
        for (std::size_t c = 0; c < symmetry_->cycles.size(); ++c)
            for (const int i : symmetry_->cycles[c].points) {
                const Entity& entity = result_.points.entities[static_cast<std::size_t>(i)];
                if (entity.kind != kind) continue;
                cycles.emplace(entity.id, c);
                for (const std::int64_t id : entity.ids) cycles.emplace(id, c);
            }
        return cycles;
    }

    static std::string cycle_name(std::size_t cycle, const char* what) {
        return "cycle " + std::to_string(cycle + 1) + " " + what;
    }

    /// The faces of each cycle in a part of their own.
    void draw_model() {
        const ShadedMesh all = shade(model_, drawing_.origin);
        const auto cycles = cycle_of(EntityKind::face);
        std::map<std::size_t, std::vector<std::size_t>> coloured;
        std::vector<std::size_t> plain;
        for (std::size_t t = 0; t < all.triangles.size(); ++t) {
            const auto cycle = all.faces[t] > 0 ? cycles.find(all.faces[t]) : cycles.end();
            (cycle == cycles.end() ? plain : coloured[cycle->second]).push_back(t);
        }
        draw_plain(part_of(all, plain));
        for (const auto& [cycle, triangles] : coloured)
            add(cycle_name(cycle, "faces"), PartKind::model, orbit_colour(cycle), part_of(all, triangles));
    }

    /// The halves that a plane parts are tinted.
    void draw_plain(ShadedMesh mesh) {
        const bool reflects =
            symmetry_ != nullptr && symmetry_->isometry.plane &&
            (symmetry_->type == SymmetryType::mirror || symmetry_->type == SymmetryType::glide_reflection);
        if (!reflects) {
            add("model", PartKind::model, kModel, std::move(mesh));
            return;
        }
        const Plane& plane = *symmetry_->isometry.plane;
        const Vector3f normal = direction(plane.normal);
        const float offset = normal.dot(place(plane.point));
        add("model", PartKind::model, kHalves[0], half(mesh, normal, offset));
        add("model, other half", PartKind::model, kHalves[1], half(mesh, -normal, -offset));
    }

    static Colour orbit_colour(std::size_t cycle) { return kOrbits[cycle % kOrbits.size()]; }

    void draw_lines() {
        std::size_t count = 0;
        for (const Tessellation::Line& line : model_.lines) count += line.vertices.size();
        if (count > kMostLineVertices) return;
        const auto cycles = cycle_of(EntityKind::edge);
        ShadedMesh plain;
        std::map<std::size_t, ShadedMesh> coloured;
        for (const Tessellation::Line& line : model_.lines) {
            const auto cycle = line.edge > 0 ? cycles.find(line.edge) : cycles.end();
            const bool is_plain = cycle == cycles.end();
            ShadedMesh& mesh = is_plain ? plain : coloured[cycle->second];
            for (std::size_t i = 1; i < line.vertices.size(); ++i)
                add_tube(place(model_.vertices[static_cast<std::size_t>(line.vertices[i - 1])]),
                         place(model_.vertices[static_cast<std::size_t>(line.vertices[i])]),
                         size(is_plain ? kLine : 2 * kLine), mesh);
        }
        add("edges", PartKind::model, kEdge, std::move(plain));
        for (auto& [cycle, mesh] : coloured)
            add(cycle_name(cycle, "edges"), PartKind::model, orbit_colour(cycle), std::move(mesh));
    }

    void draw_points() {
        ShadedMesh mesh;
        for (const Point& p : result_.points.positions) add_sphere(place(p), size(0.6F * kDot), mesh);
        add("points", PartKind::model, kPoint, std::move(mesh));
    }

    /// Hundreds of points and cycles are drawn smaller, so that they do not hide the model.
    float dot() const {
        std::size_t count = 0;
        for (const Orbit& cycle : symmetry_->cycles) count += cycle.points.size();
        return size(count > 300 ? 0.5F * kDot : count > 100 ? 0.7F * kDot : kDot);
    }
    float path() const { return size(symmetry_->cycles.size() > 60 ? 0.4F * kPath : kPath); }

    void draw_cycles() {
        for (std::size_t c = 0; c < symmetry_->cycles.size(); ++c) {
            const Orbit& cycle = symmetry_->cycles[c];
            ShadedMesh mesh;
            for (std::size_t i = 0; i < cycle.points.size(); ++i) {
                add_sphere(position(cycle.points[i]), dot(), mesh);
                if (i > 0) add_tube(position(cycle.points[i - 1]), position(cycle.points[i]), path(), mesh);
            }
            if (cycle.closed && cycle.points.size() > 2)
                add_tube(position(cycle.points.back()), position(cycle.points.front()), path(), mesh);
            add(cycle_name(c, "points"), PartKind::overlay, orbit_colour(c), std::move(mesh));
        }
    }

    /// An empty slot, filled by what stands at the end of a cycle, so many steps of the isometry further.
    struct Ghost {
        int point;
        int steps;
        Point carry(const Isometry& isometry, Point p) const {
            for (int k = 0; k < steps; ++k) p = isometry.apply(p);
            return p;
        }
    };

    /// Slots are placed by fits, the deviation of which adds to a thousandth of the model.
    bool is_slot(const Point& p, const Point& slot) const {
        return (to_vector(p) - to_vector(slot)).norm() <
               1e-3 * drawing_.radius + 4 * symmetry_->deviation.max;
    }

    /// Takes the slots that a face or an edge would fill out of `slots`.
    std::vector<Ghost> take_ghosts(std::vector<Point>& slots) const {
        std::vector<Ghost> ghosts;
        if (result_.points.entities.empty() || model_.triangles.empty()) return ghosts;
        for (const Orbit& cycle : symmetry_->cycles) {
            const int last = cycle.points.back();
            const auto entity = static_cast<std::size_t>(last);
            if (cycle.closed || result_.points.entities[entity].kind == EntityKind::vertex) continue;
            for (Ghost ghost{last, 1};; ++ghost.steps) {
                const Point p = ghost.carry(symmetry_->isometry, result_.points.positions[entity]);
                const auto slot =
                    std::find_if(slots.begin(), slots.end(), [&](const Point& q) { return is_slot(p, q); });
                if (slot == slots.end()) break;
                slots.erase(slot);
                ghosts.push_back(ghost);
            }
        }
        return ghosts;
    }

    /// Returns the ends of the edges that are drawn.
    std::vector<Point> draw_ghosts(const std::vector<Ghost>& ghosts) {
        std::vector<Point> ends;
        Tessellation surface;
        ShadedMesh edges;
        for (const Ghost& ghost : ghosts) {
            const auto carried = [&](int v) {
                return ghost.carry(symmetry_->isometry, model_.vertices[static_cast<std::size_t>(v)]);
            };
            const Entity& entity = result_.points.entities[static_cast<std::size_t>(ghost.point)];
            const auto is_its = [&](EntityKind kind, std::int64_t id) {
                return kind == entity.kind &&
                       (id == entity.id ||
                        std::find(entity.ids.begin(), entity.ids.end(), id) != entity.ids.end());
            };
            for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
                if (!is_its(EntityKind::face, model_.faces[t])) continue;
                std::array<int, 3> corners{};
                for (std::size_t k = 0; k < 3; ++k) {
                    corners[k] = static_cast<int>(surface.vertices.size());
                    surface.vertices.push_back(carried(model_.triangles[t][k]));
                }
                surface.triangles.push_back(corners);
            }
            for (const Tessellation::Line& line : model_.lines) {
                if (!is_its(EntityKind::edge, line.edge)) continue;
                ends.push_back(carried(line.vertices.front()));
                ends.push_back(carried(line.vertices.back()));
                for (std::size_t i = 1; i < line.vertices.size(); ++i)
                    add_tube(place(carried(line.vertices[i - 1])), place(carried(line.vertices[i])),
                             size(2 * kLine), edges);
            }
        }
        add("empty slots, faces", PartKind::ghost, kElement, shade(surface, drawing_.origin));
        add("empty slots, edges", PartKind::overlay, kElement, std::move(edges));
        return ends;
    }

    void draw_marks() {
        std::vector<Point> slots = symmetry_->missing;
        for (const Point& corner : draw_ghosts(take_ghosts(slots)))
            std::erase_if(slots, [&](const Point& slot) { return is_slot(corner, slot); });
        ShadedMesh fixed, missing;
        const Vector3f towards(kEye.data());  // so that rings look like rings
        for (const int i : symmetry_->fixed_points)
            add_ring(position(i), towards, size(1.6F * kDot), size(0.35F * kDot), fixed);
        for (const Point& slot : slots)
            add_ring(place(slot), towards, size(2 * kDot), size(0.4F * kDot), missing);
        add("fixed points", PartKind::overlay, kInk, std::move(fixed));
        add("empty slots", PartKind::overlay, kElement, std::move(missing));
    }

    void draw_elements() {
        const Isometry& isometry = symmetry_->isometry;
        ShadedMesh solid, sheet;
        if (isometry.plane) draw_plane(*isometry.plane, solid, sheet);
        if (isometry.axis) draw_axis(*isometry.axis, isometry.step, solid);
        if (isometry.center) add_sphere(place(*isometry.center), size(1.5F * kDot), solid);
        add("plane", PartKind::sheet, kElement, std::move(sheet));
        add("axis", PartKind::overlay, kElement, std::move(solid));
    }

    /// How far points and model reach along a direction, and a margin.
    std::pair<float, float> extent(const Vector3f& along) const {
        float low = 0, high = 0;
        for (const auto* points : {&result_.points.positions, &model_.vertices})
            for (const Point& p : *points) {
                low = std::min(low, along.dot(place(p)));
                high = std::max(high, along.dot(place(p)));
            }
        return {low - size(kMargin), high + size(kMargin)};
    }

    void draw_plane(const Plane& plane, ShadedMesh& solid, ShadedMesh& sheet) const {
        const Vector3f normal = direction(plane.normal);
        const Vector3f foot = normal * normal.dot(place(plane.point));
        if (result_.points.dimension == 2) {
            const Vector3f along = Vector3f::UnitZ().cross(normal) * size(kReach);
            add_dashes(foot - along, foot + along, size(0.6F * kPath), size(0.04F), solid);
            return;
        }
        const auto [u, v] = square_to(normal);
        const auto [left, right] = extent(u);
        const auto [bottom, top] = extent(v);
        const std::array<Vector3f, 4> corners = {foot + left * u + bottom * v, foot + right * u + bottom * v,
                                                 foot + right * u + top * v, foot + left * u + top * v};
        add_sheet(corners, sheet);
        for (std::size_t k = 0; k < 4; ++k)
            add_tube(corners[k], corners[(k + 1) % 4], size(0.5F * kPath), solid);
    }

    /// A line about the model, and the step as an arrow where there is one.
    void draw_axis(const Axis& axis, double step, ShadedMesh& solid) const {
        const Vector3f along = direction(axis.direction);
        Vector3f foot = place(axis.point) - along * along.dot(place(axis.point));
        if (symmetry_->type == SymmetryType::translation) foot.setZero();
        add_dashes(foot - along * size(kReach), foot + along * size(kReach), size(0.6F * kPath), size(0.04F),
                   solid);
        const bool steps = step > 0;
        const Vector3f tip = foot + along * (steps ? static_cast<float>(step) : size(kReach + kHead));
        if (steps) add_tube(foot, tip, size(kPath), solid);
        add_cone(tip, along, size(kHead), solid);
    }

    const DetectResult& result_;
    const Tessellation& model_;
    const Symmetry* symmetry_;
    Drawing drawing_;
};

}  // namespace

Drawing draw(const DetectResult& result, const Tessellation& model, const Symmetry* symmetry) {
    return Drawer(result, model, symmetry).run();
}

}  // namespace insym
