#!/usr/bin/env python3
"""The lessons of docs/course: their commands as written, and each number of their tables.

    lessons_test.py PROGRAM FOLDER [-v] [TestCase.test ...]     works in FOLDER, which is emptied first

A number is compared with what `backlight probe` says, to the digits that the lesson prints, and with a closed form that is worked out here
from the scene's geometry. Nothing of the program is used for that.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
from math import asin, atan, cos, cosh, degrees, exp, hypot, radians, sin, sinh, sqrt, tan, tanh

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
COURSE = TOP / "docs/course"
MIDDLE = 320  # the column of the middle of pictures of 641 pixels


def right_of_middle(column, pixels_to_45_degrees=240):
    """The angle at which a pixel of the middle row looks, to the right, in a perspective picture."""
    return atan((column - MIDDLE) / pixels_to_45_degrees)


def gamma(v):
    return 1 / sqrt(1 - v * v)


def doppler(v, angle_from_its_motion):
    return 1 / (gamma(v) * (1 + v * cos(angle_from_its_motion)))


def aberration():
    v, d = 0.8, sqrt((1 - 0.8) / (1 + 0.8))
    at_the_edge = 2 * atan(tan(right_of_middle(640) / 2) / d)  # the angle for those at rest
    return {
        ("A", 500, "object"): "hoop at 90 degrees",
        ("A", 500, "from camera's velocity"): degrees(2 * atan(d * tan(radians(90) / 2))),
        ("B", 500, "Doppler factor D"): 1 / (gamma(v) * (1 - v * v)),  # cos β = v
        ("C", 640, "P z"): 10.2 * cos(at_the_edge),
    }


def terrell():
    v, away = 0.8, 20
    s = sin(right_of_middle(440, 1600))
    # The rear wall's plane is at x = v (t + away) - 1/γ; its light comes from x = -s Z at t = -Z.
    z = (v * away - 1 / gamma(v)) / (v - s)
    return {
        ("A", 320, "emission time"): -away,
        ("A", 320, "Doppler factor D"): 1 / gamma(v),
        ("B", 440, "object"): "rear wall",
        ("B", 440, "emission time"): -z,
        ("B", 440, "object", "now"): "none: the ray meets no surface",
    }


def contraction():
    v, arrives = 0.8, 4

    def wagon(column, delay):
        x = -4 * tan(right_of_middle(column))
        t = arrives - hypot(x, 4) if delay else 0
        return gamma(v) * (x - v * t)

    return {
        ("A", 500, "P x", "now"): wagon(500, False),
        ("A", 140, "P x", "now"): wagon(140, False),
        ("B", 500, "P x"): wagon(500, True),
        ("C", 140, "P x"): wagon(140, True),
    }


def tubes():
    # What is seen at the angle a to the right is seen at 90° + a from a motion to the left.
    seen = {column: doppler(0.6, radians(90) + right_of_middle(column)) for column in (500, 320, 140, 405)}
    assert abs(round(MIDDLE + 240 * tan(asin(1 / 3))) - 405) == 0  # D = 1 at cos θ = (1/γ - 1)/v = -1/3
    return {(name, column, "Doppler factor D"): seen[column] for name, column in (("A", 500), ("B", 320), ("B", 140), ("C", 405))}


def searchlight():
    return {(name, column, "luminance"): doppler(0.6, radians(90) + right_of_middle(column)) ** 4
            for name, column in (("A", 500), ("B", 320), ("C", 140))}


def shadow():
    return {
        ("A", 320, "object"): "wall",
        ("A", 320, "luminance"): 0,
        ("A", 320, "emission time"): 9.6 - 8,
        ("C", 253, "object"): "rod",
        ("C", 253, "angle from view axis"): degrees(abs(right_of_middle(253))),
    }


def where_the_rod_is_seen():
    """The angle at which lesson 6 says that the rod's axis is seen: 0.8 X = v (T - 0.8 R)."""
    v, time = 0.6, 9.6
    # (T - 0.8 X/v)² = (0.8 R)², R² = X² + 64
    a, b, c = (0.8 / v) ** 2 - 0.64, -2 * time * 0.8 / v, time**2 - 0.64 * 64
    x = (-b - sqrt(b * b - 4 * a * c)) / (2 * a)
    return atan(x / 8)


