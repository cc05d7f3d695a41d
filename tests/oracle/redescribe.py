#!/usr/bin/env python3
"""The same scene, described from another inertial world: the principle of relativity as a program.

    redescribe.py SCENE.toml --celerity 1000 --along 1,2,-0.5 -o OUT.toml

Every event X of the old world becomes X' = B(u) X. A frame F of the old scene has coordinates
X_F = L (X - O); the pure boost of the new axes onto F's velocity gives X_F' = B(v') (X' - O') with O' = B(u) O,
and the two differ by the Wigner rotation R = B(v') B(u) L^-1 of the space axes alone: X_F' = R X_F, frame
time unchanged. So positions, rotations, light directions and camera axes within F turn by R, clocks do not change,
and the image must be the same. Old P and N are found as R^T P' and R^T N' (sidecar OUT.json).
Repeats are expanded: the sidecar's `id_map` leads from new object ids to old ones.
"""
import argparse
import json
import os

from mpmath import mpf

from minkowski import (ZERO, angles_about_axes, apply, boost, inverse, multiply, norm, scaled, unit)
from scene_reader import MOTION_KEYS, Scene, load_document
from toml_writer import document_text

PLACEMENT_KEYS = MOTION_KEYS + ("along", "frame", "position")


NOTHING = mpf(10) ** -40  # what 60-digit rounding leaves of a zero


def doubles(values):
    """Nearest doubles of a vector."""
    return [0.0 if abs(v) < NOTHING else float(v) for v in values]


class Redescription:
    """New frames for everything in a scene, made as they are asked for."""

    def __init__(self, scene, celerity):
        self.scene = scene
        self.boost = boost(celerity)
        self.frames = {}   # id of the old frame -> (new name, Wigner rotation)
        self.kept = []     # the old frames themselves, so that no id is used twice
        self.tables = {}   # new [frame.*] tables
        self.names = {id(frame): name for name, frame in scene.frames.items()}

    def frame(self, old, fallback):
        """(new frame's name, R) for an old frame; `fallback` names a frame that had no name."""
        if id(old) not in self.frames:
            to_old = multiply(old.from_world, inverse(self.boost))
            four_velocity = apply(inverse(to_old), [mpf(1), ZERO, ZERO, ZERO])
            lorentz = multiply(boost(four_velocity[1:]), inverse(to_old))
            rotation = [row[1:] for row in lorentz[1:]]
            name = {"world": "old_world"}.get(self.names.get(id(old)), self.names.get(id(old)))
            name = self._free(name or fallback)
            self.frames[id(old)] = (name, rotation)
            self.kept.append(old)
            origin = apply(self.boost, old.origin)
            self.tables[name] = self._motion(four_velocity[1:]) | {
                "origin": doubles(origin[1:]), "origin_time": float(origin[0] / self.scene.c)}
        return self.frames[id(old)]

    def _free(self, name):
        """`name`, with underscores added until it is not in use."""
        while name in self.tables or name == "world":
            name += "_"
        return name

    @staticmethod
    def _motion(celerity):
        """The motion keys of a frame with this celerity."""
        size = norm(celerity)
        if size == 0:
            return {"velocity": [0.0, 0.0, 0.0]}
        return {"celerity": float(size), "along": doubles(unit(celerity))}

    def place(self, table, fallback, frame, position):
        """(table without placement, R, position in the old rest frame); the new frame is set."""
        name, rotation = self.frame(frame, fallback)
        new = {k: v for k, v in table.items() if k not in PLACEMENT_KEYS} | {"frame": name}
        return new, rotation, position

    def objects(self):
        """(new object tables, old id of each, R of each): every copy of a repeat is its own object."""
        tables, old_ids, rotations = [], [], []
        source = self.scene.document.get("object", [])
        for obj in self.scene.objects:
            table = source[obj.object_id - 1]
            new, rotation, _ = self.place(table, f"rest_{obj.object_id}", obj.frame, obj.position)
            new.pop("repeat", None)
            if "repeat" in table and "name" in table:
                new["name"] = f"{table['name']}_{obj.copy}"
            new["position"] = doubles(apply(rotation, obj.position))
            new["rotate"] = doubles(angles_about_axes(multiply(rotation, obj.rotation)))
            tables.append(new)
            old_ids.append(obj.object_id)
            rotations.append([doubles(row) for row in rotation])
        return tables, old_ids, rotations

    def lights(self):
        """The new light tables."""
        tables = []
        for index, light in enumerate(self.scene.lights, start=1):
            table = light.table
            if table["type"] == "ambient":  # belongs to no frame
                tables.append(dict(table))
                continue
            new, rotation, position = self.place(table, f"lamp_{index}", light.frame, light.position)
            if table["type"] == "point":
                new["position"] = doubles(apply(rotation, position))
            else:
                new["direction"] = doubles(apply(rotation, light.direction))
            tables.append(new)
        return tables

    def camera(self, table, index):
        """The new table of one camera."""
        camera = self.scene.camera_of(table)
        new, rotation, position = self.place(table, f"observer_{index}", camera.frame, camera.event[1:])
        for key in ("look_at", "world_time"):
            new.pop(key, None)
        new["time"] = float(camera.event[0] / self.scene.c)
        new["position"] = doubles(apply(rotation, position))
        new["direction"] = doubles(apply(rotation, camera.axes[0]))
        new["up"] = doubles(apply(rotation, camera.axes[2]))
        return new

    def document(self, folder, new_folder):
        """(the new document, the sidecar)."""
        old = self.scene.document
        new = {k: v for k, v in old.items() if k not in ("frame", "camera", "light", "object")}
        cameras = old["camera"] if isinstance(old["camera"], list) else [old["camera"]]
        cameras = [self.camera(table, k) for k, table in enumerate(cameras, start=1)]
        objects, old_ids, rotations = self.objects()
        lights = self.lights()
        if "background" in old:
            new["background"] = self._background(old["background"])
        new |= {"camera": cameras if isinstance(old["camera"], list) else cameras[0],
                "frame": self.tables, "light": lights, "object": objects}
        new = moved_paths(new, folder, new_folder)
        sidecar = {"id_map": {str(k): i for k, i in enumerate(old_ids, start=1)},
                   "c": float(self.scene.c),
                   "rotation": {str(k): r for k, r in enumerate(rotations, start=1)}}
        return {k: v for k, v in new.items() if v not in ({}, [])}, sidecar

    def _background(self, table):
        """The background at rest in its old frame; only isotropic ones can turn by R unseen."""
        if "texture" in table or "stars" in table:
            raise ValueError("a background with directions cannot be rotated by the scene format")
        name, _ = self.frame(self.scene.background_frame, "sky")
        return {k: v for k, v in table.items() if k not in PLACEMENT_KEYS} | {"frame": name}


