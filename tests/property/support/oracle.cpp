#include "property/support/oracle.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>

#include "property/support/shapes.hpp"

namespace insym::property {

namespace {

constexpr double kExact = 1e-9;  // share of the diameter: rounding of exact sets stays far below

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

const Point& point(const std::vector<Point>& points, int i) {
    return points[at(i)];
}

Eigen::Vector3d vec(const Point& p) {
    return {p[0], p[1], p[2]};
}

struct Map3 {
    Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    Eigen::Vector3d operator()(const Point& p) const { return linear * vec(p) + shift; }
};

/// Index of the point at `place`, within `reach`.
std::optional<int> point_at(const std::vector<Point>& points, const Eigen::Vector3d& place, double reach) {
    for (std::size_t k = 0; k < points.size(); ++k)
        if ((vec(points[k]) - place).norm() <= reach) return static_cast<int>(k);
    return std::nullopt;
}

/// Right-handed orthonormal frame of a triangle, or none where it is a line.
std::optional<Eigen::Matrix3d> frame_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                        const Eigen::Vector3d& c) {
    const Eigen::Vector3d e1 = (b - a).normalized();
    const Eigen::Vector3d e3 = e1.cross(c - a);
    if (e3.norm() <= kExact * (c - a).norm()) return std::nullopt;
    Eigen::Matrix3d frame;
    frame.col(0) = e1;
    frame.col(2) = e3.normalized();
    frame.col(1) = frame.col(2).cross(e1);
    return frame;
}

}  // namespace

// --- the definitions, word for word --------------------------------------------------------------

namespace {

/// One pass of reference.interval: classes whose gap is at most eps become one.
std::vector<Span> merge_classes(const std::vector<Span>& classes, double eps) {
    std::vector<Span> merged = {classes.front()};
    for (std::size_t k = 1; k < classes.size(); ++k) {
        if (classes[k].first - merged.back().second <= eps)
            merged.back().second = classes[k].second;
        else
            merged.push_back(classes[k]);
    }
    return merged;
}

std::vector<Span> overlapping_united(std::vector<Span> spans) {
    std::sort(spans.begin(), spans.end());
    std::vector<Span> classes;
    for (const Span& span : spans) {
        if (!classes.empty() && span.first <= classes.back().second)
            classes.back().second = std::max(classes.back().second, span.second);
        else
            classes.push_back(span);
    }
    return classes;
}

}  // namespace

ToleranceInterval reference_interval(std::vector<Span> spans, double floor) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<Span> classes = overlapping_united(std::move(spans));
    double eps = floor;
    while (true) {
        double gap = kInfinity;
        for (const Span& c : classes) eps = std::max(eps, c.second - c.first);
        for (std::size_t k = 1; k < classes.size(); ++k)
            gap = std::min(gap, classes[k].first - classes[k - 1].second);
        if (classes.size() < 2 || eps < gap) return {eps, gap};
        classes = merge_classes(classes, eps);
    }
}

double Problem::length(int a, int b) const {
    return distance(points[at(a)], points[at(b)]);
}

Problem problem_of(const DetectResult& result) {
    Problem problem{result.points.positions, result.points.labels, result.resolution, result.max_tolerance};
    if (problem.labels.empty()) problem.labels.assign(problem.points.size(), 0);
    return problem;
}

CanonicalCycle canonical(const Sequence& points, bool closed) {
    Sequence s = points;
    if (closed) {
        std::rotate(s.begin(), std::min_element(s.begin(), s.end()), s.end());
        if (s.size() > 2 && s[1] > s.back()) std::reverse(s.begin() + 1, s.end());
    } else if (s.front() > s.back()) {
        std::reverse(s.begin(), s.end());
    }
    return {s, closed};
}

