#!/usr/bin/env python3
"""Writes tests/unit/surface/cases_*.inc: rays against one placed surface each, answered with 80 digits.

The doubles of a case (sizes, placement, ray) are taken as exact. The oracle knows nothing of re-origining or of stable
quadratics: it moves the ray into local coordinates, solves the defining polynomial on the whole ray and drops the
roots that lie beside a face.

Tolerances are backward: the same ray is answered for the surface displaced by `kappa` bounding radii (grown, shrunk,
shifted along its axis), and the tolerance of lambda, position and normal is how far the answer then moves, plus
rounding of the result itself. So an ill-conditioned case (a grazing ray) gets exactly the freedom it must have. A case
is `sure` when all displaced surfaces agree on hit or miss; only those may be judged.

Run: python3 tests/oracle/surface_cases.py [kind...]   (needs mpmath; the same output every time)
"""
import math
import os
import random
import sys

from mpmath import acos, cos, matrix, mp, mpf, pi, sin, sqrt

mp.dps = 80
KAPPA = mpf("4e-15")
EPS = mpf(2) ** -53


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def add(a, b, k=1):
    return [x + k * y for x, y in zip(a, b)]


def norm(a):
    return sqrt(dot(a, a))


def quadratic(a, b, c):
    """Real roots of a t^2 + 2 b t + c."""
    if a == 0:
        return [] if b == 0 else [-c / (2 * b)]
    disc = b * b - a * c
    return [] if disc < 0 else sorted([(-b - sqrt(disc)) / a, (-b + sqrt(disc)) / a])


def frustum(o, d, bottom, top, height):
    half, slope, middle = height / 2, (top - bottom) / height, (top + bottom) / 2
    w, wr = middle + slope * o[1], slope * d[1]
    a = d[0] ** 2 + d[2] ** 2 - wr ** 2
    b = o[0] * d[0] + o[2] * d[2] - w * wr
    c = o[0] ** 2 + o[2] ** 2 - w ** 2
    out = []
    for t in quadratic(a, b, c):
        p = add(o, d, t)
        if abs(p[1]) <= half:
            rho = sqrt(p[0] ** 2 + p[2] ** 2)
            if rho > 0:
                out.append((t, 0, p, [p[0] / rho, -slope, p[2] / rho]))
    if d[1] != 0:
        for part, side, radius in ((1, -1, bottom), (2, 1, top)):
            t = (side * half - o[1]) / d[1]
            p = add(o, d, t)
            if p[0] ** 2 + p[2] ** 2 <= radius ** 2:
                out.append((t, part, p, [mpf(0), mpf(side), mpf(0)]))
    return out


def cubic_roots(p, q):
    """Real roots of t^3 + p t + q, by Viete and Cardano."""
    if 4 * p ** 3 + 27 * q * q <= 0 and p != 0:
        m = 2 * sqrt(-p / 3)
        angle = acos(max(mpf(-1), min(mpf(1), 3 * q / (p * m)))) / 3
        return sorted(m * cos(angle - 2 * pi * i / 3) for i in range(3))
    disc = sqrt(q * q / 4 + p ** 3 / 27)
    big = -q / 2 - disc if q > 0 else -q / 2 + disc
    u = (1 if big >= 0 else -1) * abs(big) ** (mpf(1) / 3)
    return [u - p / (3 * u) if u != 0 else mpf(0)]


def torus(o, d, major, minor):
    # The quartic about the closest approach to the origin has no cubic term, and its derivative a closed form: the
    # derivative's roots separate the quartic's, which 80 digits then leave in no doubt.
    t0 = -dot(o, d) / dot(d, d)
    length = norm(d)
    e, p0 = [x / length for x in d], add(o, d, t0)
    g = dot(p0, p0) + major ** 2 - minor ** 2
    a, b, c = e[0] ** 2 + e[2] ** 2, p0[0] * e[0] + p0[2] * e[2], p0[0] ** 2 + p0[2] ** 2
    k = 4 * major ** 2
    out = []
    if norm(p0) > major + minor:
        return out
    f = lambda t: (t * t + g) ** 2 - k * ((a * t + 2 * b) * t + c)
    reach = major + minor + 1
    cuts = [-reach] + [x for x in cubic_roots(g - k * a / 2, -k * b / 2) if abs(x) < reach] + [reach]
    for low, high in zip(cuts, cuts[1:]):
        if (f(low) > 0) == (f(high) > 0):
            continue
        rising = f(high) > 0
        s = (low + high) / 2
        for _ in range(400):
            if (f(s) > 0) == rising:
                high = s
            else:
                low = s
            slope = 4 * s * (s * s + g) - 2 * k * (a * s + b)
            following = s - f(s) / slope if slope != 0 else low
            if not low < following < high:
                following = (low + high) / 2
            if abs(following - s) < mpf("1e-70"):
                break
            s = following
        p = add(p0, e, s)
        rho = sqrt(p[0] ** 2 + p[2] ** 2)
        beside = (rho - major) / rho
        out.append((t0 + s / length, 0, p, [p[0] * beside, p[1], p[2] * beside]))
    return out


