// The still picture: Embree casts the rays, Cairo writes the words and the file. No screen, no graphics card.
#include "insym/view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <cairo/cairo.h>
#include <tbb/task_arena.h>

#include "parallel_for.hpp"
#include "view/drawing.hpp"
#include "view/ray_scene.hpp"

namespace insym {
namespace {

using Eigen::Vector3f;

constexpr int kPanelWidth = 720, kPanelHeight = 560, kCaption = 40;  // pixels
constexpr int kSamples = 3;                                          // each way in a pixel
constexpr std::size_t kMostPanels = 4;
constexpr float kMargin = 0.06F;  // of the panel
constexpr Colour kGround{0.965F, 0.969F, 0.976F};

// Rays ----------------------------------------------------------------------------------------

struct View {
    Vector3f right, up, forward;
};

View view_of(int dimension) {
    if (dimension == 2) return {Vector3f::UnitX(), Vector3f::UnitY(), -Vector3f::UnitZ()};
    const Vector3f forward = -Vector3f(kEye.data()).normalized();
    const Vector3f right = forward.cross(Vector3f::UnitZ()).normalized();
    return {right, right.cross(forward), forward};
}

Colour mix(const Colour& a, const Colour& b, float share) {
    const auto between = [&](float x, float y) { return x + share * (y - x); };
    return {between(a.red, b.red), between(a.green, b.green), between(a.blue, b.blue)};
}

Colour scaled(const Colour& colour, float light) {
    return {std::min(1.0F, colour.red * light), std::min(1.0F, colour.green * light),
            std::min(1.0F, colour.blue * light)};
}

class Camera {
public:
    Camera(const Drawing& drawing, int dimension)
        : radius_(drawing.radius),
          view_(view_of(dimension)),
          light_((-0.8F * view_.right + 1.2F * view_.up - 1.6F * view_.forward).normalized()),
          all_(drawing.parts, {PartKind::model, PartKind::overlay}),
          overlay_(drawing.parts, {PartKind::overlay}),
          sheets_(drawing.parts, {PartKind::sheet}),
          ghosts_(drawing.parts, {PartKind::ghost}) {
        fit(drawing);
    }

    /// `column`, `row`: pixels from the upper left corner of the panel.
    Colour look(float column, float row) const {
        constexpr float kThrough = 0.4F, kSheet = 0.16F, kGhost = 0.3F;
        const float x = middle_.x() + (column - kPanelWidth / 2.0F) * pixel_;
        const float y = middle_.y() - (row - kPanelHeight / 2.0F) * pixel_;
        const Vector3f from = x * view_.right + y * view_.up - 4 * radius_ * view_.forward;
        const auto front = all_.first_hit(from, view_.forward);
        Colour colour = front ? shaded(*front) : kGround;
        if (front && front->part->kind == PartKind::model)
            if (const auto behind = overlay_.first_hit(from, view_.forward))
                colour = mix(colour, behind->part->colour, kThrough);
        const auto sheet = sheets_.first_hit(from, view_.forward);
        if (sheet && (!front || sheet->distance < front->distance))
            colour = mix(colour, sheet->part->colour, kSheet);
        if (const auto ghost = ghosts_.first_hit(from, view_.forward))
            colour = mix(colour, ghost->part->colour, kGhost);
        return colour;
    }

private:
    /// All that is drawn fills the panel.
    void fit(const Drawing& drawing) {
        Eigen::AlignedBox2f box;
        for (const Part& part : drawing.parts)
            for (const auto& p : part.mesh.positions) {
                const Vector3f position(p[0], p[1], p[2]);
                box.extend(Eigen::Vector2f(position.dot(view_.right), position.dot(view_.up)));
            }
        if (box.isEmpty()) return;
        middle_ = box.center();
        const float share = 1 - 2 * kMargin;
        pixel_ = std::max({box.sizes().x() / (share * kPanelWidth), box.sizes().y() / (share * kPanelHeight),
                           1e-6F * radius_});
    }

    Colour shaded(const Hit& hit) const {
        constexpr float kAmbient = 0.5F, kDirect = 0.55F;
        const float facing = hit.normal.dot(view_.forward) < 0 ? 1.0F : -1.0F;
        return scaled(hit.part->colour, kAmbient + kDirect * std::max(0.0F, facing * hit.normal.dot(light_)));
    }

