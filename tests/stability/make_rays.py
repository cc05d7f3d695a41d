#!/usr/bin/env python3
"""Makes tests/stability/rays.txt: surfaces, rays, and where they meet, found with 100 digits.

A line of the file is one ray:

    suite surface origin(3) direction(3) sign lambda margin roots

All numbers of the ray are doubles, written so that reading gives them back exactly; what follows is the answer
for exactly these doubles. `sign` is 1 where the ray meets the surface at some lambda > 0 and 0 where it does
not; `lambda` is the first one. `margin` is how far the surface would have to move for another answer: below
some rounding errors of the coordinates no program in double precision can be asked to know. `roots` is how
many there are ahead within the bounds, multiple ones once.

Polynomials: the restriction to the line is found exactly by interpolation, and its real roots between those of
its derivative, and so on down to a constant: none can be missed. Other formulas: signs at 20,000 points,
extrema between them, and bisection.

Usage: make_rays.py > rays.txt     (needs mpmath; a few minutes)
"""

import random
import sys

from mpmath import mp, mpf

mp.dps = 100
TINY = mpf(10) ** -60


def cheb(n, x):
    a, b = mpf(1), x
    for _ in range(n - 1):
        a, b = b, 2 * x * b - a
    return b


PHI = (1 + mp.sqrt(5)) / 2
# The parameter of the scene files is the double.
PHI_DOUBLE = mpf(float(PHI))


def sphere(x, y, z):
    return x * x + y * y + z * z - 1


def torus(x, y, z):
    s = x * x + y * y + z * z + 1 - mpf(1) / 16
    return s * s - 4 * (x * x + z * z)


def steiner(x, y, z):
    return x * x * y * y + y * y * z * z + z * z * x * x - x * y * z


def whitney(x, y, z):
    return x * x - y * y * z


def barth6(x, y, z):
    p = PHI_DOUBLE * PHI_DOUBLE
    s = x * x + y * y + z * z - 1
    return 4 * (p * x * x - y * y) * (p * y * y - z * z) * (p * z * z - x * x) - (1 + 2 * PHI_DOUBLE) * s * s


def barth10(x, y, z):
    p = PHI_DOUBLE**4
    a, b, c = x * x, y * y, z * z
    s = a + b + c
    return (8 * (a - p * b) * (b - p * c) * (c - p * a) * (a * a + b * b + c * c - 2 * a * b - 2 * a * c - 2 * b * c)
            + (3 + 5 * PHI_DOUBLE) * (s - 1)**2 * (s - (2 - PHI_DOUBLE))**2)


def chmutov(n):
    return lambda x, y, z: cheb(n, x) + cheb(n, y) + cheb(n, z) + 1


def klein(x, y, z):
    s = x * x + y * y + z * z - 1
    return (s + 2 * y) * ((s - 2 * y)**2 - 8 * z * z) + 16 * x * z * (s - 2 * y)


def clebsch(x, y, z):
    return (81 * (x**3 + y**3 + z**3) - 189 * (x * x * (y + z) + y * y * (x + z) + z * z * (x + y))
            + 54 * x * y * z + 126 * (x * y + x * z + y * z) - 9 * (x * x + y * y + z * z) - 9 * (x + y + z) + 1)


def gyroid(x, y, z):
    return mp.sin(x) * mp.cos(y) + mp.sin(y) * mp.cos(z) + mp.sin(z) * mp.cos(x)


def bulb(x, y, z):
    r = mp.sqrt(x * x + y * y + z * z)
    th = 8 * mp.acos(z / r)
    ph = 8 * mp.atan2(y, x)
    r8 = r**8
    a = r8 * mp.sin(th) * mp.cos(ph) + x
    b = r8 * mp.sin(th) * mp.sin(ph) + y
    c = r8 * mp.cos(th) + z
    return mp.sqrt(a * a + b * b + c * c) - mpf(6) / 5


def pole(x, y, z):
    return y - mpf(3) / 10 / x + mpf(1) / 5 * z * z


def shell(d):
    d = mpf(float(d))
    def f(x, y, z):
        s = x * x + y * y + z * z
        # |r - 1| = d, twice: a polynomial with the same zeros as (sqrt(s) - 1)^2 - d^2
        return (s - (1 - d)**2) * (s - (1 + d)**2)
    return f


