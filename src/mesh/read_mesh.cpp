#include "insym/read_mesh.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <string_view>

#include "mesh/feature_lines.hpp"
#include "mesh/flat_regions.hpp"

namespace insym {
namespace {

constexpr double kWeldShare = 1e-6, kFlatShare = 1e-5;  ///< of the diagonal

/// Of a face whose corners are off by 0.1 % of the diagonal the triangles are off by twice that.
constexpr double kNearlyFlatShare = 2e-3;

std::string format_of(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return ending.empty() ? "" : ending.substr(1);
}

void check_options(const ReadMeshOptions& options) {
    const auto refuse = [](const std::string& sentence) { throw Error(ErrorCode::invalid_option, sentence); };
    if (!options.model.vertices && !options.model.edges && !options.model.faces)
        refuse("points: choose at least one of vertices, edges and faces");
    if (!(options.sharp_angle_deg > 0 && options.sharp_angle_deg < 180))
        refuse("sharp angle: must be above 0 and below 180 degrees");
    label_entities({}, options.model.labels);  // a tolerance out of range is said before the long work
}

void append(const Eigen::Vector3d& position, Entity entity, std::int64_t id, PointSet& points) {
    entity.id = id;
    points.positions.push_back({position.x(), position.y(), position.z()});
    points.entities.push_back(std::move(entity));
}

void append_corners(const TriangleMesh& mesh, const std::vector<int>& corners, PointSet& points) {
    for (const int corner : corners) {
        Entity entity;
        entity.kind = EntityKind::vertex;
        entity.geometry = "point";
        append(mesh.vertices[static_cast<std::size_t>(corner)], entity, corner + 1, points);
    }
}

void append_lines(const TriangleMesh& mesh, const std::vector<FeatureLine>& lines, PointSet& points) {
    std::int64_t id = 0;
    for (const FeatureLine& line : lines) {
        const auto [position, entity] = describe_line(mesh, line);
        append(position, entity, ++id, points);
    }
}

void append_regions(const std::vector<FlatRegion>& regions, PointSet& points) {
    std::int64_t id = 0;
    for (const FlatRegion& region : regions) {
        Entity entity;
        entity.kind = EntityKind::face;
        entity.geometry = "plane";
        entity.area = region.area;
        append(region.centroid, entity, ++id, points);
    }
}

struct Features {
    FeatureLines lines;
    std::vector<FlatRegion> regions;
};

Features find_features(const TriangleMesh& mesh, double diagonal, const ReadMeshOptions& options) {
    const std::vector<MeshEdge> edges = find_edges(mesh, options.sharp_angle_deg);
    Features features;
    features.lines = find_feature_lines(mesh, edges, options.sharp_angle_deg);
    const Flatness flatness = {kFlatShare * diagonal, kNearlyFlatShare * diagonal,
                               std::cos(options.sharp_angle_deg * std::numbers::pi / 180)};
    if (options.model.faces) features.regions = find_flat_regions(mesh, edges, flatness);
    return features;
}

PointSet feature_points(const TriangleMesh& mesh, const Features& features, const ReadMeshOptions& options) {
    PointSet points;
    if (options.model.vertices) append_corners(mesh, features.lines.corners, points);
    if (options.model.edges) append_lines(mesh, features.lines.lines, points);
    if (options.model.faces) append_regions(features.regions, points);
    points.labels = label_entities(points.entities, options.model.labels);
    return points;
}

Tessellation tessellation_of(const TriangleMesh& mesh, const Features& features) {
    Tessellation result;
    result.vertices.reserve(mesh.vertices.size());
    for (const Eigen::Vector3d& v : mesh.vertices) result.vertices.push_back({v.x(), v.y(), v.z()});
    result.triangles = mesh.triangles;
    result.faces.assign(mesh.triangles.size(), 0);
    std::int64_t id = 0;
    for (const FlatRegion& region : features.regions) {
        ++id;
        for (const int t : region.triangles) result.faces[static_cast<std::size_t>(t)] = id;
    }
    id = 0;
    for (const FeatureLine& line : features.lines.lines) {
        result.lines.push_back({line.vertices, ++id});
        if (line.closed) result.lines.back().vertices.push_back(line.vertices.front());
    }
    return result;
}

}  // namespace

Input read_mesh_file(const std::string& path, const ReadMeshOptions& options) {
    check_options(options);
    const TriangleMesh loaded = load_mesh(path);
    const double diagonal = box_diagonal(loaded.vertices);
    if (loaded.triangles.empty() || !(diagonal > 0))
        throw Error(ErrorCode::invalid_input, path + ": the mesh has no triangles");
    Input input;
    input.path = path;
    input.format = format_of(path);
    const TriangleMesh mesh = weld(loaded, kWeldShare * diagonal);
    const Features features = find_features(mesh, diagonal, options);
    input.points = feature_points(mesh, features, options);
    if (input.points.positions.empty())
        throw Error(
            ErrorCode::invalid_input,
            path + ": the mesh has none of the features chosen: no sharp edges and no large flat regions");
    if (options.model.tessellate) input.tessellation = tessellation_of(mesh, features);
    return input;
}

bool is_mesh_path(const std::string& path) {
    constexpr std::array<std::string_view, 4> kFormats = {"stl", "obj", "ply", "off"};
    return std::find(kFormats.begin(), kFormats.end(), format_of(path)) != kFormats.end();
}

}  // namespace insym
