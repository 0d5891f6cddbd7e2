// An Input or an Error as bytes between two processes of the same program.
#pragma once

#include "insym/error.hpp"
#include "insym/point_set.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace insym {

using Outcome = std::variant<Input, Error>;

std::string to_bytes(const Outcome& outcome);

/// None if the bytes are not what to_bytes() makes, as from a process that died or went wrong.
std::optional<Outcome> from_bytes(std::string_view bytes);

}  // namespace insym