def box(o, d, size):
    out = []
    for axis in range(3):
        if d[axis] == 0:
            continue
        for side in (-1, 1):
            t = (side * size[axis] / 2 - o[axis]) / d[axis]
            p = add(o, d, t)
            if all(abs(p[i]) <= size[i] / 2 for i in range(3) if i != axis):
                out.append((t, 2 * axis + (side > 0), p, [mpf(side * (i == axis)) for i in range(3)]))
    return out


def gradient(q, p):
    return [2 * q[0] * p[0] + q[3] * p[1] + q[4] * p[2] + q[6], 2 * q[1] * p[1] + q[3] * p[0] + q[5] * p[2] + q[7],
            2 * q[2] * p[2] + q[4] * p[0] + q[5] * p[1] + q[8]]


def quadric(o, d, q):
    f = (q[0] * o[0] ** 2 + q[1] * o[1] ** 2 + q[2] * o[2] ** 2 + q[3] * o[0] * o[1] + q[4] * o[0] * o[2]
         + q[5] * o[1] * o[2] + q[6] * o[0] + q[7] * o[1] + q[8] * o[2] + q[9])
    a = (q[0] * d[0] ** 2 + q[1] * d[1] ** 2 + q[2] * d[2] ** 2 + q[3] * d[0] * d[1] + q[4] * d[0] * d[2]
         + q[5] * d[1] * d[2])
    return [(t, 0, p, gradient(q, p)) for t in quadratic(a, dot(gradient(q, o), d) / 2, f) for p in [add(o, d, t)]]


def flat(o, d, radius):
    if d[1] == 0:
        return []
    t = -o[1] / d[1]
    p = add(o, d, t)
    return [(t, 0, p, [mpf(0), mpf(1), mpf(0)])] if radius is None or p[0] ** 2 + p[2] ** 2 <= radius ** 2 else []


def crossings(kind, v, o, d, grow):
    """All crossings of the ray with the shape whose surface is displaced outward by `grow`."""
    if kind == "sphere":
        r = v[0] + grow
        return [(t, 0, p, p) for t in quadratic(dot(d, d), dot(o, d), dot(o, o) - r * r) for p in [add(o, d, t)]]
    if kind == "box":
        return box(o, d, [x + 2 * grow for x in v])
    if kind == "cylinder":
        return frustum(o, d, v[0] + grow, v[0] + grow, v[1] + 2 * grow)
    if kind == "cone":
        slant = sqrt(1 + ((v[1] - v[0]) / v[2]) ** 2)
        h = v[2] + 2 * grow
        slope = (v[1] - v[0]) / v[2]
        middle = (v[0] + v[1]) / 2 + grow * slant
        bottom, top = middle - slope * h / 2, middle + slope * h / 2
        return frustum(o, d, max(bottom, mpf(0)), max(top, mpf(0)), h) if min(bottom, top) >= 0 else frustum(
            o, d, bottom, top, h)
    if kind == "torus":
        return torus(o, d, v[0], v[1] + grow)
    if kind == "disk":
        return flat(o, d, v[0] + grow)
    if kind == "plane":
        return flat(o, d, None)
    q = list(v)
    q[9] = q[9] - grow
    return quadric(o, d, q)


