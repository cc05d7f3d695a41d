#!/usr/bin/env python3
"""Makes the textures of turning things of scenes/course: a turntable with spokes, a dial of ten marks, and its hand.

    scripts/make_dials.py [FOLDER]      default: scenes/textures; needs oiiotool (Debian package openimageio-tools)
"""

import math
import pathlib
import subprocess
import sys
import tempfile

SIZE, SAMPLES = 384, 3  # pixels, and samples of each along x and y
TURN = 2 * math.pi


def turntable(radius, angle):
    """Rings and eight spokes; one half of a spoke is white."""
    spoke = min(abs(angle - TURN * i / 8) for i in range(9)) * radius < 0.02
    if spoke or radius < 0.05:
        return (0.97, 0.97, 0.97) if min(angle, TURN - angle) < TURN / 16 and radius >= 0.05 else (0.12, 0.12, 0.12)
    return (0.95, 0.83, 0.55) if int(radius * 8) % 2 else (0.85, 0.72, 0.45)


def dial(radius, angle):
    """Ten marks on white; the one above is longer."""
    mark = min(abs(angle - TURN * i / 10) for i in range(11)) * radius < 0.025
    inner = 0.7 if min(angle, TURN - angle) < 0.1 else 0.8
    return (0.1, 0.1, 0.1) if mark and inner < radius < 0.95 else (0.95, 0.93, 0.88)


def hand(radius, angle):
    """A red hand that points up, on the white of the dial."""
    across, along = radius * math.sin(angle), radius * math.cos(angle)
    on_hand = radius < 0.16 or (0 < along < 0.95 and abs(across) < 0.11 * (1 - along / 0.95))
    return (0.85, 0.1, 0.08) if on_hand else (0.95, 0.93, 0.88)


def write(picture, file):
    """Clockwise angles from above, radius 1 at the middles of the edges."""
    rows = bytearray()
    for j in range(SIZE):
        for i in range(SIZE):
            total = [0.0, 0.0, 0.0]
            for sample in range(SAMPLES * SAMPLES):
                x = 2 * (i + (sample % SAMPLES + 0.5) / SAMPLES) / SIZE - 1
                y = 1 - 2 * (j + (sample // SAMPLES + 0.5) / SAMPLES) / SIZE
                colour = picture(math.hypot(x, y), math.atan2(x, y) % TURN)
                total = [t + c for t, c in zip(total, colour)]
            rows += bytes(round(255 * t / SAMPLES**2) for t in total)
    with tempfile.NamedTemporaryFile(suffix=".ppm") as raw:
        raw.write(b"P6 %d %d 255\n" % (SIZE, SIZE) + rows)
        raw.flush()
        subprocess.run(["oiiotool", raw.name, "--attrib", "oiio:ColorSpace", "sRGB", "-o", file], check=True)


folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent / "scenes/textures")
for picture in (turntable, dial, hand):
    write(picture, folder / f"{picture.__name__}.png")
