// Binary OFF, as Geomview defines it. Assimp reads OFF as text only.
#pragma once

#include <string>
#include <string_view>

#include "mesh/triangle_mesh.hpp"

namespace insym {

/// True if the head is that of a binary OFF file: a keyword that ends in OFF, and BINARY.
bool is_binary_off(std::string_view bytes);

/// `path` is for messages. O(n), and no more memory than the bytes that are there justify. Throws
/// Error(cannot_read).
TriangleMesh read_binary_off(const std::string& path, std::string_view bytes);

}  // namespace insym
