"""Triangles from Wavefront OBJ files, with the normals that a smooth mesh has (docs/meshes.md)."""
from mpmath import mp, mpf

from minkowski import ZERO, add, cross, dot, norm, scaled, subtract, unit

CREASE = 40  # degrees


def read_obj(path, smooth):
    """The shape of a file: places, texture places, and triangles of corners (place, texture, normal)."""
    places, texture, given, triangles = [], [], [], []
    with open(path, encoding="ascii") as stream:
        for words in (line.split() for line in stream):
            if not words or words[0] not in ("v", "vt", "vn", "f"):
                continue
            if words[0] == "f":
                corners = [_corner(word) for word in words[1:]]
                triangles += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]
                continue
            kept = {"v": places, "vt": texture, "vn": given}[words[0]]
            kept.append([mpf(float(x)) for x in words[1:]])
    texture = [[u, 1 - v] for u, v in texture]  # of an image v goes down, of a file up
    shape = {"places": places, "texture": texture, "triangles": triangles, "smooth": smooth}
    shape["reach"] = max(norm(place) for place in places) * (1 + mpf(10) ** -9)
    shape["rough"] = [[[float(x) for x in places[corner[0]]] for corner in corners] for corners in triangles]
    if smooth:
        given = [unit(normal) for normal in given]
        every = all(corner[2] is not None for corners in triangles for corner in corners)
        shape["normals"] = ([[given[corner[2]] for corner in corners] for corners in triangles] if every else
                            _made(places, triangles))
    return shape


def _corner(word):
    """(place, texture, normal) of one corner of a face, counted from 0."""
    numbers = [int(n) - 1 if n else None for n in word.split("/")]
    return tuple(numbers + [None] * (3 - len(numbers)))


def _made(places, triangles):
    """For each corner of each triangle the mean, weighted by angles, of the faces that meet there at less than CREASE."""
    at = [[places[corner[0]] for corner in corners] for corners in triangles]
    faces = [unit(cross(subtract(b, a), subtract(c, a))) for a, b, c in at]
    around = {}
    for face, corners in enumerate(at):
        for k, place in enumerate(corners):
            one, other = (unit(subtract(corners[(k + step) % 3], place)) for step in (1, 2))
            around.setdefault(tuple(place), []).append((face, mp.acos(dot(one, other))))
    least = mp.cos(mp.radians(CREASE))
    made = []
    for face, corners in enumerate(at):
        normals = []
        for place in corners:
            total = [ZERO] * 3
            for other, angle in around[tuple(place)]:
                if dot(faces[face], faces[other]) >= least:
                    total = add(total, scaled(faces[other], angle))
            normals.append(scaled(total, 1 / norm(total)))
        made.append(normals)
    return made
