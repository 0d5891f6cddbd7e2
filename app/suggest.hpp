// "Did you mean ...?" for names that do not exist.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace insym::app {

/// "; did you mean NAME?" with the nearest of `names`, or nothing if none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);

}  // namespace insym::app
