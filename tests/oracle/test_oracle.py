#!/usr/bin/env python3
"""Checks of the reference itself: closed forms, round trips and the principle of relativity."""
import glob
import json
import os
import struct
import tempfile
import tomllib
import unittest
import zlib

from mpmath import mp, mpf

import exr_reader
from bodies import integrated
from expression import evaluate, evaluate_precisely
from glass import parted
from meshes import read_obj
from minkowski import (ONE, ZERO, along, angles_about_axes, apply, boost, dot, identity, inverse, multiply, norm,
                       rotation_about_axes, scaled, subtract, transpose, unit)
from redescribe import redescribe
from reference import Reference, relative_difference
from scene_reader import Scene, load_document
from shapes import intersect, shading_normal
from toml_writer import document_text
from tracer import Tracer

SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "scenes")
TINY = mpf(10) ** -45


def scene_path(name):
    """A committed scene."""
    return os.path.join(SCENES, name + ".toml")


def made(**tables):
    """A scene with a camera at rest at the origin that looks along z."""
    return Scene({"camera": {"direction": [0, 0, 1], "time": 0}} | tables)


class Lorentz(unittest.TestCase):
    """minkowski.py."""

    def test_boost_and_inverse_cancel(self):
        matrix = boost([mpf(3), mpf(-400), mpf(10) ** 6])
        product = multiply(matrix, inverse(matrix))
        self.assertTrue(all(norm(subtract(a, b)) < mpf(10) ** -40 for a, b in zip(product, identity(4))))

    def test_boost_brings_the_moving_frame_to_rest(self):
        celerity = [mpf(1), mpf(2), mpf(-2)]
        at_rest = apply(boost(celerity), [mp.sqrt(10)] + celerity)
        self.assertLess(norm(subtract(at_rest, [1, 0, 0, 0])), TINY)

    def test_angles_return_the_rotation(self):
        for degrees in ([10, 20, 30], [-170, 80, 95], [40, 90, 0], [0, -90, 25]):
            rotation = rotation_about_axes([mpf(d) for d in degrees])
            again = rotation_about_axes(angles_about_axes(rotation))
            self.assertTrue(all(norm(subtract(a, b)) < mpf(10) ** -38 for a, b in zip(rotation, again)))

    def test_expression(self):
        self.assertEqual(evaluate("2*t + sin(pi*t)^2 - clamp(9, 0, 3)", {"t": 0.5}), -1.0)
        self.assertLess(abs(evaluate_precisely("t^2", {"t": mpf(1) / 3}) - mpf(1) / 9), TINY)
        with self.assertRaises(ValueError):
            evaluate("__import__('os')", {})


class Shapes(unittest.TestCase):
    """Roots lie on the surface and normals are gradients."""

    def implicit(self, shape, p):
        """The shape's implicit function, written once more."""
        x, y, z = p
        if shape["kind"] == "torus":
            return (mp.hypot(x, z) - shape["major"]) ** 2 + y * y - shape["minor"] ** 2
        if shape["kind"] == "quadric":
            monomials = [x * x, y * y, z * z, x * y, x * z, y * z, x, y, z, mpf(1)]
            return dot(shape["coefficients"], monomials)
        if shape["kind"] == "cone":
            share = mpf(1) / 2 - y / shape["height"]
            return mp.hypot(x, z) - (shape["top_radius"] + (shape["radius"] - shape["top_radius"]) * share)
        return dot(p, p) - shape["radius"] ** 2

    def test_roots_and_gradients(self):
        start, direction = [mpf(-3), mpf("0.2"), mpf("-0.4")], [mpf("1.5"), mpf("-0.1"), mpf("0.15")]
        shapes = [{"kind": "torus", "major": mpf(1), "minor": mpf("0.4")},
                  {"kind": "cone", "radius": mpf(1), "top_radius": mpf("0.5"), "height": mpf(2)},
                  {"kind": "sphere", "radius": mpf(1)},
                  {"kind": "quadric", "coefficients": [mpf(k) / 10 for k in (9, 8, 7, 1, 2, -3, 1, 0, 2, -9)]}]
        for shape in shapes:
            hits = intersect(shape, start, direction)
            self.assertEqual(len(hits), 4 if shape["kind"] == "torus" else 2)
            for s, gradient, _ in hits:
                point = along(start, direction, s)
                self.assertLess(abs(self.implicit(shape, point)), mpf(10) ** -40)
                step = mpf(10) ** -20
                numeric = [self.implicit(shape, [p + (step if i == k else 0) for i, p in enumerate(point)]) / step
                           for k in range(3)]
                self.assertLess(norm(subtract(unit(numeric), unit(gradient))), mpf(10) ** -15)

    def test_box_and_caps(self):
        box = {"kind": "box", "size": [mpf(2), mpf(4), mpf(6)]}
        self.assertEqual(sorted(h[0] for h in intersect(box, [0, 0, -10], [mpf(0), mpf(0), mpf(1)])), [7, 13])
        can = {"kind": "cylinder", "radius": mpf(1), "height": mpf(3)}
        hits = intersect(can, [mpf("0.5"), -10, 0], [mpf(0), mpf(2), mpf(0)])
        self.assertEqual(sorted(h[0] for h in hits), [mpf(17) / 4, mpf(23) / 4])


