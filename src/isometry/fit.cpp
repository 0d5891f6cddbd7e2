#include "isometry/fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

namespace insym {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void LinkSums::add(const Link& link) {
    count += 1;
    from += link.from;
    to += link.to;
    outer += link.from * link.to.transpose();
}

LinkSums& LinkSums::operator+=(const LinkSums& other) {
    count += other.count;
    from += other.from;
    to += other.to;
    outer += other.outer;
    return *this;
}

LinkSums LinkSums::reversed() const {
    return {count, to, from, outer.transpose()};
}

Matrix3d LinkSums::covariance() const {
    return outer - from * to.transpose() / count;
}

RigidFits fit_rigid(const LinkSums& sums, int dimension) {
    Matrix3d h = sums.covariance();
    // In the plane the third axis must stay itself: make it the strongest direction, so that the
    // flip of the weakest one stays in the plane.
    if (dimension == 2) h(2, 2) = 1 + 4 * h.topLeftCorner<2, 2>().norm();
    const Eigen::JacobiSVD<Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix3d& u = svd.matrixU();
    Matrix3d v = svd.matrixV();
    const Vector3d mean_from = sums.from / sums.count;
    const Vector3d mean_to = sums.to / sums.count;

    const auto map_of = [&](bool improper) {
        RigidMap map;
        map.linear = v * u.transpose();
        if ((map.linear.determinant() < 0) != improper) {
            Matrix3d flipped = v;
            flipped.col(2) = -flipped.col(2);
            map.linear = flipped * u.transpose();
        }
        map.shift = mean_to - map.linear * mean_from;
        return map;
    };
    return {map_of(false), map_of(true)};
}

Vector3d rotation_axis(const Matrix3d& linear) {
    const Eigen::AngleAxisd turn{Eigen::Quaterniond(linear)};
    return turn.angle() <= std::numbers::pi ? turn.axis() : Vector3d(-turn.axis());
}

namespace {

Matrix3d reflection(const Vector3d& normal) {
    return Matrix3d::Identity() - 2 * normal * normal.transpose();
}

/// Of the starts and of the ends of links.
struct Means {
    Vector3d from = Vector3d::Zero();
    Vector3d to = Vector3d::Zero();

    explicit Means(const std::vector<Link>& links) {
        for (const Link& l : links) {
            from += l.from;
            to += l.to;
        }
        from /= static_cast<double>(links.size());
        to /= static_cast<double>(links.size());
    }
};

/// Links relative to their means.
struct Centred : Means {
    std::vector<Link> links;

    explicit Centred(const std::vector<Link>& all) : Means(all), links(all) {
        for (Link& l : links) {
            l.from -= from;
            l.to -= to;
        }
    }

