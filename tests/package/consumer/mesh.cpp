// Oracle: a known answer. A tetrahedron with three equal edges at right angles, as a mesh, has three mirrors.
#include "insym/detect.hpp"
#include "insym/read_mesh.hpp"

#include <algorithm>
#include <fstream>
#include <iostream>

int main() {
    std::ofstream("tetrahedron.off")
        << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    const insym::Input mesh = insym::read_mesh_file("tetrahedron.off");
    const insym::DetectResult result = insym::detect(mesh.points);
    const auto mirrors = std::count_if(
        result.symmetries.begin(), result.symmetries.end(),
        [](const insym::Symmetry& s) { return s.type == insym::SymmetryType::mirror && s.coverage == 1; });
    std::cout << mesh.points.size() << " points, " << mirrors << " mirrors\n";
    return mesh.points.size() == 4 + 6 + 4 && mirrors == 3 ? 0 : 1;
}
