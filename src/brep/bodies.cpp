#include "brep/bodies.hpp"

#include <map>

#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>

namespace insym {
namespace {

class BodyFinder {
public:
    explicit BodyFinder(const PartNames& names) : names_(names) {}

    /// `path`: of the shape itself.
    void visit(const TopoDS_Shape& shape, const std::string& path) {
        if (shape.ShapeType() == TopAbs_SOLID) {
            bodies_.push_back({shape, path});
            return;
        }
        if (shape.ShapeType() > TopAbs_SOLID) {
            add_loose({shape}, path);
            return;
        }
        const std::map<std::string, int> counts = count_names(shape);
        std::map<std::string, int> seen;
        std::vector<TopoDS_Shape> loose;
        for (TopoDS_Iterator child(shape); child.More(); child.Next()) {
            if (child.Value().ShapeType() > TopAbs_SOLID) {
                loose.push_back(child.Value());
                continue;
            }
            std::string name = name_of(child.Value());
            if (!name.empty() && counts.at(name) > 1) name += "#" + std::to_string(++seen[name]);
            visit(child.Value(), joined(path, name));
        }
        if (!loose.empty()) add_loose(loose, path);
    }

    std::string name_of(const TopoDS_Shape& shape) const {
        const auto found = names_.find(shape.TShape().get());
        return found == names_.end() ? "" : found->second;
    }

    std::vector<Body> take_bodies() { return std::move(bodies_); }

private:
    static std::string joined(const std::string& path, const std::string& name) {
        return path.empty() || name.empty() ? path + name : path + "/" + name;
    }

    std::map<std::string, int> count_names(const TopoDS_Shape& shape) const {
        std::map<std::string, int> counts;
        for (TopoDS_Iterator child(shape); child.More(); child.Next()) ++counts[name_of(child.Value())];
        return counts;
    }

    /// Shells, faces, edges and vertices side by side are one body: they may adjoin.
    void add_loose(const std::vector<TopoDS_Shape>& shapes, const std::string& path) {
        const BRep_Builder builder;
        TopoDS_Compound body;
        builder.MakeCompound(body);
        for (const TopoDS_Shape& shape : shapes) builder.Add(body, shape);
        bodies_.push_back({body, path});
    }

    const PartNames& names_;
    std::vector<Body> bodies_;
};

}  // namespace

std::vector<Body> find_bodies(const ModelShape& model) {
    BodyFinder finder(model.names);
    finder.visit(model.shape, finder.name_of(model.shape));
    return finder.take_bodies();
}

}  // namespace insym
