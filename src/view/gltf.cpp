// The drawing as a scene in glTF 2.0, binary (.glb): metres, y up.
#include "insym/view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "view/drawing.hpp"

namespace insym {
namespace {

/// sRGB as linear light, which glTF has.
double linear(float x) {
    return x <= 0.04045F ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

class Scene {
public:
    explicit Scene(const std::string& unit) {
        gltf_.asset.version = "2.0";
        gltf_.asset.generator = "insym";
        gltf_.buffers.emplace_back();
        tinygltf::Node root;
        root.name = "insym";
        root.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // from z up
        root.scale = std::vector<double>(3, metres(unit));
        gltf_.nodes.push_back(root);
        gltf_.scenes.emplace_back();
        gltf_.scenes[0].nodes = {0};
        gltf_.defaultScene = 0;
    }

    void add(const Part& part) {
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.attributes["POSITION"] = positions(part.mesh.positions);
        primitive.attributes["NORMAL"] = accessor(part.mesh.normals, TINYGLTF_COMPONENT_TYPE_FLOAT,
                                                  TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
        primitive.indices = accessor(part.mesh.triangles, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                     TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        primitive.material = material(part);
        tinygltf::Mesh mesh;
        mesh.name = part.name;
        mesh.primitives.push_back(primitive);
        gltf_.meshes.push_back(mesh);
        tinygltf::Node node;
        node.name = part.name;
        node.mesh = static_cast<int>(gltf_.meshes.size()) - 1;
        gltf_.nodes.push_back(node);
        gltf_.nodes[0].children.push_back(static_cast<int>(gltf_.nodes.size()) - 1);
    }

    void write(std::ostream& out) {
        tinygltf::TinyGLTF writer;
        if (!writer.WriteGltfSceneToStream(&gltf_, out, false, true))
            throw std::runtime_error("tinygltf cannot write the scene");
    }

private:
    static double metres(const std::string& unit) {
        static const std::map<std::string, double> kMetres = {
            {"mm", 1e-3}, {"cm", 1e-2},     {"m", 1},         {"km", 1e3},
            {"um", 1e-6}, {"inch", 0.0254}, {"mil", 2.54e-5}, {"ft", 0.3048}};
        const auto known = kMetres.find(unit);
        return known == kMetres.end() ? 1 : known->second;
    }

    /// The items, all of 4-byte numbers, at the end of the buffer.
    template <class Number>
    int accessor(const std::vector<std::array<Number, 3>>& items, int component, int type, int target) {
        std::vector<unsigned char>& bytes = gltf_.buffers[0].data;
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = bytes.size();
        view.byteLength = items.size() * sizeof items[0];
        view.target = target;
        bytes.resize(bytes.size() + view.byteLength);
        std::memcpy(bytes.data() + view.byteOffset, items.data(), view.byteLength);
        gltf_.bufferViews.push_back(view);
        tinygltf::Accessor accessor;
        accessor.bufferView = static_cast<int>(gltf_.bufferViews.size()) - 1;
        accessor.componentType = component;
        accessor.type = type;
        accessor.count = items.size() * (type == TINYGLTF_TYPE_SCALAR ? 3 : 1);
        gltf_.accessors.push_back(accessor);
        return static_cast<int>(gltf_.accessors.size()) - 1;
    }

    /// The standard wants their bounds.
    int positions(const std::vector<std::array<float, 3>>& items) {
        const int index =
            accessor(items, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
        tinygltf::Accessor& made = gltf_.accessors[static_cast<std::size_t>(index)];
        made.minValues.assign(items.front().begin(), items.front().end());
        made.maxValues = made.minValues;
        for (const auto& item : items)
            for (std::size_t k = 0; k < 3; ++k) {
                made.minValues[k] = std::min<double>(made.minValues[k], item[k]);
                made.maxValues[k] = std::max<double>(made.maxValues[k], item[k]);
            }
        return index;
    }

    int material(const Part& part) {
        constexpr double kOpacity = 0.2;
        tinygltf::Material material;
        material.name = part.name;
        material.doubleSided = true;
        const bool clear = part.kind == PartKind::sheet || part.kind == PartKind::ghost;
        if (clear) material.alphaMode = "BLEND";
        material.pbrMetallicRoughness.baseColorFactor = {linear(part.colour.red), linear(part.colour.green),
                                                         linear(part.colour.blue), clear ? kOpacity : 1};
        material.pbrMetallicRoughness.metallicFactor = 0;
        material.pbrMetallicRoughness.roughnessFactor = 0.7;
        gltf_.materials.push_back(material);
        return static_cast<int>(gltf_.materials.size()) - 1;
    }

    tinygltf::Model gltf_;
};

}  // namespace

void write_gltf(std::ostream& out, const DetectResult& result, const ReportContext& context,
                const Tessellation& model) {
    const Symmetry* first = result.symmetries.empty() ? nullptr : result.symmetries.data();
    Scene scene(context.unit.value_or(""));
    for (const Part& part : draw(result, model, first).parts) scene.add(part);
    scene.write(out);
}

}  // namespace insym