def simultaneity():
    v, aside = 0.6, 3
    in_the_train = hypot(gamma(v) * aside, 4)
    clock = {column: 5.5 + gamma(v) * v * 4 * tan(right_of_middle(column)) for column in (140, 320, 500)}
    return {
        ("A", 140, "object", "platform"): "front lamp, lit",
        ("A", 500, "object", "platform"): "rear lamp, lit",
        ("A", 140, "distance", "platform"): hypot(aside, 4),
        ("B", 95, "object", "front"): "front lamp, lit",
        ("B", 95, "distance", "front"): in_the_train,
        ("B", 545, "object", "rear"): "rear lamp, lit",
        ("B", 545, "distance", "rear"): in_the_train,
        **{("C", column, "own time", "clocks"): t for column, t in clock.items()},
    }


def twins():
    v, turn, behind = 0.8, 5, 3
    own_turn = turn / gamma(v)
    slow, fast = sqrt((1 - v) / (1 + v)), sqrt((1 + v) / (1 - v))
    turn_is_seen = turn + v * turn + behind
    home = turn - (v * turn - 0.0001)  # when the light left the back of the dial at home that meets the ship at the turn
    return {
        ("A", 320, "Doppler factor D", "out"): slow,
        ("A", 320, "own time", "out"): (9 - behind) * slow,
        ("B", 320, "Doppler factor D", "back"): fast,
        ("B", 320, "own time", "back"): own_turn + (12.5 - turn_is_seen) * fast,
        ("C", 320, "own time", "before"): home,
        ("C", 320, "Doppler factor D", "before"): slow,
        ("C", 320, "own time", "after"): home,
        ("C", 320, "Doppler factor D", "after"): fast,
    }


def acceleration():
    tau = 2
    return {
        ("A", 320, "Doppler factor D", "ahead"): exp(tau),
        ("A", 640, "Doppler factor D", "ahead"): 1 / (cosh(tau) * (1 - tanh(tau) * cos(right_of_middle(640)))),
        ("B", 320, "Doppler factor D", "behind"): exp(-tau),
        ("C", 320, "own time", "behind"): sinh(tau) - cosh(tau),
        ("C", 320, "distance", "behind"): exp(-tau) * cosh(tau),
    }


def turning():
    rim, away, time = 0.8, 2, 12
    r = 120 / 160
    left = time - hypot(away, r)
    return {
        ("A", 320, "Doppler factor D"): 1,
        ("A", 440, "Doppler factor D"): sqrt(1 - (rim * r) ** 2),
        ("B", 320, "own time"): time - away,
        ("B", 440, "own time"): sqrt(1 - (rim * r) ** 2) * left,
        ("C", 440, "emission time"): left,
    }


EXPECTED = {"01": aberration, "02": terrell, "03": contraction, "04": tubes, "05": searchlight, "06": shadow, "07": simultaneity,
            "08": twins, "09": acceleration, "10": turning}


def blocks(text):
    return re.findall(r"^```sh\n(.*?)^```$", text, re.M | re.S)


def tables(text):
    """The rows of the table in the answer: name, row of the probe, what it says, image, pixel."""
    rows = re.findall(r"^\| ([A-C]) \| (.*?) \| (.*?) \| (\S+\.exr) \| (\d+,\d+) \|$", text, re.M)
    assert len(rows) == len(re.findall(r"^\| [A-Z][^|]*\|.*\.exr", text, re.M)), "a row of the table is not understood"
    return rows


