#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "hypotheses/generators.hpp"
#include "parallel_for.hpp"

namespace insym {
namespace {

/// Halves that overlap, across the longest side, until they are small: what is near stands in one of them.
void add_neighbourhoods(const Cloud& cloud, SearchGroup members, std::size_t most,
                        std::vector<SearchGroup>& out) {
    constexpr double kShare = 0.55;  // of the members in each half
    if (members.size() <= most) {
        out.push_back(std::move(members));
        return;
    }
    Eigen::Vector3d low = cloud[members.front()], high = low;
    for (const int i : members) {
        low = low.cwiseMin(cloud[i]);
        high = high.cwiseMax(cloud[i]);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    std::sort(members.begin(), members.end(), [&](int a, int b) {
        return cloud[a][axis] != cloud[b][axis] ? cloud[a][axis] < cloud[b][axis] : a < b;
    });
    const auto part = static_cast<std::ptrdiff_t>(std::ceil(kShare * static_cast<double>(members.size())));
    add_neighbourhoods(cloud, SearchGroup(members.begin(), members.begin() + part), most, out);
    add_neighbourhoods(cloud, SearchGroup(members.end() - part, members.end()), most, out);
}

/// Points whose nearest neighbours lie alike: the same corner of each copy of a part, wherever these are.
/// Distances are told apart in steps of a tenth.
using Likeness = std::array<int, 4>;

Likeness likeness(const Cloud& cloud, int i) {
    constexpr double kStep = 0.1;
    std::array<double, Likeness{}.size()> nearest{};
    cloud.nearest_distances(i, nearest);
    Likeness out{};
    for (std::size_t k = 0; k < nearest.size(); ++k)
        out[k] = nearest[k] > 0 ? static_cast<int>(std::floor(std::log(nearest[k]) / kStep)) : 0;
    return out;
}

void add_alike(const Cloud& cloud, const SearchGroup& members, std::size_t most,
               std::vector<SearchGroup>& out) {
    std::vector<Likeness> each(members.size());
    parallel_for(members.size(), [&](std::size_t k) { each[k] = likeness(cloud, members[k]); });
    std::map<Likeness, SearchGroup> alike;
    for (std::size_t k = 0; k < members.size(); ++k) alike[each[k]].push_back(members[k]);
    for (auto& [_, group] : alike)
        if (group.size() >= 3) add_neighbourhoods(cloud, std::move(group), most, out);
}

}  // namespace

std::vector<SearchGroup> search_groups(const Cloud& cloud, const SearchGroup& points, std::size_t most) {
    std::map<int, SearchGroup> classes;
    for (const int i : points) classes[cloud.label(i)].push_back(i);
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
        add_neighbourhoods(cloud, members, most / 4, groups);
        add_alike(cloud, members, most / 4, groups);
    }
    return groups;
}

}  // namespace insym