def moved_paths(value, folder, new_folder):
    """The value with texture paths made relative to the folder of the new scene."""
    if isinstance(value, dict):
        return {k: os.path.relpath(os.path.join(folder, v), new_folder)
                if k == "texture" and isinstance(v, str) else moved_paths(v, folder, new_folder)
                for k, v in value.items()}
    if isinstance(value, list):
        return [moved_paths(v, folder, new_folder) for v in value]
    return value


def redescribe(path, out, celerity, image=None):
    """Writes OUT.toml and OUT.json for the scene seen from a world moving with `celerity` (vector)."""
    scene = Scene(load_document(path), image)
    folder, new_folder = (os.path.dirname(os.path.abspath(p)) for p in (path, out))
    document, sidecar = Redescription(scene, celerity).document(folder, new_folder)
    with open(out, "w", encoding="utf-8") as stream:
        stream.write(document_text(document))
    with open(os.path.splitext(out)[0] + ".json", "w", encoding="utf-8") as stream:
        json.dump(sidecar, stream, indent=1)


def main():
    """Command line entry."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--celerity", required=True, help="gamma * beta of the new world in the old one")
    parser.add_argument("--along", required=True, help="its direction: x,y,z")
    parser.add_argument("--frame", type=int, help="image of the animation")
    parser.add_argument("-o", "--output", required=True)
    arguments = parser.parse_args()
    direction = unit([mpf(x) for x in arguments.along.split(",")])
    redescribe(arguments.scene, arguments.output, scaled(direction, mpf(arguments.celerity)), arguments.frame)


if __name__ == "__main__":
    main()