class Bodies(unittest.TestCase):
    """Solids and meshes two ways, and integrals with closed forms."""

    PARTS = [{"shape": "box", "size": [2, 1.5, 1.8], "rotate": [10, 20, 30]},
             {"shape": "cylinder", "radius": 0.5, "height": 3, "position": [0.2, 0.1, 0], "scale": [1, 1, 0.8]},
             {"shape": "torus", "major": 0.9, "minor": 0.3, "position": [0, 0.4, 0.2]}]

    def test_solids_by_their_parts_and_by_steps(self):
        start, direction = [ZERO, mpf("0.3"), mpf("0.1"), mpf(-6)], [-ONE, mpf("0.02"), mpf("0.03"), ONE]
        for kind in ("union", "intersection", "difference"):
            body = made(object=[{"shape": kind, "part": self.PARTS}]).objects[0].body
            by_parts = body.roots(start, direction, None)
            self.assertGreaterEqual(len(by_parts), 2)
            body.radius, body.certain, body.rate = 3.0, True, body.whole.slope()
            by_steps = body._walked(start, direction, None)
            self.assertEqual(len(by_parts), len(by_steps))
            for one, other in zip(by_parts, by_steps):
                self.assertLess(abs(one[0] - other[0]), mpf(10) ** -40)
                self.assertEqual(one[2][-1].number, other[2][-1].number)

    def test_a_box_of_triangles(self):
        corners = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "box.obj")
            with open(path, "w", encoding="ascii") as stream:
                stream.write("".join("v %d %d %d\n" % tuple(c) for c in corners))
                stream.write("".join("f " + " ".join(str(n + 1) for n in face) + "\n" for face in faces))
            shape = {"kind": "mesh"} | read_obj(path, True)
        start, direction = [mpf("0.3"), mpf("-0.2"), mpf(-5)], [mpf("0.05"), mpf("0.1"), ONE]
        box = {"kind": "box", "size": [mpf(2)] * 3}
        found, expected = (sorted(intersect(s, start, direction), key=lambda hit: hit[0]) for s in (shape, box))
        self.assertEqual(len(found), 2)
        for one, other in zip(found, expected):
            self.assertLess(abs(one[0] - other[0]), TINY)
            self.assertLess(norm(subtract(unit(one[1]), other[1])), TINY)
            normal = shading_normal(shape, along(start, direction, one[0]), one[2])  # a cube keeps its edges
            self.assertLess(norm(subtract(unit(normal), other[1])), TINY)

    def test_the_way_of_a_flow(self):
        end = mpf("-3.7")
        turned = integrated(lambda s, y: [y[1], -y[0]], [ZERO, ONE], end)
        self.assertLess(abs(turned[0] - mp.sin(end)), mpf(10) ** -12)


