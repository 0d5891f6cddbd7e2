#include "points/near_cells.hpp"

#include <algorithm>
#include <cstddef>

namespace insym {
namespace {

constexpr double kMostCells = 1 << 22;
constexpr double kCellsForEach = 512;  // point; of 27 cells about each then hardly a twentieth are near
constexpr int kBorder = 2;  // cells outside on either side: one that may be near and one that is not

}  // namespace

NearCells::NearCells(const std::vector<Point>& positions)
    : cells_(positions, std::min(kMostCells, kCellsForEach * static_cast<double>(positions.size()) + 4096),
             kBorder),
      largest_reach_(cells_.cell_size() - 1e-5 * cells_.longest_side()),
      bits_(cells_.size() / 64 + 1, 0) {
    for (std::size_t i = 0; i < cells_.points(); ++i)
        for (const float dx : {-1.0F, 0.0F, 1.0F})
            for (const float dy : {-1.0F, 0.0F, 1.0F})
                for (const float dz : {-1.0F, 0.0F, 1.0F}) {
                    const auto at = static_cast<std::size_t>(cells_.cell(
                        cells_.place(i, 0) + dx, cells_.place(i, 1) + dy, cells_.place(i, 2) + dz));
                    bits_[at / 64] |= std::uint64_t{1} << (at % 64);
                }
}

void NearCells::images_near(const Isometry& isometry, std::vector<int>& out) const {
    out.resize(cells_.points() + 1);
    std::size_t count = 0;
    // Without a branch.
    cells_.visit_images(isometry, [&](int point, std::size_t cell) {
        out[count] = point;
        count += bits_[cell / 64] >> (cell % 64) & 1U;
    });
    out.resize(count);
}

}  // namespace insym
