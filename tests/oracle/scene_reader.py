"""Scene file to frames, objects, lights and camera, at one frame of the animation.

Follows the scene format contract for what it covers; anything else that would change a value
(stereo) is refused with ValueError rather than ignored.
"""
import os
import tomllib
from dataclasses import dataclass, field

from mpmath import mp, mpf

from expression import evaluate, evaluate_precisely, number, vector
import cameras
from bodies import Body
from meshes import read_obj
from motion import Motion
from minkowski import Frame, ZERO, dot, rotation_about_axes, scaled, unit

MOTION_KEYS = ("velocity", "beta", "gamma", "celerity", "rapidity")
MERGED_TABLES = ("frame", "material")
MERGED_LISTS = ("light", "object")


@dataclass
class SceneObject:
    """One copy of an [[object]]: its body in its rest frame."""
    object_id: int
    copy: int
    name: str
    frame: Frame
    position: list
    rotation: list      # body axes to frame axes
    material: dict      # of what has none of its own
    body: Body
    visible: str        # a formula of the own time of its matter, or None
    casts_shadow: bool


@dataclass
class Light:
    """A light at rest in `frame`, unless it has a motion; `position` or `direction` are in that frame's coordinates."""
    kind: str
    table: dict
    frame: Frame
    position: list
    direction: list
    motion: Motion = None


def load_document(path, including=()):
    """The TOML document with its includes merged; ValueError for an include cycle."""
    path = os.path.abspath(path)
    if path in including:
        raise ValueError(f"include cycle through {path}")
    with open(path, "rb") as stream:
        document = tomllib.load(stream)
    for other in document.pop("include", []):
        part = load_document(os.path.join(os.path.dirname(path), other), including + (path,))
        for table in MERGED_TABLES:
            document.setdefault(table, {}).update(part.get(table, {}))
        for items in MERGED_LISTS:
            document[items] = part.get(items, []) + document.get(items, [])
    return document