def probe(image, pixel, row):
    """What the probe says in a row of its text, as a reader finds it."""
    told = subprocess.run([program, "probe", image, pixel], cwd=folder, capture_output=True, text=True, check=True).stdout
    part = None
    if row in ("P x", "P y", "P z"):
        row, part = "P", "xyz".index(row[-1])
    if row == "luminance":
        return float(re.search(r"luminance (\S+)", told)[1])
    line = re.search(rf"^  {re.escape(row)} +(\S.*)$", told, re.M)
    assert line, f"no row '{row}' in\n{told}"
    if row == "object":
        return re.sub(r" \(object \d+ of the scene\)$", "", line[1])
    return float(line[1].split()[part or 0])


class Lessons(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "bin").mkdir(parents=True)
        (folder / "scenes").symlink_to(TOP / "scenes")
        (folder / "bin/backlight").symlink_to(program)

    def check(self, number):
        (file,) = COURSE.glob(f"{number}-*.md")
        text = file.read_text()
        environment = os.environ | {"PATH": f"{folder}/bin:{os.environ['PATH']}"}
        environment.setdefault("BACKLIGHT_MODULE_PATH", str(pathlib.Path(program).parent.parent / "lib/backlight"))
        for block in blocks(text):
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=folder, env=environment, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stderr, "")
        left = dict(EXPECTED[number]())
        for name, row, says, image, pixel in tables(text):
            with self.subTest(name=name, image=image, pixel=pixel, row=row):
                column, line = map(int, pixel.split(","))
                self.assertEqual(line, 180)
                stem = pathlib.Path(image).stem
                key = next((key for key in ((name, column, row, stem), (name, column, row, stem.split("-")[-1]), (name, column, row)) if key in left), None)
                self.assertIsNotNone(key, "the test has no closed form for this row")
                expected = left.pop(key)
                found = probe(image, pixel, row)
                if isinstance(expected, str):
                    self.assertEqual((says, found), (expected, expected))
                    continue
                half_a_digit = 0.5 * 10.0 ** -len(says.partition(".")[2]) * (1 + 1e-9)
                self.assertLessEqual(abs(float(says) - expected), half_a_digit, f"the lesson says {says}, the formula {expected}")
                self.assertLessEqual(abs(float(says) - found), half_a_digit, f"the lesson says {says}, the probe {found}")
                self.assertLessEqual(abs(found - expected), 4e-6 * max(1.0, abs(expected)), f"the probe says {found}, the formula {expected}")
        self.assertEqual(left, {}, "the lesson's table lacks what the test expects")

    def test_the_rod_is_seen_where_lesson_6_says(self):
        angle = degrees(where_the_rod_is_seen())
        self.assertAlmostEqual(angle, 15.5, delta=0.05)
        self.assertIn("arctan(2.22/8) = 15.5°", (COURSE / "06-shadow.md").read_text())

    def test_every_lesson_is_tested_and_in_the_list(self):
        files = sorted(file.name for file in COURSE.glob("[0-9][0-9]-*.md"))
        self.assertEqual([name[:2] for name in files], sorted(EXPECTED))
        listed = re.findall(r"^\d+\. \[.*?\]\((.*?)\)", (COURSE / "README.md").read_text(), re.M)
        self.assertEqual(listed, files)
        for file in files:
            text = (COURSE / file).read_text()
            self.assertTrue(text.startswith(f"# {int(file[:2])}. "), file)
            self.assertRegex(text, r"(?s)\*\*Question\.\*\*.*!\[.+\]\(images/.*\n## Predict\n.*\n## Read it off\n.*\n## Answer\n", file)
            self.assertGreaterEqual(len(re.findall(r"^- \*\*[A-C](, [A-C])?\.\*\*", text, re.M)), 3, file)


for lesson in EXPECTED:
    setattr(Lessons, f"test_lesson_{lesson}", lambda self, lesson=lesson: self.check(lesson))

if __name__ == "__main__":
    program, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