def local_radius(kind, v):
    return {"sphere": lambda: v[0], "box": lambda: norm(v) / 2, "cylinder": lambda: sqrt(v[0] ** 2 + v[1] ** 2 / 4),
            "cone": lambda: sqrt(max(v[0], v[1]) ** 2 + v[2] ** 2 / 4), "torus": lambda: v[0] + v[1],
            "disk": lambda: v[0], "plane": lambda: mpf(1), "quadric": lambda: mpf(2)}[kind]()


def feature(kind, v):
    """The smallest radius of curvature, for the normal's tolerance."""
    return {"sphere": lambda: v[0], "cylinder": lambda: v[0], "torus": lambda: v[1],
            "cone": lambda: max(v[0], v[1])}.get(kind, lambda: mpf(1))()


class Placement:
    def __init__(self, position, rotate, scale):
        self.position, self.rotate, self.scale = position, rotate, scale
        quarters = {0: (1, 0), 90: (0, 1), 180: (-1, 0), -90: (0, -1)}  # exactly
        pairs = [quarters[a] if a in quarters else (cos(mpf(a) * pi / 180), sin(mpf(a) * pi / 180)) for a in rotate]
        c, s = zip(*pairs)
        rx = matrix([[1, 0, 0], [0, c[0], -s[0]], [0, s[0], c[0]]])
        ry = matrix([[c[1], 0, s[1]], [0, 1, 0], [-s[1], 0, c[1]]])
        rz = matrix([[c[2], -s[2], 0], [s[2], c[2], 0], [0, 0, 1]])
        self.r = rz * ry * rx

    def to_rest(self, p):
        return [sum(self.r[i, j] * self.scale[j] * p[j] for j in range(3)) for i in range(3)]

    def to_local(self, p):
        return [sum(self.r[j, i] * p[j] for j in range(3)) / self.scale[i] for i in range(3)]

    def normal(self, g):
        n = [sum(self.r[i, j] * g[j] / self.scale[j] for j in range(3)) for i in range(3)]
        return [x / norm(n) for x in n]


def answer(kind, v, place, origin, direction, grow=mpf(0), shift=(0, 0, 0)):
    """(lambda, part, P, N, cosine) of the first crossing with lambda > 0 in rest coordinates, or None."""
    o = add(place.to_local(add([mpf(x) for x in origin], place.position, -1)), shift)
    d = place.to_local([mpf(x) for x in direction])
    hits = [h for h in crossings(kind, v, o, d, grow) if h[0] > 0]
    if not hits:
        return None
    t, part, p, g = min(hits, key=lambda h: h[0])
    n = place.normal(g) if norm(g) > 0 else [mpf(0)] * 3
    return t, part, add(place.to_rest(p), place.position), n, abs(dot(n, direction)) / norm(direction)


def judge(kind, v, place, origin, direction):
    """The answer with its tolerances."""
    turned = any(a % 90 for a in place.rotate)
    stretched = len({abs(x) for x in place.scale}) > 1
    kappa = KAPPA * (2 if turned else 1) * (2 if stretched else 1)
    size = local_radius(kind, v)
    rest_size = size * max(abs(x) for x in place.scale)
    grow = kappa * size
    if kind in ("plane", "quadric"):  # rounding there is that of the coordinates near the hit
        first = answer(kind, v, place, origin, direction)
        if first:
            rest_size = max(rest_size, norm(add(first[2], place.position, -1)))
            reach = norm(place.to_local(add(first[2], place.position, -1)))
            grow = kappa * max(1, reach) * (1 if kind == "plane" else 10 * max(1, reach))
    base = answer(kind, v, place, origin, direction)
    others = [answer(kind, v, place, origin, direction, g) for g in (grow, -grow)]
    step = kappa * max(size, rest_size / min(abs(x) for x in place.scale) if kind == "plane" else 0)
    others += [answer(kind, v, place, origin, direction, mpf(0), s)
               for s in ((0, step, 0), (0, -step, 0), (step, 0, step), (-step, 0, -step))]
    sure = all((x is None) == (base is None) for x in others)
    if base is None or not sure:
        return base, sure, None
    length = norm([mpf(x) for x in direction])
    lam_tol = max(abs(x[0] - base[0]) for x in others) + 4 * EPS * abs(base[0]) + kappa * rest_size / length
    if kind == "plane":  # solved by the height of the camera above it
        lam_tol += kappa * norm(add([mpf(x) for x in origin], place.position, -1)) / (base[4] * length)
    # A displacement that leads to another root makes the case unsure.
    if max(abs(x[0] - base[0]) for x in others) * length > mpf("1e-5") * rest_size:
        return base, False, None
    pos_tol = max(norm(add(x[2], base[2], -1)) for x in others) + kappa * rest_size + 4 * EPS * norm(place.position)
    same_part = all(x[1] == base[1] for x in others)
    nrm_tol = max(norm(add(x[3], base[3], -1)) for x in others) + kappa * max(1, size / feature(kind, v)) * 2
    if kind == "quadric":
        g = norm(gradient(v, place.to_local(add(base[2], place.position, -1))))
        nrm_tol += 100 * EPS * max(1, reach) / g
    return base, True, (lam_tol, pos_tol, nrm_tol, base[1] if same_part else -1)