    float radius_;
    float pixel_ = 1;  ///< its size in the drawing
    Eigen::Vector2f middle_ = Eigen::Vector2f::Zero();
    View view_;
    Vector3f light_;
    RayScene all_, overlay_, sheets_, ghosts_;
};

// Pixels --------------------------------------------------------------------------------------

struct FreeSurface {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Surface = std::unique_ptr<cairo_surface_t, FreeSurface>;

std::uint32_t pixel(const Colour& colour) {
    const auto byte = [](float x) { return static_cast<std::uint32_t>(std::lround(255 * x)); };
    return 0xff000000U | byte(colour.red) << 16U | byte(colour.green) << 8U | byte(colour.blue);
}

bool alike(const Colour& a, const Colour& b) {
    constexpr float kLeast = 0.02F;
    return std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue) < kLeast;
}

/// Two samples where nothing begins or ends, the whole grid of them elsewhere.
Colour average_of_pixel(const Camera& camera, int column, int row) {
    const auto sample = [&](int i, int j) {
        const float x = static_cast<float>(column) + (static_cast<float>(j) + 0.5F) / kSamples;
        const float y = static_cast<float>(row) + (static_cast<float>(i) + 0.5F) / kSamples;
        return camera.look(x, y);
    };
    const Colour first = sample(0, 0), last = sample(kSamples - 1, kSamples - 1);
    if (alike(first, last)) return mix(first, last, 0.5F);
    Colour sum;
    for (int i = 0; i < kSamples; ++i)
        for (int j = 0; j < kSamples; ++j) {
            const Colour colour = sample(i, j);
            sum = {sum.red + colour.red, sum.green + colour.green, sum.blue + colour.blue};
        }
    return scaled(sum, 1.0F / (kSamples * kSamples));
}

void render(const Drawing& drawing, int dimension, int left, int top, cairo_surface_t* surface) {
    const Camera camera(drawing, dimension);
    cairo_surface_flush(surface);
    unsigned char* data = cairo_image_surface_get_data(surface);
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
    parallel_for(kPanelHeight, [&](int row) {
        auto* line = reinterpret_cast<std::uint32_t*>(data + static_cast<std::size_t>(top + row) * stride);
        for (int column = 0; column < kPanelWidth; ++column)
            line[left + column] = pixel(average_of_pixel(camera, column, row));
    });
    cairo_surface_mark_dirty(surface);
}

// Words ---------------------------------------------------------------------------------------

std::string number(double x) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.4g", x);
    return text.data();
}

std::string kind_of(const Symmetry& symmetry) {
    constexpr std::array<const char*, 8> words = {
        "mirror",      "inversion",        "half-turn",           "rotation",
        "translation", "glide reflection", "rotation-reflection", "screw"};
    return words[static_cast<std::size_t>(symmetry.type)];
}

std::string caption_of(const Symmetry& symmetry, const ReportContext& context, double resolution) {
    const std::string unit = context.unit ? " " + *context.unit : "";
    std::string text = "#" + std::to_string(symmetry.id) + "  " + kind_of(symmetry);
    if (symmetry.order && *symmetry.order > 2) text += " of order " + std::to_string(*symmetry.order);
    if (symmetry.isometry.step > 0) text += ", step " + number(symmetry.isometry.step) + unit;
    text +=
        "   " + std::to_string(symmetry.cycles.size()) + (symmetry.cycles.size() == 1 ? " cycle" : " cycles");
    if (const std::size_t slots = symmetry.missing.size(); slots > 0)
        text += ", " + std::to_string(slots) + (slots == 1 ? " empty slot" : " empty slots");
    const double deviation = symmetry.deviation.max;
    return text + (deviation <= resolution ? ", exact" : ", deviation up to " + number(deviation) + unit);
}

void write_words(cairo_surface_t* surface, const std::string& text, int left, int top) {
    cairo_t* cairo = cairo_create(surface);
    cairo_set_source_rgb(cairo, 0.08, 0.1, 0.12);
    cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, 17);
    cairo_move_to(cairo, left + 16, top + 28);
    cairo_show_text(cairo, text.c_str());
    cairo_destroy(cairo);
}

cairo_status_t append(void* out, const unsigned char* data, unsigned size) {
    static_cast<std::ostream*>(out)->write(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;
}

/// The first ones that no other implies; a null pointer, for the model alone, where there are none.
std::vector<const Symmetry*> chosen(const DetectResult& result) {
    std::vector<const Symmetry*> symmetries;
    for (const Symmetry& symmetry : result.symmetries)
        if (symmetry.implied_by.empty() && symmetries.size() < kMostPanels) symmetries.push_back(&symmetry);
    if (symmetries.empty()) symmetries.push_back(nullptr);
    return symmetries;
}

void write_panels(std::ostream& out, const DetectResult& result, const ReportContext& context,
                  const Tessellation& model) {
    const std::vector<const Symmetry*> symmetries = chosen(result);
    const int columns = symmetries.size() > 1 ? 2 : 1;
    const int rows = (static_cast<int>(symmetries.size()) + columns - 1) / columns;
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, columns * kPanelWidth,
                                                     rows * (kPanelHeight + kCaption)));
    cairo_t* cairo = cairo_create(surface.get());
    cairo_set_source_rgb(cairo, kGround.red, kGround.green, kGround.blue);
    cairo_paint(cairo);
    cairo_destroy(cairo);
    for (std::size_t i = 0; i < symmetries.size(); ++i) {
        const int left = static_cast<int>(i) % columns * kPanelWidth;
        const int top = static_cast<int>(i) / columns * (kPanelHeight + kCaption);
        render(draw(result, model, symmetries[i]), result.points.dimension, left, top + kCaption,
               surface.get());
        const std::string words = symmetries[i] != nullptr
                                      ? caption_of(*symmetries[i], context, result.resolution)
                                      : "no symmetry found";
        write_words(surface.get(), words, left, top);
    }
    if (cairo_surface_write_to_png_stream(surface.get(), append, &out) != CAIRO_STATUS_SUCCESS)
        throw std::runtime_error("Cairo cannot write the picture");
}

}  // namespace

void write_png(std::ostream& out, const DetectResult& result, const ReportContext& context,
               const Tessellation& model, int threads) {
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    arena.execute([&] { write_panels(out, result, context, model); });
}

}  // namespace insym
