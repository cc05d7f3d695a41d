#!/usr/bin/env python3
"""60-digit reference values of pixels of a scene, as JSON lines.

    reference.py SCENE.toml --pixels "10,12;30,20"      chosen pixels
    reference.py SCENE.toml --grid 8                    every 8th pixel of every 8th row

Each line holds a pixel centre's id and AOVs, the RGB film value where it is defined without a colour
model, `condition` (the relative change of each value when the looking direction changes by 1e-16) and
`edge` (a change of direction by 1e-9 to 1e-6, less where pixels lie closer than 0.02, changes which smooth surface
is seen or which lights reach it).
"""
import argparse
import json
import random

from mpmath import mp, mpf

from minkowski import along, norm, subtract, unit
from scene_reader import load_scene
from shading import Shader, Unsupported
from tracer import Tracer, pixel_direction

ROUNDING, ROUNDINGS = mpf(10) ** -16, 3
ORDINARY_PITCH = mpf("0.02")  # of 64 pixels over 66 degrees
WIGGLES = [mpf(10) ** -9] * 3 + [mpf(10) ** -7, mpf(10) ** -6] * 2 + [mpf(10) ** -6] * 2


class Reference:
    """Reference values of one scene at one image of its animation."""

    def __init__(self, path, image=None):
        self.scene = load_scene(path, image)
        self.tracer = Tracer(self.scene)
        self.shader = Shader(self.tracer)

    def look(self, direction, light_delay):
        """(values by name, signature) of one looking direction in the camera frame."""
        camera = self.scene.camera
        ray, glass = self.tracer.camera_ray(direction, light_delay)
        hit = self.tracer.nearest(camera.frame, camera.event, ray, glass=glass)
        values = self.tracer.aovs(hit, light_delay) if hit else {}
        signature = hit.signature() if hit else (0, 0, 0)
        if hit and self.tracer.passed_on(hit, light_delay):
            mirrored, through = self.tracer.seen_in_mirror(hit, light_delay)
            values |= mirrored
            signature += through
        try:
            values["RGB"], reached = self.shader.film(hit, ray, light_delay)
            signature += reached
        except Unsupported:
            pass
        return values, signature

    def pixel_pitch(self, direction, i, j):
        """How far the next pixel's direction is, in radians: tiny where the view is a telescope's."""
        beside = [pixel_direction(self.scene.camera, i + step, j) for step in (1, -1)]
        return min(norm(subtract(d, direction)) for d in beside if d is not None)

    def pixel(self, i, j, light_delay=True, agrees=lambda record: False):
        """All that is known of pixel centre (i, j), as a dictionary ready for `to_json`. Of one whose record agrees with
        what it is compared with, it is not asked how well its direction determines it."""
        direction = pixel_direction(self.scene.camera, i, j)
        if direction is None:
            return {"pixel": [i, j], "light_delay": light_delay, "objectId": 0, "outside": True, "edge": False}
        values, signature = self.look(direction, light_delay)
        record = {"pixel": [i, j], "light_delay": light_delay, "objectId": signature[0], **values,
                  "condition": {name: mpf(0) for name in values}, "edge": False}
        return record if agrees(record) else record | self.doubts(direction, i, j, light_delay, values, signature)

    def doubts(self, direction, i, j, light_delay, values, signature):
        """{edge, condition} of a pixel."""
        wiggles = random.Random(i * 100003 + j)  # any fixed choice: results must repeat
        pitch = min(mpf(1), self.pixel_pitch(direction, i, j) / ORDINARY_PITCH)
        edge = any(self.look(moved(direction, size * pitch, wiggles), light_delay)[1] != signature
                   for size in WIGGLES)
        condition = {name: mpf(0) for name in values}
        for _ in range(0 if edge else ROUNDINGS):
            others, _ = self.look(moved(direction, ROUNDING, wiggles), light_delay)
            for name in values:
                change = relative_difference(others[name], values[name])
                condition[name] = max(condition[name], change)
        return {"condition": condition, "edge": edge}


def moved(direction, size, generator):
    """A unit direction `size` away from `direction`."""
    step = unit([mpf(generator.gauss(0, 1)) for _ in range(3)])
    return unit(along(direction, step, size))


def relative_difference(value, reference):
    """|value - reference| / |reference| of two vectors; 0 if they are equal."""
    difference = norm(subtract(value, reference))
    if difference == 0:
        return mpf(0)
    size = norm(reference)
    return difference / size if size else mpf("inf")


def to_json(value, digits=20):
    """JSON text with mpf numbers written in `digits` digits; a one-component vector as a number."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)}: {to_json(v, digits)}" for k, v in value.items()) + "}"
    if isinstance(value, list) and len(value) == 1 and isinstance(value[0], mpf):
        return to_json(value[0], digits)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(to_json(v, digits) for v in value) + "]"
    if isinstance(value, mpf):
        return mp.nstr(value, digits) if mp.isfinite(value) else "1e300"
    return json.dumps(value)


def rounded_condition(record):
    """The record with its condition figures in three digits, which is all they are worth."""
    if "condition" in record:
        figures = {k: float(mp.nstr(v, 3)) if mp.isfinite(v) else 1e300 for k, v in record["condition"].items()}
        record = record | {"condition": figures}
    return record


def chosen_pixels(arguments, camera):
    """The pixels that the command line names."""
    if arguments.pixels:
        return [tuple(int(n) for n in pair.split(",")) for pair in arguments.pixels.split(";")]
    first, step = arguments.grid // 2, arguments.grid
    return [(i, j) for j in range(first, camera.height, step) for i in range(first, camera.width, step)]


def main():
    """Command line entry."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--pixels", help="i,j;i,j;...")
    parser.add_argument("--grid", type=int, default=8, help="every Nth pixel")
    parser.add_argument("--frame", type=int, help="image of the animation")
    arguments = parser.parse_args()
    reference = Reference(arguments.scene, arguments.frame)
    for i, j in chosen_pixels(arguments, reference.scene.camera):
        for light_delay in (True, False):
            print(to_json(rounded_condition(reference.pixel(i, j, light_delay))))


if __name__ == "__main__":
    main()
