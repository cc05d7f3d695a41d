#!/usr/bin/env python3
"""backlight.py: what it writes, what it makes of images and of errors, and docs/python.md as written.

  BACKLIGHT=PROGRAM PYTHONPATH=.../python tests/python/module_test.py TOP
"""
import json
import math
import os
import pathlib
import re
import stat
import subprocess
import sys
import tempfile
import tomllib
import unittest
import warnings

import numpy as np
import OpenImageIO

import backlight

TOP = pathlib.Path(sys.argv.pop(1)).resolve()
SCENE = {
    "film": {"resolution": [32, 20], "aovs": []},
    "camera": {"position": [0, 0, -5], "look_at": [0, 0, 0]},
    "light": [{"type": "distant", "direction": [1, -1, 1], "irradiance": 3}],
    "object": [{"name": "ball", "shape": "sphere", "radius": 1, "material": {"color": [0.8, 0.4, 0.2]}}],
}


def with_(**more):
    return {**SCENE, **more}


class Writer(unittest.TestCase):
    def test_what_is_written_is_read_back(self):
        table = {
            "text": "a \"quote\", a \\, a\nline, \t, \x00 \x1f \x7f, ü, 雪, \U0001f680", "": "no name", "dotted.name": 1,
            "numbers": [0, -1, 2**60, 0.1, -1e300, 5e-324, 1e22, math.inf, -math.inf],
            "flags": [True, False], "empty": [], "nested": [[1, 2], [[]], ["x"]],
            "table": {"a": {"b": {"c": 1}}, "mixed": [1, {"x": 2}], "empty": {}},
            "list": [{"x": 1, "inner": {"y": [2]}}, {"list": [{"z": 3}, {}]}, {}],
            "ü": {"é b": [{"k": 1}]},
        }
        self.assertEqual(tomllib.loads(backlight.dumps(table)), table)

    def test_numpy_tuples_and_paths(self):
        written = backlight.dumps({"a": np.float32(0.5), "b": np.arange(3), "c": (1, np.bool_(True)),
                                   "d": pathlib.Path("x/y"), "e": np.eye(2)})
        self.assertEqual(tomllib.loads(written), {"a": 0.5, "b": [0, 1, 2], "c": [1, True], "d": "x/y",
                                                  "e": [[1.0, 0.0], [0.0, 1.0]]})

    def test_what_has_no_form_is_named(self):
        for value, words in (({"a": {"b": None}}, r"a\.b: .*NoneType"), ({"a": [1, {"b": 1j}]}, r"a\[1\]\.b: .*complex"),
                             ({1: 2}, "a key must be a str")):
            with self.assertRaisesRegex(TypeError, words):
                backlight.dumps(value)


