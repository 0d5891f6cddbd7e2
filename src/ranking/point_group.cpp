#include "ranking/point_group.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "isometry/fit.hpp"
#include "parallel_for.hpp"
#include "ranking/significance.hpp"

namespace insym {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSameMap =
    0.05;  // radians: what two elements of one group are never nearer than, up to order 100

/// The turn of an orthogonal map: proper part angle and axis.
struct Element {
    bool improper = false;
    double angle = 0;  // of the map, or of the map times the inversion where improper
    Vector3d axis = Vector3d::UnitZ();
};

Element element_of(const Matrix3d& map) {
    Element e;
    e.improper = map.determinant() < 0;
    const Matrix3d turn = e.improper ? Matrix3d(-map) : map;
    const Matrix3d k = 2 * Matrix3d::Identity() - turn - turn.transpose();
    e.axis = Eigen::SelfAdjointEigenSolver<Matrix3d>(k).eigenvectors().col(0);
    e.angle = std::acos(std::clamp((turn.trace() - 1) / 2, -1.0, 1.0));
    return e;
}

bool near_angle(double angle, double other) {
    return std::abs(angle - other) < kSameMap;
}

/// What the decision tree of every textbook asks for.
struct Census {
    struct Axis {
        Vector3d direction;
        int order = 1;  // 1 + the number of its turns
    };
    std::vector<Axis> axes;
    std::vector<Vector3d> mirrors;  // normals
    bool inversion = false;
    int size = 1;

    explicit Census(const std::vector<Matrix3d>& elements) {
        for (const Matrix3d& m : elements) {
            const Element e = element_of(m);
            if (!e.improper && e.angle < kSameMap) continue;
            ++size;
            if (e.improper && e.angle < kSameMap) {
                inversion = true;
            } else if (e.improper && near_angle(e.angle, std::numbers::pi)) {
                mirrors.push_back(e.axis);
            } else if (!e.improper) {
                add_turn(e.axis);
            }
        }
        std::stable_sort(axes.begin(), axes.end(),
                         [](const Axis& a, const Axis& b) { return a.order > b.order; });
    }

    int axes_of(int order) const {
        return static_cast<int>(
            std::count_if(axes.begin(), axes.end(), [&](const Axis& a) { return a.order == order; }));
    }

private:
    void add_turn(const Vector3d& direction) {
        for (Axis& a : axes)
            if (std::abs(a.direction.dot(direction)) > std::cos(2 * kSameMap)) {
                ++a.order;
                return;
            }
        axes.push_back({direction, 2});
    }
};

std::string number(int n) {
    return std::to_string(n);
}

GroupName cubic(const Census& c) {
    if (c.axes_of(5) > 0) return c.inversion ? GroupName{"Ih", "m-3-5"} : GroupName{"I", "235"};
    if (c.axes_of(4) > 0) return c.inversion ? GroupName{"Oh", "m-3m"} : GroupName{"O", "432"};
    if (c.inversion) return {"Th", "m-3"};
    return c.mirrors.empty() ? GroupName{"T", "23"} : GroupName{"Td", "-43m"};
}

GroupName uniaxial(const Census& c) {
    const int n = c.axes.front().order;
    Vector3d axis = c.axes.front().direction;
    const auto across = [&](const Vector3d& v) { return std::abs(v.dot(axis)) < 2 * kSameMap; };
    // Of several axes of order two, the main one is that in which the mirrors cross (D2d).
    for (const Census::Axis& a : c.axes) {
        if (a.order != n || std::all_of(c.mirrors.begin(), c.mirrors.end(), across)) break;
        axis = a.direction;
    }
    if (!std::all_of(c.mirrors.begin(), c.mirrors.end(), across)) axis = c.axes.front().direction;
    const bool dihedral =
        std::any_of(c.axes.begin() + 1, c.axes.end(), [&](const auto& a) { return across(a.direction); });
    const bool flat = std::any_of(c.mirrors.begin(), c.mirrors.end(), [&](const Vector3d& v) {
        return std::abs(v.dot(axis)) > std::cos(2 * kSameMap);
    });
    const bool upright = std::any_of(c.mirrors.begin(), c.mirrors.end(), across);
    const bool even = n % 2 == 0;
    const std::string name = number(n), twice = number(2 * n);
    if (dihedral) {
        if (flat) {
            if (n == 2) return {"D2h", "mmm"};
            return {"D" + name + "h", even ? name + "/mmm" : "-" + twice + "m2"};
        }
        if (upright) return {"D" + name + "d", even ? "-" + twice + "2m" : "-" + name + "m"};
        return {"D" + name, n == 2 ? "222" : even ? name + "22" : name + "2"};
    }
    if (flat) return {"C" + name + "h", even ? name + "/m" : "-" + twice};
    if (upright) return {"C" + name + "v", n == 2 ? "mm2" : even ? name + "mm" : name + "m"};
    if (c.size == 2 * n) return {"S" + twice, even ? "-" + twice : "-" + name};
    return {"C" + name, name};
}

}  // namespace

