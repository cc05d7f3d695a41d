"""How matter and lamps move in their frame, by formulas of t or as rockets (docs/physics.md section 10).

Everything is done with the map from body points to places and its inverse, at 60 digits: velocities by differences of
1e-20, own times by quadrature. Times are the frame's, times c.
"""
import ast
import math

from mpmath import mp, mpf

from expression import CONSTANTS, FUNCTIONS, PRECISE, compiled
from minkowski import ZERO, dot, norm, scaled, subtract, unit

STEP = mpf(10) ** -20
OWN_TIME_DIGITS = 24


def uses_t(value):
    """Whether a number as written, or one of a list, is a formula of t."""
    if isinstance(value, list):
        return any(uses_t(v) for v in value)
    return isinstance(value, str) and any(isinstance(node, ast.Name) and node.id == "t"
                                          for node in ast.walk(ast.parse(value.strip().replace("^", "**"))))


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
    """Where the points of a body are at each time, in the coordinates of what it is part of."""

    TIMES = [-60 + 0.2 * k for k in range(601)]  # at which bounds are looked for

    def __init__(self, table, scene, offset, position=None):
        self.c = scene.c
        scale = table.get("scale", 1)
        written = [table.get("position", [0, 0, 0]), table.get("rotate", [0, 0, 0]),
                   scale if isinstance(scale, list) else [scale] * 3]
        if position is not None:  # what has a velocity rests in the frame of that, anew for each image
            written = [position] + [scene.vector(three) for three in written[1:]]
        written = [[v if uses_t(v) else scene.number(v) for v in three] for three in written]
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
        self.formulas_move = any(uses_t(three) for three in written)
        self.in_motion = self.rocket is not None or self.formulas_move
        self._still = {}

    def _level(self, time, name):
        """(kind, position, rotation matrix as rows, scale) at a time."""
        if name in self._still:
            return self._still[name]
        kind, (position, rotate, scale) = self.kinds[name]
        t = kind.real(time) / kind.real(self.c)
        at = [f(t) + kind.real(o) for f, o in zip(position, self.offset)]
        angles = [f(t) * kind.constants["pi"] / 180 for f in rotate]
        level = kind, at, rotation(angles, kind), [f(t) for f in scale]
        if not self.formulas_move:
            self._still[name] = level
        return level

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

    def covector_out(self, gradient):
        """A gradient in body coordinates in those of what the body is part of, of what is at rest."""
        _, _, turn, scale = self._level(ZERO, "precise")
        return [sum(turn[row][k] * gradient[k] / scale[k] for k in range(3)) for row in range(3)]

    def _over_times(self, value, of):
        """The extreme of something of the level, with some room where it is of only many times."""
        if not self.formulas_move:
            return of(value(self._level(0.0, "double")))
        room = 0.95 if of is min else 1.05
        return room * of(v for t in self.TIMES for v in value(self._level(t, "double")))

    def least_scale(self):
        """The least of the stretches, over all times."""
        return self._over_times(lambda level: [abs(s) for s in level[3]], min)

    def largest_scale(self):
        """The largest of them."""
        return self._over_times(lambda level: [abs(s) for s in level[3]], max)

    def farthest(self):
        """How far the body's centre comes from the origin of what it is part of."""
        return self._over_times(lambda level: [math.sqrt(sum(x * x for x in level[1]))], max)

    def steepness(self, time, radius):
        """How much nearer to each other points of a rocket are than they are to those aboard: their gamma."""
        if self.rocket is None:
            return 1.0
        rear = float(self.rocket[0]) - radius
        return math.hypot(1.0, time / rear) if rear > 0 else 1e3

    def celerity(self, point, time):
        """gamma v of a body point."""
        later, earlier = self.place(point, time + STEP), self.place(point, time - STEP)
        v = [(a - b) / (2 * STEP) for a, b in zip(later, earlier)]
        return scaled(v, 1 / mp.sqrt(1 - dot(v, v)))

    def own_time(self, point, time):
        """What the clock of a body point has counted since the frame's time 0."""
        h = mpf(10) ** -9

        def rate(t):
            later, earlier = self.place(point, t + h), self.place(point, t - h)
            return mp.sqrt(1 - sum(((a - b) / (2 * h)) ** 2 for a, b in zip(later, earlier)))
        return clock(rate, time)


def clock(rate, time):
    """The integral of a clock's rate from 0 to a time."""
    with mp.workdps(OWN_TIME_DIGITS):
        pieces = max(1, int(math.ceil(abs(float(time)) / 1.5)))
        ends = [mpf(time) * k / pieces for k in range(pieces + 1)]
        return mp.quad(rate, ends, method="gauss-legendre", maxdegree=4)


def rotation(angles, kind):
    """Rz Ry Rx, by rows."""
    (sa, sb, sc), (ca, cb, cc) = [kind.sin(a) for a in angles], [kind.cos(a) for a in angles]
    return [[cc * cb, cc * sb * sa - sc * ca, cc * sb * ca + sc * sa],
            [sc * cb, sc * sb * sa + cc * ca, sc * sb * ca - cc * sa],
            [-sb, cb * sa, cb * ca]]


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
