#include "insym/read_model.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <new>
#include <string_view>
#include <utility>

#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>

#include "brep/model_file.hpp"
#include "brep/model_shape.hpp"
#include "brep/occt_session.hpp"
#include "brep/representative_points.hpp"
#include "brep/tessellate.hpp"

namespace insym {
namespace {

struct Format {
    const char* name;
    ModelShape (*read)(const std::string& path);
    bool sewn = false;  ///< its faces must be whole for their edges to be found to be the same
};

constexpr Format kStep = {"step", read_step}, kIges = {"iges", read_iges, true}, kBrep = {"brep", read_brep};

/// By the ending of the path; null for none of these.
const Format* find_format(const std::string& path) {
    static const std::map<std::string_view, const Format*> kEndings = {
        {".step", &kStep}, {".stp", &kStep},  {".p21", &kStep}, {".iges", &kIges},
        {".igs", &kIges},  {".brep", &kBrep}, {".brp", &kBrep}, {".bbrep", &kBrep}};
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const auto found = kEndings.find(ending);
    return found == kEndings.end() ? nullptr : found->second;
}

/// From millimetres to the unit of the file.
void append(const RepresentativePoint& point, double unit, PointSet& points) {
    const gp_Pnt& p = point.position;
    Entity entity = point.entity;
    for (auto* length : {&entity.radius, &entity.minor_radius, &entity.length})
        if (*length) **length /= unit;
    if (entity.area) *entity.area /= unit * unit;
    points.positions.push_back({p.X() / unit, p.Y() / unit, p.Z() / unit});
    points.entities.push_back(std::move(entity));
}

/// Huge or damaged geometry may have no middle; such points would make the whole set useless.
bool is_finite(const RepresentativePoint& point) {
    return std::isfinite(point.position.X()) && std::isfinite(point.position.Y()) &&
           std::isfinite(point.position.Z());
}

Input read_with_open_cascade(const std::string& path, const Format& format, const ReadModelOptions& options) {
    // Vertices need no repair, which takes most of the time and puts more of them where seams happen to lie.
    const OcctSession session(options.edges || options.faces || format.sewn ? Healing::on : Healing::off);
    const ModelShape model = format.read(path);
    Input input;
    input.path = path;
    input.format = format.name;
    input.unit = model.unit.name;
    if (!model.shape.IsNull()) {
        const auto points = representative_points(model, options);
        int lost = 0;
        for (const RepresentativePoint& point : points)
            is_finite(point) ? append(point, model.unit.millimetres, input.points) : void(++lost);
        if (lost > 0)
            input.diagnostics.push_back(
                {"entities_without_point",
                 std::to_string(lost) + " edges or faces have no finite special point and were left out"});
    }
    if (input.points.positions.empty())
        throw Error(ErrorCode::invalid_input,
                    path + ": the " + format.name + " file holds no geometry with " +
                        (options.vertices ? "vertices" : "edges or faces as chosen"));
    input.points.labels = label_entities(input.points.entities, options.labels);
    if (options.tessellate) input.tessellation = tessellate(model);
    return input;
}

}  // namespace

Input read_model_file(const std::string& path, const ReadModelOptions& options) {
    if (!options.vertices && !options.edges && !options.faces)
        throw Error(ErrorCode::invalid_option, "points: choose at least one of vertices, edges and faces");
    label_entities({}, options.labels);  // a tolerance out of range is said before the long work
    const Format* format = find_format(path);
    try {
        return read_with_open_cascade(path, format != nullptr ? *format : kStep, options);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const Standard_OutOfMemory&) {
        throw std::bad_alloc();
    } catch (const Standard_Failure& failure) {
        fail_reading(path, std::string("the file is damaged: Open CASCADE gave up on it (") +
                               failure.DynamicType()->Name() + ")");
    } catch (const std::exception& failure) {
        fail_reading(path, std::string("reading failed: ") + failure.what());
    } catch (...) {
        fail_reading(path, "reading failed for an unknown reason");
    }
}

bool is_model_path(const std::string& path) {
    return find_format(path) != nullptr;
}

}  // namespace insym
