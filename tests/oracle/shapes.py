"""Where a line meets each shape, in the shape's local coordinates, at 60 digits.

Every function takes the shape's parameters, the line's start and direction (not normalised) and
returns all roots as (s, outward gradient, face): the line parameter, a normal of any length and the
number of the smooth face that was met. No order, no s > 0: the caller chooses.
"""
from mpmath import mp, mpf

from minkowski import ONE, ZERO, along, cross, dot, norm, subtract

IMAGINARY_PART_OF_A_REAL_ROOT = mpf(10) ** -22


def quadratic_roots(a, b, c):
    """Real roots of a s^2 + 2 b s + c, none for a tangent line."""
    if a == 0:
        return [] if b == 0 else [-c / (2 * b)]
    discriminant = b * b - a * c
    if discriminant <= 0:
        return []
    root = mp.sqrt(discriminant)
    return [(-b - root) / a, (-b + root) / a]


def sphere(shape, start, direction):
    """|x| = radius."""
    r = shape["radius"]
    roots = quadratic_roots(dot(direction, direction), dot(start, direction), dot(start, start) - r * r)
    return [(s, along(start, direction, s), 0) for s in roots]


def box(shape, start, direction):
    """|x_i| = size_i / 2."""
    half = [extent / 2 for extent in shape["size"]]
    hits = []
    for axis in range(3):
        if direction[axis] == 0:
            continue
        for side in (-1, 1):
            s = (side * half[axis] - start[axis]) / direction[axis]
            point = along(start, direction, s)
            if all(abs(point[other]) <= half[other] for other in range(3) if other != axis):
                normal = [mpf(side) if i == axis else ZERO for i in range(3)]
                hits.append((s, normal, 2 * axis + (side > 0)))
    return hits


def plane(_shape, start, direction):
    """y = 0."""
    if direction[1] == 0:
        return []
    return [(-start[1] / direction[1], [ZERO, ONE, ZERO], 0)]


def disk(shape, start, direction):
    """y = 0 within radius."""
    return cap(start, direction, ZERO, shape["radius"], ONE, 0)


def cap(start, direction, height, radius, sign, face):
    """The disk y = height, normal sign * y."""
    if direction[1] == 0:
        return []
    s = (height - start[1]) / direction[1]
    x, _, z = along(start, direction, s)
    return [(s, [ZERO, sign, ZERO], face)] if x * x + z * z <= radius * radius else []


def frustum(start, direction, bottom, top, height):
    """A capped cone or cylinder about y: radius `bottom` at -height/2, `top` at +height/2."""
    slope = (top - bottom) / height
    mid = (top + bottom) / 2  # the radius at y is mid + slope y
    radius, change = mid + slope * start[1], slope * direction[1]
    roots = quadratic_roots(
        direction[0] ** 2 + direction[2] ** 2 - change * change,
        start[0] * direction[0] + start[2] * direction[2] - radius * change,
        start[0] ** 2 + start[2] ** 2 - radius * radius)
    hits = []
    for s in roots:
        x, y, z = along(start, direction, s)
        if abs(y) <= height / 2:
            hits.append((s, [x, -slope * (mid + slope * y), z], 0))
    hits += cap(start, direction, -height / 2, bottom, -ONE, 1)
    if top > 0:
        hits += cap(start, direction, height / 2, top, ONE, 2)
    return hits


def cylinder(shape, start, direction):
    """A capped cylinder about y."""
    return frustum(start, direction, shape["radius"], shape["radius"], shape["height"])


def cone(shape, start, direction):
    """A capped cone about y, the full radius at the bottom."""
    return frustum(start, direction, shape["radius"], shape.get("top_radius", ZERO), shape["height"])


def torus(shape, start, direction):
    """(|x|^2 + major^2 - minor^2)^2 = 4 major^2 (x^2 + z^2), a quartic along the line."""
    major, minor = shape["major"], shape["minor"]
    length = norm(direction)
    d = [x / length for x in direction]
    nearest = -dot(start, d)  # start the polynomial at the line's closest approach
    o = along(start, d, nearest)
    if dot(o, o) > (major + minor) ** 2:
        return []
    k = dot(o, o) + major * major - minor * minor
    four = 4 * major * major
    quartic = [ONE, ZERO, 2 * k - four * (d[0] ** 2 + d[2] ** 2),
               -2 * four * (o[0] * d[0] + o[2] * d[2]), k * k - four * (o[0] ** 2 + o[2] ** 2)]
    hits = []
    for root in mp.polyroots(quartic, maxsteps=500, extraprec=200):
        if abs(mp.im(root)) > IMAGINARY_PART_OF_A_REAL_ROOT * (major + minor):
            continue
        p = along(o, d, mp.re(root))
        bracket = dot(p, p) - minor * minor
        normal = [p[0] * (bracket - major * major), p[1] * (bracket + major * major),
                  p[2] * (bracket - major * major)]
        hits.append(((nearest + mp.re(root)) / length, normal, 0))
    return hits


