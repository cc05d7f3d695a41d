#!/usr/bin/env python3
"""The report of `backlight compare --html`, in a real headless Chromium.

    report_test.py PROGRAM FOLDER      renders and works in FOLDER, which is emptied first; the screenshots stay there

The page is loaded with in_the_page.js added at its end, which presses its keys, clicks, reads pixels back as the browser has
decoded them, and leaves what it found as JSON in the page.
"""

import html
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--hide-scrollbars",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]

SCENE = """
[film]
resolution = [48, 36]
[camera]
position = [0, 1, -5]
[[object]]
shape = "sphere"
radius = 1
position = ["0.4 * t", 1, 0]
[[light]]
type = "distant"
direction = [0.2, -1, 0.7]
irradiance = 2
[background]
color = [0.1, 0.2, 0.4]
[animation]
fps = 1
frames = [1, 4]
"""

def chromium(page, *flags):
    """Loads a page; what the browser prints. All of its processes end with the call."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        command = ["chromium", *FLAGS, f"--user-data-dir={profile}", *flags, f"file://{page}"]
        with open(folder / "chromium.log", "w") as log, open(folder / "chromium.out", "w+") as out:
            browser = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=log, start_new_session=True)
            try:
                browser.wait(timeout=60)
            finally:
                try:

                    os.killpg(browser.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass
            out.seek(0)
            return out.read()

def render(output, *more):
    subprocess.run([program, "scene.toml", "-q", "-o", output, *more], cwd=folder, check=True)

class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "ref").mkdir(parents=True)
        (folder / "scene.toml").write_text(SCENE)
        render("ref/scene.####.exr", "--aov", "Z")
        render("new/scene.####.exr", "--aov", "Z", "-D", "object.1.radius=1.1")
        render("new/scene.####.exr", "--aov", "Z", "-f", "2")
        shutil.copy(folder / "new/scene.0001.exr", folder / "new/extra.exr")
        shutil.copy(folder / "ref/scene.0001.exr", folder / "ref/missing.exr")
        shutil.copy(folder / "ref/scene.0001.exr", folder / "ref/broken.exr")
        (folder / "new/broken.exr").write_bytes((folder / "new/scene.0001.exr").read_bytes()[:900])
        outcome = subprocess.run([program, "compare", "ref", "new", "-q", "--html", "report.html"], cwd=folder,
                                 stderr=subprocess.DEVNULL)
        assert outcome.returncode == 2, outcome.returncode
        script = pathlib.Path(__file__).with_name("in_the_page.js").read_text()
        page = folder / "tested.html"
        page.write_text((folder / "report.html").read_text() + f"<script>{script}</script>")
        text = chromium(page, "--window-size=1200,1500", "--virtual-time-budget=20000", "--dump-dom")
        found = re.search(r'<pre id="found">(.*?)</pre>', text, re.S)
        assert found, "the page's script did not come to its end: see chromium.log"
        cls.found = json.loads(html.unescape(found[1]))

    def test_no_script_failed(self):
        self.assertEqual(self.found["errors"], [])

    def test_every_picture_loads_and_nothing_is_fetched(self):
        names = ["broken.exr", "extra.exr", "missing.exr"] + [f"scene.000{i}.exr" for i in range(1, 5)]
        self.assertEqual(self.found["names"], names)
        # Colour: 4 pairs, the extra, the missing and the readable side of the broken one; 3 heat maps. Z: 3 triples.
        self.assertEqual(self.found["sizes"], [[48, 36]] * (8 + 3 + 3 + 9))
        self.assertEqual(self.found["fetched"], [])

    def test_the_first_that_is_not_equal_is_shown_and_counts_are_right(self):
        self.assertEqual(self.found["firstTitle"], "broken.exr")
        self.assertIn("the file ends too early", self.found["firstReason"])
        self.assertEqual(self.found["counts"],
                         ["7 images", "1 equal", "3 differs", "1 missing", "1 extra", "1 trouble"])

    def test_flipping_shows_the_other_picture(self):
        steps = self.found["flips"]
        self.assertEqual([step["shown"] for step in steps], ["New", "Reference", "New", "Reference", "New"])
        new, reference = steps[0]["pixel"], steps[1]["pixel"]
        self.assertGreater(max(abs(a - b) for a, b in zip(new, reference)), 20)
        self.assertEqual([step["pixel"] for step in steps], [new, reference, new, reference, new])

    def test_the_heat_map_is_brightest_at_the_worst_pixel(self):
        self.assertIn("Heat map", self.found["heat"]["shown"])
        self.assertGreater(sum(self.found["heat"]["worst"][:3]), 560)  # the pale yellow end of inferno
        self.assertLess(sum(self.found["heat"]["corner"][:3]), 20)

    def test_the_slider_uncovers_the_new_picture(self):
        self.assertEqual(self.found["slider"], [[False, "inset(0px 50% 0px 0px)"], [False, "inset(0px 20% 0px 0px)"], True])

    def test_channels_are_selectable(self):
        self.assertEqual(self.found["pictures"], ["colour", "Z"])
        self.assertTrue(self.found["pictureChanges"])
        self.assertEqual(self.found["graphChannels"], ["worst channel", "A", "B", "G", "R", "Z"])

    def test_the_graph_leads_to_the_image(self):
        heights = self.found["heights"]
        self.assertEqual(len(heights), 4)
        self.assertEqual(heights[1], 210)  # the frame without a difference lies on the ground
        self.assertTrue(all(10 <= h < 150 for h in (heights[0], heights[2], heights[3])), heights)
        self.assertEqual(self.found["afterGraph"], "scene.0004.exr")

    def test_the_worst_pixel_renders_again_as_the_page_says(self):
        command = self.found["command"]
        self.assertRegex(command, r"^backlight render scene\.toml .*-f 3 .*--crop \d+,\d+,\d+,\d+ -o pixel\.exr$")
        subprocess.run(command.replace("backlight", f"'{program}'", 1) + " -q", shell=True, cwd=folder, check=True)
        crop = command.split("--crop ")[1].split()[0]
        render("again.exr", "--aov", "Z", "-D", "object.1.radius=1.1", "-f", "3", "--crop", crop)
        same = subprocess.run([program, "compare", "-q", "--fail", "0", "again.0003.exr", "pixel.0003.exr"], cwd=folder)
        self.assertEqual(same.returncode, 0)

    def test_it_can_be_read_in_light_and_in_the_dark(self):
        for scheme, contrasts in self.found["contrast"].items():
            for place, ratio in contrasts.items():
                self.assertGreater(ratio, 4.5, f"{scheme}: {place}")  # WCAG 2.1, level AA
        for name, flags in (("light", []), ("dark", ["--blink-settings=preferredColorScheme=0"])):
            picture = folder / f"{name}.png"
            chromium(folder / "report.html", "--window-size=1200,1500", f"--screenshot={picture}", *flags)
            self.assertGreater(picture.stat().st_size, 20000)

if __name__ == "__main__":
    program, folder = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    unittest.main(argv=[sys.argv[0]] + sys.argv[3:])
