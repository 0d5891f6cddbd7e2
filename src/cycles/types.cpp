#include "cycles/types.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "cycles/tolerance_interval.hpp"

namespace insym {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kLeastLine = 3;
constexpr std::size_t kLeastArc = 4;
constexpr std::size_t kLeastRing = 3;
constexpr std::size_t kLeastZigzag = 4;
constexpr std::size_t kLeastHelix = 5;
constexpr std::size_t kLeastAlternatingRing = 4;
constexpr double kStraight = 1e-9;  // the sine of a turn

/// Slope and value at the middle of the least-squares line through (k, y_k), k = 0, 1, ...
struct Line {
    double slope = 0;
    double middle = 0;
};

template <class Values>
Line fit_line(std::size_t count, Values value) {
    const double centre = static_cast<double>(count - 1) / 2;
    Line line;
    double weight = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double at = static_cast<double>(k) - centre;
        line.middle += value(k) / static_cast<double>(count);
        line.slope += at * value(k);
        weight += at * at;
    }
    line.slope /= weight;
    return line;
}

double at(const Line& line, std::size_t k, std::size_t count) {
    return line.middle + line.slope * (static_cast<double>(k) - static_cast<double>(count - 1) / 2);
}

double cross(const Vector2d& a, const Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

TypeSet TypeOracle::types(std::span<const int> points, bool closed, double eps) {
    const std::size_t c = points.size();
    eps_ = eps * (1 + 1e-9) + 1e-12 * scene_.diameter;
    x_.resize(c);
    dist_.resize(c * c);
    Vector3d centre = Vector3d::Zero();
    for (std::size_t i = 0; i < c; ++i) {
        x_[i] = to_vector(scene_.position(points[i]));
        centre += x_[i];
        for (std::size_t j = 0; j < i; ++j) dist_[i * c + j] = scene_.distances(points[i], points[j]);
    }
    centre /= static_cast<double>(c);
    for (Vector3d& p : x_) p -= centre;

    TypeSet found;
    if (!closed && c >= kLeastLine && near_line()) found.insert(SymmetryType::translation);
    if (!found.empty() || c < kLeastRing) return found;  // a line explains it already
    if (!closed && (c < kLeastArc || (c == kLeastArc && !four_may_be_flat()))) return found;

    find_plane();
    find_turns();
    if (one_way_ && c >= (closed ? kLeastRing : kLeastArc) && near_circle(closed))
        found.insert(SymmetryType::rotation);
    if (!found.empty()) return found;
    if (alternate_ && !closed && c >= kLeastZigzag && near_zigzag()) {
        found.insert(SymmetryType::glide_reflection);
        // A flat zigzag in space is also a candidate for a half-turn screw.
        if (scene_.dimension() == 3) found.insert(SymmetryType::screw);
        return found;
    }
    const bool long_enough = closed ? c >= kLeastAlternatingRing && c % 2 == 0 : c >= kLeastHelix;
    if (!long_enough || scene_.dimension() == 2 || eps >= flatness_change()) return found;
    const RigidFits step = fit_step(closed);
    if (!closed && near_helix(step.proper))
        found.insert(SymmetryType::screw);
    else if (near_helix(step.improper))
        found.insert(SymmetryType::rotation_reflection);
    return found;
}

bool TypeOracle::close_to(const Points& ideal) const {
    const std::size_t c = ideal.size();
    for (std::size_t i = 1; i < c; ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (std::abs((ideal[i] - ideal[j]).norm() - dist_[i * c + j]) > eps_) return false;
    return true;
}

bool TypeOracle::near_line() {
    const std::size_t c = x_.size();
    const Vector3d direction = (x_.back() - x_.front()).normalized();
    const Line line = fit_line(c, [&](std::size_t k) { return x_[k].dot(direction); });
    for (std::size_t i = 1; i < c; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const double ideal = std::abs(line.slope) * static_cast<double>(i - j);
            if (std::abs(ideal - dist_[i * c + j]) > eps_) return false;
        }
    return true;
}

/// Can four points be close to an ideal arc or zigzag? There the distance of the ends follows from link and
/// step, on a circle by Ptolemy, ends * link = step^2 - link^2, in a zigzag by parallelograms, ends^2 =
/// link^2 + 2 step^2; each may be off by the tolerance.
bool TypeOracle::four_may_be_flat() const {
    const auto d = [&](std::size_t i, std::size_t j) { return dist_[i * 4 + j]; };
    const double slack = eps_ + 1e-9 * scene_.diameter;
    const auto ideal = [&](std::initializer_list<double> measured) {
        return Span{std::max(measured) - slack, std::min(measured) + slack};
    };
    const Span link = ideal({d(1, 0), d(2, 1), d(3, 2)}), step = ideal({d(2, 0), d(3, 1)});
    const double ends = d(3, 0);
    const auto reached = [&](double low, double high) { return low - slack <= ends && ends <= high + slack; };
    if (link.low <= 0 || step.low <= 0) return true;
    const auto arc = [](double l, double s) { return s * s / l - l; };
    const auto zigzag = [](double l, double s) { return std::sqrt(l * l + 2 * s * s); };
    return reached(arc(link.high, step.low), std::abs(arc(link.low, step.high))) ||
           reached(zigzag(link.low, step.low), zigzag(link.high, step.high));
}

void TypeOracle::find_plane() {
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Vector3d& p : x_) covariance += p * p.transpose();
    // In closed form: an axis that is off by an angle changes distances by its square.
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance);
    plane_.col(0) = solver.eigenvectors().col(2);
    plane_.col(1) = solver.eigenvectors().col(1);
    flat_.resize(x_.size());
    for (std::size_t i = 0; i < x_.size(); ++i) flat_[i] = plane_.transpose() * x_[i];
}

