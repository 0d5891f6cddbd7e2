// Oracle: a known answer. The model named on the command line has points, and they have symmetries.
#include "insym/detect.hpp"
#include "insym/read_model.hpp"

#include <iostream>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const insym::Input model = insym::read_model_file(argv[1]);
    const insym::DetectResult result = insym::detect(model.points);
    std::cout << model.points.size() << " points, " << result.symmetries.size() << " symmetries\n";
    return result.symmetries.empty() ? 1 : 0;
}
