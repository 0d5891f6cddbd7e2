// What the readers of the three formats return: one shape, its names and its unit.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include <TopoDS_Shape.hxx>
#include <TopoDS_TShape.hxx>

class Standard_Transient;

namespace insym {

struct LengthUnit {
    const char* name;
    double millimetres;
};

inline constexpr LengthUnit kMillimetre = {"mm", 1};

/// The unit with that many millimetres; none where it has no name here.
std::optional<LengthUnit> find_unit(double millimetres);

/// Names of parts and assemblies; placed copies of a part share its TShape.
using PartNames = std::unordered_map<const TopoDS_TShape*, std::string>;

/// A model as Open CASCADE has it: lengths in millimetres, whatever the unit of the file.
struct ModelShape {
    TopoDS_Shape shape;  ///< null where there is no geometry
    PartNames names;
    LengthUnit unit = kMillimetre;  ///< of the file
};

// Each throws Error(cannot_read) with a sentence that says what is wrong with the file. To be called within
// an OcctSession.
ModelShape read_step(const std::string& path);
ModelShape read_iges(const std::string& path);
ModelShape read_brep(const std::string& path);

}  // namespace insym