GroupName name_group(const std::vector<Matrix3d>& elements, int dimension) {
    const Census c(elements);
    if (dimension == 2) {
        const int turns =
            1 + static_cast<int>(std::count_if(elements.begin(), elements.end(), [](const Matrix3d& m) {
                return m.determinant() > 0 && element_of(m).angle > kSameMap;
            }));
        const bool mirror = std::any_of(elements.begin(), elements.end(),
                                        [](const Matrix3d& m) { return m.determinant() < 0; });
        const std::string name = number(turns);
        if (!mirror) return {"C" + name, name};
        return {"D" + name, turns == 1       ? "m"
                            : turns == 2     ? "2mm"
                            : turns % 2 == 0 ? name + "mm"
                                             : name + "m"};
    }
    if (c.axes_of(3) >= 4 || c.axes_of(5) >= 6) return cubic(c);
    if (!c.axes.empty()) return uniaxial(c);
    if (c.inversion) return {"Ci", "-1"};
    if (!c.mirrors.empty()) return {"Cs", "m"};
    return {"C1", "1"};
}

namespace {

/// The points, the symmetries that may belong to the group, and the empty slots that they ask for.
class GroupSearch {
public:
    GroupSearch(const Cloud& cloud, const std::vector<Symmetry>& symmetries)
        : cloud_(cloud), symmetries_(symmetries) {
        Matrix3d spread = Matrix3d::Zero();
        for (int i = 0; i < cloud.size(); ++i) spread += cloud[i] * cloud[i].transpose();
        const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(spread / cloud.size());
        extent_ = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
        axes_ = solver.eigenvectors();
    }

    PointGroup run(std::vector<Symmetry>& symmetries) {
        collect();
        PointGroup group;
        group.center = to_point(cloud_.middle());
        group.schoenflies = "C1";
        group.hermann_mauguin = "1";
        if (candidates_.empty()) {
            // A line and a plane have symmetries that move no point.
            grow(true);
            name(group);
            return group;
        }
        // With slots for the full group, or with those alone that need none where they are as many, or that
        // are met so much better that the full group is nearly one, and its slots are none.
        constexpr double kNoisier = 2;
        grow(true);
        const std::size_t complete = elements_.size();
        const double noise = noise_.squared();
        grow(false);
        const bool looser = complete > 1 && noise_.squared() > kNoisier * noise;
        if (slots_too_many() || elements_.size() <= complete || looser || !holds()) grow(true);
        if (slots_too_many() || elements_.empty()) return group;
        name(group);
        group.empty_slots = static_cast<int>(slots_.size());
        for (const std::size_t m : members_) add_slots(symmetries[m]);
        return group;
    }

private:
    /// How far links are off, beyond what the fit of each isometry takes up.
    struct Noise {
        double sum = 0, free = 0, floor = 0;

        void add(const Symmetry& s, const Cloud& cloud) {
            int links = 0;
            for (const Orbit& o : s.cycles)
                links += static_cast<int>(o.points.size()) - (o.closed && !is_pair_type(s.type) ? 0 : 1);
            sum += links * s.deviation.rms * s.deviation.rms;
            free += std::max(0, cloud.dimension() * links - degrees_of_freedom(s.type, cloud.dimension()));
        }
        double squared() const { return sum / std::max(free, 1.0) + floor * floor; }
    };

    struct Candidate {
        std::size_t id;
        RigidMap map;
        double slack;
        std::vector<std::pair<Vector3d, int>> holes;  // where points go that there is none, and their labels
    };

    bool point_near(const Vector3d& place, int label, double reach) const {
        double ignored = 0;
        return cloud_.nearest(place, label, reach, ignored) >= 0;
    }

