"""Four-vectors and Lorentz transformations in 60-digit arithmetic.

Units: c = 1, so every component is a length. Metric (-,+,+,+), components (time; space).
A four-vector is a list of four `mpf`, a matrix a list of rows. Nothing here is clever: at 60
digits the textbook formulas are good to 1e-30 even where gamma is 1e9, which is why they can
serve as the reference for code that may not use them (docs/physics.md section 6).
"""
from mpmath import mp, mpf

mp.dps = 60

ZERO, ONE = mpf(0), mpf(1)


def dot(a, b):
    """Euclidean scalar product of two equally long vectors."""
    return sum(x * y for x, y in zip(a, b))


def norm(a):
    """Euclidean length."""
    return mp.sqrt(dot(a, a))


def unit(a):
    """The direction of `a`; ValueError for the zero vector."""
    length = norm(a)
    if length == 0:
        raise ValueError("a zero vector has no direction")
    return [x / length for x in a]


def cross(a, b):
    """Right-handed vector product."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def add(a, b):
    """a + b, component by component."""
    return [x + y for x, y in zip(a, b)]


def subtract(a, b):
    """a - b, component by component."""
    return [x - y for x, y in zip(a, b)]


def scaled(a, factor):
    """factor * a."""
    return [factor * x for x in a]


def along(start, direction, s):
    """The point or event start + s * direction."""
    return [x + s * d for x, d in zip(start, direction)]


def apply(matrix, vector):
    """matrix * vector."""
    return [dot(row, vector) for row in matrix]


def multiply(a, b):
    """Matrix product a * b."""
    columns = list(zip(*b))
    return [[dot(row, column) for column in columns] for row in a]


def transpose(matrix):
    """The transposed matrix: for a rotation, its inverse."""
    return [list(row) for row in zip(*matrix)]


def identity(n):
    """The n x n unit matrix."""
    return [[ONE if i == j else ZERO for j in range(n)] for i in range(n)]


def boost(celerity):
    """The pure boost into the frame that moves with `celerity` (vector gamma * beta)."""
    gamma = mp.sqrt(1 + dot(celerity, celerity))
    matrix = [[gamma] + [-u for u in celerity]]
    for i in range(3):
        row = [-celerity[i]]
        row += [(ONE if i == j else ZERO) + celerity[i] * celerity[j] / (1 + gamma) for j in range(3)]
        matrix.append(row)
    return matrix


def inverse(lorentz):
    """Inverse of a Lorentz transformation: eta * transpose * eta."""
    return [[(-1 if (i == 0) != (j == 0) else 1) * lorentz[j][i] for j in range(4)] for i in range(4)]


class Frame:
    """An inertial frame: X_frame = from_world * (X_world - origin), origin being a world event."""

    def __init__(self, from_world=None, origin=None):
        self.from_world = from_world or identity(4)
        self.origin = origin or [ZERO] * 4
        self.to_world = inverse(self.from_world)

    def moving_child(self, celerity, origin):
        """The frame of a given celerity and origin event, both in this frame's coordinates.

        Its axes are the *world's* carried by the pure boost to its velocity, whatever this frame's are.
        """
        gamma = mp.sqrt(1 + dot(celerity, celerity))
        four_velocity = apply(self.to_world, [gamma] + list(celerity))
        return Frame(boost(four_velocity[1:]), self.event_to_world(origin))

    def event_from_world(self, event):
        """Coordinates in this frame of a world event."""
        return apply(self.from_world, subtract(event, self.origin))

    def event_to_world(self, event):
        """World coordinates of an event of this frame."""
        return add(self.origin, apply(self.to_world, event))

    def vector_from(self, other, vector):
        """Coordinates in this frame of a displacement given in `other`."""
        return apply(self.from_world, apply(other.to_world, vector))

    def event_from(self, other, event):
        """Coordinates in this frame of an event given in `other`."""
        return self.event_from_world(other.event_to_world(event))

    def gamma_relative_to(self, other):
        """Lorentz factor of the relative velocity of the two frames."""
        return self.vector_from(other, [ONE, ZERO, ZERO, ZERO])[0]


def rotation_about_axes(degrees):
    """Rz * Ry * Rx: a rotation about x, then y, then z, by three angles in degrees."""
    (a, b, c) = [mp.radians(angle) for angle in degrees]
    x = [[ONE, ZERO, ZERO], [ZERO, mp.cos(a), -mp.sin(a)], [ZERO, mp.sin(a), mp.cos(a)]]
    y = [[mp.cos(b), ZERO, mp.sin(b)], [ZERO, ONE, ZERO], [-mp.sin(b), ZERO, mp.cos(b)]]
    z = [[mp.cos(c), -mp.sin(c), ZERO], [mp.sin(c), mp.cos(c), ZERO], [ZERO, ZERO, ONE]]
    return multiply(z, multiply(y, x))


def angles_about_axes(rotation):
    """The three angles in degrees whose `rotation_about_axes` is `rotation`."""
    cos_b = mp.hypot(rotation[0][0], rotation[1][0])
    b = mp.atan2(-rotation[2][0], cos_b)
    if cos_b > mpf(10) ** -40:
        a = mp.atan2(rotation[2][1], rotation[2][2])
        c = mp.atan2(rotation[1][0], rotation[0][0])
    else:  # gimbal lock: only a -+ c is defined, so c = 0
        a = mp.atan2(-rotation[1][2], rotation[1][1])
        c = ZERO
    return [mp.degrees(angle) for angle in (a, b, c)]
