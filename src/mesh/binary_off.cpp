#include "mesh/binary_off.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/triangulate.hpp"

namespace insym {
namespace {

constexpr std::string_view kBlank = " \t\r";

/// The numbers of the file: four bytes each, the highest first.
constexpr std::size_t kWord = 4;

/// A face has at least its number of corners and its number of colours.
constexpr std::size_t kLeastFaceWords = 2;

/// An index, or red, green, blue and how opaque.
constexpr std::int32_t kMostColours = 4;

[[noreturn]] void fail_damaged(const std::string& path, const std::string& why) {
    throw Error(ErrorCode::cannot_read, path + ": the binary OFF file is damaged: " + why);
}

struct Head {
    std::string_view prefixes;  ///< of the keyword: what a vertex has, [ST][C][N][4][n]
    std::size_t size = 0;       ///< in bytes
};

std::string_view take_word(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(kBlank));
    line.remove_prefix(word.size());
    return word;
}

/// The first line that is neither empty nor a comment must be the keyword and BINARY, and nothing else.
std::optional<Head> find_head(std::string_view bytes) {
    for (std::size_t start = 0; start < bytes.size();) {
        const std::size_t end = bytes.find('\n', start);
        if (end == std::string_view::npos) break;
        std::string_view line = bytes.substr(start, end - start);
        start = end + 1;
        const std::string_view keyword = take_word(line);
        if (keyword.empty() || keyword.front() == '#') continue;
        if (!keyword.ends_with("OFF") || take_word(line) != "BINARY" || !take_word(line).empty()) break;
        return Head{keyword.substr(0, keyword.size() - 3), start};
    }
    return std::nullopt;
}

/// The numbers after the head, one after the other.
class Words {
public:
    Words(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

    std::size_t left() const { return bytes_.size() / kWord; }
    bool at_end() const { return bytes_.empty(); }

    std::int32_t integer() { return std::bit_cast<std::int32_t>(word()); }
    float real() { return std::bit_cast<float>(word()); }

    /// The number of things that take at least `words` words each; so many must still be there.
    std::size_t checked(std::int32_t number, const char* of_what, std::size_t words) const {
        if (number < 0 || static_cast<std::size_t>(number) > left() / words)
            fail_damaged(path_, "it announces " + std::to_string(number) + " " + of_what +
                                    " and has no room for them");
        return static_cast<std::size_t>(number);
    }

    /// There must be as many.
    void skip(std::size_t words) { bytes_.remove_prefix(words * kWord); }

private:
    std::uint32_t word() {
        if (left() == 0) fail_damaged(path_, "it stops before its end");
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < kWord; ++i) value = value << 8U | static_cast<unsigned char>(bytes_[i]);
        skip(1);
        return value;
    }

    const std::string& path_;
    std::string_view bytes_;
};

/// What a vertex has, by the keyword: its place, then its normal, colour and place in a texture.
struct VertexLayout {
    bool homogeneous = false;
    std::size_t rest = 0;  ///< words after the place
};

VertexLayout find_layout(const std::string& path, std::string_view prefixes) {
    VertexLayout layout;
    const auto take = [&](std::string_view prefix) {
        if (!prefixes.starts_with(prefix)) return false;
        prefixes.remove_prefix(prefix.size());
        return true;
    };
    if (take("ST")) layout.rest += 2;
    if (take("C")) layout.rest += 4;
    if (take("N")) layout.rest += 3;
    layout.homogeneous = take("4");
    if (!prefixes.empty())
        throw Error(
            ErrorCode::cannot_read,
            path + ": the OFF file is not of a mesh in space: its keyword is none of [ST][C][N][4]OFF");
    return layout;
}

void append_vertices(const std::string& path, const VertexLayout& layout, std::size_t count, Words& words,
                     TriangleMesh& mesh) {
    mesh.vertices.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = words.real(), y = words.real(), z = words.real();
        const double w = layout.homogeneous ? words.real() : 1;
        words.skip(layout.rest);
        const Eigen::Vector3d place = Eigen::Vector3d(x, y, z) / w;
        if (!place.allFinite()) fail_damaged(path, "a coordinate is not a finite number");
        mesh.vertices.push_back(place);
    }
}

void append_face(const std::string& path, Words& words, TriangleMesh& mesh) {
    std::vector<int> polygon(words.checked(words.integer(), "corners of a face", 1));
    for (int& corner : polygon) {
        corner = words.integer();
        if (corner < 0 || static_cast<std::size_t>(corner) >= mesh.vertices.size())
            fail_damaged(path, "a face has no such vertex");
    }
    const std::size_t colours = words.checked(words.integer(), "colours of a face", 1);
    if (colours > kMostColours) fail_damaged(path, "a face has more than four numbers for its colour");
    words.skip(colours);
    if (polygon.size() == 3) mesh.triangles.push_back({polygon[0], polygon[1], polygon[2]});
    if (polygon.size() > 3)  // fewer are points and lines
        for (const auto& triangle : triangulate(mesh.vertices, std::move(polygon)))
            mesh.triangles.push_back(triangle);
}

}  // namespace

bool is_binary_off(std::string_view bytes) {
    return find_head(bytes).has_value();
}

TriangleMesh read_binary_off(const std::string& path, std::string_view bytes) {
    const Head head = find_head(bytes).value_or(Head{});
    const VertexLayout layout = find_layout(path, head.prefixes);
    Words words(path, bytes.substr(head.size));
    const std::int32_t vertices = words.integer(), faces = words.integer();
    words.integer();  // the number of edges, which Geomview does not look at either
    TriangleMesh mesh;
    const std::size_t vertex_words = (layout.homogeneous ? 4 : 3) + layout.rest;
    append_vertices(path, layout, words.checked(vertices, "vertices", vertex_words), words, mesh);
    const std::size_t count = words.checked(faces, "faces", kLeastFaceWords);
    for (std::size_t i = 0; i < count; ++i) append_face(path, words, mesh);
    if (!words.at_end()) fail_damaged(path, "it goes on after the faces that it announces");
    return mesh;
}

}  // namespace insym