# name: (function, degree or None, half edge of the bounds, size, factor whose power it is or None)
SURFACES = {
    "sphere": (sphere, 2, None, 1),
    "torus": (torus, 4, None, 1.25),
    "sphere_squared": (sphere, 2, None, 1),
    "sphere_cubed": (sphere, 2, None, 1),
    "steiner": (steiner, 4, 1.0, 1),
    "whitney": (whitney, 3, 1.0, 1),
    "barth6": (barth6, 6, 1.75, 1.75),
    "barth10": (barth10, 10, 1.5, 1.5),
    "chmutov8": (chmutov(8), 8, 1.125, 1),
    "chmutov12": (chmutov(12), 12, 1.125, 1),
    "chmutov16": (chmutov(16), 16, 1.125, 1),
    "chmutov20": (chmutov(20), 20, 1.125, 1),
    "klein": (klein, 6, 4.0, 3),
    "clebsch": (clebsch, 3, 2.0, 2),
    "gyroid": (gyroid, None, 6.0, 6),
    "bulb": (bulb, None, 1.25, 1),
    "pole": (pole, None, 2.0, 2),
}
for k in range(3, 10):
    SURFACES["shell%d" % k] = (shell(10.0**-k), 4, None, 1)


def derivative(c):
    return [i * c[i] for i in range(1, len(c))]


def value(c, t):
    v = mpf(0)
    for a in reversed(c):
        v = v * t + a
    return v


def bisect(f, a, b):
    """The root between points of different signs: bisection, then secants that stay inside."""
    fa, fb = f(a), f(b)
    for i in range(800):
        if b - a <= abs(a + b) * mpf(10)**-90 + mpf(10)**-95:
            break
        m = (a + b) / 2
        if i % 3 and fb != fa:
            s = b - fb * (b - a) / (fb - fa)
            if a < s < b:
                m = s
        fm = f(m)
        if fm == 0:
            return m
        if (fm > 0) == (fa > 0):
            a, fa = m, fm
        else:
            b, fb = m, fm
    return (a + b) / 2


def poly_roots(c, lo, hi):
    """All real roots in [lo, hi], multiple ones once; (root, even multiplicity?)"""
    scale = max(abs(a) for a in c)
    while len(c) > 1 and abs(c[-1]) < scale * TINY * TINY:
        c = c[:-1]
    if len(c) <= 1:
        return []
    if len(c) == 2:
        r = -c[0] / c[1]
        return [r] if lo <= r <= hi else []
    cuts = [lo] + poly_roots(derivative(c), lo, hi) + [hi]
    span = max(abs(lo), abs(hi), mpf(1))
    size = sum(abs(a) * span**i for i, a in enumerate(c))
    roots = []
    f = lambda t: value(c, t)
    for a, b in zip(cuts, cuts[1:]):
        fa, fb = f(a), f(b)
        za, zb = abs(fa) < size * TINY, abs(fb) < size * TINY
        if za:
            roots.append(a)
        elif not zb and (fa > 0) != (fb > 0):
            roots.append(bisect(f, a, b))
    if abs(f(hi)) < size * TINY:
        roots.append(hi)
    merged = []
    for r in roots:
        if not merged or r - merged[-1] > mpf(10)**-40:
            merged.append(r)
    return merged


def sampled_roots(f, lo, hi):
    n = 20000
    with mp.workdps(25):
        ts = [lo + (hi - lo) * i / n for i in range(n + 1)]
        fs = [f(t) for t in ts]
    roots = []
    for i in range(n):
        if (fs[i] > 0) != (fs[i + 1] > 0):
            r = bisect(f, ts[i], ts[i + 1])
            if abs(f(r)) < mpf(10)**-20:  # not a pole
                roots.append(r)
        elif 0 < i and abs(fs[i]) < abs(fs[i - 1]) and abs(fs[i]) < abs(fs[i + 1]) and (fs[i - 1] > 0) == (fs[i] > 0):
            a, b = ts[i - 1], ts[i + 1]
            sign = 1 if fs[i] > 0 else -1
            for _ in range(120):  # the extremum between, by thirds
                u, v = a + (b - a) / 3, b - (b - a) / 3
                if sign * f(u) < sign * f(v):
                    b = v
                else:
                    a = u
            m = (a + b) / 2
            if sign * f(m) < 0:
                roots += [bisect(f, ts[i - 1], m), bisect(f, m, ts[i + 1])]
    return sorted(roots)


