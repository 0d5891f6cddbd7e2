// Least-squares isometries of each kind (definitions, section 7).
//
// Oracles: a round trip (a known isometry is recovered from exact links), and the definition of a
// least-squares fit (no other isometry of the kind has a lower sum of squares).
#include "isometry/fit.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "property/support/pose.hpp"

namespace insym::property {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Random = std::mt19937_64;

struct Kind {
    SymmetryType type;
    int dimension;
};

void PrintTo(const Kind& kind, std::ostream* out) {
    *out << option_letter(kind.type) << " in " << kind.dimension << "D";
}

RigidMap operator*(const RigidMap& a, const RigidMap& b) {
    return {a.linear * b.linear, a.linear * b.shift + a.shift};
}

Vector3d random_vector(int dimension, double size, Random& random) {
    Vector3d v = Vector3d::Zero();
    for (int i = 0; i < dimension; ++i) v[i] = uniform(random, -size, size);
    return v;
}

RigidMap turn_about_z(double angle) {
    return {Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix(), Vector3d::Zero()};
}

/// A rigid motion by at most about `size` in angle and length.
RigidMap random_motion(int dimension, double size, Random& random) {
    RigidMap map = turn_about_z(uniform(random, -size, size));
    if (dimension == 3) {
        const Vector3d w = random_vector(3, size, random);
        map.linear = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
    }
    map.shift = random_vector(dimension, size, random);
    return map;
}

/// The free parameters of a kind in its own frame: a turn about z, a step along z or in the plane.
struct Parameters {
    double angle = 0;
    double step = 0;
};

RigidMap standard_map(const Kind& kind, const Parameters& p) {
    RigidMap map;
    switch (kind.type) {
        case SymmetryType::mirror:
            map.linear(1, 1) = -1;
            break;
        case SymmetryType::inversion:
            map.linear = -Matrix3d::Identity();
            break;
        case SymmetryType::half_turn:
            map = turn_about_z(std::numbers::pi);
            break;
        case SymmetryType::rotation:
            map = turn_about_z(p.angle);
            break;
        case SymmetryType::translation:
            map.shift.x() = p.step;
            break;
        case SymmetryType::glide_reflection:
            map.linear(1, 1) = -1;
            map.shift.x() = p.step;
            break;
        case SymmetryType::rotation_reflection:
            map = turn_about_z(p.angle);
            map.linear(2, 2) = -1;
            break;
        case SymmetryType::screw:
            map = turn_about_z(p.angle);
            map.shift.z() = p.step;
            break;
    }
    return map;
}

/// An isometry of the kind, remembered in its own frame so that it can be changed within the kind.
struct Posed {
    Kind kind;
    Parameters parameters;
    RigidMap frame;

