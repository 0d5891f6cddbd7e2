#include "cycles/seeds.hpp"

#include <atomic>

#include "parallel_for.hpp"

namespace insym {

Seeds::Seeds(const Scene& scene, const Rows& rows, RunMonitor& monitor)
    : scene_(scene), rows_(rows), monitor_(monitor) {
    if (!listed()) return;
    lists_.resize(static_cast<std::size_t>(scene.size()));
    std::atomic<std::size_t> left_out{0};
    parallel_for(scene.size(), [&](int apex) {
        std::size_t here = 0;
        const auto ask = [&](int a, int c) {
            const bool superfluous = rows_.superfluous(a, apex, c);
            here += superfluous ? 1 : 0;
            return !superfluous;
        };
        find(apex, ask, [&](const Seed& seed) { lists_[static_cast<std::size_t>(apex)].push_back(seed); });
        left_out += here;
    });
    left_out_ = left_out;
}

}  // namespace insym
