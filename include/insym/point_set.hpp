// The input of the detector: points in the plane or in space, with optional labels and origins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace insym {

/// A position x, y, z in the unit of the input. In 2D the third coordinate is 0.
using Point = std::array<double, 3>;

/// What a representative point of a model stands for.
enum class EntityKind { vertex, edge, face };

/// The side of a round face that the material is on, told from its orientation: a hole or a boss goes at
/// least three quarters of the way round its axis, a hollow (the fillet of an inner corner, the end of a
/// slot) or a round (the blend of an outer corner) less. Spheres and tori are hollows or rounds.
enum class EntityRole { none, hole, boss, hollow, round };

/// The part of a model that a point comes from. Lengths are in the input's unit, and its square for areas.
struct Entity {
    EntityKind kind = EntityKind::vertex;
    std::int64_t id = 0;              ///< 1-based index in the reader's documented, stable order
    std::string geometry{};           ///< "point", "circle", "line", "plane", ...
    std::vector<std::int64_t> ids{};  ///< all, ascending, where several make one entity; empty: only `id`
    EntityRole role = EntityRole::none;
    std::optional<double> radius{};  ///< of circle, cylinder, sphere; the major one of ellipse and torus
    std::optional<double> minor_radius{};  ///< of ellipse and torus
    std::optional<double> length{};        ///< of an edge
    std::optional<double> area{};          ///< of a face
    std::string part{};  ///< names from the assembly down, parted by "/"; empty where the file has none
};

/// A set of points in E^d (definitions, section 1).
///
/// `labels` and `entities` are either empty or hold one item for each position.
/// A cycle never mixes labels. The detector merges equal points itself.
struct PointSet {
    int dimension = 3;             ///< 2 or 3
    std::vector<Point> positions;  ///< finite coordinates, in the input's unit
    std::vector<int> labels;       ///< any integers; empty: all points are alike
    std::vector<Entity> entities;  ///< empty where the input is not a model

    std::size_t size() const { return positions.size(); }
};

/// Something the user should know: a stable code and a sentence.
struct Diagnostic {
    std::string code;
    std::string message;
};

/// The surface of a model or mesh, for pictures only. Lengths are in the input's unit; vertices are finite.
struct Tessellation {
    /// The polyline of an edge: indices of vertices in order; a closed one repeats the first.
    struct Line {
        std::vector<int> vertices;
        std::int64_t edge = 0;  ///< an Entity::id; 0: none that gives a point
    };
    std::vector<Point> vertices;                ///< of triangles and lines
    std::vector<std::array<int, 3>> triangles;  ///< indices of vertices, counter-clockwise seen from outside
    std::vector<std::int64_t> faces;  ///< Entity::id of each triangle's face; 0: none that gives a point
    std::vector<Line> lines;
};

/// A point set together with where it came from; what every reader returns.
struct Input {
    PointSet points;
    std::string path;                       ///< as given by the caller, "-" for standard input
    std::string format;                     ///< "xyz", "csv", "step", ...
    std::optional<std::string> unit;        ///< "mm" for models; none for bare points
    std::vector<Diagnostic> diagnostics{};  ///< what the reader passed over; callers add it to the report's
    Tessellation tessellation{};            ///< where the reader was asked for it; empty for bare points
};

}  // namespace insym