std::vector<Span> orbit_spans(const Problem& problem, const Sequence& points, bool closed) {
    const std::size_t c = points.size();
    std::vector<Span> spans;
    for (std::size_t r = 1; r < (closed ? c / 2 + 1 : c); ++r) {
        Span span = {std::numeric_limits<double>::infinity(), 0};
        for (std::size_t i = 0; i < (closed ? c : c - r); ++i) {
            const double d = problem.length(points[i], points[(i + r) % c]);
            span = {std::min(span.first, d), std::max(span.second, d)};
        }
        spans.push_back(span);
    }
    return spans;
}

ToleranceInterval cycle_interval(const Problem& problem, const Sequence& points, bool closed) {
    return reference_interval(orbit_spans(problem, points, closed), problem.resolution);
}

bool unambiguous(const Problem& problem, const Sequence& points, bool closed) {
    const double eps = cycle_interval(problem, points, closed).min;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const int next = i + 1 < points.size() ? points[i + 1] : points[i - 1];
        for (int q = 0; q < problem.size(); ++q) {
            if (std::find(points.begin(), points.end(), q) != points.end()) continue;
            if (problem.labels[at(q)] != problem.labels[at(points[i])]) continue;
            if (std::abs(problem.length(q, next) - problem.length(points[i], next)) > 2 * eps) continue;
            Sequence other = points;
            other[i] = q;
            const ToleranceInterval valid = cycle_interval(problem, other, closed);
            if (valid.min <= eps && eps < valid.max) return false;
        }
    }
    return true;
}

bool can_be_extended(const Problem& problem, const Sequence& points) {
    for (int q = 0; q < problem.size(); ++q) {
        if (std::find(points.begin(), points.end(), q) != points.end()) continue;
        if (problem.labels[at(q)] != problem.labels[at(points.front())]) continue;
        for (bool at_front : {true, false}) {
            Sequence longer = points;
            longer.insert(at_front ? longer.begin() : longer.end(), q);
            if (cycle_interval(problem, longer, false).min <= problem.max_tolerance &&
                unambiguous(problem, longer, false))
                return true;
        }
    }
    return false;
}

// --- brute force over all isometries ----------------------------------------------------------------

Point Element::apply(const Point& p) const {
    Point q = translation;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) q[i] += linear[i][j] * p[j];
    return q;
}

namespace {

int order_of(const std::vector<int>& image) {
    std::vector<int> now = image;
    for (int order = 1;; ++order) {
        bool identity = true;
        for (std::size_t k = 0; k < now.size(); ++k) identity = identity && now[k] == static_cast<int>(k);
        if (identity) return order;
        for (int& k : now) k = image[at(k)];
    }
}

/// Type of a non-trivial isometry with a fixed point, from determinant, trace and dimension.
SymmetryType type_of(const Eigen::Matrix3d& linear, int dimension) {
    const bool proper = linear.determinant() > 0;
    const double trace = linear.trace();
    if (proper) return std::abs(trace + 1) < 1e-6 ? SymmetryType::half_turn : SymmetryType::rotation;
    if (std::abs(trace - 1) < 1e-6) return SymmetryType::mirror;
    if (dimension == 3 && std::abs(trace + 3) < 1e-6) return SymmetryType::inversion;
    return SymmetryType::rotation_reflection;
}

double turn_of(const Eigen::Matrix3d& linear) {
    const double sign = linear.determinant() > 0 ? 1 : -1;
    const double cosine = std::clamp((linear.trace() - sign) / 2, -1.0, 1.0);
    return std::acos(cosine) / (2 * std::numbers::pi);
}

Element element_of(const Map3& map, std::vector<int> image, int dimension) {
    Element element;
    for (int i = 0; i < 3; ++i) {
        element.translation[at(i)] = map.shift[i];
        for (int j = 0; j < 3; ++j) element.linear[at(i)][at(j)] = map.linear(i, j);
    }
    element.image = std::move(image);
    element.type = type_of(map.linear, dimension);
    element.order = order_of(element.image);
    element.turn = element.type == SymmetryType::mirror ? 0 : turn_of(map.linear);
    return element;
}

/// Where `map` takes each point, or nothing if it leaves the set.
std::vector<int> image_of(const std::vector<Point>& points, const Map3& map, double reach) {
    std::vector<int> image;
    for (const Point& p : points) {
        const auto k = point_at(points, map(p), reach);
        if (!k) return {};
        image.push_back(*k);
    }
    return image;
}

Eigen::Vector3d centroid(const std::vector<Point>& points) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Point& p : points) sum += vec(p);
    return sum / static_cast<double>(points.size());
}

