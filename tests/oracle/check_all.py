#!/usr/bin/env python3
"""Renders every oracle scene with Backlight and runs compare.py and compare_pair.py on the images.

    check_all.py BACKLIGHT [SCENE.toml ...] [--step 3] [--celerity 1000] [--along 1,2,-0.5] [--keep FOLDER]

A redescription whose numbers, rounded to doubles, are no longer the same scene is recognised by asking the
reference itself, and left out. Exits with 1 if anything is out of tolerance.
"""
import argparse
import glob
import json
import os
import subprocess
import sys
import tempfile
import tomllib

from mpmath import mp, mpf

from minkowski import apply, scaled, transpose, unit
from redescribe import redescribe
from reference import Reference, relative_difference
from tracer import pixel_direction

HERE = os.path.dirname(os.path.abspath(__file__))
REPRESENTABLE = mpf(10) ** -7
# Scenes whose pair is not asked for, and why.
UNPAIRED = {"fast_receding_lit": "a shadow between frames of relative Lorentz factor 1e11: a camera-relative hub "
                                 "in doubles does not determine it"}
PROBES = [(i, j) for j in (9, 27, 39) for i in (6, 19, 33, 45, 57)]


def rounding_loss(path, again, sidecar):
    """The worst relative change of Z, P or properTime that rounding the new description has made."""
    old, new, worst = Reference(path), Reference(again), mpf(0)
    light_delay = old.scene.effects.get("light_delay", True)
    for i, j in PROBES:
        directions = [pixel_direction(r.scene.camera, i, j) for r in (old, new)]
        if None in directions:
            continue
        (before, seen), (after, now) = (r.look(d, light_delay) for r, d in zip((old, new), directions))
        if seen[0] == 0 and now[0] == 0:
            continue
        if seen[0] != sidecar["id_map"].get(str(now[0]), 0):
            return mp.inf
        rotation = [[mpf(x) for x in row] for row in sidecar["rotation"][str(now[0])]]
        after["P"] = apply(transpose(rotation), after["P"])
        worst = max([worst] + [relative_difference(after[k], before[k]) for k in ("Z", "P", "properTime")])
    return worst


def render(backlight, scene, image):
    """Renders a scene's first image; returns its file, or None with the messages printed when it fails."""
    with open(scene, "rb") as stream:
        frames = tomllib.load(stream).get("animation", {}).get("frames")
    chosen = ["-f", str(frames[0])] if frames else []
    pattern = image.replace(".exr", ".####.exr") if frames else image
    done = subprocess.run([backlight, "render", scene, *chosen, "-o", pattern, "--float", "-q"],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        print("  render FAILS:", done.returncode, done.stderr.strip(), flush=True)
        return None
    return image.replace(".exr", f".{frames[0]:04d}.exr") if frames else image


def run(tool, *arguments):
    """Runs one of the comparisons; True if it is content."""
    return subprocess.run([sys.executable, os.path.join(HERE, tool), *arguments], check=False).returncode == 0


def check(path, arguments, folder):
    """Both comparisons of one scene."""
    stem = os.path.splitext(os.path.basename(path))[0]
    print(f"{stem}", flush=True)
    image, again = os.path.join(folder, stem + ".exr"), os.path.join(folder, stem + "_again.toml")
    image = render(arguments.backlight, path, image)
    if image is None:
        return False
    good = run("compare.py", image, path, "--step", str(arguments.step))
    if stem in UNPAIRED:
        print(f"  redescription left out: {UNPAIRED[stem]}", flush=True)
        return good
    direction = unit([mpf(x) for x in arguments.along.split(",")])
    redescribe(path, again, scaled(direction, mpf(arguments.celerity)))
    with open(again[:-5] + ".json", encoding="utf-8") as stream:
        loss = rounding_loss(path, again, json.load(stream))
    if loss > REPRESENTABLE:
        print(f"  redescription left out: rounding its numbers changes the scene by {mp.nstr(loss, 2)}", flush=True)
        return good
    print(f"  redescribed at celerity {arguments.celerity} (rounding: {mp.nstr(loss, 2)})", flush=True)
    again_image = render(arguments.backlight, again, again[:-5] + ".exr")
    return (again_image is not None
            and run("compare_pair.py", image, again_image, again[:-5] + ".json") and good)


def main():
    """Command line entry."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("backlight")
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--step", type=int, default=3, help="every Nth pixel against the reference")
    parser.add_argument("--celerity", default="1000")
    parser.add_argument("--along", default="1,2,-0.5")
    parser.add_argument("--keep", help="folder for the images, kept")
    arguments = parser.parse_args()
    scenes = arguments.scenes or sorted(glob.glob(os.path.join(HERE, "scenes", "*.toml")))
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or temporary
        os.makedirs(folder, exist_ok=True)
        bad = [path for path in scenes if not check(path, arguments, folder)]
    print("all within tolerance" if not bad else "out of tolerance: " + " ".join(map(os.path.basename, bad)))
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
