// Results made by hand for the tests of the report and the table.
#pragma once

#include "insym/report.hpp"

#include <limits>

namespace insym::testing_support {

/// A four-fold ring in space with one symmetry of each of a few types; every number is known.
inline DetectResult ring_result() {
    DetectResult result;
    result.points.positions = {{1, 0, 0.5}, {0, 1, 0.5}, {-1, 0, 0.5}, {0, -1, 0.5}};
    result.diameter = 2;
    result.resolution = 2e-6;
    result.max_tolerance = 0.1;
    result.options.max_tolerance = 0.05;
    result.stats = {12, 1, 2};
    result.timing = {0.25, 0.5, 0.75};
    TypeSet types;
    types.insert(SymmetryType::rotation);
    types.insert(SymmetryType::rotation_reflection);
    result.cycles = {{{0, 1, 2, 3}, true, types, {2e-6, std::numeric_limits<double>::infinity()}}};

    Symmetry turn;
    turn.id = 1;
    turn.type = SymmetryType::rotation;
    turn.order = 4;
    turn.isometry.linear = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
    turn.isometry.translation = {0.125, 0.25, 0};
    turn.isometry.angle_deg = 90;
    turn.isometry.axis = Axis{{0, 0, 0.5}, {0, 0, 1}};
    turn.cycles = {{{0, 1, 2, 3}, true}};
    turn.tolerance = {2e-6, std::numeric_limits<double>::infinity()};
    turn.coverage = 1;
    turn.significance = -7.25;

    Symmetry mirror;
    mirror.id = 2;
    mirror.type = SymmetryType::mirror;
    mirror.isometry.linear = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    mirror.isometry.plane = Plane{{0.0631, 0, 0}, {1, 0, 0}};
    mirror.cycles = {{{0, 2}, true}};
    mirror.tolerance = {0.012345, 0.0625};
    mirror.deviation = {0.00125, 0.0025};
    mirror.coverage = 0.75;
    mirror.fixed_points = {1, 3};
    mirror.missing = {{5, 6, 7}};
    mirror.significance = 1.5;
    mirror.maximal = false;
    mirror.implied_by = {1};
    result.symmetries = {turn, mirror};
    return result;
}

/// The same in the plane.
inline DetectResult flat_result() {
    DetectResult result = ring_result();
    result.points.dimension = 2;
    for (Point& point : result.points.positions) point[2] = 0;
    for (Symmetry& symmetry : result.symmetries) symmetry.isometry.dimension = 2;
    result.symmetries[0].isometry.center = Point{0.5, -0.5, 0};
    result.symmetries[0].isometry.axis.reset();
    return result;
}

}  // namespace insym::testing_support