/// `dimension` points that span the space from the centroid; in 2D the third vector is z.
std::vector<int> base_points(const std::vector<Point>& points, int dimension) {
    const Eigen::Vector3d centre = centroid(points);
    const int n = static_cast<int>(points.size());
    std::vector<int> base;
    Eigen::Matrix3d found = Eigen::Matrix3d::Zero();
    for (int k = 0; k < n && static_cast<int>(base.size()) < dimension; ++k) {
        Eigen::Matrix3d tried = found;
        const auto column = static_cast<Eigen::Index>(base.size());
        tried.col(column) = vec(point(points, k)) - centre;
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(tried);
        if (svd.singularValues()[column] < 1e-3) continue;
        found = tried;
        base.push_back(k);
    }
    return base;
}

Eigen::Matrix3d columns(const std::vector<Point>& points, const std::vector<int>& chosen) {
    const Eigen::Vector3d centre = centroid(points);
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
    for (std::size_t k = 0; k < chosen.size(); ++k)
        matrix.col(static_cast<Eigen::Index>(k)) = vec(point(points, chosen[k])) - centre;
    return matrix;
}

/// The next of all sequences of `size` indices below n, in counting order; false after the last.
bool count_up(std::vector<int>& digits, int n) {
    for (int& digit : digits) {
        if (++digit < n) return true;
        digit = 0;
    }
    return false;
}

}  // namespace

std::vector<Element> symmetry_group(const std::vector<Point>& points, int dimension) {
    const double reach = kExact * diameter(points);
    const Eigen::Vector3d centre = centroid(points);
    const std::vector<int> base = base_points(points, dimension);
    const Eigen::Matrix3d from = columns(points, base).inverse();
    std::vector<Element> group;
    std::vector<int> images(base.size(), 0);
    do {
        Map3 map;
        map.linear = columns(points, images) * from;
        if ((map.linear * map.linear.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-8) continue;
        map.shift = centre - map.linear * centre;
        std::vector<int> image = image_of(points, map, reach);
        if (image.empty()) continue;
        Element element = element_of(map, std::move(image), dimension);
        if (element.order > 1) group.push_back(std::move(element));
    } while (count_up(images, static_cast<int>(points.size())));
    return group;
}

namespace {

/// Points that `map` visits from `start` until it is back; empty if it leaves the set.
Sequence orbit_of(const std::vector<Point>& points, const Map3& map, int start, double reach) {
    Sequence orbit = {start};
    while (orbit.size() <= points.size()) {
        const auto next = point_at(points, map(point(points, orbit.back())), reach);
        if (!next) return {};
        if (*next == start) return orbit;
        orbit.push_back(*next);
    }
    return {};
}

bool is_flat(const std::vector<Point>& points, const Sequence& orbit, double reach) {
    const Eigen::Vector3d a = vec(point(points, orbit[0]));
    const Eigen::Vector3d normal =
        (vec(point(points, orbit[1])) - a).cross(vec(point(points, orbit[2])) - a).normalized();
    return std::all_of(orbit.begin(), orbit.end(),
                       [&](int k) { return std::abs(normal.dot(vec(point(points, k)) - a)) <= reach; });
}

/// A regular polygon that turns once: no two of its points are closer than two neighbours.
bool turns_once(const std::vector<Point>& points, const Sequence& orbit, double reach) {
    const double side = distance(point(points, orbit[0]), point(points, orbit[1]));
    for (int a : orbit)
        for (int b : orbit)
            if (a != b && distance(point(points, a), point(points, b)) < side - reach) return false;
    return true;
}

struct CycleSearch {
    const std::vector<Point>& points;
    double reach;
    std::map<CanonicalCycle, SymmetryType> found;

    bool equal(int a, int b, int c, int e) const {
        return std::abs(distance(point(points, a), point(points, b)) -
                        distance(point(points, c), point(points, e))) <= reach;
    }

    void keep(const Sequence& orbit) {
        if (!is_flat(points, orbit, reach))
            found.emplace(canonical(orbit, true), SymmetryType::rotation_reflection);
        else if (turns_once(points, orbit, reach))
            found.emplace(canonical(orbit, true), SymmetryType::rotation);
    }

    /// The proper and the improper isometry that take a, b, c to b, c, e.
    void follow(int a, int b, int c, int e) {
        const auto from = frame_of(vec(point(points, a)), vec(point(points, b)), vec(point(points, c)));
        auto to = frame_of(vec(point(points, b)), vec(point(points, c)), vec(point(points, e)));
        if (!from || !to) return;
        for (double sign : {1.0, -1.0}) {
            to->col(2) *= sign;
            Map3 map;
            map.linear = *to * from->transpose();
            map.shift = vec(point(points, b)) - map.linear * vec(point(points, a));
            const Sequence orbit = orbit_of(points, map, a, reach);
            if (orbit.size() >= 4) keep(orbit);
        }
    }

    void search() {
        const int n = static_cast<int>(points.size());
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n; ++b)
                for (int c = 0; c < n; ++c) {
                    if (a == b || b == c || a == c || !equal(a, b, b, c)) continue;
                    if (equal(a, b, a, c)) keep({a, b, c});
                    for (int e = 0; e < n; ++e)
                        if (e != a && e != b && e != c && equal(a, b, c, e) && equal(a, c, b, e))
                            follow(a, b, c, e);
                }
    }
};

}  // namespace