    /// Symmetries of no more than a few holes.
    void collect() {
        std::vector<std::optional<Candidate>> found(symmetries_.size());
        parallel_for(symmetries_.size(), [&](std::size_t k) { found[k] = candidate(k); });
        for (std::optional<Candidate>& c : found)
            if (c) candidates_.push_back(std::move(*c));
        drop_looser();
    }

    std::optional<Candidate> candidate(std::size_t k) const {
        constexpr int kMany = 200;
        constexpr double kLeastCoverage = 0.3;
        const Symmetry& s = symmetries_[k];
        if (s.type == SymmetryType::translation || s.type == SymmetryType::screw ||
            s.type == SymmetryType::glide_reflection)
            return std::nullopt;
        // Of many points nearly all are carried; of a few, noise may hide which.
        if (cloud_.size() > kMany && s.coverage < kLeastCoverage) return std::nullopt;
        // A tolerance of the size of the gaps between points says nothing about their places.
        if (s.deviation.max > 0.12 * cloud_.gap()) return std::nullopt;
        Candidate c{k,
                    map_about(s.isometry, cloud_.middle()),
                    std::max({1.5 * s.deviation.max, 2 * cloud_.scene().resolution}),
                    {}};
        // Points of no orbit that stay nearly in place: noise moves them, too.
        constexpr double kShareOfGap = 0.08;
        for (int i = 0; i < cloud_.size(); ++i) {
            const Vector3d& p = cloud_[i];
            const double off = (c.map(p) - p).norm();
            if (off <= kShareOfGap * cloud_.gap()) c.slack = std::max(c.slack, off);
        }
        for (const bool back : {false, true})
            for (int i = 0; i < cloud_.size(); ++i) {
                const Vector3d& p = cloud_[i];
                const Vector3d image =
                    back ? Vector3d(c.map.linear.transpose() * (p - c.map.shift)) : c.map(p);
                if (point_near(image, cloud_.label(i), 1.5 * c.slack)) continue;
                c.holes.emplace_back(image, cloud_.label(i));
                if (c.holes.size() > 2 * most_slots()) return std::nullopt;
            }
        return c;
    }

    /// What holds much more loosely than the others is no element of their group: a box that is nearly a
    /// cube. One alone may hold so well by chance.
    void drop_looser() {
        constexpr double kJump = 8;
        std::vector<double> slacks;
        slacks.reserve(candidates_.size());
        for (const Candidate& c : candidates_) slacks.push_back(c.slack);
        std::sort(slacks.begin(), slacks.end());
        for (std::size_t k = 1; k < slacks.size(); ++k)
            if (slacks[k] > (k == 1 ? kJump : 1) * kJump * slacks[k - 1]) {
                std::erase_if(candidates_, [&](const Candidate& c) { return c.slack >= slacks[k]; });
                return;
            }
    }

    /// One point may always be lost; more only from many, or any set would be part of a larger one.
    std::size_t most_slots() const {
        return std::max<std::size_t>(1, static_cast<std::size_t>(cloud_.size()) / 8);
    }
    bool slots_too_many() const { return slots_.size() > most_slots(); }

    /// Candidates whose holes agree, best rank first, both ways; then products while these are listed.
    void grow(bool complete) {
        elements_.clear();
        members_.clear();
        slots_.clear();
        tolerance_ = 2 * cloud_.scene().resolution;
        noise_ = {0, 0, cloud_.scene().resolution};
        for (const Candidate& c : candidates_) {
            if (complete && !c.holes.empty()) continue;
            const double tolerance = std::max(tolerance_, c.slack);
            std::vector<std::pair<Vector3d, int>> slots = slots_;
            for (const auto& [place, label] : c.holes) {
                const bool known =
                    std::any_of(slots.begin(), slots.end(), [&, p = place, l = label](const auto& s) {
                        return s.second == l && (s.first - p).norm() <= 3 * tolerance;
                    });
                if (!known) slots.emplace_back(place, label);
            }
            if (slots.size() > most_slots()) continue;
            slots_ = std::move(slots);
            tolerance_ = tolerance;
            noise_.add(symmetries_[c.id], cloud_);
            members_.push_back(c.id);
            add_element(c.map.linear);
            add_element(c.map.linear.transpose());
        }
        if (cloud_.dimension() == 3 && extent_[0] <= flatness()) {
            // The plane of a flat set is a mirror that moves no point.
            const std::vector<Matrix3d> flat = elements_;
            const Matrix3d mirror = Matrix3d::Identity() - 2 * axes_.col(0) * axes_.col(0).transpose();
            add_element(mirror);
            for (const Matrix3d& m : flat) add_element(mirror * m);
        }
        close();
    }

