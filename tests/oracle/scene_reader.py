"""Scene file to frames, objects, lights and camera, at one frame of the animation.

Follows the scene format contract for what it covers; anything else that would change a value
(CSG, implicit surfaces, stereo) is refused with ValueError rather than ignored.
"""
import os
import tomllib
from dataclasses import dataclass, field

from mpmath import mp, mpf

from expression import evaluate, number, vector
from motion import Motion, MovingBody, is_in_motion
from minkowski import (Frame, ONE, ZERO, apply, dot, multiply, rotation_about_axes, scaled,
                       subtract, transpose, unit)

MOTION_KEYS = ("velocity", "beta", "gamma", "celerity", "rapidity")
MERGED_TABLES = ("frame", "material")
MERGED_LISTS = ("light", "object")


@dataclass
class SceneObject:
    """One copy of an [[object]]: shape in local coordinates, placement in its rest frame."""
    object_id: int
    copy: int
    name: str
    shape: dict
    frame: Frame
    position: list
    rotation: list      # local axes to frame axes
    scale: list
    material: dict
    body: MovingBody = None  # of what moves in its frame
    to_local: list = field(init=False)  # linear part of frame -> local

    def __post_init__(self):
        inverse_scale = [[ONE / self.scale[i] if i == j else ZERO for j in range(3)] for i in range(3)]
        self.to_local = multiply(inverse_scale, transpose(self.rotation))


@dataclass
class Light:
    """A light at rest in `frame`, unless it has a motion; `position` or `direction` are in that frame's coordinates."""
    kind: str
    table: dict
    frame: Frame
    position: list
    direction: list
    motion: Motion = None


@dataclass
class Camera:
    """The camera event (own frame coordinates), the axes f, r, u and the projection."""
    frame: Frame
    event: list
    axes: tuple
    projection: str
    fov: mpf
    width: int
    height: int


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

    def __init__(self, document, image=None, camera_name=None):
        self.document = document
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
        """All copies of all objects, in file order."""
        found = []
        for index, table in enumerate(self.document.get("object", []), start=1):
            frame, position = self.rest_frame(table)
            scale = table.get("scale", 1)
            scale = self.vector(scale) if isinstance(scale, list) else [self.number(scale)] * 3
            material = table.get("material", {})
            material = self.materials[material] if isinstance(material, str) else material
            rotation = rotation_about_axes(self.vector(table.get("rotate", [0, 0, 0])))
            for copy, offset in enumerate(self.copies(table)):
                place = [p + o for p, o in zip(position, offset)]
                shape = self._shape(table)
                body = MovingBody(shape, Motion(table, self, offset)) if self._moves(table) else None
                found.append(SceneObject(index, copy, table.get("name", ""), shape, frame,
                                         place, rotation, scale, material, body))
        return found

    def copies(self, table):
        """The offsets of the copies of a table with `repeat`, in the rest frame's axes."""
        repeat = table.get("repeat")
        if not repeat:
            return [[ZERO] * 3]
        counts = [int(self.number(n)) for n in repeat["count"]]
        step = self.vector(repeat["step"])
        return [[i * step[0], j * step[1], k * step[2]] for k in range(counts[2])
                for j in range(counts[1]) for i in range(counts[0])]

    def _shape(self, table):
        """The shape's parameters as mpf, with its kind."""
        shape = {"kind": table["shape"]}
        for key in ("radius", "top_radius", "height", "major", "minor"):
            if key in table:
                shape[key] = self.number(table[key])
        for key in ("size", "coefficients"):
            if key in table:
                shape[key] = self.vector(table[key])
        return shape

    def _light(self, table):
        """A light in its rest frame."""
        frame, position = self.rest_frame(table)
        direction = unit(self.vector(table["direction"])) if table["type"] == "distant" else None
        motion = Motion(table, self, [ZERO] * 3) if self._moves(table) else None
        return Light(table["type"], table, frame, position, direction, motion)

    def _moves(self, table):
        """Whether a thing moves in its frame."""
        return is_in_motion(table) and not any(key in table for key in MOTION_KEYS)

    def camera_table(self, name=None):
        """The table of the camera called `name`, or the only or first one."""
        table = self.document["camera"]
        if isinstance(table, dict):
            return table
        return next(t for t in table if name is None or t.get("name") == name)

    def camera_of(self, table):
        """The camera at the exposure."""
        frame, position = self.rest_frame(table)
        event = [self._exposure(table, frame, position)] + position
        if "look_at" in table:
            start = self.vector(table.get("position", [0, 0, 0]))
            forward = unit(subtract(self.vector(table["look_at"]), start))
        else:
            forward = unit(self.vector(table.get("direction", [0, 0, 1])))
        width, height = self.document.get("film", {}).get("resolution", [64, 48])
        return Camera(frame, event, axes_looking(forward, self.vector(table.get("up", [0, 1, 0]))),
                      table.get("projection", "perspective"), self.number(table.get("fov", 60)),
                      width, height)

    def _exposure(self, table, frame, position):
        """The camera's own time of the exposure, times c."""
        if "world_time" in table:
            world_time = self.number(table["world_time"]) * self.c
            at_own_zero = frame.event_to_world([ZERO] + position)[0]
            return (world_time - at_own_zero) / apply(frame.to_world, [ONE, ZERO, ZERO, ZERO])[0]
        return self.number(table.get("time", "t")) * self.c


def axes_looking(forward, up):
    """(f, r, u): r = f x up normalised, u = r x f."""
    f = forward
    r = unit([f[1] * up[2] - f[2] * up[1], f[2] * up[0] - f[0] * up[2], f[0] * up[1] - f[1] * up[0]])
    u = [r[1] * f[2] - r[2] * f[1], r[2] * f[0] - r[0] * f[2], r[0] * f[1] - r[1] * f[0]]
    return f, r, u


def load_scene(path, image=None):
    """The scene of a file at an image of its animation (the first one unless told)."""
    return Scene(load_document(path), image)