QUADRICS = [
    [1, 2, 0.5, 0, 0, 0, 0, 0, 0, -1], [1, -1, 1, 0, 0, 0, 0, 0, 0, -0.25], [1, -1, 1, 0, 0, 0, 0, 0, 0, 0.25],
    [1, 0, 1, 0, 0, 0, 0, -1, 0, -0.5], [1, -0.5, 1, 0, 0, 0, 0, 0, 0, 0], [1, 0, 1, 0, 0, 0, 0, 0, 0, -1],
    [1, 0, -1, 0, 0, 0, 0, -1, 0, 0], [1, 1.25, 0.75, 0.5, -0.25, 0.125, 0.5, -0.25, 0.125, -1],
    [0, 0, 0, 0, 0, 0, 1, 2, -1, 0.5]]


def random_shape(rng, kind, index):
    r = lambda low, high: rng.uniform(low, high)
    if kind in ("sphere", "disk"):
        return [rng.choice([1.0, r(0.1, 10)])]
    if kind == "box":
        return rng.choice([[2.0, 2.0, 2.0], [r(0.5, 4) for _ in range(3)], [3.0, 0.01, 1.0]])
    if kind == "cylinder":
        return rng.choice([[1.0, 2.0], [r(0.2, 2), r(0.2, 5)], [0.01, 2.0]])
    if kind == "cone":
        return rng.choice([[1.0, 0.0, 2.0], [r(0.2, 2), r(0.2, 2), r(0.3, 5)], [0.0, 1.0, 1.5], [0.5, 0.45, 2.0]])
    if kind == "torus":
        return rng.choice([[1.0, 0.25], [r(0.5, 2), r(0.05, 0.45)], [1.0, 1e-3], [1.0, 0.999], [2.0, 1e-5]])
    return QUADRICS[index % len(QUADRICS)] if kind == "quadric" else []


def random_unit(rng):
    v = [rng.gauss(0, 1) for _ in range(3)]
    n = math.sqrt(sum(x * x for x in v))
    return [x / n for x in v]


def random_placement(rng, index):
    style = index % 4
    position = [0.0] * 3 if style == 0 else [rng.uniform(-5, 5) for _ in range(3)]
    rotate = [0.0] * 3 if style < 2 else rng.choice([[rng.uniform(-180, 180) for _ in range(3)], [90.0, 180.0, -90.0]])
    scale = [1.0] * 3
    if style == 3:
        scale = rng.choice([[rng.uniform(0.3, 3) for _ in range(3)], [2.5] * 3, [1.0, -1.0, 0.5]])
    return Placement([mpf(x) for x in position], rotate, [mpf(x) for x in scale])


def surface_sample(rng, kind, v):
    """A point of the surface and its unit normal, local coordinates."""
    size = float(local_radius(kind, v))
    if kind == "torus":  # too thin, sometimes, to be found by shooting at it
        around, tube = rng.uniform(-3.14, 3.14), rng.uniform(-3.14, 3.14)
        n = [cos(tube) * sin(around), sin(tube), cos(tube) * cos(around)]
        return [v[0] * sin(around) + v[1] * n[0], v[1] * n[1], v[0] * cos(around) + v[1] * n[2]], n
    while True:
        target = [rng.uniform(-0.7, 0.7) * size for _ in range(3)]
        d = [mpf(x) for x in random_unit(rng)]
        hits = crossings(kind, v, add([mpf(x) for x in target], d, -3 * size), d, mpf(0))
        hits = [h for h in hits if norm(h[2]) < 3 * size and norm(h[3]) > 0]
        if hits:
            h = rng.choice(hits)
            return h[2], [x / norm(h[3]) for x in h[3]]