/// How much the projection to the best plane changes the distances.
double TypeOracle::flatness_change() const {
    const std::size_t c = x_.size();
    double change = 0;
    for (std::size_t i = 1; i < c; ++i)
        for (std::size_t j = 0; j < i; ++j)
            change = std::max(change, std::abs((flat_[i] - flat_[j]).norm() - dist_[i * c + j]));
    return change;
}

void TypeOracle::find_turns() {
    one_way_ = true;
    alternate_ = flat_.size() >= 4;
    double last = 0;
    for (std::size_t i = 0; i + 2 < flat_.size(); ++i) {
        const Vector2d link = flat_[i + 1] - flat_[i], next = flat_[i + 2] - flat_[i + 1];
        double turn = cross(link, next);
        // Of three points on a line the sign would be that of the rounding.
        if (std::abs(turn) <= kStraight * link.norm() * next.norm()) turn = 0;
        if (i == 0) first_turn_ = turn;
        one_way_ = one_way_ && (first_turn_ > 0 ? turn > 0 : first_turn_ < 0 && turn < 0);
        if (i > 0) alternate_ = alternate_ && last * turn < 0;
        last = turn;
    }
}

bool TypeOracle::near_circle(bool closed) {
    const std::size_t c = flat_.size();
    // The algebraic circle fit, 2 m.p + const = |p|^2, about the mean and along the axes of the covariance.
    Vector2d squares = Vector2d::Zero(), cubes = Vector2d::Zero();
    for (const Vector2d& p : flat_) {
        squares += p.cwiseAbs2();
        cubes += p.squaredNorm() * p;
    }
    if (!(squares.minCoeff() > 0)) return false;
    const Vector2d m = cubes.cwiseQuotient(2 * squares);

    double radius = 0;
    std::vector<double>& angle = angles_;
    angle.resize(c);
    for (std::size_t i = 0; i < c; ++i) {
        const Vector2d spoke = flat_[i] - m;
        radius += spoke.norm() / static_cast<double>(c);
        angle[i] = std::atan2(spoke.y(), spoke.x());
        if (i > 0) angle[i] = angle[i - 1] + std::remainder(angle[i] - angle[i - 1], 2 * std::numbers::pi);
    }
    const Line line = fit_line(c, [&](std::size_t k) { return angle[k]; });
    const double step =
        closed ? std::copysign(2 * std::numbers::pi / static_cast<double>(c), first_turn_) : line.slope;
    // One turn at most: a star is not a ring of its own.
    if (std::abs(step) * static_cast<double>(closed ? c : c - 1) > 2 * std::numbers::pi * (1 + 1e-6))
        return false;

    for (std::size_t i = 1; i < c; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const double chord = 2 * radius * std::abs(std::sin(step * static_cast<double>(i - j) / 2));
            if (std::abs(chord - dist_[i * c + j]) > eps_) return false;
        }
    return true;
}

bool TypeOracle::near_zigzag() {
    const std::size_t c = flat_.size();
    // The direction of the row: the principal axis of the middles of the links.
    Vector2d mean = Vector2d::Zero();
    for (std::size_t i = 0; i + 1 < c; ++i)
        mean += (flat_[i] + flat_[i + 1]) / 2 / static_cast<double>(c - 1);
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    for (std::size_t i = 0; i + 1 < c; ++i) {
        const Vector2d p = (flat_[i] + flat_[i + 1]) / 2 - mean;
        covariance += p * p.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
    solver.computeDirect(covariance);
    const Vector2d along = solver.eigenvectors().col(1);
    const Vector2d across(-along.y(), along.x());

    // Along: an even step. Across: offset + (-1)^k amplitude, by least squares.
    const Line line = fit_line(c, [&](std::size_t k) { return flat_[k].dot(along); });
    double even = 0, odd = 0;
    for (std::size_t i = 0; i < c; ++i) (i % 2 == 0 ? even : odd) += flat_[i].dot(across);
    const std::size_t odds = c / 2;
    const double width = even / static_cast<double>(c - odds) - odd / static_cast<double>(odds);

    for (std::size_t i = 1; i < c; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const double dx = at(line, i, c) - at(line, j, c);
            const double dy = (i - j) % 2 == 0 ? 0 : width;
            if (std::abs(std::sqrt(dx * dx + dy * dy) - dist_[i * c + j]) > eps_) return false;
        }
    return true;
}

/// The least-squares isometries that carry each point to the next.
RigidFits TypeOracle::fit_step(bool closed) const {
    LinkSums sums;
    for (std::size_t i = 0; i + 1 < x_.size(); ++i) sums.add({x_[i], x_[i + 1]});
    if (closed) sums.add({x_.back(), x_.front()});
    return fit_rigid(sums, scene_.dimension());
}

bool TypeOracle::near_helix(const RigidMap& step) {
    const std::size_t c = x_.size();
    // Pull every point back to the first, average, and go out again.
    Vector3d first = Vector3d::Zero();
    RigidMap power;
    for (const Vector3d& p : x_) {
        first += power.linear.transpose() * (p - power.shift) / static_cast<double>(c);
        power = {step.linear * power.linear, step.linear * power.shift + step.shift};
    }
    ideal_.resize(c);
    for (Vector3d& p : ideal_) {
        p = first;
        first = step(first);
    }
    return close_to(ideal_);
}

}  // namespace insym
