"""Images of Backlight in Blender: colour and data by name, with the same bits, of both eyes.

  images_test.py BACKLIGHT SOURCE_DIR      exit status 77: skipped, as Blender is not installed

Debian: blender, python3-numpy, python3-openimageio.
"""
import os
import sys
import tempfile

from processes import blender_or_skip, fail, run


def planes(path):
    """By channel, arrays of rows."""
    import OpenImageIO
    opened = OpenImageIO.ImageInput.open(path)
    if opened is None:
        fail("cannot read %s: %s" % (path, OpenImageIO.geterror()))
    pixels, names = opened.read_image("float"), opened.spec().channelnames
    opened.close()
    return {name: pixels[:, :, i] for i, name in enumerate(names)}


# Blender's layer, our channels, and which it has them in.
LAYERS = (("Combined", ("R", "G", "B", "A"), "RGBA"), ("Depth", ("Z",), "R"), ("P", ("P.X", "P.Y", "P.Z"), "RGB"),
          ("N", ("N.X", "N.Y", "N.Z"), "RGB"), ("doppler", ("doppler.D",), "R"), ("emissionTime", ("emissionTime.T",), "R"),
          ("properTime", ("properTime.T",), "R"), ("objectId", ("objectId.V",), "R"))


def expect_same(found, plane, what):
    if found.tobytes() != plane.tobytes():
        fail("%s is not what the image has" % what)


def passed(blender, here, image, folder):
    told = run(blender, "-b", "-noaudio", "--factory-startup", "-P", os.path.join(here, "pass_images.py"), "--", image, folder + "/")
    return next(line for line in told.splitlines() if line.startswith("LAYERS")).split()[1:]


def main(backlight, source):
    blender = blender_or_skip()
    here = os.path.join(source, "tests", "blender")
    with tempfile.TemporaryDirectory() as folder:
        path = lambda name: os.path.join(folder, name)
        render = lambda name, *more: run(backlight, os.path.join(source, "scenes", "first.toml"), "-q", "-r", "60x44", "-s", "2", "-o",
                                         path(name + ".exr"), *more)
        render("all", "--aov", "all")
        names = passed(blender, here, path("all.exr"), path("all"))
        ours = planes(path("all.exr"))
        for layer, channels, letters in LAYERS:
            if layer not in names:
                fail("Blender finds no %s; it finds %s" % (layer, names))
            theirs = planes(path("all/%s0001.exr" % layer))
            for channel, letter in zip(channels, letters):
                expect_same(theirs[letter], ours[channel], channel)
        render("pair", "--aov", "Z,doppler", "-D", "camera.stereo.separation=0.5")
        passed(blender, here, path("pair.exr"), path("pair"))
        ours = planes(path("pair.exr"))
        for eye, of in (("L", {"R": "R", "Z": "Z", "D": "doppler.left.D"}),
                        ("R", {"R": "right.R", "Z": "right.Z", "D": "doppler.right.D"})):
            for layer, channel in (("Combined", of["R"]), ("Depth", of["Z"]), ("doppler", of["D"])):
                expect_same(planes(path("pair/%s0001_%s.exr" % (layer, eye)))["R"], ours[channel], channel)
        print("Blender has the same in %d layers and two eyes" % len(LAYERS))


main(*sys.argv[1:])
