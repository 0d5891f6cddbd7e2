#include "insym/read_mesh.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <string_view>

#include "mesh/feature_lines.hpp"
#include "mesh/flat_regions.hpp"

namespace insym {
namespace {

constexpr double kWeldShare = 1e-6, kFlatShare = 1e-5;  ///< of the diagonal

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

PointSet feature_points(const TriangleMesh& mesh, double diagonal, const ReadMeshOptions& options) {
    const std::vector<MeshEdge> edges = find_edges(mesh, options.sharp_angle_deg);
    const FeatureLines lines = find_feature_lines(mesh, edges, options.sharp_angle_deg);
    PointSet points;
    if (options.model.vertices) append_corners(mesh, lines.corners, points);
    if (options.model.edges) append_lines(mesh, lines.lines, points);
    if (options.model.faces) append_regions(find_flat_regions(mesh, edges, kFlatShare * diagonal), points);
    points.labels = label_entities(points.entities, options.model.labels);
    return points;
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
    input.points = feature_points(weld(loaded, kWeldShare * diagonal), diagonal, options);
    if (input.points.positions.empty())
        throw Error(
            ErrorCode::invalid_input,
            path + ": the mesh has none of the features chosen: no sharp edges and no large flat regions");
    return input;
}

bool is_mesh_path(const std::string& path) {
    constexpr std::array<std::string_view, 4> kFormats = {"stl", "obj", "ply", "off"};
    return std::find(kFormats.begin(), kFormats.end(), format_of(path)) != kFormats.end();
}

}  // namespace insym
