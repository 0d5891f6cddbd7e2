#include "insym/read_model.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include <BRep_Tool.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Check.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_CartesianPoint.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_VertexPoint.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Pnt.hxx>

#include "brep/occt_session.hpp"

namespace insym {
namespace {

constexpr std::array<std::string_view, 3> kStepEndings = {".step", ".stp", ".p21"};
constexpr std::string_view kStepStart = "ISO-10303-21;";
constexpr std::string_view kStepEnd = "END-ISO-10303-21";
constexpr std::size_t kChunk = std::size_t{1} << 18;

struct LengthUnit {
    const char* name;
    double millimetres;
};

constexpr LengthUnit kMillimetre = {"mm", 1};
constexpr std::array<LengthUnit, 8> kLengthUnits = {kMillimetre,      {"cm", 10},   {"m", 1e3},
                                                    {"km", 1e6},      {"um", 1e-3}, {"inch", 25.4},
                                                    {"mil", 25.4e-3}, {"ft", 304.8}};

[[noreturn]] void fail_reading(const std::string& path, const std::string& why) {
    throw Error(ErrorCode::cannot_read, path + ": " + why);
}

[[noreturn]] void fail_damaged(const std::string& path, const std::string& why) {
    fail_reading(path, "the STEP file is damaged: " + why);
}

std::ifstream open_file(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) fail_reading(path, "is a directory, not a STEP file");
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (stream) return stream;
    fail_reading(path, "cannot be opened: " + std::generic_category().message(errno != 0 ? errno : ENOENT));
}

/// The whole file. Its two ends are checked here, because Open CASCADE calls every fault of the text the
/// same; the first as soon as it is there, because what is no STEP file may be endless.
std::string read_step_text(const std::string& path) {
    std::ifstream stream = open_file(path);
    std::string text;
    while (stream) {
        const std::size_t start = text.size();
        text.resize(start + kChunk);
        stream.read(text.data() + start, static_cast<std::streamsize>(kChunk));
        text.resize(start + static_cast<std::size_t>(stream.gcount()));
        if (stream.bad()) fail_reading(path, "reading failed part way");
        if (text.empty()) fail_reading(path, "the file is empty");
        if (start == 0 && text.find(kStepStart) == std::string::npos)
            fail_reading(path, "is not a STEP file: it does not begin with " + std::string(kStepStart));
    }
    if (text.rfind(kStepEnd) == std::string::npos)
        fail_damaged(path, "it stops before its end, the line " + std::string(kStepEnd) + ";");
    return text;
}

/// A message of Open CASCADE as part of a sentence: one line, no runs of blanks.
std::string in_one_line(const char* message) {
    std::istringstream words(message);
    std::string line;
    for (std::string word; words >> word;) line += line.empty() ? word : " " + word;
    constexpr std::string_view kSyntax = "Undefined Parsing: Line ";
    // Open CASCADE 7.6 counts one line too many, so the number is no more than near.
    return line.starts_with(kSyntax) ? "near line " + line.substr(kSyntax.size()) : line;
}

/// What is wrong with one item of the model's geometry or topology. Open CASCADE notes wrong parameters and
/// then follows them to null pointers all the same; so it does from a vertex whose point is not one in space.
std::optional<std::string> find_fault(const StepData_StepModel& model, Standard_Integer number) {
    const Handle(Standard_Transient)& item = model.Value(number);
    if (!item->IsKind(STANDARD_TYPE(StepRepr_RepresentationItem))) return std::nullopt;
    const Handle(Interface_Check)& check = model.Check(number, Standard_True);
    if (check->HasFailed()) return in_one_line(check->CFail(1));
    if (const auto point = Handle(StepGeom_CartesianPoint)::DownCast(item)) {
        for (Standard_Integer i = 1; i <= point->NbCoordinates(); ++i)
            if (!std::isfinite(point->CoordinatesValue(i))) return "a coordinate is not a finite number";
    } else if (const auto vertex = Handle(StepShape_VertexPoint)::DownCast(item)) {
        const auto place = Handle(StepGeom_CartesianPoint)::DownCast(vertex->VertexGeometry());
        if (place.IsNull() || place->NbCoordinates() != 3) return "the vertex is not at a point in space";
    }
    return std::nullopt;
}

/// What makes the model unfit for use, if anything does: any fault of syntax and any reference to an entity
/// that is not there, for then a part is missing; and any fault of geometry or topology.
std::optional<std::string> find_damage(const StepData_StepModel& model) {
    if (model.GlobalCheck()->HasFailed()) return in_one_line(model.GlobalCheck()->CFail(1));
    for (Standard_Integer i = 1; i <= model.NbEntities(); ++i)
        if (const auto fault = find_fault(model, i))
            return "entity " + std::string(model.StringLabel(model.Value(i))->ToCString()) + ": " + *fault;
    return std::nullopt;
}

/// The units that a context declares; null where the entity is no such context.
Handle(StepRepr_GlobalUnitAssignedContext) declared_units(const Handle(Standard_Transient) & entity) {
    using Toleranced = StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx;
    using Plain = StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext;
    if (const auto context = Handle(Toleranced)::DownCast(entity))
        return context->GlobalUnitAssignedContext();
    if (const auto context = Handle(Plain)::DownCast(entity)) return context->GlobalUnitAssignedContext();
    return {};
}

/// The unit of length of the whole file: the one that all its contexts declare. Where they differ, or name
/// one that is not known here, it is the millimetre, which Open CASCADE converts all lengths to.
LengthUnit find_length_unit(const StepData_StepModel& model) {
    std::optional<double> millimetres;
    for (Standard_Integer i = 1; i <= model.NbEntities(); ++i) {
        const auto units = declared_units(model.Value(i));
        if (units.IsNull()) continue;
        STEPConstruct_UnitContext factors;
        factors.ComputeFactors(units);
        if (!factors.LengthDone()) continue;
        if (millimetres && *millimetres != factors.LengthFactor()) return kMillimetre;
        millimetres = factors.LengthFactor();
    }
    for (const LengthUnit& unit : kLengthUnits)
        if (millimetres && std::abs(*millimetres - unit.millimetres) <= 1e-9 * unit.millimetres) return unit;
    return kMillimetre;
}

void append_vertices(const TopoDS_Shape& shape, const LengthUnit& unit, PointSet& points) {
    TopTools_IndexedMapOfShape vertices;
    TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
    for (Standard_Integer i = 1; i <= vertices.Extent(); ++i) {
        const gp_Pnt point = BRep_Tool::Pnt(TopoDS::Vertex(vertices(i)));
        points.positions.push_back(
            {point.X() / unit.millimetres, point.Y() / unit.millimetres, point.Z() / unit.millimetres});
        points.entities.push_back({EntityKind::vertex, i, "point"});
    }
}

Input read_step(const std::string& path) {
    std::istringstream text(read_step_text(path));

    const OcctSession session;
    STEPControl_Reader reader;
    if (reader.ReadStream(path.c_str(), text) != IFSelect_RetDone || reader.StepModel().IsNull())
        fail_damaged(path, "its text cannot be parsed");
    reader.SetSystemLengthUnit(kMillimetre.millimetres);
    const StepData_StepModel& model = *reader.StepModel();
    const std::string no_geometry = path + ": the STEP file holds no geometry with vertices";
    if (model.NbEntities() == 0) throw Error(ErrorCode::invalid_input, no_geometry);
    if (const auto damage = find_damage(model)) fail_damaged(path, *damage);

    Input input;
    input.path = path;
    input.format = "step";
    const LengthUnit unit = find_length_unit(model);
    input.unit = unit.name;
    reader.TransferRoots();
    if (const TopoDS_Shape shape = reader.OneShape(); !shape.IsNull())
        append_vertices(shape, unit, input.points);
    if (input.points.positions.empty()) throw Error(ErrorCode::invalid_input, no_geometry);
    return input;
}

}  // namespace

Input read_model_file(const std::string& path) {
    try {
        return read_step(path);
    } catch (const Error&) {
        throw;
    } catch (const Standard_Failure& failure) {
        fail_damaged(path, std::string("Open CASCADE gave up on it (") + failure.DynamicType()->Name() + ")");
    } catch (const std::exception& failure) {
        fail_reading(path, std::string("reading failed: ") + failure.what());
    } catch (...) {
        fail_reading(path, "reading failed for an unknown reason");
    }
}

bool is_model_path(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return std::find(kStepEndings.begin(), kStepEndings.end(), ending) != kStepEndings.end();
}

}  // namespace insym