    LinkSums sums() const {
        LinkSums s;
        for (const Link& l : links) s.add(l);
        return s;
    }
};

/// Eigenvectors of a symmetric matrix, least eigenvalue first; in 2D those of the upper left block,
/// in columns 0 and 1.
Matrix3d eigenvectors(const Matrix3d& symmetric, int dimension) {
    if (dimension == 3) return Eigen::SelfAdjointEigenSolver<Matrix3d>(symmetric).eigenvectors();
    const Eigen::Matrix2d block = symmetric.topLeftCorner<2, 2>();
    Matrix3d vectors = Matrix3d::Identity();
    vectors.topLeftCorner<2, 2>() = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(block).eigenvectors();
    return vectors;
}

/// Minimise 4 sum (n.a)(n.b) over unit n; the shift along the plane is free.
Matrix3d fit_glide(const LinkSums& centred, int dimension) {
    return reflection(eigenvectors(centred.outer + centred.outer.transpose(), dimension).col(0));
}

/// M, I and the half-turn from pairs p +- u. With K = sum u u^T - sum (p - mean)(p - mean)^T the sum
/// of squares is 8 (sum |u|^2 - n^T K n) for the mirror with normal n through the mean of the
/// midpoints, and 8 (a^T K a + const) for the half-turn about axis a through it.
RigidMap fit_pairs(SymmetryType type, const std::vector<Link>& links, int dimension) {
    Vector3d middle = Vector3d::Zero();
    for (const Link& l : links) middle += (l.from + l.to) / 2;
    middle /= static_cast<double>(links.size());

    Matrix3d q = -Matrix3d::Identity();
    if (dimension == 2) q(2, 2) = 1;
    const bool central =
        type == SymmetryType::inversion || (type == SymmetryType::half_turn && dimension == 2);
    if (!central) {
        Matrix3d k = Matrix3d::Zero();
        for (const Link& l : links) {
            const Vector3d u = (l.to - l.from) / 2;
            const Vector3d p = (l.from + l.to) / 2 - middle;
            k += u * u.transpose() - p * p.transpose();
        }
        const Matrix3d vectors = eigenvectors(k, dimension);
        if (type == SymmetryType::mirror) {
            q = reflection(vectors.col(dimension - 1));
        } else {
            const Vector3d a = vectors.col(0);
            q = 2 * a * a.transpose() - Matrix3d::Identity();
        }
    }
    return {q, middle - q * middle};
}

/// exp of the cross-product matrix of w.
Matrix3d turn_by(const Vector3d& w) {
    const double angle = w.norm();
    if (angle < 1e-300) return Matrix3d::Identity();
    return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

/// The rotation R that minimises sum |R a - b|^2 + N (axis(R) . delta)^2, where delta is the way from
/// the mean start to the mean end: the step along the axis that a rotation cannot make.
struct StepFreeProblem {
    const Centred& centred;
    Vector3d delta;

    double step(const Matrix3d& r) const { return rotation_axis(r).dot(delta); }

    double cost(const Matrix3d& r) const {
        double sum = static_cast<double>(centred.links.size()) * step(r) * step(r);
        for (const Link& l : centred.links) sum += (r * l.from - l.to).squaredNorm();
        return sum;
    }

    /// A Gauss-Newton step for a small turn w after r, of angle t about u: it moves u by
    /// (cot(t / 2) (w - u (u.w)) + w x u) / 2, to first order.
    Vector3d direction(const Matrix3d& r) const {
        const auto count = static_cast<double>(centred.links.size());
        const Vector3d u = rotation_axis(r);
        const double sine = Eigen::Quaterniond(r).vec().norm();
        const double cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
        if (!(sine > 0)) return Vector3d::Zero();
        const Vector3d slope = (cosine / sine * (delta - u * u.dot(delta)) + u.cross(delta)) / 2;
        Matrix3d hessian = count * slope * slope.transpose();
        Vector3d gradient = count * slope * step(r);
        for (const Link& l : centred.links) {
            const Vector3d y = r * l.from;
            hessian += y.dot(l.to) * Matrix3d::Identity() - (y * l.to.transpose() + l.to * y.transpose()) / 2;
            gradient += y.cross(y - l.to);
        }
        return -hessian.completeOrthogonalDecomposition().solve(gradient);
    }
};

RigidMap fit_rotation(const Centred& centred, int dimension) {
    RigidMap map = fit_rigid(centred.sums(), dimension).proper;
    const Vector3d delta = centred.to - centred.from;
    if (dimension == 3) {
        const StepFreeProblem problem{centred, delta};
        double cost = problem.cost(map.linear);
        for (int round = 0; round < 20; ++round) {
            const Vector3d w = problem.direction(map.linear);
            double scale = 1;
            Matrix3d next = turn_by(w) * map.linear;
            while (problem.cost(next) > cost && scale > 1e-6) {
                scale /= 4;
                next = turn_by(scale * w) * map.linear;
            }
            const double next_cost = problem.cost(next);
            if (!(next_cost < cost)) break;
            map.linear = next;
            cost = next_cost;
            if (scale * w.norm() < 1e-12) break;
        }
    }
    map.shift = centred.to - map.linear * centred.from;
    if (dimension == 3) {
        const Vector3d axis = rotation_axis(map.linear);
        map.shift -= axis * axis.dot(map.shift);
    }
    return map;
}

}  // namespace

RigidMap map_about(const Isometry& isometry, const Vector3d& middle) {
    RigidMap map;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            map.linear(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = isometry.linear[i][j];
    map.shift = to_vector(isometry.translation) + map.linear * middle - middle;
    return map;
}

RigidMap fit_of_type(SymmetryType type, const std::vector<Link>& links, int dimension) {
    if (is_pair_type(type)) return fit_pairs(type, links, dimension);
    if (type == SymmetryType::rotation) return fit_rotation(Centred(links), dimension);
    const Means means(links);
    LinkSums centred;
    for (const Link& l : links) centred.add({l.from - means.from, l.to - means.to});
    const auto linear = [&]() -> Matrix3d {
        if (type == SymmetryType::translation) return Matrix3d::Identity();
        if (type == SymmetryType::glide_reflection) return fit_glide(centred, dimension);
        const RigidFits fits = fit_rigid(centred, dimension);
        return type == SymmetryType::rotation_reflection ? fits.improper.linear : fits.proper.linear;
    }();
    return {linear, means.to - linear * means.from};
}

}  // namespace insym
