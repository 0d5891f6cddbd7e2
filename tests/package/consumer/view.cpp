// Oracle: what each kind of file begins with.
#include "insym/view.hpp"

#include "insym/detect.hpp"

#include <iostream>
#include <sstream>

int main() {
    const insym::PointSet corners{.dimension = 2, .positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}};
    const insym::DetectResult result = insym::detect(corners);
    std::ostringstream page, picture, scene;
    insym::write_page(page, result, {}, {});
    insym::write_png(picture, result, {}, {});
    insym::write_gltf(scene, result, {}, {});
    std::cout << page.str().size() << ' ' << picture.str().size() << ' ' << scene.str().size() << " bytes\n";
    const bool good = page.str().starts_with("<!doctype html>") && picture.str().starts_with("\x89PNG") &&
                      scene.str().starts_with("glTF");
    return good ? 0 : 1;
}