class Glass(unittest.TestCase):
    """glass.py."""

    def test_fresnel(self):
        share, refracted = parted([ZERO, ZERO, ONE], [ZERO, ZERO, -ONE], ONE, mpf("1.5"))
        self.assertLess(abs(share - mpf("0.04")), TINY)
        self.assertEqual(refracted, [0, 0, 1])
        slanted = unit([mpf("0.8"), ZERO, mpf("0.6")])
        _, refracted = parted(slanted, [ZERO, ZERO, -ONE], ONE, mpf("1.6"))
        self.assertLess(norm(subtract(refracted, [mpf("0.5"), ZERO, mp.sqrt(3) / 2])), TINY)
        self.assertEqual(parted(slanted, [ZERO, ZERO, -ONE], mpf("1.6"), ONE), (1, None))

    def test_a_slab_in_motion_leaves_the_ray_as_it_was(self):
        scene = made(object=[{"shape": "box", "size": [9, 9, 1], "position": [0, 0, 4], "rotate": [20, 10, 0],
                              "beta": [0.7, 0.1, -0.5], "material": {"glass": {"index": 1.5}}}])
        tracer = Tracer(scene)
        ray, glass = tracer.camera_ray(unit([mpf("-0.7"), mpf("-0.1"), ONE]), True)
        hit = tracer.nearest(scene.camera.frame, scene.camera.event, ray, glass=glass)
        for index in (ONE, mpf(1.5)):
            self.assertEqual(hit.index, index)
            _, on, glass = tracer.passed_on(hit, True)[0]
            frame, hit = hit.obj.frame, tracer.nearest(hit.obj.frame, hit.event, on, mpf(10) ** -25, glass)
        self.assertIsNone(hit)
        after = tracer.carry(scene.camera.frame, frame, on)
        self.assertLess(norm(subtract(after, ray)), mpf(10) ** -40)


class Physics(unittest.TestCase):
    """Closed forms of docs/physics.md section 5."""

    def look(self, scene, direction):
        """The nearest hit along a looking direction."""
        tracer = Tracer(scene)
        ray, _ = tracer.camera_ray(unit([mpf(d) for d in direction]), True)
        return tracer, tracer.nearest(scene.camera.frame, scene.camera.event, ray)

    def test_doppler_factor_of_a_receding_plane(self):
        scene = made(object=[{"shape": "plane", "rotate": [90, 0, 0], "position": [0, 0, 5], "beta": [0, 0, 0.6]}])
        tracer, hit = self.look(scene, [0, 0, 1])
        beta = mpf(0.6)
        aovs = tracer.aovs(hit, True)
        self.assertLess(abs(aovs["doppler"][0] - mp.sqrt((1 - beta) / (1 + beta))), TINY)
        self.assertLess(abs(aovs["Z"][0] - 5 / (1 + beta)), TINY)  # it was there when the light left

    def test_outline_of_a_moving_sphere_is_a_circle(self):
        scene = made(object=[{"shape": "sphere", "radius": 1, "position": [1, 2, 6], "beta": [0.9, 0.1, -0.2]}])
        frame = scene.objects[0].frame
        centre = scaled(frame.event_from_world([mpf(0)] * 4)[1:], -1)  # seen from the camera event
        outward, side = unit(centre), unit([centre[1], -centre[0], mpf(0)])
        other = [outward[1] * side[2] - outward[2] * side[1], outward[2] * side[0] - outward[0] * side[2],
                 outward[0] * side[1] - outward[1] * side[0]]
        half = mp.asin(1 / norm(centre))
        rim = []
        for k in range(7):
            around = along(scaled(side, mp.cos(k)), other, mp.sin(k))
            direction = along(scaled(outward, mp.cos(half)), around, mp.sin(half))
            rim.append(unit(apply(frame.to_world, [mpf(-1)] + direction)[1:]))
        normal = unit([mp.det(mp.matrix([[a[i] if i != k else mpf(1) for i in range(3)] for a in rim[:3]]))
                       for k in range(3)])
        heights = [dot(normal, direction) for direction in rim]
        self.assertLess(max(heights) - min(heights), mpf(10) ** -40)
        for direction in rim:
            inside = along(direction, subtract(scaled(normal, dot(normal, direction)), direction), mpf(10) ** -6)
            outside = along(direction, subtract(scaled(normal, dot(normal, direction)), direction), -mpf(10) ** -6)
            self.assertIsNotNone(self.look(scene, inside)[1])
            self.assertIsNone(self.look(scene, outside)[1])

    def test_white_surface_under_a_point_light(self):
        document = {"camera": {"direction": [0, -1, 0], "up": [0, 0, 1], "position": [0, 2, 0], "time": 0},
                    "light": [{"type": "point", "position": [0, 4, 0], "intensity": 8}],
                    "object": [{"shape": "plane", "material": {"color": [1, 1, 1]}}], "film": {"resolution": [1, 1]}}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.toml")
            with open(path, "w", encoding="utf-8") as stream:
                stream.write(document_text(document))
            record = Reference(path).look([mpf(0), -mpf(1), mpf(0)], True)[0]
        self.assertLess(abs(record["RGB"][0] - mpf(8) / (16 * mp.pi)), TINY)


