"""scripts/blender/export_backlight.py on a file that is made here, against the same things as shapes.

  export_test.py BACKLIGHT SOURCE_DIR      exit status 77: skipped, as Blender is not installed
"""
import os
import sys
import tempfile

from processes import blender_or_skip, fail, run

TWINS = """
[[object]]
shape = "box"
size = [2, 0.5, 1]
rotate = [0, 30, 0]
position = [-1.5, 0.25, 0]
beta = [0, 0, -0.6]
[[object]]
shape = "sphere"
radius = 0.7
position = [1.2, 0.7, 0]
[[object]]
shape = "box"
size = [0.4, 0.4, 0.4]
position = [0, 1.5, -2]
[[light]]
position = [2, 5, 4]
intensity = 80
"""


# The same as the meshes and materials of the other file, with lamps that Blender gives in watts: a lamp that sends P
# to all sides has an intensity of P/4π, and a lamp whose face sends P has P/π straight ahead.
OPTICS = """
[[object]]
shape = "box"
size = [12, 1, 12]
position = [0, -0.5, 0]
material = { color = [0.5, 0.5, 0.5] }
[[object]]
shape = "box"
size = [1.5, 1.6, 0.2]
rotate = [0, 25, 0]
position = [-1.4, 0.8, -0.5]
material = { color = [0, 0, 0], mirror = [0.9, 0.8, 0.7] }
[[object]]
shape = "box"
size = [1, 1, 1]
rotate = [0, -15, 0]
position = [1.3, 0.5, 0]
material = { color = [0, 0, 0], glass = { index = 1.5, tint = [0.7, 0.9, 0.8] } }
[[object]]
shape = "box"
size = [0.6, 0.6, 0.6]
position = [0.2, 0.3, -1.2]
material = { color = [0.6, 0.2, 0.1] }
[[light]]
position = [2, 5, 4]
intensity = "100/pi"
color = [1, 1, 1]
[[light]]
type = "spot"
position = [-3, 4, 3]
direction = [0.4330127, -0.75, -0.5]
angle = 70
edge = 0.4
intensity = "400/(4*pi)"
color = [1, 1, 1]
"""


def exported(blender, source, scene, folder):
    """The text of the scene that a file of make_scene.py becomes, SCENE.toml in the folder, and what was told."""
    here = os.path.join(source, "tests", "blender")
    exporter = os.path.join(source, "scripts", "blender", "export_backlight.py")
    made, out = os.path.join(folder, scene + ".blend"), os.path.join(folder, scene + ".toml")
    run(blender, "-b", "-noaudio", "-P", os.path.join(here, "make_scene.py"), "--", scene, made)
    run(blender, "-b", "-noaudio", made, "-P", exporter, "--", out)
    with open(out, encoding="utf-8") as file:
        return file.read()


def expect_in(text, *all_wanted):
    for wanted in all_wanted:
        if wanted not in text:
            fail("not in the scene: %s\n%s" % (wanted, text))


class Pictures:
    """Renders scenes of a folder by name."""

    def __init__(self, backlight, folder):
        self.backlight, self.folder = backlight, folder

    def path(self, name):
        return os.path.join(self.folder, name)

    def render(self, name, text=None):
        if text is not None:
            with open(self.path(name + ".toml"), "w", encoding="utf-8") as file:
                file.write(text)
        run(self.backlight, "check", self.path(name + ".toml"))
        run(self.backlight, "render", self.path(name + ".toml"), "-o", self.path(name + ".exr"), "-D", "film.samples=1",
            "-D", 'film.aovs=["Z", "N", "doppler"]')

    def compare(self, one, other, *limits, status=0):
        run(self.backlight, "compare", self.path(one + ".exr"), self.path(other + ".exr"), *limits, status=status)


def test_shapes(blender, backlight, source, folder):
    text = exported(blender, source, "shapes", folder)
    expect_in(text, 'name = "box"', "beta = [0, 0, -0.6]", "color = [0.600000024, 0.200000003, 0.100000001]",
              'texture = "shapes.files/squares.png"', "emission = 2", "emission_color = [1, 0.5, 0.25]",
              "intensity = 79.5774715", "irradiance = 1", "resolution = [160, 100]")
    pictures = Pictures(backlight, folder)
    twins = text[:text.index("[[object]]")] + TWINS
    pictures.render("shapes")
    pictures.render("twins", twins)
    pictures.render("moved", twins.replace("[1.2, 0.7, 0]", "[1.25, 0.7, 0]"))
    # But for outlines: facets are off the ball by their sagitta.
    same = ["--channels", "Z,N,doppler", "--fail", "4e-3", "--tolerance", "N=0.03", "--failpercent", "1"]
    pictures.compare("twins", "shapes", *same)
    pictures.compare("moved", "shapes", *same, status=1)


def test_optics(blender, backlight, source, folder):
    text = exported(blender, source, "optics", folder)
    expect_in(text, "mirror = [0.899999976, 0.800000012", "glass = { index = 1.5, tint = [0.699999988, 0.899999976",
              "intensity = 31.8309886", 'type = "spot"')
    pictures = Pictures(backlight, folder)
    twins = text[:text.index("[[object]]")] + OPTICS
    pictures.render("optics")
    pictures.render("twins", twins)
    pictures.render("other", twins.replace("index = 1.5", "index = 1.4"))
    # Colour too: boxes of triangles are boxes.
    same = ["--fail", "1e-3", "--failrelative", "3e-3", "--failpercent", "0.5"]
    pictures.compare("twins", "optics", *same)
    pictures.compare("other", "optics", *same, status=1)


def main(backlight, source):
    blender = blender_or_skip()
    for test in (test_shapes, test_optics):
        with tempfile.TemporaryDirectory() as folder:
            test(blender, backlight, source, folder)
    print("the exported scenes show what the shapes do")


main(*sys.argv[1:])
