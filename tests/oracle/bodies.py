"""Bodies: shapes, formulas, and solids and blends made of them, at rest or in motion (docs/physics.md section 10).

A body is a tree. A leaf is a shape with a signed distance, or a bound on one, or a formula; a node joins its parts.
Each has a motion (motion.py) in the coordinates of what it is part of. Where all is at rest and every leaf has a closed
form, the crossings with a line are the leaves' own, sorted, and what is inside is read off them. Otherwise the line is
walked in doubles, by steps that no surface fits into where the leaves have distances, and every change of sign is
brought to 60 digits.
"""
import math

from mpmath import mp, mpf

from expression import compiled
from minkowski import ONE, ZERO, along, apply, boost, dot, norm, scaled, subtract, unit
from motion import DOUBLES, STEP, Motion, clock, precise, uses_t
from shapes import INTERSECTIONS, intersect, shading_normal

SURELY_CROSSED = 1e-9  # of a body's size: what is thinner than that is an edge for any ray
SAMPLES = 400          # across a body with a formula
FARTHEST = 400.0


def outside_box(beyond, sqrt):
    """The distance from a box of a point that is so far beyond each pair of its faces."""
    outside = [q for q in beyond if q > 0]
    return sqrt(sum(q * q for q in outside)) if len(outside) > 1 else max(beyond)


def signed_distance(shape, point, sqrt):
    """(distance, face): how far a point is outside of a shape, or (negative) inside; of a cone, a bound on it."""
    kind = shape["kind"]
    x, y, z = point
    if kind == "sphere":
        return sqrt(x * x + y * y + z * z) - shape["radius"], 0
    if kind == "plane" or kind == "disk":
        return y, 0
    if kind == "torus":
        across = sqrt(x * x + z * z) - shape["major"]
        return sqrt(across * across + y * y) - shape["minor"], 0
    if kind == "box":
        beyond = [abs(p) - extent / 2 for p, extent in zip(point, shape["size"])]
        axis = beyond.index(max(beyond))
        return outside_box(beyond, sqrt), 2 * axis + (point[axis] > 0)
    half = shape["height"] / 2
    top = shape["radius"] if kind == "cylinder" else shape.get("top_radius", 0 * half)
    slope = (top - shape["radius"]) / shape["height"]
    side = sqrt(x * x + z * z) - ((shape["radius"] + top) / 2 + slope * y)
    beyond = [side / sqrt(1 + slope * slope), abs(y) - half]
    face = 0 if beyond[0] > beyond[1] else 1 + (y > 0)
    return (outside_box(beyond, sqrt) if kind == "cylinder" else max(beyond)), face


def reach(shape):
    """The radius of a ball about the origin that holds a shape."""
    kind = shape["kind"]
    if kind in ("sphere", "disk"):
        return float(shape["radius"])
    if kind == "torus":
        return float(shape["major"] + shape["minor"])
    if kind == "box":
        return float(norm(shape["size"])) / 2
    if kind in ("cylinder", "cone"):
        return math.hypot(float(max(shape["radius"], shape.get("top_radius", 0))), float(shape["height"]) / 2)
    if kind == "mesh":
        return float(shape["reach"])
    if kind == "implicit":
        return max(math.hypot(*corner) for corner in _corners(shape["bounds"]))
    return math.inf


def _corners(bounds):
    """The eight corners of a box."""
    low, high = ([float(b) for b in corner] for corner in bounds)
    return [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]


