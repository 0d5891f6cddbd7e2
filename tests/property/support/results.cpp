#include "property/support/results.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <sstream>

#include "property/support/pose.hpp"
#include "property/support/shapes.hpp"

namespace insym::property {

PointSet point_set(const std::vector<Point>& points, int dimension) {
    PointSet set;
    set.dimension = dimension;
    set.positions = points;
    return set;
}

DetectOptions exact_options() {
    DetectOptions options;
    options.method = Method::paper;
    options.max_tolerance = 1e-4;
    return options;
}

std::vector<int> indices_in(const DetectResult& result, const std::vector<Point>& positions) {
    std::vector<int> indices;
    for (const Point& p : result.points.positions) {
        const auto nearest =
            std::min_element(positions.begin(), positions.end(),
                             [&](const Point& a, const Point& b) { return distance(a, p) < distance(b, p); });
        indices.push_back(static_cast<int>(nearest - positions.begin()));
    }
    return indices;
}

std::string text_of(const CanonicalCycle& cycle) {
    std::ostringstream out;
    out << (cycle.second ? "closed" : "open");
    for (int k : cycle.first) out << ' ' << k;
    return out.str();
}

namespace {

CanonicalCycle renamed(const Sequence& points, bool closed, const std::vector<int>& original) {
    Sequence names;
    for (int k : points) names.push_back(original[static_cast<std::size_t>(k)]);
    return canonical(names, closed);
}

std::string key_of(const Symmetry& symmetry, const std::vector<int>& original) {
    std::set<std::string> cycles;
    for (const Orbit& orbit : symmetry.cycles)
        cycles.insert(text_of(renamed(orbit.points, orbit.closed, original)));
    std::string key(option_letter(symmetry.type));
    key += " order " + (symmetry.order ? std::to_string(*symmetry.order) : "none");
    for (const std::string& cycle : cycles) key += " (" + cycle + ")";
    return key;
}

std::set<std::string> letters_of(const TypeSet& types) {
    std::set<std::string> letters;
    for (SymmetryType type : kAllSymmetryTypes)
        if (types.contains(type)) letters.insert(std::string(option_letter(type)));
    return letters;
}

/// Equal to 1e-6 relative, or to 1e-12 of the diameter where both are rounding.
bool close(double a, double b) {
    return a == b || std::abs(a - b) <= 1e-6 * std::max(std::abs(a), std::abs(b)) + 1e-12;
}

std::string difference_of_cycles(const Summary& a, const Summary& b) {
    for (const auto& [cycle, facts] : a.cycles) {
        const auto other = b.cycles.find(cycle);
        if (other == b.cycles.end()) return "cycle in the first only: " + text_of(cycle);
        if (facts.types != other->second.types) return "types differ: " + text_of(cycle);
        if (!close(facts.min, other->second.min) || !close(facts.max, other->second.max))
            return "tolerances differ: " + text_of(cycle);
    }
    for (const auto& [cycle, facts] : b.cycles)
        if (!a.cycles.contains(cycle)) return "cycle in the second only: " + text_of(cycle);
    return {};
}

std::string difference_of_symmetries(const Summary& a, const Summary& b) {
    for (const auto& [key, facts] : a.symmetries) {
        const auto other = b.symmetries.find(key);
        if (other == b.symmetries.end()) return "symmetry in the first only: " + key;
        for (std::size_t k = 0; k < facts.size(); ++k)
            if (!close(facts[k], other->second[k])) return "fact " + std::to_string(k) + " differs: " + key;
    }
    for (const auto& [key, facts] : b.symmetries)
        if (!a.symmetries.contains(key)) return "symmetry in the second only: " + key;
    return a.count_by_type == b.count_by_type ? "" : "numbers of symmetries by type differ";
}

}  // namespace

Summary summary_of(const DetectResult& result, const std::vector<int>& original) {
    Summary summary;
    const double unit = result.diameter;
    for (const Cycle& cycle : result.cycles)
        summary.cycles[renamed(cycle.points, cycle.closed, original)] = {
            letters_of(cycle.types), cycle.tolerance.min / unit, cycle.tolerance.max / unit};
    for (const Symmetry& symmetry : result.symmetries) {
        std::vector<double>& facts = summary.symmetries[key_of(symmetry, original)];
        facts = {symmetry.tolerance.min / unit, symmetry.tolerance.max / unit, symmetry.deviation.rms / unit,
                 symmetry.deviation.max / unit, symmetry.maximal ? 1.0 : 0.0};
        if (is_pair_type(symmetry.type))
            facts.insert(facts.end(), {symmetry.coverage, double(symmetry.fixed_points.size())});
        ++summary.count_by_type[std::string(option_letter(symmetry.type))];
    }
    return summary;
}

Summary without_half_turns(Summary summary) {
    const std::string letters(option_letter(SymmetryType::half_turn));
    std::erase_if(summary.symmetries,
                  [&](const auto& item) { return item.first.starts_with(letters + " "); });
    summary.count_by_type.erase(letters);
    return summary;
}

std::string difference(const Summary& a, const Summary& b) {
    const std::string cycles = difference_of_cycles(a, b);
    return cycles.empty() ? difference_of_symmetries(a, b) : cycles;
}

namespace {

/// A result as text in which every number is written by its bits.
class BitText {
public:
    void add(double value) { out_ << std::hex << std::bit_cast<std::uint64_t>(value) << std::dec << ' '; }
    void add(int value) { out_ << value << ' '; }
    void add(bool value) { out_ << value << ' '; }
    void add(std::string_view value) { out_ << value << ' '; }
    template <class T>
    void add(const std::vector<T>& values) {
        out_ << "[ ";
        for (const T& value : values) add(value);
        out_ << "] ";
    }
    template <class T>
    void add(const std::optional<T>& value) {
        if (value)
            add(*value);
        else
            out_ << "none ";
    }
    template <class T, std::size_t N>
    void add(const std::array<T, N>& values) {
        for (const T& value : values) add(value);
    }
    void add(const ToleranceInterval& value) { add(std::array{value.min, value.max}); }
    void add(const Axis& value) { add(std::array{value.point, value.direction}); }
    void add(const Plane& value) { add(std::array{value.point, value.normal}); }
    void add(const Orbit& value) {
        add(value.points);
        add(value.closed);
    }
    void add(const Isometry& value) {
        add(value.linear);
        add(value.translation);
        add(std::array{value.angle_deg, value.step});
        add(value.axis);
        add(value.plane);
        add(value.center);
    }
    void add(const Cycle& value) {
        out_ << "\ncycle ";
        add(value.points);
        add(value.closed);
        for (const std::string& letter : letters_of(value.types)) out_ << letter;
        add(value.tolerance);
    }
    void add(const Symmetry& value) {
        out_ << "\nsymmetry ";
        add(value.id);
        add(option_letter(value.type));
        add(value.order);
        add(value.isometry);
        add(value.cycles);
        add(value.tolerance);
        add(std::array{value.deviation.rms, value.deviation.max, value.coverage, value.significance});
        add(value.fixed_points);
        add(value.missing);
        add(value.maximal);
        add(value.implied_by);
    }
    void add(const Diagnostic& value) { out_ << "\ndiagnostic " << value.code << ' ' << value.message; }
    void add(const DetectResult& value) {
        add(static_cast<int>(value.status));
        add(value.points.positions);
        add(value.points.labels);
        add(std::array{value.diameter, value.resolution, value.max_tolerance});
        add(value.merged_points);
        add(value.cycles);
        add(value.symmetries);
        out_ << "\nstats " << value.stats.seeds << ' ' << value.stats.cycles << ' ' << value.stats.symmetries;
        add(value.diagnostics);
    }
    std::string str() const { return out_.str(); }

private:
    std::ostringstream out_;
};

std::string bit_text(const DetectResult& result) {
    BitText text;
    text.add(result);
    return text.str();
}

}  // namespace

std::string difference_in_bits(const DetectResult& a, const DetectResult& b) {
    std::istringstream one(bit_text(a));
    std::istringstream two(bit_text(b));
    std::string first;
    std::string second;
    while (true) {
        const bool more = static_cast<bool>(std::getline(one, first));
        if (more != static_cast<bool>(std::getline(two, second))) return "one result is longer";
        if (!more) return {};
        if (first != second) return first + "\n  differs from\n" + second;
    }
}

// --- noisy sets ----------------------------------------------------------------------------------

namespace {

/// One step of a random isometry about the z axis: turn, lift and flip.
struct Step {
    double turn = 0;
    double lift = 0;
    bool flip = false;  ///< in 3D of z, in 2D of y
    int count = 4;

