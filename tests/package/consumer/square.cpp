// Oracle: a theorem. The symmetries of a square's corners are the dihedral group of order 8: turns by
// 90 and 180 degrees and four mirrors. All the kinds that insym lists must be there, and nothing else.
#include "insym/detect.hpp"
#include "insym/version.hpp"

#include <iostream>
#include <map>

int main() {
    insym::PointSet corners;
    corners.dimension = 2;
    corners.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};

    std::map<std::string_view, int> found;
    for (const insym::Symmetry& symmetry : insym::detect(corners).symmetries)
        ++found[insym::option_letter(symmetry.type)];

    std::cout << "insym " << INSYM_VERSION << ':';
    for (const auto& [type, count] : found) std::cout << ' ' << type << ' ' << count;
    std::cout << '\n';

    // The error of the library must be caught by its type, also across a shared library.
    try {
        insym::detect({});
        return 1;
    } catch (const insym::Error& error) {
        std::cout << error.what() << '\n';
    }
    return found["C"] == 1 && found["C2"] == 1 && found["M"] == 4 ? 0 : 1;
}
