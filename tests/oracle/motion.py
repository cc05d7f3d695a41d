"""Matter and lamps that move in their frame by formulas of t or as rockets (docs/physics.md section 13).

Everything is done with the map from body points to places and its inverse, at 60 digits: velocities and
normals by differences of 1e-20, own times by quadrature, roots by stepping along the ray no farther than the
body can come, and bisection. Times are the frame's, times c.
"""
import ast
import math

from mpmath import mp, mpf

from expression import CONSTANTS, FUNCTIONS, PRECISE, compiled
from minkowski import ONE, ZERO, along, apply, boost, dot, norm, rotation_about_axes, scaled, subtract, unit

STEP = mpf(10) ** -20
OWN_TIME_DIGITS = 24


def uses_t(value):
    """Whether a number as written, or one of a list, is a formula of t."""
    if isinstance(value, list):
        return any(uses_t(v) for v in value)
    return isinstance(value, str) and any(isinstance(node, ast.Name) and node.id == "t"
                                          for node in ast.walk(ast.parse(value.strip().replace("^", "**"))))


def is_in_motion(table):
    """Whether a table without a velocity says that its thing moves in its frame."""
    return "rocket" in table or any(uses_t(table.get(key)) for key in ("position", "rotate", "scale"))


class Numbers:
    """A kind of arithmetic: doubles to look around, 60 digits for the result."""

    def __init__(self, functions, constants, real):
        self.functions, self.constants, self.real = functions, constants, real
        self.sqrt, self.sin, self.cos = functions["sqrt"], functions["sin"], functions["cos"]


DOUBLES = Numbers(FUNCTIONS, CONSTANTS, float)


def precise():
    """60 digits, with pi as good as that."""
    return Numbers(PRECISE, {"pi": +mp.pi, "e": +mp.e}, mpf)


class Motion:
    """Where the points of a body are at each time."""

    def __init__(self, table, scene, offset):
        self.c = scene.c
        triple = lambda key, default: table.get(key, default)
        scale = triple("scale", 1)
        written = [triple("position", [0, 0, 0]), triple("rotate", [0, 0, 0]),
                   scale if isinstance(scale, list) else [scale] * 3]
        self.kinds = {}
        for name, kind in (("double", DOUBLES), ("precise", precise())):
            variables = {k: kind.real(v) for k, v in scene.variables.items()}
            formulas = [[compiled(v, variables, kind) for v in three] for three in written]
            self.kinds[name] = (kind, formulas)
        self.offset = offset
        self.rocket = None
        if "rocket" in table:
            along_ = unit(scene.vector(table["rocket"]["along"]))
            self.rocket = (scene.c ** 2 / scene.number(table["rocket"]["acceleration"]), along_)

    def _level(self, time, name):
        """(kind, position, rotation matrix as rows, scale) at a time."""
        kind, (position, rotate, scale) = self.kinds[name]
        t = kind.real(time) / kind.real(self.c)
        at = [f(t) + kind.real(o) for f, o in zip(position, self.offset)]
        angles = [f(t) * kind.constants["pi"] / 180 for f in rotate]
        return kind, at, rotation(angles, kind), [f(t) for f in scale]

    def place(self, point, time, name="precise"):
        """Where a body point is."""
        kind, at, turn, scale = self._level(time, name)
        y = [sum(row[k] * scale[k] * point[k] for k in range(3)) for row in turn]
        if self.rocket:
            inverse, n = kind.real(self.rocket[0]), [kind.real(x) for x in self.rocket[1]]
            xi = sum(a * b for a, b in zip(y, n)) + inverse
            ahead = kind.sqrt(xi * xi + time * time) - xi
            y = [a + ahead * b for a, b in zip(y, n)]
        return [a + b for a, b in zip(at, y)]

    def point(self, place, time, name="precise"):
        """Which body point is there; None where there can be none."""
        kind, at, turn, scale = self._level(time, name)
        y = [a - b for a, b in zip(place, at)]
        if self.rocket:
            inverse, n = kind.real(self.rocket[0]), [kind.real(x) for x in self.rocket[1]]
            here = sum(a * b for a, b in zip(y, n)) + inverse
            if here <= 0 or here * here <= time * time:
                return None
            back = kind.sqrt(here * here - time * time) - here
            y = [a + back * b for a, b in zip(y, n)]
        return [sum(turn[row][k] * y[row] for row in range(3)) / scale[k] for k in range(3)]

    def velocity(self, point, time):
        """Of a body point."""
        later, earlier = self.place(point, time + STEP), self.place(point, time - STEP)
        return [(a - b) / (2 * STEP) for a, b in zip(later, earlier)]

    def celerity(self, point, time):
        """gamma v of a body point."""
        v = self.velocity(point, time)
        return scaled(v, 1 / mp.sqrt(1 - dot(v, v)))

    def own_time(self, point, time):
        """What the clock of a body point has counted since the frame's time 0."""
        with mp.workdps(OWN_TIME_DIGITS):
            pieces = max(1, int(math.ceil(abs(float(time)) / 1.5)))
            ends = [mpf(time) * k / pieces for k in range(pieces + 1)]
            h = mpf(10) ** -9

            def rate(t):
                later, earlier = self.place(point, t + h), self.place(point, t - h)
                return mp.sqrt(1 - sum(((a - b) / (2 * h)) ** 2 for a, b in zip(later, earlier)))
            return mp.quad(rate, ends, method="gauss-legendre", maxdegree=4)


def rotation(angles, kind):
    """Rz Ry Rx, by rows."""
    (sa, sb, sc), (ca, cb, cc) = [kind.sin(a) for a in angles], [kind.cos(a) for a in angles]
    return [[cc * cb, cc * sb * sa - sc * ca, cc * sb * ca + sc * sa],
            [sc * cb, sc * sb * sa + cc * ca, sc * sb * ca - cc * sa],
            [-sb, cb * sa, cb * ca]]


