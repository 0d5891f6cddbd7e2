// IGES: text to shape.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <BRepBndLib.hxx>
#include <Bnd_Box.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Check.hxx>
#include <Precision.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include "brep/model_file.hpp"
#include "brep/model_shape.hpp"
#include "brep/sew.hpp"

namespace insym {
namespace {

constexpr std::size_t kSectionColumn = 72;  ///< of a line; from 0

/// Edges of two faces are one within the resolution that the file names for its coordinates, but no less and
/// no more than these shares of the diagonal of the model's box: programs write much too small and much too
/// large ones.
constexpr double kLeastSewing = 1e-6, kMostSewing = 1e-4;

[[noreturn]] void fail_damaged(const std::string& path, const std::string& why) {
    fail_reading(path, "the IGES file is damaged: " + why);
}

/// Lines of 80 columns, of which the 73rd names the section: S first, T on the last line. The reader takes a
/// file without its end for whole.
void check_sections(const std::string& path) {
    const std::string text = read_whole_file(path, "an IGES file", [&](std::string_view start) {
        if (start.size() <= kSectionColumn || start[kSectionColumn] != 'S')
            fail_reading(path, "is not an IGES file: its first line has no S in column 73");
    });
    const std::size_t last = text.find_last_not_of("\r\n ");
    const std::size_t line = text.find_last_of("\r\n", last) + 1;
    if (last < line + kSectionColumn || text[line + kSectionColumn] != 'T')
        fail_damaged(path, "it stops before its end, the line with T in column 73");
}

/// The entities that carry a name and became shapes.
PartNames find_names(const IGESControl_Reader& reader) {
    PartNames names;
    const Handle(Transfer_TransientProcess)& transfer = reader.WS()->TransferReader()->TransientProcess();
    for (Standard_Integer i = 1; i <= transfer->NbMapped(); ++i) {
        const auto entity = Handle(IGESData_IGESEntity)::DownCast(transfer->Mapped(i));
        if (entity.IsNull() || !entity->HasName() || entity->NameValue().IsNull()) continue;
        const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer->MapItem(i));
        if (shape.IsNull() || (shape.ShapeType() != TopAbs_SOLID && shape.ShapeType() != TopAbs_COMPOUND))
            continue;
        names.emplace(shape.TShape().get(), in_one_line(entity->NameValue()->ToCString()));
    }
    return names;
}

double sewing_tolerance(const TopoDS_Shape& shape, double resolution) {
    Bnd_Box box;
    BRepBndLib::AddClose(shape, box);
    if (box.IsVoid() || box.IsOpen()) return Precision::Confusion();
    const double diagonal = std::sqrt(box.SquareExtent());
    return std::clamp(resolution, kLeastSewing * diagonal, kMostSewing * diagonal);
}

}  // namespace

ModelShape read_iges(const std::string& path) {
    check_sections(path);
    IGESControl_Reader reader;
    if (reader.ReadFile(path.c_str()) != IFSelect_RetDone || reader.IGESModel().IsNull())
        fail_damaged(path, "its text cannot be parsed");
    const Handle(IGESData_IGESModel) model = reader.IGESModel();
    if (model->GlobalCheck()->HasFailed()) fail_damaged(path, in_one_line(model->GlobalCheck()->CFail(1)));
    reader.TransferRoots();
    const double millimetres = model->GlobalSection().UnitValue();
    ModelShape result = {reader.OneShape(), find_names(reader), find_unit(millimetres).value_or(kMillimetre)};
    if (result.shape.IsNull()) return result;
    const double resolution = model->GlobalSection().Resolution() * millimetres;
    result.shape = sewn(result.shape, sewing_tolerance(result.shape, resolution), result.names);
    return result;
}

}  // namespace insym