    /// Points of a noisy plane or line lie so far off it.
    double flatness() const {
        constexpr double kShareOfGap = 0.03;
        const bool exact = !candidates_.empty() && tolerance_ <= 4 * cloud_.scene().resolution;
        return exact ? tolerance_ : std::max(tolerance_, kShareOfGap * cloud_.gap());
    }

    /// Of the points, whose mean is the origin, and the slots.
    Vector3d center() const {
        Vector3d sum = Vector3d::Zero();
        for (const auto& [place, label] : slots_) sum += place;
        return sum / (cloud_.size() + static_cast<double>(slots_.size()));
    }

    /// Every element takes every point to a point or to an empty slot.
    bool holds() const {
        const Vector3d middle = center();
        const double reach = 3 * tolerance_;
        return std::all_of(elements_.begin(), elements_.end(), [&](const Matrix3d& m) {
            for (int i = 0; i < cloud_.size(); ++i) {
                const Vector3d image = m * (cloud_[i] - middle) + middle;
                const bool slot = std::any_of(slots_.begin(), slots_.end(), [&](const auto& s) {
                    return s.second == cloud_.label(i) && (s.first - image).norm() <= reach;
                });
                if (!slot && !point_near(image, cloud_.label(i), reach)) return false;
            }
            return true;
        });
    }

    /// Noise moves the maps by so much that their products do not quite close.
    void add_element(const Matrix3d& m) {
        const double same = std::clamp(6 * tolerance_ / cloud_.radius(), 2 * kSameMap, 6 * kSameMap);
        for (const Matrix3d& e : elements_)
            if ((e - m).norm() < same) return;
        elements_.push_back(m);
    }

    /// What is a symmetry to its tolerance may lack a product that is one to slightly more.
    void close() {
        constexpr std::size_t kMost = 400;
        for (std::size_t a = 0; a < elements_.size() && elements_.size() < kMost; ++a)
            for (std::size_t b = 0; b <= a; ++b) {
                const Matrix3d first = elements_[a] * elements_[b], second = elements_[b] * elements_[a];
                add_element(first);
                add_element(second);
            }
    }

    void name(PointGroup& group) const {
        if (cloud_.dimension() == 3 && extent_[1] <= flatness()) {
            // All on one line: turns about it by any angle.
            const bool swaps = std::any_of(elements_.begin(), elements_.end(), [&](const Matrix3d& m) {
                return (m * axes_.col(2)).dot(axes_.col(2)) < 0;
            });
            group.schoenflies = swaps ? "Dinfh" : "Cinfv";
            group.hermann_mauguin = swaps ? "inf/mm" : "inf m";
        } else {
            const GroupName n = name_group(elements_, cloud_.dimension());
            group.schoenflies = n.schoenflies;
            group.hermann_mauguin = n.hermann_mauguin;
        }
        group.center = to_point(cloud_.middle() + center());
    }

    void add_slots(Symmetry& s) const {
        for (const auto& [place, label] : slots_) {
            const Vector3d slot = place + cloud_.middle();
            const bool known = std::any_of(s.missing.begin(), s.missing.end(), [&](const Point& p) {
                return (to_vector(p) - slot).norm() <= 3 * tolerance_;
            });
            if (!known) s.missing.push_back(to_point(slot));
        }
    }

    const Cloud& cloud_;
    const std::vector<Symmetry>& symmetries_;
    Vector3d extent_;
    Matrix3d axes_;
    double tolerance_ = 0;
    Noise noise_;  // of the members
    std::vector<Candidate> candidates_;
    std::vector<Matrix3d> elements_;
    std::vector<std::size_t> members_;
    std::vector<std::pair<Vector3d, int>> slots_;
};

}  // namespace

PointGroup point_group(const Cloud& cloud, std::vector<Symmetry>& symmetries) {
    return GroupSearch(cloud, symmetries).run(symmetries);
}

}  // namespace insym