class Images(unittest.TestCase):
    def test_arrays_are_those_of_the_file(self):
        image = backlight.render(with_(background={"color": [0.1, 0.2, 0.3]}), samples=2)
        self.assertEqual((image.width, image.height, image.window), (32, 20, (0, 0, 32, 20)))
        self.assertLessEqual(set("rgb alpha Z doppler emissionTime properTime P N objectId unresolved light.N light.Y "
                                 "samples".split()), set(image.names))
        with tempfile.TemporaryDirectory() as folder:  # every channel of the file is in one array
            image.save(pathlib.Path(folder, "a.exr"))
            info = subprocess.run([os.environ["BACKLIGHT"], "info", "--json", "a.exr"], cwd=folder, check=True,
                                  capture_output=True).stdout
        self.assertEqual(sum(image[name].size for name in image.names), 32 * 20 * len(json.loads(info)["channels"]))
        for name in image.names:
            shape = (20, 32, 3) if name in ("rgb", "P", "N") else (20, 32)
            self.assertEqual(image[name].shape, shape, name)
            self.assertEqual(image[name].dtype, np.float32, name)
        np.testing.assert_allclose(image["rgb"][0, 0], [0.1, 0.2, 0.3], rtol=1e-3)
        self.assertTrue(np.isinf(image["Z"][0, 0]))
        at = image.probe(15, 10)
        self.assertEqual(at["object"], "ball")
        np.testing.assert_array_equal(image["P"][10, 15], np.float32(at["P"]))
        np.testing.assert_array_equal(image["N"][10, 15], np.float32(at["N"]))
        self.assertLess(image["P"][10, 15][2], -0.9)  # the near side of the ball
        self.assertIn("doppler", image)
        self.assertNotIn("D", image)
        with self.assertRaisesRegex(KeyError, "the image has no 'D'; it has .*doppler"):
            image["D"]

    def test_a_dict_a_file_and_the_command_line_give_the_same_bits(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "a name with spaces.toml")
            file.write_text(backlight.dumps(SCENE), encoding="utf-8")
            images = [backlight.render(SCENE, aovs="none"), backlight.render(file, aovs="none")]
            made = pathlib.Path(folder, "c.exr")
            subprocess.run([os.environ["BACKLIGHT"], file, "-q", "-o", made], check=True)
            images.append(backlight.read(made))
            copy = pathlib.Path(folder, "copy.exr")
            images[0].save(copy)
            images.append(backlight.read(copy))
        for image in images:
            self.assertEqual(sorted(image.names), ["Z", "alpha", "rgb"] if "Z" in image else ["alpha", "rgb"])
            np.testing.assert_array_equal(image["rgb"], images[0]["rgb"])

    def test_eyes_of_a_stereo_pair(self):
        camera = {**SCENE["camera"], "stereo": {"separation": 0.5}}
        image = backlight.render(with_(camera=camera))
        for name in ("rgb", "alpha", "Z", "doppler", "P", "light.Y"):
            self.assertEqual(image[name].shape, image["right." + name].shape, name)
        self.assertFalse(np.array_equal(image["objectId"], image["right.objectId"]))
        right = [name for name in image.names if name.startswith("right.")]
        self.assertEqual(sorted(image.names), sorted(right + [name.removeprefix("right.") for name in right]))

    def test_a_crop_has_its_window(self):
        whole, part = backlight.render(SCENE), backlight.render(SCENE, arguments=["--crop", "8,4,24,12"])
        self.assertEqual((part.width, part.height, part.window), (32, 20, (8, 4, 24, 12)))
        np.testing.assert_array_equal(part["rgb"], whole["rgb"][4:12, 8:24])

    def test_keywords(self):
        animated = with_(params={"v": 0.0, "time": 1.0}, c="time", animation={"fps": 10, "frames": [1, 20]},
                         object=[{**SCENE["object"][0], "velocity": ["v", 0, 0]}])
        image = backlight.render(animated, resolution=(16, 10), samples=3, frame=11, v=0.25, aovs=["Z", "doppler"],
                                 overrides={"camera.fov": 40, "params.time": 2.5, "object.ball.position": [0, "v", 0]})
        header = image.header
        self.assertEqual((image.width, image.height), (16, 10))
        self.assertEqual((header["backlight/samples"], header["backlight/frame"], header["backlight/time"],
                          header["backlight/fov"]), (3, 11, 1, 40))
        self.assertEqual(header["backlight/overrides"], ["camera.fov=40", "params.time=2.5",
                                                         'object.ball.position=[0, "v", 0]', "params.v=0.25"])
        self.assertEqual(sorted(image.names), ["Z", "alpha", "doppler", "rgb"])
        self.assertEqual(backlight.render(animated, time=0.73).header["backlight/time"], 0.73)
        self.assertEqual(backlight.render(animated).header["backlight/frame"], 1)
        with self.assertRaises(TypeError):
            backlight.render(animated, time=1, frame=2)

    def test_it_shows_itself(self):
        image = backlight.render(SCENE)
        png = image._repr_png_()
        self.assertTrue(png.startswith(b"\x89PNG\r\n\x1a\n"))
        self.assertNotEqual(png, image.png("--exposure", -2))

    def test_nothing_is_left_behind(self):
        with tempfile.TemporaryDirectory() as folder:
            before, tempfile.tempdir = tempfile.tempdir, folder
            try:
                image = backlight.render(SCENE)
                image.png()
                self.assertEqual(len(os.listdir(folder)), 1)
                del image
                with self.assertRaises(backlight.SceneError):
                    backlight.render({"camera": {"fov": -1}})
                self.assertEqual(os.listdir(folder), [])
            finally:
                tempfile.tempdir = before


