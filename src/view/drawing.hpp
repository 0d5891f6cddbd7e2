// A model with one of its symmetries as coloured triangles: what the scene and the still picture share.
#pragma once

#include "insym/detect.hpp"

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "view/shaded_mesh.hpp"

namespace insym {

struct Colour {
    float red = 0, green = 0, blue = 0;  ///< sRGB, 0..1
};

/// What a part of a drawing is for; it decides what may hide it.
enum class PartKind {
    model,    ///< solid
    overlay,  ///< also seen, faintly, through the model
    sheet,    ///< translucent
};

struct Part {
    std::string name;
    PartKind kind = PartKind::model;
    Colour colour;
    ShadedMesh mesh{};
    /// The half on the side of the normal has `colour`, the other one this colour.
    struct Halves {
        Eigen::Vector3f normal;
        float offset = 0;
        Colour other;
    };
    std::optional<Halves> halves{};
};

/// Coordinates less `origin`; everything lies within `radius` of it.
struct Drawing {
    Point origin{};
    float radius = 1;
    std::vector<Part> parts;
};

/// `symmetry`: null for the model and its points alone.
Drawing draw(const DetectResult& result, const Tessellation& model, const Symmetry* symmetry);

}  // namespace insym
