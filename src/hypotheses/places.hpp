// Isometries as places: what the counts of votes and of candidates that agree have in common.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace insym {

/// The direction of a point outside the set, whose image tells isometries apart.
inline const Eigen::Vector3d kOutside(0.31, 0.74, 0.597);

/// One more number of a key: any change of it changes all bits.
inline std::uint64_t mixed(std::uint64_t key, std::int64_t number) {
    key += static_cast<std::uint64_t>(number);
    key ^= key >> 31U;
    key *= 0x9E3779B97F4A7C15ULL;
    return key ^ (key >> 29U);
}

}  // namespace insym
