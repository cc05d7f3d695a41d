#!/usr/bin/env python3
"""Writes tests/unit/spacetime/composition_cases.inc: two frames' celerities (doubles), and of B(to) B(from)^-1 = R B(w), found by
multiplying matrices with 120 digits, w, R, and the null vector (-1; d) of a direction d in frame To as sums of two doubles."""
import random

from mpmath import matrix, mp, mpf, sqrt

mp.dps = 120


def boost(u):
    """The matrix of B(u), rows and columns (t, x, y, z)."""
    gamma = sqrt(1 + sum(p * p for p in u))
    m = matrix(4, 4)
    m[0, 0] = gamma
    for i in range(3):
        m[0, i + 1] = m[i + 1, 0] = -u[i]
        for j in range(3):
            m[i + 1, j + 1] = (1 if i == j else 0) + u[i] * u[j] / (1 + gamma)
    return m


def direction(rng):
    """A random unit vector of doubles, to rounding."""
    v = [rng.gauss(0, 1) for _ in range(3)]
    size = sum(p * p for p in v) ** 0.5
    return [p / size for p in v]


def two(value):
    """High and low part."""
    high = float(value)
    return "%r, %r" % (high, float(value - mpf(high)))


def case(rng, to_size, from_size, kind):
    """One line of the table."""
    to = [to_size * p for p in direction(rng)]
    start = [from_size * p for p in direction(rng)]
    if kind == "against":
        start = [-from_size / to_size * p * (1 + 1e-7 * rng.random()) for p in to]
    if kind == "beside":
        start = [from_size / to_size * p * (1 + 1e-3 * rng.random()) for p in to]
    looking = direction(rng)
    lorentz = boost([mpf(p) for p in to]) * boost([-mpf(p) for p in start])
    w = [-lorentz[0, i] for i in (1, 2, 3)]
    rotation = lorentz * boost([-p for p in w])
    seen = lorentz * matrix([mpf(-1)] + [mpf(p) for p in looking])
    turned = [rotation[i, j] for i in (1, 2, 3) for j in (1, 2, 3)]
    groups = [["%r" % float(p) for p in group] for group in (to, start, looking, w, turned)]
    groups.append([two(seen[i]) for i in range(4)])
    braced = ["{" + ", ".join(group) + "}" for group in groups]
    print("{" + ", ".join(braced) + "},  // gamma", mp.nstr(lorentz[0, 0], 3))


def main():
    """All of them."""
    rng = random.Random(3)
    print("// Written by tests/oracle/composition_cases.py: do not edit.")
    for to_size, from_size in ((1e3, 2.0), (3e1, 3e1), (1e3, 1e3), (1e5, 1e4), (1e5, 1e6), (1e6, 1e6), (1e12, 3.0), (0.3, 1e12)):
        for kind in ("any", "any", "against", "beside"):
            case(rng, to_size, from_size, kind)


if __name__ == "__main__":
    main()
