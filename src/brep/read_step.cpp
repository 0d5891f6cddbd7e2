// STEP: text to shape. What is damaged is refused with a sentence.
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Check.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <STEPControl_Reader.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_CartesianPoint.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_VertexPoint.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include "brep/model_file.hpp"
#include "brep/model_shape.hpp"

namespace insym {
namespace {

constexpr std::string_view kStepStart = "ISO-10303-21;";
constexpr std::string_view kStepEnd = "END-ISO-10303-21";

[[noreturn]] void fail_damaged(const std::string& path, const std::string& why) {
    fail_reading(path, "the STEP file is damaged: " + why);
}

/// The whole file. Its two ends are checked here, because Open CASCADE calls every fault of the text the
/// same.
std::string read_step_text(const std::string& path) {
    std::string text = read_whole_file(path, "a STEP file", [&](std::string_view start) {
        if (start.find(kStepStart) == std::string_view::npos)
            fail_reading(path, "is not a STEP file: it does not begin with " + std::string(kStepStart));
    });
    if (text.rfind(kStepEnd) == std::string::npos)
        fail_damaged(path, "it stops before its end, the line " + std::string(kStepEnd) + ";");
    return text;
}

/// What Open CASCADE says of a fault.
std::string message_of(const Interface_Check& check) {
    std::string line = in_one_line(check.CFail(1));
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
    if (check->HasFailed()) return message_of(*check);
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
    if (model.GlobalCheck()->HasFailed()) return message_of(*model.GlobalCheck());
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
    return find_unit(millimetres.value_or(1)).value_or(kMillimetre);
}

/// The products that became shapes, by those shapes.
PartNames find_names(const STEPControl_Reader& reader) {
    PartNames names;
    const Handle(Transfer_TransientProcess)& transfer = reader.WS()->TransferReader()->TransientProcess();
    for (Standard_Integer i = 1; i <= transfer->NbMapped(); ++i) {
        const auto definition = Handle(StepBasic_ProductDefinition)::DownCast(transfer->Mapped(i));
        if (definition.IsNull() || definition->Formation().IsNull()) continue;
        const Handle(StepBasic_Product)& product = definition->Formation()->OfProduct();
        const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer->MapItem(i));
        if (product.IsNull() || product->Name().IsNull() || shape.IsNull()) continue;
        names.emplace(shape.TShape().get(), in_one_line(product->Name()->ToCString()));
    }
    return names;
}

}  // namespace

ModelShape read_step(const std::string& path) {
    std::istringstream text(read_step_text(path));
    STEPControl_Reader reader;
    if (reader.ReadStream(path.c_str(), text) != IFSelect_RetDone || reader.StepModel().IsNull())
        fail_damaged(path, "its text cannot be parsed");
    reader.SetSystemLengthUnit(kMillimetre.millimetres);
    const StepData_StepModel& model = *reader.StepModel();
    if (model.NbEntities() == 0) return {};
    if (const auto damage = find_damage(model)) fail_damaged(path, *damage);
    reader.TransferRoots();
    return {reader.OneShape(), find_names(reader), find_length_unit(model)};
}

}  // namespace insym