def inside(shape, p):
    """(f, face): negative inside; of the face that f is of."""
    kind = shape["kind"]
    x, y, z = p
    if kind == "sphere":
        return x * x + y * y + z * z - shape["radius"] ** 2, 0
    if kind == "torus":
        root = (x * x + z * z) ** 0.5 if isinstance(x, float) else mp.sqrt(x * x + z * z)
        return (root - shape["major"]) ** 2 + y * y - shape["minor"] ** 2, 0
    if kind == "box":
        return max((abs(a) - extent / 2, 2 * i + (a > 0)) for i, (a, extent) in enumerate(zip(p, shape["size"])))
    if kind in ("cylinder", "cone"):
        half = shape["height"] / 2
        top = shape["radius"] if kind == "cylinder" else shape.get("top_radius", 0 * half)
        radius = (shape["radius"] + top) / 2 + (top - shape["radius"]) / shape["height"] * y
        root = (x * x + z * z) ** 0.5 if isinstance(x, float) else mp.sqrt(x * x + z * z)
        return max((root - radius, 0), (abs(y) - half, 1 + (y > 0)))
    raise ValueError(f"no reference for shape '{kind}' in motion")


def reach(shape):
    """The radius of a ball about the origin that holds it."""
    kind = shape["kind"]
    if kind == "sphere":
        return float(shape["radius"])
    if kind == "torus":
        return float(shape["major"] + shape["minor"])
    if kind == "box":
        return float(norm(shape["size"])) / 2
    return math.hypot(float(max(shape["radius"], shape.get("top_radius", 0))), float(shape["height"]) / 2)


class MovingBody:
    """A shape in motion, asked by null lines or others of its frame."""

    SAMPLES = 160  # across its diameter
    FARTHEST = 400.0

    def __init__(self, shape, motion):
        self.shape, self.motion = shape, motion
        self.rough = {k: [float(v) for v in value] if isinstance(value, list) else
                      value if isinstance(value, str) else float(value) for k, value in shape.items()}
        largest = max(abs(f(0.0)) for f in motion.kinds["double"][1][2])
        self.radius = 1.5 * reach(shape) * max(1.0, largest)  # scales are not to grow by more than half

    def value(self, event, name):
        """f and the face at an event."""
        point = self.motion.point(event[1:], event[0], name)
        if point is None:
            return (1.0, -1)
        return inside(self.rough if name == "double" else self.shape, point)

    def roots(self, start, direction, end):
        """(s, face) of all crossings with 0 < s < end."""
        rough_start, rough = [float(x) for x in start], [float(x) for x in direction]
        size = math.sqrt(sum(x * x for x in rough[1:]))
        fastest = size + abs(rough[0])
        last = min(float(end) if end is not None else math.inf, self.FARTHEST / size)
        at = lambda s: [a + s * b for a, b in zip(rough_start, rough)]
        found, s, before = [], 0.0, None
        while s < last:
            event = at(s)
            centre = self.motion.place([0.0] * 3, event[0], "double")
            away = math.sqrt(sum((a - b) ** 2 for a, b in zip(event[1:], centre))) - self.radius
            if away > 0:
                before = None
                s += max(away / fastest, 1e-6 / size)
                continue
            now = self.value(event, "double")[0] < 0
            if before is not None and now != before[1]:
                found.append(self.refined(start, direction, before[0], s, now))
            before = (s, now)
            s += 2 * self.radius / self.SAMPLES / fastest
        return found

    def refined(self, start, direction, low, high, ends_inside):
        """The crossing between two parameters, by bisection and then by regula falsi."""
        f = lambda s: self.value(along(start, direction, s), "precise")[0]
        low, high = mpf(low), mpf(high)
        for _ in range(30):
            middle = (low + high) / 2
            if (f(middle) < 0) == ends_inside:
                high = middle
            else:
                low = middle
        try:
            s = mp.findroot(f, (low, high), solver="anderson", tol=mpf(10) ** -80, maxsteps=60, verify=False)
        except ZeroDivisionError:
            s = low
        return s, self.value(along(start, direction, low), "precise")[1]

    def matter_at(self, event):
        """(body point, celerity, normal in the matter's own frame) of a point of the surface."""
        point = self.motion.point(event[1:], event[0])
        celerity = self.motion.celerity(point, event[0])
        slopes = []
        for k in range(4):
            step = [STEP if i == k else ZERO for i in range(4)]
            later = self.value([a + b for a, b in zip(event, step)], "precise")[0]
            earlier = self.value([a - b for a, b in zip(event, step)], "precise")[0]
            slopes.append((later - earlier) / (2 * STEP))
        own = apply(boost(celerity), [-slopes[0]] + slopes[1:])
        if abs(own[0]) > mpf(10) ** -15 * norm(own[1:]):
            raise ArithmeticError("the surface does not go with its matter")
        return point, celerity, unit(own[1:])


def retarded(motion, event):
    """(time, place) of a lamp on a path when its light of an event left it."""
    late = lambda t: event[0] - t - norm(subtract(event[1:], motion.place([ZERO] * 3, t)))
    low = event[0] - 1
    while late(low) < 0:
        low = event[0] - 2 * (event[0] - low)
        if event[0] - low > mpf(10) ** 9:
            return None
    high = event[0]
    for _ in range(20):
        middle = (low + high) / 2
        low, high = (middle, high) if late(middle) > 0 else (low, middle)
    time = mp.findroot(late, (low, high), solver="anderson", tol=mpf(10) ** -80, maxsteps=60, verify=False)
    return time, motion.place([ZERO] * 3, time)
