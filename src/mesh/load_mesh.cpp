#include "insym/error.hpp"

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include "mesh/binary_off.hpp"
#include "mesh/triangle_mesh.hpp"
#include "mesh/triangulate.hpp"

namespace insym {
namespace {

/// The steps that the library offers end the program on some damaged meshes.
constexpr unsigned kNoProcessing = 0;

constexpr int kLongestLine = 1000;

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

/// Of a PLY file in text, each element is a line.
void check_ply(const std::string& path, const std::string& bytes) {
    const std::size_t end = bytes.find("end_header");
    if (end == std::string::npos) fail(path, "is not a PLY file, or a damaged one: its head has no end");
    if (bytes.rfind("format ascii", end) == std::string::npos) return;
    std::size_t wanted = 0;
    std::istringstream head(bytes.substr(0, end)), body(bytes.substr(end));
    for (std::string word, name; head >> word;) {
        std::size_t count = 0;
        if (word == "element" && head >> name >> count) wanted += count;
    }
    std::size_t lines = 0;
    std::string line;
    std::getline(body, line);
    while (lines < wanted && std::getline(body, line))
        lines += line.find_first_not_of(" \t\r") != line.npos ? 1 : 0;
    if (lines < wanted) fail(path, "the PLY file is damaged: it stops before its end");
}

/// How many faces the head of an OFF or PLY file announces; 0 where it is neither. Such a file that breaks
/// off is taken for whole, too.
std::size_t announced_faces(std::string_view ending, const std::string& bytes) {
    std::size_t count = 0;
    if (ending == ".ply") {
        constexpr std::string_view kElement = "element face ";
        if (const std::size_t at = bytes.find(kElement); at != std::string::npos)
            std::istringstream(bytes.substr(at + kElement.size(), 20)) >> count;
    } else if (ending == ".off") {
        std::istringstream head(bytes.substr(0, 10000));
        std::vector<std::size_t> numbers;
        for (std::string line; numbers.size() < 2 && std::getline(head, line);) {
            std::istringstream words(line.substr(0, line.find('#')));
            std::size_t number = 0;
            if (words.str().find("OFF") != std::string::npos) words.ignore(kLongestLine, 'F').ignore(1);
            while (words >> number) numbers.push_back(number);
        }
        if (numbers.size() >= 2) count = numbers[1];
    }
    return count;
}

/// Returns how many faces there are.
std::size_t append(const std::string& path, const aiMesh& part, TriangleMesh& mesh) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        const aiVector3D& p = part.mVertices[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            fail(path, "the mesh is damaged: a coordinate is not a finite number");
        mesh.vertices.emplace_back(p.x, p.y, p.z);
    }
    std::size_t count = 0;
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
        const aiFace& face = part.mFaces[i];
        std::vector<int> polygon;
        count += face.mNumIndices > 0 ? 1 : 0;
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            if (face.mIndices[k] >= part.mNumVertices)
                fail(path, "the mesh is damaged: a face has no such vertex");
            polygon.push_back(first + static_cast<int>(face.mIndices[k]));
        }
        if (polygon.size() == 3)
            mesh.triangles.push_back({polygon[0], polygon[1], polygon[2]});
        else if (polygon.size() > 3)  // fewer are points and lines
            for (const auto& triangle : triangulate(mesh.vertices, polygon))
                mesh.triangles.push_back(triangle);
    }
    return count;
}

}  // namespace

TriangleMesh load_mesh(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const std::string bytes = read_bytes(path);
    if (ending == ".stl") check_stl(path, bytes);
    if (ending == ".ply") check_ply(path, bytes);
    if (ending == ".off" && is_binary_off(bytes)) return read_binary_off(path, bytes);
    Assimp::Importer importer;
    // From memory: the library must not follow names in the file to others, such as an OBJ's materials.
    const aiScene* scene =
        importer.ReadFileFromMemory(bytes.data(), bytes.size(), kNoProcessing, ending.substr(1).c_str());
    if (scene == nullptr) fail(path, std::string("the mesh cannot be read: ") + importer.GetErrorString());
    TriangleMesh mesh;
    std::size_t faces = 0;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) faces += append(path, *scene->mMeshes[i], mesh);
    if (const std::size_t announced = announced_faces(ending, bytes); faces < announced)
        fail(path, "the mesh is damaged: it announces " + std::to_string(announced) + " faces and has " +
                       std::to_string(faces));
    return mesh;
}

}  // namespace insym