class Part:
    """A leaf of a body or a node of it, in the coordinates of what it is part of."""

    def __init__(self, table, scene, number, offset, position=None):
        self.kind = table["shape"]
        self.motion = Motion(table, scene, offset, position)
        self.material = scene.material_of(table)
        self.parts = []
        self.number = next(number)
        self.shape = scene.shape_of(table)
        self.rough = {k: [float(v) for v in value] if k in ("size", "coefficients") else float(value)
                      for k, value in self.shape.items() if isinstance(value, mpf) or k in ("size", "coefficients")}
        self.rough["kind"] = self.kind
        self.blend = None
        if "part" in table:
            self.parts = [Part(part, scene, number, [ZERO] * 3) for part in table["part"]]
            self.blend = scene.number(table["blend"]) if "blend" in table else None
        self.formula, self.flow = {}, {}
        for name, kind in (("double", DOUBLES), ("precise", precise())):
            names = {k: kind.real(v) for k, v in scene.variables.items()}
            make = lambda text: compiled(text, names, kind, ("x", "y", "z", "t"))
            if self.kind == "implicit":
                self.formula[name] = make(table["f"])
            if "matter_velocity" in table:
                self.flow[name] = [make(v) for v in table["matter_velocity"]]
        self.c = scene.c
        self.in_motion = self.motion.in_motion or any(p.in_motion for p in self.parts) or bool(
            self.flow) or uses_t(table.get("f"))

    def leaves(self, chain=()):
        """Every leaf, as the chain of parts from the whole down to it."""
        chain += (self,)
        return [leaf for part in self.parts for leaf in part.leaves(chain)] if self.parts else [chain]

    def closed_form(self):
        """Whether the crossings with a line are those of its leaves."""
        if self.in_motion or self.blend is not None:
            return False
        return all(p.closed_form() for p in self.parts) if self.parts else self.kind in INTERSECTIONS

    def has_distance(self):
        """Whether its value is no more than the distance from its surface."""
        return all(p.has_distance() for p in self.parts) if self.parts else self.kind not in ("implicit", "quadric", "mesh")

    def slope(self):
        """How much faster than a distance its value can grow, by its stretches."""
        within = max((p.slope() for p in self.parts), default=1.0)
        return within / self.motion.least_scale()

    def reach(self):
        """The radius of a ball about its own centre that holds it at all times."""
        if not self.parts:
            own = reach(self.shape)
        else:
            parts = [p.reach() + p.motion.farthest() for p in self.parts]
            own = {"union": max, "intersection": min, "difference": lambda all_: all_[0]}[self.kind](parts)
        return own * self.motion.largest_scale()

    def value(self, place, time, name):
        """(value, leaf chain, face) at a place at a time; negative inside."""
        point = self.motion.point(place, time, name)
        if point is None:
            return 1.0, (self,), -1
        if not self.parts:
            return (*self._leaf_value(point, time, name), )
        found = [part.value(point, time, name) for part in self.parts]
        least = min(found, key=lambda v: v[0])
        if self.kind == "union" and self.blend is not None:
            value, k = found[0][0], self.motion.kinds[name][0].real(self.blend)
            for other in found[1:]:
                near = max(1 - abs(value - other[0]) / k, 0)
                value = min(value, other[0]) - k / 4 * near * near
            return value, (self,) + least[1], "blend"
        if self.kind == "union":
            chosen = least
        elif self.kind == "intersection":
            chosen = max(found, key=lambda v: v[0])
        else:
            chosen = max([found[0]] + [(-v, chain, face) for v, chain, face in found[1:]], key=lambda v: v[0])
        return chosen[0], (self,) + chosen[1], chosen[2]

    def _leaf_value(self, point, time, name):
        """The same of a leaf, at one of its own points."""
        kind = self.motion.kinds[name][0]
        if self.kind == "implicit":
            return self.formula[name](*point, kind.real(time) / kind.real(self.c)), (self,), 0
        shape = self.rough if name == "double" else self.shape
        if self.kind == "quadric":
            x, y, z = point
            terms = (x * x, y * y, z * z, x * y, x * z, y * z, x, y, z, 1)
            return sum(a * b for a, b in zip(shape["coefficients"], terms)), (self,), 0
        value, face = signed_distance(shape, point, kind.sqrt)
        return value, (self,), face

    def crossings(self, start, direction):
        """([(s, gradient, leaf chain, face)], whether a parameter that is none of them is inside), all at rest."""
        local_start = self.motion.point(start, ZERO)
        local = subtract(self.motion.point(along(start, direction, ONE), ZERO), local_start)
        if not self.parts:
            found = sorted(intersect(self.shape, local_start, local), key=lambda hit: hit[0])
            enters = [(s, dot(gradient, local) < 0) for s, gradient, _ in found]
            inside = lambda s: self._is_inside(s, enters, local_start)
            mine = [(s, gradient, (self,), face) for s, gradient, face in found]
        else:
            parts = [part.crossings(local_start, local) for part in self.parts]
            join = {"union": any, "intersection": all,
                    "difference": lambda each: (lambda e: e[0] and not any(e[1:]))(list(each))}[self.kind]
            inside = lambda s: join([within(s) for _, within in parts])
            every = sorted((hit for hits, _ in parts for hit in hits), key=lambda hit: hit[0])
            ends = [every[0][0] - 1] + [hit[0] for hit in every] + [every[-1][0] + 1] if every else []
            sides = [inside((a + b) / 2) for a, b in zip(ends, ends[1:])]
            mine = [(s, gradient, (self,) + chain, face)
                    for (s, gradient, chain, face), before, after in zip(every, sides, sides[1:]) if before != after]
        return [(s, self.motion.covector_out(gradient), chain, face) for s, gradient, chain, face in mine], inside

    def _is_inside(self, s, enters, start):
        """Whether a line is inside of a leaf at a parameter, by what it does next, or did last."""
        for at, entering in enters:
            if at > s:
                return not entering
        if enters:
            return enters[-1][1]
        return self.kind == "plane" and start[1] < 0


