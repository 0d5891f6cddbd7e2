// The seven kinds of isometry that insym looks for, and sets of them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace insym {

/// The kind of a symmetry (definitions, section 5). A half-turn is the rotation of order 2; it has
/// a value of its own because it comes from pairs of points, not from longer cycles. In 2D the
/// half-turn is the inversion, and `inversion` and the 3D-only kinds never occur.
enum class SymmetryType : std::uint8_t {
    mirror,               ///< M
    inversion,            ///< I, 3D only
    half_turn,            ///< C of order 2
    rotation,             ///< C
    translation,          ///< T
    glide_reflection,     ///< Z
    rotation_reflection,  ///< S, 3D only
    screw,                ///< W, 3D only
};

inline constexpr std::array<SymmetryType, 8> kAllSymmetryTypes = {SymmetryType::mirror,
                                                                  SymmetryType::inversion,
                                                                  SymmetryType::half_turn,
                                                                  SymmetryType::rotation,
                                                                  SymmetryType::translation,
                                                                  SymmetryType::glide_reflection,
                                                                  SymmetryType::rotation_reflection,
                                                                  SymmetryType::screw};

/// The letter of the report: M I C C T Z S W.
constexpr std::string_view letter(SymmetryType type) {
    constexpr std::array<std::string_view, 8> letters = {"M", "I", "C", "C", "T", "Z", "S", "W"};
    return letters[static_cast<std::size_t>(type)];
}

/// The letter of the command line, where C2 stands for half-turns: M I C2 C T Z S W.
constexpr std::string_view option_letter(SymmetryType type) {
    return type == SymmetryType::half_turn ? std::string_view("C2") : letter(type);
}

/// True for the kinds that come from pairs of points: M, I and the half-turn.
constexpr bool is_pair_type(SymmetryType type) {
    return type <= SymmetryType::half_turn;
}

/// True for the kinds that reverse orientation in `dimension` 2 or 3.
constexpr bool is_improper(SymmetryType type, int dimension) {
    return type == SymmetryType::mirror || type == SymmetryType::glide_reflection ||
           type == SymmetryType::rotation_reflection || (type == SymmetryType::inversion && dimension == 3);
}

/// A set of kinds.
class TypeSet {
public:
    constexpr TypeSet() = default;
    static constexpr TypeSet all() {
        TypeSet set;
        set.bits_ = 0xff;
        return set;
    }
    constexpr bool contains(SymmetryType type) const { return (bits_ & bit(type)) != 0; }
    constexpr void insert(SymmetryType type) { bits_ = static_cast<std::uint8_t>(bits_ | bit(type)); }
    constexpr bool empty() const { return bits_ == 0; }
    constexpr bool operator==(const TypeSet&) const = default;
    friend constexpr TypeSet operator&(TypeSet a, TypeSet b) {
        a.bits_ = static_cast<std::uint8_t>(a.bits_ & b.bits_);
        return a;
    }

private:
    static constexpr std::uint8_t bit(SymmetryType type) {
        return static_cast<std::uint8_t>(1U << static_cast<unsigned>(type));
    }
    std::uint8_t bits_ = 0;
};

}  // namespace insym