class Errors(unittest.TestCase):
    def test_of_a_scene_have_their_place(self):
        wrong = with_(camera={"fov": -1, "positon": [0, 0, 0]})
        with self.assertRaises(backlight.SceneError) as caught:
            backlight.render(wrong)
        error, lines = caught.exception, backlight.dumps(wrong).splitlines()
        self.assertEqual(error.file, "<stdin>")
        self.assertEqual(error.status, 3)
        self.assertEqual([lines[one.line - 1][one.column - 1:] for one in error.errors],
                         ["-1", "positon = [0, 0, 0]"])
        self.assertIn("did you mean 'position'?", str(error))
        self.assertEqual(error.errors[0][:4], (error.file, error.line, error.column, error.message))

    def test_of_a_file_name_it(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "a: 1:2: error: b.toml")
            file.write_text("[camera]\nfov = 0\n", encoding="utf-8")
            with self.assertRaises(backlight.SceneError) as caught:
                backlight.render(file)
            self.assertEqual((caught.exception.line, caught.exception.column), (2, 7))

    def test_of_a_parameter_name_the_override(self):
        with self.assertRaises(backlight.SceneError) as caught:
            backlight.render(SCENE, no_such_parameter="1 +")
        self.assertEqual(caught.exception.status, 3)

    def test_of_all_else(self):
        with self.assertRaises(backlight.BacklightError) as caught:
            backlight.render("no/such/scene.toml")
        self.assertEqual(caught.exception.status, 4)
        self.assertTrue(str(caught.exception).startswith("cannot read "), caught.exception)
        self.assertIn("no/such/scene.toml", str(caught.exception))
        with self.assertRaises(backlight.BacklightError) as caught:
            backlight.render(SCENE, arguments=["--no-such-option"])
        self.assertEqual(caught.exception.status, 2)
        with self.assertRaises(backlight.BacklightError) as caught:
            backlight.read("no.exr")
        self.assertEqual(caught.exception.status, 4)

    def test_a_program_that_is_not_there(self):
        before = os.environ["BACKLIGHT"]
        try:
            os.environ["BACKLIGHT"] = "/no/such/program"
            with self.assertRaisesRegex(backlight.BacklightError, "cannot run /no/such/program: No such file"):
                backlight.render(SCENE)
            del os.environ["BACKLIGHT"]
            path, os.environ["PATH"] = os.environ["PATH"], "/nowhere"
            try:
                with self.assertRaisesRegex(backlight.BacklightError, "there is no program backlight"):
                    backlight.render(SCENE)
            finally:
                os.environ["PATH"] = path
        finally:
            os.environ["BACKLIGHT"] = before

    def test_warnings_are_pythons(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            backlight.render(with_(material={"unused": {"color": [1, 1, 1]}}))
        self.assertEqual([one.category for one in caught], [backlight.BacklightWarning])
        self.assertIn("'unused' is not used", str(caught[0].message))
        self.assertEqual(caught[0].filename, __file__)


class Docs(unittest.TestCase):
    def test_the_page_runs_as_written(self):
        page = (TOP / "docs/python.md").read_text(encoding="utf-8")
        blocks = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
        self.assertGreaterEqual(len(blocks), 4)
        names = {}
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            os.symlink(TOP / "scenes", "scenes")
            try:
                for i, block in enumerate(blocks):
                    exec(compile(block, f"docs/python.md, example {i + 1}", "exec"), names)
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main(verbosity=2)