def random_ray(rng, kind, v, place, index):
    """(origin, direction) as doubles. `aim` is the local point the ray passes, `along` its local direction."""
    size = local_radius(kind, v)
    aim = [mpf(rng.uniform(-0.7, 0.7)) * size for _ in range(3)]
    along = [mpf(x) for x in random_unit(rng)]
    distance = rng.choice([0, 0.3, 3, 3, 30, 1e3, 1e5, 1e7, 1e9]) * size
    style = index % 6
    if style == 1:  # grazing: tangent, displaced by 1e-1 .. 1e-15 to either side
        aim, n = surface_sample(rng, kind, v)
        along = add(along, n, -dot(along, n))
        aim = add(aim, n, rng.choice([-1, 1]) * mpf(10) ** -rng.randint(1, 15) * size)
        distance = rng.choice([2, 3, 10, 1e3]) * size
    elif style == 2:  # along the axes and faces, through edges and corners
        along = [mpf(x) for x in rng.choice([(1, 0, 0), (0, 1, 0), (0, 0, -1), (1, 1, 0), (0, -1, 1), (1, 1, 1)])]
        if kind == "box":
            aim = [rng.choice([-1, 0, 1, mpf(0.3), mpf(1) - mpf(2) ** -40]) * x / 2 for x in v]
    elif style == 3:  # right next to the surface, towards and away
        aim, n = surface_sample(rng, kind, v)
        aim = add(aim, n, rng.choice([-1, 1]) * mpf(10) ** -rng.randint(1, 12) * size)
        distance = mpf(0)
    elif style == 5 and kind == "torus":  # a random ray would miss a thin one
        aim, _ = surface_sample(rng, kind, v)
    elif style == 4 and kind == "box":  # to a corner or an edge
        aim = [rng.choice([-1, 1, rng.uniform(-1, 1)]) * x / 2 for x in v]
    rest = place.to_rest(along)
    rest = [x / norm(rest) for x in rest]
    start = add(add(place.to_rest(aim), place.position), rest, -distance)
    length = mpf(10) ** mpf(rng.uniform(-6, 6))
    return [float(x) for x in start], [float(x * length) for x in rest]


def number(x):
    x = float(x)
    return "%d." % x if x == int(x) and abs(x) < 100 else x.hex()


def numbers(v):
    return "{" + ", ".join(number(x) for x in v) + "}"


def call(kind, v):
    return "ShapeKind::%s, %s" % (kind, numbers(v))


def write_cases(kind, count, folder):
    rng = random.Random("surface " + kind)
    lines, sure_count, hit_count = [], 0, 0
    for index in range(count):
        v = [mpf(x) for x in random_shape(rng, kind, index // 6)]
        place = random_placement(rng, rng.randrange(4))
        origin, direction = random_ray(rng, kind, v, place, index)
        base, sure, tolerance = judge(kind, v, place, origin, direction)
        if not sure:
            continue
        sure_count += 1
        hit_count += base is not None
        where = ", ".join(numbers(x) for x in (place.position, place.rotate, place.scale, origin, direction))
        result = "false"
        if base is not None:
            result = "true, %s, %d, %s, %s, %s, %s, %s, %s" % (
                number(base[0]), tolerance[3], numbers(base[2]), numbers(base[3]), number(base[4]),
                number(tolerance[0]), number(tolerance[1]), number(tolerance[2]))
        lines.append("{%s, %s, %s}," % (call(kind, v), where, result))
    name = "cases_%s.inc" % kind
    with open(os.path.join(folder, name), "w") as out:
        out.write("// Written by tests/oracle/surface_cases.py: do not edit.\n")
        out.write("\n".join(lines) + "\n")
    print("%s: %d rays, %d sure, %d of them hits" % (name, count, sure_count, hit_count))


if __name__ == "__main__":
    only = sys.argv[1:]
    target = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "unit", "surface")
    for shape, rays in (("sphere", 480), ("box", 480), ("cylinder", 480), ("cone", 480), ("torus", 600), ("disk", 240),
                        ("plane", 240), ("quadric", 540)):
        if not only or shape in only:
            write_cases(shape, rays, target)
