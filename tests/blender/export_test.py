"""scripts/blender/export_backlight.py on a file that is made here, against the same things as shapes.

  export_test.py BACKLIGHT SOURCE_DIR      exit status 77: skipped, as Blender is not installed
"""
import os
import shutil
import subprocess
import sys
import tempfile

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


def run(*command, status=0):
    done = subprocess.run(command, capture_output=True, text=True, timeout=250)
    if done.returncode != status:
        sys.exit("%s\nexit status %d instead of %d\n%s%s" % (" ".join(command), done.returncode, status, done.stdout, done.stderr))
    return done.stdout


def main(backlight, source):
    blender = shutil.which("blender")
    if blender is None:
        print("skipped: Blender is not installed")
        sys.exit(77)
    here = os.path.join(source, "tests", "blender")
    exporter = os.path.join(source, "scripts", "blender", "export_backlight.py")
    with tempfile.TemporaryDirectory() as folder:
        path = lambda name: os.path.join(folder, name)
        run(blender, "-b", "-noaudio", "-P", os.path.join(here, "make_scene.py"), "--", path("made.blend"))
        run(blender, "-b", "-noaudio", path("made.blend"), "-P", exporter, "--", path("scene.toml"))
        with open(path("scene.toml"), encoding="utf-8") as file:
            text = file.read()
        for wanted in ('name = "box"', "beta = [0, 0, -0.6]", "color = [0.600000024, 0.200000003, 0.100000001]",
                       'texture = "scene.files/squares.png"', "emission = 2", "emission_color = [1, 0.5, 0.25]",
                       "intensity = 79.5774715", "irradiance = 1", "resolution = [160, 100]"):
            if wanted not in text:
                sys.exit("not in the scene: %s\n%s" % (wanted, text))
        run(backlight, "check", path("scene.toml"))
        twins = text[:text.index("[[object]]")] + TWINS
        with open(path("twins.toml"), "w", encoding="utf-8") as file:
            file.write(twins)
        with open(path("moved.toml"), "w", encoding="utf-8") as file:
            file.write(twins.replace("[1.2, 0.7, 0]", "[1.25, 0.7, 0]"))
        for name in ("scene", "twins", "moved"):
            run(backlight, "render", path(name + ".toml"), "-o", path(name + ".exr"), "-D", "film.samples=1",
                "-D", 'film.aovs=["Z", "N", "doppler"]')
        # But for outlines: facets are off the ball by their sagitta.
        same = ["--channels", "Z,N,doppler", "--fail", "4e-3", "--tolerance", "N=0.03", "--failpercent", "1"]
        run(backlight, "compare", path("twins.exr"), path("scene.exr"), *same)
        run(backlight, "compare", path("moved.exr"), path("scene.exr"), *same, status=1)
        print("the exported scene shows what the shapes do")


main(*sys.argv[1:])
