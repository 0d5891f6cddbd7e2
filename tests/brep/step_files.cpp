#include "brep/step_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Shape.hxx>
#include <unistd.h>

namespace insym::test {

ScratchFolder::ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "insym_brep_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder");
    folder_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

std::string ScratchFolder::write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return path(name);
}

std::string step_text(const TopoDS_Shape& shape) {
    auto& printers = Message::DefaultMessenger()->ChangePrinters();
    const Message_SequenceOfPrinters saved = printers;
    printers.Clear();
    const ScratchFolder folder;
    STEPControl_Writer writer;
    const bool done = writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone &&
                      writer.Write(folder.path("shape.step").c_str()) == IFSelect_RetDone;
    printers = saved;
    if (!done) throw std::runtime_error("Open CASCADE wrote no STEP file");
    return read_text(folder.path("shape.step"));
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::runtime_error("nothing to replace");
    for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
    return text;
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::vector<Point> box_corners(const Point& low, const Point& high) {
    std::vector<Point> corners;
    for (const double x : {low[0], high[0]})
        for (const double y : {low[1], high[1]})
            for (const double z : {low[2], high[2]}) corners.push_back({x, y, z});
    return corners;
}

bool same_points(std::vector<Point> a, std::vector<Point> b, double tolerance) {
    if (a.size() != b.size()) return false;
    for (const Point& p : a) {
        const auto partner = std::find_if(b.begin(), b.end(), [&](const Point& q) {
            return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) <= tolerance;
        });
        if (partner == b.end()) return false;
        b.erase(partner);
    }
    return true;
}

}  // namespace insym::test
