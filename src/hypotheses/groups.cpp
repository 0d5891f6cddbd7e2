#include <algorithm>
#include <map>
#include <numeric>

#include "hypotheses/generators.hpp"

namespace insym {

std::vector<SearchGroup> search_groups(const Cloud& cloud, std::size_t most) {
    std::map<int, SearchGroup> classes;
    for (int i = 0; i < cloud.size(); ++i) classes[cloud.label(i)].push_back(i);
    std::vector<SearchGroup> groups;
    for (auto& [label, members] : classes) {
        if (members.size() < 2) continue;
        if (members.size() <= most) {
            groups.push_back(std::move(members));
            continue;
        }
        // Mates under a symmetry of the whole are equally far from the middle: shells keep them together.
        std::stable_sort(members.begin(), members.end(),
                         [&](int a, int b) { return cloud[a].squaredNorm() > cloud[b].squaredNorm(); });
        groups.emplace_back(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(most));
        // Neighbourhoods along the three axes of the input: what is meant locally is near.
        for (int axis = 0; axis < 3; ++axis) {
            SearchGroup sorted = members;
            std::stable_sort(sorted.begin(), sorted.end(),
                             [&](int a, int b) { return cloud[a][axis] < cloud[b][axis]; });
            const std::size_t size = most / 3;
            for (std::size_t start = 0; start < sorted.size(); start += size / 2) {
                const std::size_t end = std::min(sorted.size(), start + size);
                groups.emplace_back(sorted.begin() + static_cast<std::ptrdiff_t>(start),
                                    sorted.begin() + static_cast<std::ptrdiff_t>(end));
                if (end == sorted.size()) break;
            }
        }
    }
    return groups;
}

}  // namespace insym