class Body:
    """A whole object, asked by null lines or others of its frame."""

    def __init__(self, table, scene, offset, position):
        self.whole = Part(table, scene, iter(range(10 ** 9)), offset, position)
        self.in_motion = self.whole.in_motion
        self.exact = self.whole.closed_form()
        if not self.exact:
            self.radius = 1.01 * self.whole.reach()
            self.certain = self.whole.has_distance()
            # Along a line whose time runs too, distances from matter that is slower than light change by no more
            # than twice the way; here it is asked within the body's bounds, where the map may be somewhat faster.
            self.rate = (4.0 if self.in_motion else 1.0) * self.whole.slope()

    def encloses(self, event):
        """Whether an event is inside of it."""
        if self.exact:
            return self.whole.crossings(event[1:], [mpf("0.36"), mpf("0.48"), mpf("0.8")])[1](ZERO)
        return self.whole.value(event[1:], event[0], "precise")[0] < 0

    def roots(self, start, direction, end):
        """(s, gradient or None, leaf chain, face) of all crossings, of those walked to only with 0 < s < end."""
        if self.exact:
            return self.whole.crossings(start[1:], direction[1:])[0]
        return self._walked(start, direction, end)

    def _closest(self, start, direction):
        """Where a line is closest to the centre, or about there."""
        s = ZERO
        for _ in range(1 if not self.in_motion else 0):
            centre = self.whole.motion.place([ZERO] * 3, start[0])
            s = -dot(subtract(start[1:], centre), direction[1:]) / dot(direction[1:], direction[1:])
        return s

    def _walked(self, start, direction, end):
        """The crossings of what has no closed form."""
        shift = max(ZERO, self._closest(start, direction) - mpf(self.radius) / norm(direction[1:]))
        rough_start, rough = [float(x) for x in along(start, direction, shift)], [float(x) for x in direction]
        size = math.sqrt(sum(x * x for x in rough[1:]))
        fastest = size + abs(rough[0]) if self.in_motion else size
        last = min(float(end - shift) if end is not None else math.inf, FARTHEST / size)
        found, s, before = [], 0.0, None
        while s < last:
            event = [a + s * b for a, b in zip(rough_start, rough)]
            centre = self.whole.motion.place([0.0] * 3, event[0], "double")
            away = math.sqrt(sum((a - b) ** 2 for a, b in zip(event[1:], centre))) - self.radius
            if away > 0:
                before = None
                s += max(away / fastest, SURELY_CROSSED * self.radius / fastest)
                continue
            value = self.whole.value(event[1:], event[0], "double")[0]
            if before is not None and (value < 0) != before[1]:
                found.append(self._refined(start, direction, shift + mpf(before[0]), shift + mpf(s), value < 0))
            before = (s, value < 0)
            s += self._step(value, event[0]) / size
        return [root for root in found if root is not None]

    def _step(self, value, time):
        """How far along a line no crossing can be."""
        if not self.certain:
            return 2 * self.radius / SAMPLES
        rate = self.rate * self.whole.motion.steepness(time, self.radius)
        return max(abs(value) / rate, SURELY_CROSSED * self.radius)

    def _refined(self, start, direction, low, high, ends_inside):
        """The crossing between two parameters, by bisection and then by regula falsi."""
        def at(s):
            event = along(start, direction, s)
            return self.whole.value(event[1:], event[0], "precise")
        f = lambda s: at(s)[0]
        for _ in range(40):
            middle = (low + high) / 2
            if (f(middle) < 0) == ends_inside:
                high = middle
            else:
                low = middle
        try:
            s = mp.findroot(f, (low, high), solver="anderson", tol=mpf(10) ** -80, maxsteps=60, verify=False)
        except ZeroDivisionError:
            s = low
        _, chain, face = at(low)
        if chain[-1].kind == "disk":
            x, _, z = body_point(chain, along(start, direction, s))
            if x * x + z * z > chain[-1].shape["radius"] ** 2:
                return None
        return s, None, chain, face

    def matter_at(self, event, chain, face, gradient):
        """(body point, celerity, normal in the matter's own frame) of a point of the surface."""
        point = body_point(chain, event)
        if gradient is not None:
            return point, [ZERO] * 3, unit(self._smooth(chain, point, face, gradient))
        celerity = [ZERO] * 3
        if self.in_motion:
            v = velocity(chain, point, event[0])
            celerity = scaled(v, 1 / mp.sqrt(1 - dot(v, v)))
        slopes = []
        for k in range(4):
            step = [STEP if i == k else ZERO for i in range(4)]
            later, earlier = ([a + sign * b for a, b in zip(event, step)] for sign in (1, -1))
            values = [self.whole.value(e[1:], e[0], "precise")[0] for e in (later, earlier)]
            slopes.append((values[0] - values[1]) / (2 * STEP))
        own = apply(boost(celerity), [-slopes[0]] + slopes[1:])
        if abs(own[0]) > mpf(10) ** -15 * norm(own[1:]):
            raise ArithmeticError("the surface does not go with its matter")
        return point, celerity, unit(own[1:])

    @staticmethod
    def _smooth(chain, point, face, gradient):
        """The normal of a smooth mesh, or the gradient; in the frame's axes."""
        smooth = shading_normal(chain[-1].shape, point, face)
        if smooth is None:
            return gradient
        for part in reversed(chain):
            smooth = part.motion.covector_out(smooth)
        return smooth if dot(smooth, gradient) > 0 else scaled(smooth, -ONE)


