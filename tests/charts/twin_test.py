"""Of a scene, POV-Ray's twin has the same things where they are seen; what has no twin is refused with the reason.

    twin_test.py SOURCE
"""

import os
import re
import sys
import tempfile

SOURCE = sys.argv[1]
sys.path.insert(0, os.path.join(SOURCE, "bench"))
import povray_twin  # noqa: E402

# The train passes x = 1 at time -5 and is seen from the origin at time 0 where 1 + 0.6 (t + 5) = -t: at x = 2.5.
SCENE = """
[params]
half = "0.5 * one"
one = 1

[camera]
direction = [1, 0, 0]

[frame.train]
beta = [0.6, 0, 0]
origin = [1, 0, 0]
origin_time = -5

[[light]]
type = "point"
position = [0, "2^2 + sqrt(1)", 0]
shadows = false

[material]
red = { color = [1, 0, 0], specular = 0.25 }

[[object]]
shape = "sphere"
radius = "half"
frame = "train"
material = "red"

[[object]]
shape = "box"
size = [1, 2, 3]
rotate = [0, 90, 0]
casts_shadow = false
repeat = { count = [2, 1, 3], step = [4, 0, 5] }

[[object]]
shape = "difference"

[[object.part]]
shape = "cylinder"
radius = 1
height = 2

[[object.part]]
shape = "torus"
major = 1
minor = 0.2
position = [0, 1, 0]
material = "red"
"""
REFUSED = {
    '[[object]]\nshape = "implicit"\nf = "x*y*z"\n': 'shape = "implicit"',
    '[camera]\nprojection = "fisheye"\n': "perspective",
    '[[object]]\nshape = "sphere"\nradius = "width"\n': "width",
    '[[object]]\nshape = "sphere"\nradius = 1\nmaterial = "gold"\n': "gold",
    '[[object]]\nshape = "sphere"\nradius = "open(1)"\n': "formula",
}


def expect(is_so, what):
    if not is_so:
        sys.exit("twin_test: " + what)


def twin_of(text, folder):
    path = os.path.join(folder, "scene.toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return povray_twin.twin(path)


def main():
    with tempfile.TemporaryDirectory() as folder:
        twin = twin_of(SCENE, folder)
        expect(re.search(r"sphere { 0, 0\.5 pigment { rgb <1,0,0> }.*phong 0\.25.*translate <2\.5,0,0> }", twin), "the ball is where it is seen")
        expect(twin.count("box { <-0.5,-1,-1.5>, <0.5,1,1.5>") == 6, "six boxes")
        expect(twin.count("no_shadow rotate <0,90,0> translate <4,0,10>") == 1, "the last of them")
        expect("light_source { <0,5,0> " in twin and twin.count("shadowless") == 1, "the lamp")
        expect(re.search(r"difference { cylinder { -1\*y, 1\*y, 1 +} torus { 1, 0\.2 pigment .* translate <0,1,0> } pigment", twin), "the parts")
        for text, reason in REFUSED.items():
            try:
                twin_of(text, folder)
                expect(False, f"no twin of {text}")
            except povray_twin.NoTwin as refused:
                expect(reason in str(refused), f"'{refused}' tells of {reason}")
    for name in ("default", "fig1-tram-interior", "fig2a-tram-rest", "fig2b-tram-terrell", "fig7-tram-shadow", "street-lamp-flicker"):
        text = povray_twin.twin(os.path.join(SOURCE, "scenes", name + ".toml"))
        expect(text.count("{") == text.count("}") and "nan" not in text, f"the twin of {name}")


if __name__ == "__main__":
    main()