    RigidMap map() const { return frame * standard_map(kind, parameters) * inverse(frame); }
};

Posed random_posed(const Kind& kind, Random& random) {
    return {
        kind, {uniform(random, 0.3, 2.8), uniform(random, 0.2, 1)}, random_motion(kind.dimension, 3, random)};
}

std::vector<Link> links_of(const RigidMap& map, int dimension, int count, double noise, Random& random) {
    std::vector<Link> links;
    for (int k = 0; k < count; ++k) {
        const Vector3d p = random_vector(dimension, 1, random);
        links.push_back(
            {p + random_vector(dimension, noise, random), map(p) + random_vector(dimension, noise, random)});
    }
    return links;
}

double sum_of_squares(const RigidMap& map, const std::vector<Link>& links) {
    double sum = 0;
    for (const Link& link : links) sum += (map(link.from) - link.to).squaredNorm();
    return sum;
}

double difference(const RigidMap& a, const RigidMap& b) {
    return (a.linear - b.linear).norm() + (a.shift - b.shift).norm();
}

/// How far `map` is from being of its kind: 0 where it is exactly.
double impurity(const Kind& kind, const RigidMap& map) {
    const Matrix3d one = Matrix3d::Identity();
    const Matrix3d& q = map.linear;
    const double orthogonal = (q * q.transpose() - one).norm();
    const double determinant = std::abs(q.determinant() - (is_improper(kind.type, kind.dimension) ? -1 : 1));
    const double involution = (q * q - one).norm();
    const double returns = (map * map).shift.norm();
    double own = 0;
    switch (kind.type) {
        case SymmetryType::translation:
            own = (q - one).norm();
            break;
        case SymmetryType::glide_reflection:
            own = involution;
            break;
        case SymmetryType::inversion:
            own = (q + one).norm();
            break;
        case SymmetryType::mirror:
        case SymmetryType::half_turn:
            own = involution + returns;
            break;
        case SymmetryType::rotation:
            own = kind.dimension == 3 ? std::abs(rotation_axis(q).dot(map.shift)) : 0;
            break;
        default:
            break;
    }
    const double plane =
        kind.dimension == 2 ? (q.col(2) - Vector3d::UnitZ()).norm() + std::abs(map.shift.z()) : 0;
    return orthogonal + determinant + own + plane;
}

/// Changes the fitted map within its kind: moves its axis, plane or centre by a small motion, and
/// turns and steps a little more or less.
RigidMap changed(const Kind& kind, const RigidMap& map, double size, Random& random) {
    const RigidMap motion = random_motion(kind.dimension, size, random);
    RigidMap moved = motion * map * inverse(motion);
    const double more = uniform(random, -size, size);
    const Matrix3d turn =
        kind.dimension == 2
            ? turn_about_z(more).linear
            : Matrix3d(Eigen::AngleAxisd(more, rotation_axis(moved.linear * moved.linear.determinant()))
                           .toRotationMatrix());
    switch (kind.type) {
        case SymmetryType::translation:
            moved.shift += random_vector(kind.dimension, size, random);
            break;
        case SymmetryType::glide_reflection: {
            const Vector3d step = random_vector(kind.dimension, size, random);
            moved.shift += (step + moved.linear * step) / 2;  // the part in the plane
            break;
        }
        case SymmetryType::rotation: {  // about the same axis or centre
            const Matrix3d fixing = Matrix3d::Identity() - moved.linear;
            const Vector3d centre = fixing.completeOrthogonalDecomposition().solve(moved.shift);
            moved.linear = turn * moved.linear;
            moved.shift = centre - moved.linear * centre;
            break;
        }
        case SymmetryType::rotation_reflection:
        case SymmetryType::screw:
            moved.linear = turn * moved.linear;
            moved.shift += random_vector(kind.dimension, size, random);
            break;
        default:
            break;
    }
    return moved;
}

class FitOfType : public ::testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(FitOfType, recovers_a_known_isometry_from_exact_links) {
    const Kind kind = GetParam();
    EXPECT_TRUE(rc::check("exact links", [&] {
        Random random(*rc::gen::arbitrary<std::uint64_t>());
        const RigidMap truth = random_posed(kind, random).map();
        const auto links = links_of(truth, kind.dimension, 8, 0, random);
        const RigidMap fitted = fit_of_type(kind.type, links, kind.dimension);
        RC_ASSERT(difference(fitted, truth) < 1e-9);
        RC_ASSERT(impurity(kind, fitted) < 1e-9);
    }));
}

TEST_P(FitOfType, is_exactly_of_its_kind_and_no_other_of_it_fits_better) {
    const Kind kind = GetParam();
    EXPECT_TRUE(rc::check("noisy links", [&] {
        Random random(*rc::gen::arbitrary<std::uint64_t>());
        const double noise = *rc::gen::element(1e-6, 1e-3, 0.05, 0.2);
        const RigidMap truth = random_posed(kind, random).map();
        const auto links =
            links_of(truth, kind.dimension, 3 + static_cast<int>(random() % 10), noise, random);
        const RigidMap fitted = fit_of_type(kind.type, links, kind.dimension);
        RC_ASSERT(impurity(kind, fitted) < 1e-9);
        const double least = sum_of_squares(fitted, links);
        RC_ASSERT(least <= sum_of_squares(truth, links) * (1 + 1e-9));
        for (int k = 0; k < 200; ++k) {
            const double size = std::pow(10, -uniform(random, 0.3, 7));
            const RigidMap other = changed(kind, fitted, size, random);
            RC_ASSERT(impurity(kind, other) < 1e-9);  // the test's own promise
            RC_ASSERT(sum_of_squares(other, links) >= least * (1 - 1e-9) - 1e-15);
        }
    }));
}

// The least that fixes a symmetry of each kind leaves no residual: one pair, a row, a ring.
TEST_P(FitOfType, carries_the_least_number_of_exact_links) {
    const Kind kind = GetParam();
    EXPECT_TRUE(rc::check("few exact links", [&] {
        Random random(*rc::gen::arbitrary<std::uint64_t>());
        const RigidMap truth = random_posed(kind, random).map();
        Vector3d p = random_vector(kind.dimension, 1, random);
        std::vector<Link> links;
        const int count = is_pair_type(kind.type) ? 1 : 4;
        for (int k = 0; k < count; ++k, p = truth(p)) links.push_back({p, truth(p)});
        const RigidMap fitted = fit_of_type(kind.type, links, kind.dimension);
        RC_ASSERT(impurity(kind, fitted) < 1e-9);
        RC_ASSERT(std::sqrt(sum_of_squares(fitted, links)) < 1e-7);
    }));
}

INSTANTIATE_TEST_SUITE_P(Space, FitOfType,
                         ::testing::Values(Kind{SymmetryType::mirror, 3}, Kind{SymmetryType::inversion, 3},
                                           Kind{SymmetryType::half_turn, 3}, Kind{SymmetryType::rotation, 3},
                                           Kind{SymmetryType::translation, 3},
                                           Kind{SymmetryType::glide_reflection, 3},
                                           Kind{SymmetryType::rotation_reflection, 3},
                                           Kind{SymmetryType::screw, 3}),
                         [](const auto& test) { return std::string(option_letter(test.param.type)); });
INSTANTIATE_TEST_SUITE_P(Plane, FitOfType,
                         ::testing::Values(Kind{SymmetryType::mirror, 2}, Kind{SymmetryType::half_turn, 2},
                                           Kind{SymmetryType::rotation, 2},
                                           Kind{SymmetryType::translation, 2},
                                           Kind{SymmetryType::glide_reflection, 2}),
                         [](const auto& test) { return std::string(option_letter(test.param.type)); });

}  // namespace insym::property