std::map<CanonicalCycle, SymmetryType> exact_closed_cycles(const std::vector<Point>& points) {
    CycleSearch search{points, kExact * diameter(points), {}};
    search.search();
    return search.found;
}

// --- checks of a whole result ------------------------------------------------------------------------

namespace {

struct ResultChecker {
    const DetectResult& result;
    Problem problem = problem_of(result);
    double slack = 1e-9 * result.diameter;
    std::vector<std::string> found{};

    void fail(const std::string& where, const std::string& what) { found.push_back(where + ": " + what); }

    bool sound(const std::string& where, const Sequence& points) {
        std::set<int> once;
        for (int k : points) {
            if (k < 0 || k >= problem.size()) {
                fail(where, "unknown point");
                return false;
            }
            once.insert(k);
            if (problem.labels[at(k)] != problem.labels[at(points.front())]) fail(where, "mixes labels");
        }
        if (points.size() < 2 || once.size() != points.size()) {
            fail(where, "too short, or a point twice");
            return false;
        }
        return true;
    }

    void check(const std::string& where, const Cycle& cycle, bool check_maximal) {
        if (!sound(where, cycle.points)) return;
        const ToleranceInterval valid = cycle_interval(problem, cycle.points, cycle.closed);
        if (std::abs(valid.min - cycle.tolerance.min) > slack) fail(where, "tolerance.min");
        if (valid.max != cycle.tolerance.max && !(std::abs(valid.max - cycle.tolerance.max) <= slack))
            fail(where, "tolerance.max");
        if (valid.min > problem.max_tolerance + slack) fail(where, "C1");
        if (!unambiguous(problem, cycle.points, cycle.closed)) fail(where, "C2");
        if (check_maximal && !cycle.closed && can_be_extended(problem, cycle.points)) fail(where, "C3");
        if (cycle.types.empty()) fail(where, "has no type");
    }

    void check_isometry(const std::string& where, const Isometry& isometry) {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                double dot = 0;
                for (std::size_t k = 0; k < 3; ++k) dot += isometry.linear[i][k] * isometry.linear[j][k];
                if (!(std::abs(dot - (i == j ? 1 : 0)) <= 1e-9)) fail(where, "matrix is not an isometry");
            }
    }