def quadric(shape, start, direction):
    """A x^2 + B y^2 + C z^2 + D xy + E xz + F yz + G x + H y + I z + J = 0."""
    a, b, c, d, e, f, g, h, i, j = shape["coefficients"]

    def form(p, q):
        """Twice the symmetric bilinear form of the second-degree part."""
        return (2 * (a * p[0] * q[0] + b * p[1] * q[1] + c * p[2] * q[2])
                + d * (p[0] * q[1] + p[1] * q[0]) + e * (p[0] * q[2] + p[2] * q[0])
                + f * (p[1] * q[2] + p[2] * q[1]))

    linear = [g, h, i]
    roots = quadratic_roots(form(direction, direction) / 2,
                            (form(start, direction) + dot(linear, direction)) / 2,
                            form(start, start) / 2 + dot(linear, start) + j)
    hits = []
    for s in roots:
        x, y, z = along(start, direction, s)
        hits.append((s, [2 * a * x + d * y + e * z + g, 2 * b * y + d * x + f * z + h,
                         2 * c * z + e * x + f * y + i], 0))
    return hits


def mesh(shape, start, direction):
    """All triangles, each by Cramer's rule, but for those that doubles say are far from the line."""
    nearest = -dot(start, direction) / dot(direction, direction)
    closest = along(start, direction, nearest)
    if norm(closest) > shape["reach"]:
        return []
    length, hits = norm(direction), []
    rough = [float(x) for x in closest], [float(x / length) for x in direction]
    for face, corners in enumerate(shape["triangles"]):
        if not cramer(shape["rough"][face], *rough, 1e-6):
            continue
        met = cramer([shape["places"][corner[0]] for corner in corners], closest, direction, 0)
        if met:
            hits.append((nearest + met[0], met[1], face))
    return hits


def cramer(places, start, direction, room):
    """(s, normal) of where a line meets a triangle, or is outside of it by so little; None where it does not."""
    a, b, c = places
    one, other, to = subtract(b, a), subtract(c, a), subtract(start, a)
    normal = cross(one, other)
    determinant = -dot(direction, normal)
    if abs(determinant) <= room:  # for doubles it is anywhere
        return (room, normal) if room else None
    aside = cross(to, direction)
    u, v = dot(other, aside) / determinant, -dot(one, aside) / determinant
    return (dot(to, normal) / determinant, normal) if min(u, v, 1 - u - v) >= -room else None


def weights(shape, point, face):
    """The barycentric coordinates of a point of a triangle."""
    a, b, c = (shape["places"][corner[0]] for corner in shape["triangles"][face])
    whole = cross(subtract(b, a), subtract(c, a))
    v = dot(cross(subtract(point, a), subtract(c, a)), whole) / dot(whole, whole)
    w = dot(cross(subtract(b, a), subtract(point, a)), whole) / dot(whole, whole)
    return 1 - v - w, v, w


def mean_of_corners(shape, point, face, values):
    """A value given at a triangle's corners, at a point of it."""
    parts = zip(weights(shape, point, face), values)
    return [sum(terms) for terms in zip(*[[w * x for x in value] for w, value in parts])]


def shading_normal(shape, point, face):
    """The normal of a smooth mesh at a point of a triangle, in its coordinates; None of all else."""
    if shape["kind"] != "mesh" or not shape["smooth"]:
        return None
    return mean_of_corners(shape, point, face, shape["normals"][face])


def longitude(x, z):
    """From 0 to 1 about y, 1/2 at +z."""
    return mpf(1) / 2 + mp.atan2(x, z) / (2 * mp.pi)


def texture_coordinates(shape, point, face):
    """(u, v) of a point of the surface, in the shape's coordinates."""
    kind, (x, y, z), half = shape["kind"], point, mpf(1) / 2
    if kind in ("sphere", "implicit"):
        return longitude(x, z), mp.atan2(mp.hypot(x, z), y) / mp.pi
    if kind in ("cylinder", "cone"):
        return longitude(x, z), half - y / shape["height"]
    if kind == "torus":
        return longitude(x, z), half - mp.atan2(y, mp.hypot(x, z) - shape["major"]) / (2 * mp.pi)
    if kind == "disk":
        return half + x / (2 * shape["radius"]), half + z / (2 * shape["radius"])
    if kind in ("plane", "quadric"):
        return x, z
    if kind == "mesh":
        corners = shape["triangles"][face]
        if any(corner[1] is None for corner in corners):
            return ZERO, ZERO
        return tuple(mean_of_corners(shape, point, face, [shape["texture"][corner[1]] for corner in corners]))
    x, y, z = (p / extent for p, extent in zip(point, shape["size"]))
    right = {0: z, 1: -z, 2: x, 3: x, 4: -x, 5: x}[face]
    down = {2: -z, 3: z}.get(face, -y)
    return half + right, half + down


INTERSECTIONS = {"sphere": sphere, "box": box, "plane": plane, "disk": disk, "cylinder": cylinder,
                 "cone": cone, "torus": torus, "quadric": quadric, "mesh": mesh}


def intersect(shape, start, direction):
    """All roots of a shape along a line; ValueError for a shape that this reference does not know."""
    if shape["kind"] not in INTERSECTIONS:
        raise ValueError(f"no reference for shape '{shape['kind']}'")
    return INTERSECTIONS[shape["kind"]](shape, start, direction)
