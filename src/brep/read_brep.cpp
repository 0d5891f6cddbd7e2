// BREP, Open CASCADE's own format: text or binary to shape.
#include <sstream>
#include <string>
#include <string_view>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>

#include "brep/model_file.hpp"
#include "brep/model_shape.hpp"

namespace insym {
namespace {

constexpr std::string_view kTextStart = "CASCADE Topology V";
constexpr std::string_view kBinaryStart = "Open CASCADE Topology V";

}  // namespace

ModelShape read_brep(const std::string& path) {
    bool binary = false;
    std::string bytes = read_whole_file(path, "a BREP file", [&](std::string_view start) {
        start =
            start.substr(0, 200);  // blank lines and, in old files, the name of a drawing command come first
        binary = start.find(kBinaryStart) != std::string_view::npos;
        if (!binary && start.find(kTextStart) == std::string_view::npos)
            fail_reading(path, "is not a BREP file: it does not begin with " + std::string(kTextStart));
    });
    std::istringstream stream(std::move(bytes));
    ModelShape model;
    if (binary)
        BinTools::Read(model.shape, stream);
    else
        BRepTools::Read(model.shape, stream, BRep_Builder());
    // Both give what they have got so far where the file breaks off.
    if (model.shape.IsNull() || !stream)
        fail_reading(path, "the BREP file is damaged: its content cannot be parsed");
    return model;
}

}  // namespace insym