    void check_deviation(const std::string& where, const Symmetry& symmetry) {
        double sum = 0;
        double most = 0;
        std::size_t links = 0;
        for (const Orbit& orbit : symmetry.cycles)
            for (std::size_t k = 0; k < orbit.points.size(); ++k) {
                if (k + 1 == orbit.points.size() && !orbit.closed) break;
                const int to = orbit.points[(k + 1) % orbit.points.size()];
                const double off = distance(symmetry.isometry.apply(point(problem.points, orbit.points[k])),
                                            point(problem.points, to));
                sum += off * off;
                most = std::max(most, off);
                ++links;
            }
        const double rms = links == 0 ? -1 : std::sqrt(sum / static_cast<double>(links));
        if (!(std::abs(symmetry.deviation.max - most) <= slack)) fail(where, "deviation.max");
        if (!(std::abs(symmetry.deviation.rms - rms) <= slack)) fail(where, "deviation.rms");
    }

    static std::size_t link_starts(const Symmetry& symmetry) {
        std::size_t starts = 0;
        for (const Orbit& orbit : symmetry.cycles) starts += orbit.points.size() - (orbit.closed ? 0 : 1);
        return starts;
    }

    /// Share of the points that the isometry takes to a point, within the definitions' reach.
    void check_coverage(const std::string& where, const Symmetry& symmetry) {
        const double reach = std::max({symmetry.tolerance.min, symmetry.deviation.max, problem.resolution});
        const auto hits = [&](double within) {
            return std::count_if(problem.points.begin(), problem.points.end(), [&](const Point& p) {
                const Point q = symmetry.isometry.apply(p);
                return std::any_of(problem.points.begin(), problem.points.end(),
                                   [&](const Point& r) { return distance(q, r) <= within; });
            });
        };
        const double n = problem.size();
        const double least = static_cast<double>(hits(reach * (1 - 1e-6))) / n;
        const double most = static_cast<double>(hits(reach * (1 + 1e-6))) / n;
        if (!(symmetry.coverage >= least - 1e-9 && symmetry.coverage <= most + 1e-9)) fail(where, "coverage");
        // No rounding here: deviation.max is the largest of the links' own distances.
        if (symmetry.coverage * n < static_cast<double>(link_starts(symmetry)) - 1e-6)
            fail(where, "coverage leaves out points that the symmetry's own links carry");
    }

    void check(const std::string& where, const Symmetry& symmetry) {
        std::set<int> used;
        std::size_t total = 0;
        for (const Orbit& orbit : symmetry.cycles) {
            if (!sound(where, orbit.points)) return;
            used.insert(orbit.points.begin(), orbit.points.end());
            total += orbit.points.size();
        }
        if (used.size() != total) fail(where, "cycles share points");
        check_isometry(where, symmetry.isometry);
        check_deviation(where, symmetry);
        check_coverage(where, symmetry);
        if (!(symmetry.tolerance.min < symmetry.tolerance.max)) fail(where, "empty tolerance interval");
    }

    void check_ids() {
        std::set<int> ids;
        for (const Symmetry& symmetry : result.symmetries) ids.insert(symmetry.id);
        if (ids.size() != result.symmetries.size()) fail("ids", "not unique");
        for (const Symmetry& symmetry : result.symmetries)
            for (int id : symmetry.implied_by)
                if (!ids.contains(id)) fail("ids", "implied_by names an unknown symmetry");
    }
};

}  // namespace

std::vector<std::string> violations(const DetectResult& result, bool check_maximal) {
    ResultChecker checker{result};
    for (std::size_t k = 0; k < result.cycles.size(); ++k)
        checker.check("cycle " + std::to_string(k), result.cycles[k], check_maximal);
    for (std::size_t k = 0; k < result.symmetries.size(); ++k)
        checker.check("symmetry " + std::to_string(k), result.symmetries[k]);
    checker.check_ids();
    return checker.found;
}

}  // namespace insym::property
