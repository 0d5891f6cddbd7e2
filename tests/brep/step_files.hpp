// What the tests of this folder share: a folder of their own, and STEP files written by Open CASCADE.
#pragma once

#include "insym/point_set.hpp"
#include "insym/read_model.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

class TopoDS_Shape;

namespace insym::test {

/// Points of the vertices alone, without labels.
inline const ReadModelOptions kVertices = {true, false, false, {LabelBy::none}};

/// A folder that is gone when the test is.
class ScratchFolder {
public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    /// Writes a file and returns its path.
    std::string write(const std::string& name, const std::string& text) const;

private:
    std::filesystem::path folder_;
};

/// The text of a STEP file of the shape, lengths in millimetres.
std::string step_text(const TopoDS_Shape& shape);

/// The text with every `from` replaced; there must be one.
std::string replaced(std::string text, std::string_view from, std::string_view to);

std::string read_text(const std::filesystem::path& path);

/// The corners of a box, in no order that matters.
std::vector<Point> box_corners(const Point& low, const Point& high);

/// True if the two are the same points to `tolerance`, in any order: each has its own partner.
bool same_points(std::vector<Point> a, std::vector<Point> b, double tolerance);

}  // namespace insym::test