def interpolated(f, degree, lo, hi):
    """Coefficients about the middle of the range, by divided differences."""
    xs = [lo + (hi - lo) * i / degree for i in range(degree + 1)]
    table = [f(x) for x in xs]
    for k in range(1, degree + 1):
        for i in range(degree, k - 1, -1):
            table[i] = (table[i] - table[i - 1]) / (xs[i] - xs[i - k])
    c = [table[degree]]
    for i in range(degree - 1, -1, -1):
        c = [mpf(0)] + c
        for j in range(len(c) - 1):
            c[j] -= xs[i] * c[j + 1]
        c[0] += table[i]
    return c


def answer(name, origin, direction):
    f, degree, half, size = SURFACES[name]
    o = [mpf(v) for v in origin]
    d = [mpf(v) for v in direction]
    n2 = sum(v * v for v in d)
    length = mp.sqrt(n2)
    middle = -sum(a * b for a, b in zip(o, d)) / n2  # re-originned at the closest approach
    p = [a + middle * b for a, b in zip(o, d)]
    u = [b / length for b in d]
    lo, hi = -mpf(4) * size, mpf(4) * size
    if half is not None:
        lo, hi = -mpf(100), mpf(100)
        for a, b in zip(p, u):
            if b == 0:
                if abs(a) > half:
                    return None, mpf(1), 0
                continue
            x, y = (-half - a) / b, (half - a) / b
            lo, hi = max(lo, min(x, y)), min(hi, max(x, y))
        if lo >= hi:
            return None, mpf(1), 0
    along = lambda t: f(*[a + t * b for a, b in zip(p, u)])
    if degree is not None:
        roots = poly_roots(interpolated(along, degree, lo, hi), lo, hi)
    else:
        roots = sampled_roots(along, lo, hi)

    def distance(t):
        """From the surface, to first order."""
        q = [a + t * b for a, b in zip(p, u)]
        h = mpf(10)**-30
        g = [(f(*[q[j] + (h if i == j else 0) for j in range(3)]) - f(*[q[j] - (h if i == j else 0) for j in range(3)]))
             / (2 * h) for i in range(3)]
        slope = mp.sqrt(sum(v * v for v in g))
        return abs(f(*q)) / slope if slope > 0 else mpf(1)

    start = -middle * length  # lambda = 0
    ahead = [t for t in roots if t > start]
    span = hi - max(lo, start)
    if not ahead:
        if span <= 0:
            return None, mpf(1), 0
        margin = min(distance(max(lo, start) + span * i / 64) for i in range(65))
        if degree == 2 or name == "torus" or name.startswith("shell"):
            margin = min([margin] + [distance(t) for t in critical(along, degree, lo, hi)])
        if roots and roots[-1] <= start:
            margin = min(margin, start - roots[-1])
        return None, margin, 0
    first = ahead[0]
    neighbours = [t for t in roots if t != first] + ([hi] if half is not None else [])
    margin = mpf(1)
    after = [t for t in roots if t > first]
    before = [t for t in roots if t < first and t > start]
    for other in after[:1] + before[-1:]:
        margin = min(margin, distance((first + other) / 2))
    if half is not None:
        margin = min(margin, hi - first, first - lo)
    margin = min(margin, first - start)
    return middle + first / length, margin, len(ahead)


def critical(along, degree, lo, hi):
    return poly_roots(derivative(interpolated(along, degree, lo, hi)), lo, hi)


def emit(suite, name, origin, direction):
    lam, margin, count = answer(name, origin, direction)
    numbers = ["%.17g" % v for v in list(origin) + list(direction)]
    print(suite, name, *numbers, 0 if lam is None else 1, "0" if lam is None else mp.nstr(lam, 25),
          mp.nstr(min(margin, mpf(1)), 3), count)
    sys.stdout.flush()
    return lam


def unit(rng):
    while True:
        v = [rng.uniform(-1, 1) for _ in range(3)]
        n = sum(x * x for x in v)
        if 0.01 < n < 1:
            return [x / n**0.5 for x in v]


def towards(rng, target, distance):
    """A ray from `distance` away to a target point."""
    u = unit(rng)
    origin = [t - distance * x for t, x in zip(target, u)]
    return origin, u