    Point operator()(const Point& p, int dimension) const {
        const double c = std::cos(turn);
        const double s = std::sin(turn);
        if (dimension == 2) {
            if (flip) return {p[0] + lift, -p[1], 0};
            if (lift != 0) return {p[0] + lift, p[1], 0};
            return {c * p[0] - s * p[1], s * p[0] + c * p[1], 0};
        }
        return {c * p[0] - s * p[1], s * p[0] + c * p[1], (flip ? -p[2] : p[2]) + lift};
    }
};

Step random_step(int dimension, std::mt19937_64& random) {
    constexpr double kTurn = 2 * std::numbers::pi;
    const int n = 4 + static_cast<int>(random() % 4);
    const double lift = uniform(random, 0.2, 0.4);
    switch (random() % 4) {
        case 0:
            return {kTurn / n, 0, false, n};  // rotation
        case 1:
            return {0, lift, dimension == 2, n};  // translation or glide
        case 2:
            return {dimension == 3 ? 0.9 : 0, lift, false, n + 1};  // screw or translation
        default:
            return {kTurn / 6, 0, dimension == 3, 6};  // rotation-reflection
    }
}

Point random_point(int dimension, std::mt19937_64& random) {
    Point p{};
    for (int i = 0; i < dimension; ++i) p[static_cast<std::size_t>(i)] = uniform(random, -1, 1);
    return p;
}

}  // namespace

PointSet noisy_set(int dimension, int orbits, int scattered, double noise, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    PointSet set;
    set.dimension = dimension;
    const auto add = [&set](const Point& p, int label) {
        set.positions.push_back(p);
        set.labels.push_back(label);
    };
    const Step step = random_step(dimension, random);
    for (int k = 1; k <= orbits; ++k) {
        Point p = random_point(dimension, random);
        for (int i = 0; i < step.count; ++i, p = step(p, dimension)) add(p, k);
    }
    for (int k = 0; k < scattered; ++k) add(random_point(dimension, random), 0);
    const double sigma = noise * diameter(set.positions);
    for (Point& p : set.positions)
        for (int i = 0; i < dimension; ++i) p[static_cast<std::size_t>(i)] += sigma * normal(random);
    return set;
}

}  // namespace insym::property