class Scene:
    """Everything that the tracer needs. Lengths in scene units, times multiplied by c."""

    def __init__(self, document, image=None, camera_name=None, folder="."):
        self.document, self.folder = document, folder
        self.c = mpf(1)
        self.variables = self._variables(image)
        self.c = self.number(document.get("c", 1))
        self.frames = {"world": Frame()}
        for name in document.get("frame", {}):
            self._named_frame(name, ())
        self.materials = document.get("material", {})
        self.objects = self._objects()
        self.lights = [self._light(table) for table in document.get("light", [])]
        self.camera = self.camera_of(self.camera_table(camera_name))
        self.effects = document.get("effects", {})
        self.bounces = document.get("film", {}).get("bounces", 8)
        self.background = document.get("background", {})
        self.background_frame = self.rest_frame(self.background)[0]

    def number(self, value):
        """A scene number at this scene's parameters and time."""
        return number(value, self.variables)

    def vector(self, values):
        """A scene vector at this scene's parameters and time."""
        return vector(values, self.variables)

    def _variables(self, image):
        """`t`, `image_time`, `frame` and the parameters, which may refer to one another in file order."""
        animation = self.document.get("animation")
        variables = {"t": 0.0, "frame": float(image or 1)}
        if animation:
            first = animation.get("frames", [1, 1])[0]
            index = image if image is not None else first
            variables = {"t": (index - 1) / float(animation.get("fps", 25)), "frame": float(index)}
        variables["image_time"] = variables["t"]
        for name, value in self.document.get("params", {}).items():
            variables[name] = evaluate(value, variables) if isinstance(value, str) else float(value)
        return variables

    def celerity(self, table):
        """The vector gamma * beta of a table with a motion key, else None."""
        given = [key for key in MOTION_KEYS if key in table]
        if not given:
            return None
        if len(given) > 1:
            raise ValueError(f"more than one of {given}")
        key = given[0]
        if key in ("velocity", "beta"):
            beta = self.vector(table[key])
            if key == "velocity":
                beta = [b / self.c for b in beta]
            return scaled(beta, 1 / mp.sqrt(1 - dot(beta, beta)))
        value = self.number(table[key])
        size = {"gamma": lambda: mp.sqrt((value - 1) * (value + 1)), "celerity": lambda: value,
                "rapidity": lambda: mp.sinh(value)}[key]()
        return scaled(unit(self.vector(table["along"])), size)

    def _named_frame(self, name, above):
        """The frame [frame.NAME], made together with the frames it lies within."""
        if name in self.frames:
            return self.frames[name]
        if name in above:
            raise ValueError(f"frame '{name}' lies within itself")
        table = self.document["frame"][name]
        parent = self._named_frame(table.get("within", "world"), above + (name,))
        origin = [self.number(table.get("origin_time", 0)) * self.c]
        origin += self.vector(table.get("origin", [0, 0, 0]))
        self.frames[name] = parent.moving_child(self.celerity(table) or [ZERO] * 3, origin)
        return self.frames[name]

    def rest_frame(self, table):
        """(rest frame, position in it) of an object, light, camera or background table."""
        position = self.vector(table.get("position", [0, 0, 0]))
        celerity = self.celerity(table)
        if celerity is None:
            return self.frames[table.get("frame", "world")], position
        return Frame().moving_child(celerity, [ZERO] + position), [ZERO] * 3

    def _objects(self):
        """Every copy of every object, in file order, ids from 1."""
        found = []
        for index, table in enumerate(self.document.get("object", []), start=1):
            frame, position = self.rest_frame(table)
            fixed = position if any(key in table for key in MOTION_KEYS) else None
            rotation = rotation_about_axes(self.vector(table.get("rotate", [0, 0, 0])))
            for copy, offset in enumerate(self.copies(table)):
                body = Body(table, self, offset, fixed)
                found.append(SceneObject(index, copy, table.get("name", ""), frame,
                                         [p + o for p, o in zip(position, offset)], rotation,
                                         self.material_of(table) or {}, body, table.get("visible"),
                                         table.get("casts_shadow", True)))
        return found

    def material_of(self, table):
        """The keys of a thing's own material; None if it has none."""
        material = table.get("material")
        return self.materials[material] if isinstance(material, str) else material

    def at_own_time(self, value, own_time):
        """A number as written in a material or a light, by the own time (times c) of the matter."""
        if not isinstance(value, str):
            return mpf(value)
        return evaluate_precisely(value, {k: mpf(v) for k, v in self.variables.items()} | {"t": own_time / self.c})

    def copies(self, table):
        """The offsets of the copies of a table with `repeat`, in the rest frame's axes."""
        repeat = table.get("repeat")
        if not repeat:
            return [[ZERO] * 3]
        counts = [int(self.number(n)) for n in repeat["count"]]
        step = self.vector(repeat["step"])
        return [[i * step[0], j * step[1], k * step[2]] for k in range(counts[2])
                for j in range(counts[1]) for i in range(counts[0])]

    def shape_of(self, table):
        """The shape's parameters as mpf, with its kind."""
        shape = {"kind": table["shape"]}
        for key in ("radius", "top_radius", "height", "major", "minor"):
            if key in table:
                shape[key] = self.number(table[key])
        for key in ("size", "coefficients"):
            if key in table:
                shape[key] = self.vector(table[key])
        if "bounds" in table:
            shape["bounds"] = [self.vector(corner) for corner in table["bounds"]]
        if table["shape"] == "mesh":
            shape |= read_obj(os.path.join(self.folder, table["file"]), table.get("smooth", True))
        return shape

    def _light(self, table):
        """A light in its rest frame."""
        frame, position = self.rest_frame(table)
        direction = unit(self.vector(table["direction"])) if "direction" in table else None
        fixed = position if any(key in table for key in MOTION_KEYS) else None
        motion = Motion(table, self, [ZERO] * 3, fixed)
        motion = motion if motion.in_motion else None
        return Light(table.get("type", "point"), table, frame, position, direction, motion)

    def camera_table(self, name=None):
        """The table of the camera called `name`, or the only or first one."""
        table = self.document["camera"]
        if isinstance(table, dict):
            return table
        return next(t for t in table if name is None or t.get("name") == name)

    def camera_of(self, table):
        """The camera at the exposure."""
        return cameras.camera_of(self, table)


def load_scene(path, image=None):
    """The scene of a file at an image of its animation (the first one unless told)."""
    return Scene(load_document(path), image, folder=os.path.dirname(os.path.abspath(path)))
