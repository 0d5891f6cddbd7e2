// A model with one of its symmetries as coloured triangles: what the scene and the still picture share.
#pragma once

#include "insym/detect.hpp"

#include <array>
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
    ghost,    ///< translucent, also seen through the model
};

struct Part {
    std::string name;
    PartKind kind = PartKind::model;
    Colour colour;
    ShadedMesh mesh{};
};

/// From where still pictures are taken: x, y, z towards the eye.
constexpr std::array<float, 3> kEye = {0.62F, -0.94F, 0.72F};

/// Coordinates less `origin`; everything lies within `radius` of it.
struct Drawing {
    Point origin{};
    float radius = 1;
    std::vector<Part> parts;
};

/// `symmetry`: null for the model and its points alone.
Drawing draw(const DetectResult& result, const Tessellation& model, const Symmetry* symmetry);

}  // namespace insym
