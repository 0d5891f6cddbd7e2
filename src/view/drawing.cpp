#include "view/drawing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

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
    Vector3f place(const Point& p) const {
        const Point& o = drawing_.origin;
        return {static_cast<float>(p[0] - o[0]), static_cast<float>(p[1] - o[1]),
                static_cast<float>(p[2] - o[2])};
    }
    static Vector3f direction(const Point& d) {
        return Vector3f(static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2]))
            .normalized();
    }
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
        std::map<std::size_t, ShadedMesh> coloured;
        ShadedMesh rest;
        rest.positions = all.positions;
        rest.normals = all.normals;
        for (std::size_t t = 0; t < all.triangles.size(); ++t) {
            const auto cycle = all.faces[t] > 0 ? cycles.find(all.faces[t]) : cycles.end();
            ShadedMesh& mesh = cycle == cycles.end() ? rest : coloured[cycle->second];
            if (cycle == cycles.end()) {
                mesh.triangles.push_back(all.triangles[t]);
                continue;
            }
            std::array<std::uint32_t, 3> corners{};
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = static_cast<std::uint32_t>(mesh.positions.size());
                mesh.positions.push_back(all.positions[all.triangles[t][k]]);
                mesh.normals.push_back(all.normals[all.triangles[t][k]]);
            }
            mesh.triangles.push_back(corners);
        }
        const auto halves = halves_of_model();
        add("model", PartKind::model, halves ? kHalves[0] : kModel, std::move(rest));
        if (!drawing_.parts.empty()) drawing_.parts.back().halves = halves;
        for (auto& [cycle, mesh] : coloured)
            add(cycle_name(cycle, "faces"), PartKind::model, orbit_colour(cycle), std::move(mesh));
    }

    std::optional<Part::Halves> halves_of_model() const {
        if (symmetry_ == nullptr || !symmetry_->isometry.plane ||
            (symmetry_->type != SymmetryType::mirror && symmetry_->type != SymmetryType::glide_reflection))
            return std::nullopt;
        const Plane& plane = *symmetry_->isometry.plane;
        const Vector3f normal = direction(plane.normal);
        return Part::Halves{normal, normal.dot(place(plane.point)), kHalves[1]};
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

    void draw_marks() {
        ShadedMesh fixed, missing;
        const Vector3f towards = Vector3f(0.62F, -0.94F, 0.72F);  // a view from which rings look like rings
        for (const int i : symmetry_->fixed_points)
            add_ring(position(i), towards, size(1.6F * kDot), size(0.35F * kDot), fixed);
        for (const Point& slot : symmetry_->missing)
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