def tangent_rays(rng):
    for name, limb in (("sphere", 1.0), ("torus", 1.25)):
        for k in range(1, 17):
            for side in (-1, 1):
                for _ in range(2):
                    b = limb + side * 10.0**-k
                    turn = rng.uniform(0, 6.2831853)
                    c, s = float(mp.cos(turn)), float(mp.sin(turn))
                    if name == "torus":  # along the axis direction, past the outer equator
                        emit("tangent", name, [b * c, -5.0, b * s], [0.0, 1.0, 0.0])
                    else:
                        tilt = rng.uniform(-1, 1)
                        emit("tangent", name, [b * c - 5 * 0.0, b * s, -5.0], [0.0 * tilt, 0.0, 1.0])


def multiple_rays(rng):
    for name in ("sphere_squared", "sphere_cubed", "steiner", "whitney"):
        for _ in range(30):
            o, d = towards(rng, [rng.uniform(-0.4, 0.4) for _ in range(3)], 3.0)
            emit("multiple", name, o, d)
    for t in (0.5, -0.25, 0.125):  # through the double lines themselves
        emit("multiple", "steiner", [t, 0.75, 0.75], [0.0, -1.0, -1.0])
        emit("multiple", "steiner", [0.75, t, -0.75], [-1.0, 0.0, 1.0])
        emit("multiple", "whitney", [0.75, 0.75, -abs(t)], [-1.0, -1.0, 0.0])  # meets the handle
        emit("multiple", "whitney", [0.75, 0.5, abs(t)], [-1.0, -0.5, 0.0])


def algebraic_rays(rng):
    for name, spread, n in (("barth6", 1.2, 40), ("barth10", 1.1, 40), ("chmutov8", 1.0, 30), ("chmutov12", 1.0, 25),
                            ("chmutov16", 1.0, 20), ("chmutov20", 1.0, 20), ("klein", 2.0, 40), ("clebsch", 1.5, 40)):
        for _ in range(n):
            target = [rng.uniform(-spread, spread) for _ in range(3)]
            o, d = towards(rng, target, 6.0)
            lam = emit("algebraic", name, o, d)
            if lam is not None:  # and from within, just past the first sheet
                lam = float(lam) + 0.03125
                emit("algebraic", name, [a + lam * b for a, b in zip(o, d)], d)


def other_rays(rng):
    for name, spread, n in (("gyroid", 5.0, 12), ("bulb", 0.9, 12), ("pole", 1.5, 12)):
        for _ in range(n):
            target = [rng.uniform(-spread, spread) for _ in range(3)]
            o, d = towards(rng, target, 15.0)
            lam = emit("transcendental", name, o, d)
            if lam is not None:
                lam = float(lam) + 0.03125
                emit("transcendental", name, [a + lam * b for a, b in zip(o, d)], d)


def far_rays(rng):
    for name, n in (("sphere", 4), ("torus", 4), ("barth6", 3), ("klein", 3), ("chmutov16", 1), ("gyroid", 1)):
        for k in range(3, 10):
            for _ in range(n):
                o, d = towards(rng, [rng.uniform(-0.7, 0.7) for _ in range(3)], 10.0**k)
                emit("far", name, o, d)


def shell_rays(rng):
    for k in range(3, 10):
        for _ in range(6):
            o, d = towards(rng, [rng.uniform(-0.55, 0.55) for _ in range(3)], 5.0)
            emit("thin", "shell%d" % k, o, d)
        for _ in range(4):  # from the middle
            emit("thin", "shell%d" % k, [rng.uniform(-0.3, 0.3) for _ in range(3)], unit(rng))
        for j in (0, 1, 2):  # through the shell alone, along it
            b = 1.0 + (j - 1) * 0.5 * 10.0**-k
            turn = rng.uniform(0, 6.2831853)
            emit("thin", "shell%d" % k, [b * float(mp.cos(turn)), b * float(mp.sin(turn)), -3.0], [0.0, 0.0, 1.0])


def main():
    rng = random.Random(20)
    only = sys.argv[1:]
    for make in (tangent_rays, multiple_rays, algebraic_rays, far_rays, shell_rays, other_rays):
        if not only or make.__name__ in only:
            make(rng)


if __name__ == "__main__":
    main()
