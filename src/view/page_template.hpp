// The page without its data, as a part of the program.
#pragma once

#include <string_view>

namespace insym {

/// viewer/dist/page.html; its source file is made by CMake (embed.cmake).
std::string_view page_template();

}  // namespace insym
