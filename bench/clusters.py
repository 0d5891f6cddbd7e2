"""Finite clusters with a known point group, and what spglib says of them in a large cell."""
import time

import numpy as np

# Generators as matrices; spglib needs a lattice that the group leaves in place.
SWAP_XY = np.array([[0, 1, 0], [1, 0, 0], [0, 0, 1]])
CYCLE_XYZ = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])
FLIP_Z, FLIP_XY = np.diag([1, 1, -1]), np.diag([-1, -1, 1])
SIXTH = np.array([[0.5, -np.sqrt(0.75), 0], [np.sqrt(0.75), 0.5, 0], [0, 0, 1]])
CUBE = np.eye(3)
HEXAGON = np.array([[1, 0, 0], [-0.5, np.sqrt(0.75), 0], [0, 0, 1.3]])
GROUPS = {"Oh": ((SWAP_XY, CYCLE_XYZ, FLIP_Z), CUBE),
          "Td": ((SWAP_XY, CYCLE_XYZ, FLIP_XY), CUBE),
          "D6h": ((SIXTH, np.diag([1, -1, 1]), FLIP_Z), HEXAGON)}


def elements(generators):
    """The group that the matrices generate."""
    known = [np.eye(3)]
    for element in known:  # grows while it is read
        for generator in generators:
            product = generator @ element
            if not any(np.allclose(product, other) for other in known):
                known.append(product)
    return known


def cluster(group, orbits):
    """`orbits` orbits in general position, between 0.4 and 1 from the centre."""
    rng = np.random.default_rng(orbits)
    seeds = rng.normal(size=(orbits, 3))
    seeds *= rng.uniform(0.4, 1, (orbits, 1)) / np.linalg.norm(seeds, axis=1, keepdims=True)
    return np.vstack([seeds @ element.T for element in elements(GROUPS[group][0])])


def have_spglib():
    try:
        import spglib  # noqa: F401
    except ImportError:
        return False
    return True


def with_spglib(group, points, repetitions):
    """Seconds of each repetition, how many operations, and the name of the group."""
    import spglib
    lattice = 10 * GROUPS[group][1]  # far larger than the cluster, which so has no neighbours
    cell = (lattice, points @ np.linalg.inv(lattice) + 0.5, np.ones(len(points), dtype=int))
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        found = spglib.get_symmetry(cell, symprec=1e-5)
        times.append(time.perf_counter() - start)
    return times, len(found["rotations"]), spglib.get_pointgroup(found["rotations"])[0].strip()