def body_point(chain, event):
    """Which point of a leaf is at an event."""
    point = event[1:]
    for part in chain:
        point = part.motion.point(point, event[0])
    return point


def place_of(chain, point, time):
    """Where a point of a leaf is."""
    for part in reversed(chain):
        point = part.motion.place(point, time)
    return point


def flow_at(chain, point, time):
    """The velocity of a leaf's matter in its own coordinates, or None."""
    leaf = chain[-1]
    if not leaf.flow:
        return None
    return [f(*point, time / leaf.c) / leaf.c for f in leaf.flow["precise"]]


def velocity(chain, point, time, step=STEP):
    """Of the matter of a leaf."""
    flow = flow_at(chain, point, time) or [ZERO] * 3
    later = place_of(chain, along(point, flow, step), time + step)
    earlier = place_of(chain, along(point, flow, -step), time - step)
    return [(a - b) / (2 * step) for a, b in zip(later, earlier)]


def own_time(chain, point, time):
    """What the clock of the matter at a leaf's point has counted since the frame's time 0."""
    h = mpf(10) ** -9
    rate = lambda at, t: mp.sqrt(1 - sum(v * v for v in velocity(chain, at, t, h)))
    if not chain[-1].flow:
        return clock(lambda t: rate(point, t), time)
    with mp.workdps(24):
        def back(s, y):
            """Backwards along the way of the matter, the clock beside its place."""
            return [-v for v in flow_at(chain, y[:3], time - s)] + [rate(y[:3], time - s)]
        return integrated(back, list(point) + [ZERO], time)[3]


def integrated(slope, y, end):
    """y(end) of y' = slope(s, y) from y(0), by extrapolation of the modified midpoint rule (Gragg) on pieces of 1 or less."""
    pieces = max(1, int(math.ceil(abs(float(end)))))
    h = end / pieces
    for piece in range(pieces):
        start, table = h * piece, []
        for n in range(2, 20, 2):
            before, now = y, along(y, slope(start, y), h / n)
            for k in range(1, n):
                before, now = now, along(before, slope(start + h * k / n, now), 2 * h / n)
            last = scaled(along([a + b for a, b in zip(before, now)], slope(start + h, now), h / n), ONE / 2)
            row = [last]
            for j, finer in enumerate(table[-1] if table else [], start=1):
                ratio = mpf(n) / (n - 2 * j)
                row.append([a + (a - b) / (ratio ** 2 - 1) for a, b in zip(row[-1], finer)])
            table.append(row)
        y = table[-1][-1]
    return y
