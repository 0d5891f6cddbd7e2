#include "symmetries/clusters.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace insym {
namespace {

/// Disjoint components that know, beside who they hold, in which direction each member runs relative
/// to the component's root, and whether the edges agree on it.
class Components {
public:
    Components(std::size_t members, const std::vector<double>& tolerance_max)
        : parent_(members), next_(members), reversed_(members, 0), parts_(members) {
        std::iota(parent_.begin(), parent_.end(), 0);
        std::iota(next_.begin(), next_.end(), 0);
        for (std::size_t i = 0; i < members; ++i) parts_[i].top = tolerance_max[i];
    }

    struct Part {
        std::size_t members = 1;
        std::size_t edges = 0;
        double tolerance = 0;  // the largest of its edges
        double top = 0;        // the least E_max
        bool agrees = true;
        std::vector<int> recorded;  // clusters of this component that no later one holds
        bool complete() const { return edges == members * (members - 1) / 2; }
    };

    /// The root of i; sets `reversed` to i's direction relative to it.
    int root(int i, char& reversed) {
        reversed = 0;
        int r = i;
        for (; parent(r) != r; r = parent(r)) reversed = static_cast<char>(reversed ^ direction(r));
        // Hang the whole path below the root.
        char rest = reversed;
        while (parent(i) != r && i != r) {
            const int next = parent(i);
            const char own = direction(i);
            parent_[static_cast<std::size_t>(i)] = r;
            reversed_[static_cast<std::size_t>(i)] = rest;
            rest = static_cast<char>(rest ^ own);
            i = next;
        }
        return r;
    }

    Part& part(int root) { return parts_[static_cast<std::size_t>(root)]; }

    /// Ascending.
    std::vector<int> members_with(int i) const {
        std::vector<int> out{i};
        for (int m = next(i); m != i; m = next(m)) out.push_back(m);
        std::sort(out.begin(), out.end());
        return out;
    }

    /// Adds an edge; returns the root of the component that it is in now.
    int connect(const Consistency& edge) {
        char a = 0, b = 0;
        int ra = root(edge.first, a);
        int rb = root(edge.second, b);
        const char between = static_cast<char>(a ^ b ^ static_cast<char>(edge.reversed));
        if (ra == rb) {
            if (between != 0) part(ra).agrees = false;
        } else {
            if (part(ra).members < part(rb).members) std::swap(ra, rb);
            parent_[static_cast<std::size_t>(rb)] = ra;
            reversed_[static_cast<std::size_t>(rb)] = between;
            std::swap(next_[static_cast<std::size_t>(ra)], next_[static_cast<std::size_t>(rb)]);
            absorb(part(ra), part(rb));
        }
        ++part(ra).edges;
        part(ra).tolerance = std::max(part(ra).tolerance, edge.tolerance);
        return ra;
    }

private:
    int parent(int i) const { return parent_[static_cast<std::size_t>(i)]; }
    int next(int i) const { return next_[static_cast<std::size_t>(i)]; }
    char direction(int i) const { return reversed_[static_cast<std::size_t>(i)]; }

    static void absorb(Part& into, Part& from) {
        into.members += from.members;
        into.recorded.insert(into.recorded.end(), from.recorded.begin(), from.recorded.end());
        into.edges += from.edges;
        into.tolerance = std::max(into.tolerance, from.tolerance);
        into.top = std::min(into.top, from.top);
        into.agrees = into.agrees && from.agrees;
        from = Part{};
    }

    std::vector<int> parent_;
    std::vector<int> next_;  // the members of each component in a ring
    std::vector<char> reversed_;
    std::vector<Part> parts_;
};

}  // namespace

Clustering complete_components(std::size_t members, std::vector<Consistency> edges,
                               const std::vector<double>& tolerance_max, double resolution) {
    if (edges.empty()) return {{}, std::vector<char>(members, 0), 0};
    // Most edges enter with the first, in any order.
    const auto lower = [](const Consistency& a, const Consistency& b) { return a.tolerance < b.tolerance; };
    const double least = std::min_element(edges.begin(), edges.end(), lower)->tolerance;
    const auto later = std::partition(
        edges.begin(), edges.end(), [&](const Consistency& e) { return e.tolerance <= least + resolution; });
    std::sort(later, edges.end(), [](const Consistency& a, const Consistency& b) {
        return std::tie(a.tolerance, a.first, a.second) < std::tie(b.tolerance, b.first, b.second);
    });
    Components components(members, tolerance_max);
    Clustering result;
    result.clustered.assign(members, 0);

    const auto record = [&](int root, double level) {
        Components::Part& part = components.part(root);
        if (!part.complete() || !(level < part.top)) return;
        if (!part.agrees) {
            ++result.frustrated;
            return;
        }
        Cluster cluster;
        cluster.tolerance = part.tolerance;
        cluster.members = components.members_with(root);
        char first = 0;
        components.root(cluster.members.front(), first);
        for (const int m : cluster.members) {
            char own = 0;
            components.root(m, own);
            cluster.reversed.push_back(static_cast<char>(own ^ first));
            result.clustered[static_cast<std::size_t>(m)] = 1;
        }
        for (const int inner : part.recorded)
            result.clusters[static_cast<std::size_t>(inner)].maximal = false;
        part.recorded = {static_cast<int>(result.clusters.size())};
        result.clusters.push_back(std::move(cluster));
    };

    std::vector<int> touched;
    std::vector<char> is_touched(members, 0);
    const auto touch = [&](int i) {
        char& known = is_touched[static_cast<std::size_t>(i)];
        if (known == 0) touched.push_back(i);
        known = 1;
    };
    for (std::size_t k = 0; k < edges.size();) {
        const double level = k == 0 ? least : edges[k].tolerance;
        double highest = level;
        touched.clear();
        for (; k < edges.size() && edges[k].tolerance <= level + resolution; ++k) {
            highest = std::max(highest, edges[k].tolerance);
            touch(components.connect(edges[k]));
        }
        // Some have become part of others since.
        std::vector<int> connected;
        connected.swap(touched);
        for (const int t : connected) is_touched[static_cast<std::size_t>(t)] = 0;
        for (const int t : connected) {
            char ignored = 0;
            touch(components.root(t, ignored));
        }
        std::sort(touched.begin(), touched.end());
        for (const int root : touched) {
            is_touched[static_cast<std::size_t>(root)] = 0;
            record(root, highest);
        }
    }
    return result;
}

}  // namespace insym
