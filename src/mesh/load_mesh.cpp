#include "insym/error.hpp"

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "mesh/triangle_mesh.hpp"

namespace insym {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
    throw Error(ErrorCode::cannot_read, path + ": " + why);
}

std::string read_bytes(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) fail(path, "is a directory, not a mesh");
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        fail(path, "cannot be opened: " + std::generic_category().message(errno != 0 ? errno : ENOENT));
    std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (stream.bad()) fail(path, "reading failed part way");
    if (bytes.empty()) fail(path, "the file is empty");
    return bytes;
}

/// The library takes an STL file that breaks off for whole.
void check_stl(const std::string& path, std::string_view bytes) {
    constexpr std::size_t kHeader = 80, kTriangle = 50;
    std::uint32_t count = 0;
    if (bytes.size() >= kHeader + sizeof count) std::memcpy(&count, bytes.data() + kHeader, sizeof count);
    const std::size_t binary_size = kHeader + sizeof count + kTriangle * std::size_t{count};
    if (bytes.size() >= kHeader + sizeof count && bytes.size() == binary_size) return;
    const std::size_t start = bytes.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos || !bytes.substr(start).starts_with("solid"))
        fail(path,
             "is not an STL file, or a damaged one: its size is not that of the triangles that it announces");
    if (bytes.rfind("endsolid") == std::string_view::npos)
        fail(path, "the STL file is damaged: it stops before its end, the word endsolid");
}

void append(const std::string& path, const aiMesh& part, TriangleMesh& mesh) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        const aiVector3D& p = part.mVertices[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            fail(path, "the mesh is damaged: a coordinate is not a finite number");
        mesh.vertices.emplace_back(p.x, p.y, p.z);
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
        const aiFace& face = part.mFaces[i];
        if (face.mNumIndices != 3) continue;  // points and lines
        std::array<int, 3> triangle{};
        for (unsigned k = 0; k < 3; ++k) {
            if (face.mIndices[k] >= part.mNumVertices)
                fail(path, "the mesh is damaged: a face has no such vertex");
            triangle[k] = first + static_cast<int>(face.mIndices[k]);
        }
        mesh.triangles.push_back(triangle);
    }
}

}  // namespace

TriangleMesh load_mesh(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const std::string bytes = read_bytes(path);
    if (ending == ".stl") check_stl(path, bytes);
    Assimp::Importer importer;
    // From memory: the library must not follow names in the file to others, such as an OBJ's materials.
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate,
                                                       ending.substr(1).c_str());
    if (scene == nullptr) fail(path, std::string("the mesh cannot be read: ") + importer.GetErrorString());
    TriangleMesh mesh;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) append(path, *scene->mMeshes[i], mesh);
    return mesh;
}

}  // namespace insym
