#!/usr/bin/env python3
"""Writes tests/analytic/values/NAME.json: 20-digit values on a coarse grid of every oracle scene.

    make_values.py [SCENE.toml ...]      all of tests/oracle/scenes unless named

The files let ctest check Backlight against this reference without Python. Layout: README.md here.
"""
import argparse
import glob
import multiprocessing
import os

from reference import Reference, rounded_condition, to_json

HERE = os.path.dirname(os.path.abspath(__file__))
VALUES = os.path.join(HERE, "..", "analytic", "values")


def grid(camera, name):
    """12 x 9 pixels, evenly spread, or 7 x 5 of a scene that was made at random."""
    columns, rows = (7, 5) if name.startswith("random_") else (12, 9)
    return [((2 * k + 1) * camera.width // (2 * columns), (2 * m + 1) * camera.height // (2 * rows))
            for m in range(rows) for k in range(columns)]


def values_of(path):
    """The JSON text of a scene's values, one line a pixel, and a line about it for people."""
    reference = Reference(path)
    light_delay = reference.scene.effects.get("light_delay", True)
    name = os.path.basename(path)
    records = [reference.pixel(i, j, light_delay) for i, j in grid(reference.scene.camera, name)]
    hits = sum(r["objectId"] > 0 for r in records)
    colours = sum("RGB" in r for r in records)
    lines = [to_json({k: v for k, v in rounded_condition(r).items() if k != "light_delay"}) for r in records]
    text = f'{{"scene": "{name}",\n "pixels": [\n  ' + ",\n  ".join(lines) + "\n]}\n"
    edges = sum(r["edge"] for r in records)
    return text, f"{name}: {hits} of {len(records)} hit, {edges} at edges, {colours} with colour"


def write_values(path):
    """Writes the values of one scene; returns the line about it."""
    text, summary = values_of(path)
    stem = os.path.splitext(os.path.basename(path))[0]
    with open(os.path.join(VALUES, stem + ".json"), "w", encoding="utf-8") as stream:
        stream.write(text)
    return summary


def main():
    """Command line entry."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    arguments = parser.parse_args()
    os.makedirs(VALUES, exist_ok=True)
    scenes = arguments.scenes or sorted(glob.glob(os.path.join(HERE, "scenes", "*.toml")))
    with multiprocessing.Pool(arguments.jobs) as pool:
        for summary in pool.imap(write_values, scenes):
            print(summary)


if __name__ == "__main__":
    main()