class Relativity(unittest.TestCase):
    """A scene and its redescription have the same pixels."""

    def check(self, name, celerity, tolerance):
        """Compares pixels of the scene with those of its redescription."""
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "again.toml")
            redescribe(scene_path(name), out, [mpf(u) for u in celerity])
            old, new = Reference(scene_path(name)), Reference(out)
            with open(os.path.join(folder, "again.json"), encoding="utf-8") as stream:
                sidecar = json.load(stream)
        for i in range(3, 64, 12):
            for j in range(5, 48, 8):
                self.check_pixel(old.pixel(i, j), new.pixel(i, j), sidecar, tolerance)

    def check_pixel(self, old, new, sidecar, tolerance):
        """Compares one pixel."""
        if old["edge"]:
            return
        self.assertEqual(old["objectId"], sidecar["id_map"].get(str(new["objectId"]), 0))
        for name in ("Z", "doppler", "properTime", "P", "N", "RGB"):
            if name not in old:
                continue
            value = new[name]
            if name in "PN":
                rotation = [[mpf(x) for x in row] for row in sidecar["rotation"][str(new["objectId"])]]
                value = apply(transpose(rotation), value)
            self.assertLess(relative_difference(value, old[name]), tolerance, (name, old["pixel"]))

    def test_slow(self):
        self.check("relativity", [0.3, -0.2, 0.4], 1e-13)

    def test_celerity_1000(self):
        self.check("relativity", [600, 0, -800], 1e-7)

    def test_nested_frames(self):
        self.check("nested_frames", [-30, 20, 10], 1e-9)

    def test_repeats_and_repeated_ids(self):
        self.check("shapes_oblique", [1, 2, 3], 1e-12)


class Files(unittest.TestCase):
    """Reading and writing."""

    def test_toml_round_trip(self):
        for path in glob.glob(os.path.join(SCENES, "*.toml")):
            document = load_document(path)
            self.assertEqual(tomllib.loads(document_text(document)), document)

    def test_exr(self):
        rows = [[0.5 + x + 10 * y for x in range(3)] for y in range(2)]
        raw = b"".join(struct.pack("<3f", *row) for row in rows)
        split = raw[0::2] + raw[1::2]
        deltas = bytes([split[0]] + [(b - a + 128) & 255 for a, b in zip(split, split[1:])])
        block = zlib.compress(deltas)
        raw_attributes = [("channels", "chlist", b"Z\0" + struct.pack("<iIii", 2, 0, 1, 1) + b"\0"),
                          ("compression", "compression", b"\3"),
                          ("dataWindow", "box2i", struct.pack("<4i", 5, 7, 7, 8))]
        header = struct.pack("<ii", exr_reader.MAGIC, 2) + b"".join(
            f"{n}\0{t}\0".encode() + struct.pack("<i", len(v)) + v for n, t, v in raw_attributes) + b"\0"
        stored = block if len(block) < len(raw) else raw
        data = header + struct.pack("<Q", len(header) + 8) + struct.pack("<ii", 7, len(stored)) + stored
        self.assertEqual(exr_reader.unzipped(block, len(raw)), raw)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "z.exr")
            with open(path, "wb") as stream:
                stream.write(data)
            image = exr_reader.read(path)
        self.assertEqual([[image.at("Z", 5 + x, 7 + y) for x in range(3)] for y in range(2)], rows)


if __name__ == "__main__":
    unittest.main()
