#!/usr/bin/env python3
"""Compares an EXR made by Backlight with the 60-digit reference of its scene.

    compare.py IMAGE.exr SCENE.toml [--step 1] [--frame F]

Prints the worst relative error of each channel group over the pixels whose own direction determines
it, and the pixels where ids differ. Exits with 1 when a tolerance is exceeded, 0 otherwise.
Render with `samples = 1` and --float: colours in half are compared at half's precision.
"""
import argparse
import multiprocessing
import sys

from mpmath import mp, mpf

import exr_reader
from reference import Reference, relative_difference

CHANNELS = {"Z": ["Z"], "doppler": ["doppler.D"], "emissionTime": ["emissionTime.T"],
            "properTime": ["properTime.T"], "P": ["P.X", "P.Y", "P.Z"], "N": ["N.X", "N.Y", "N.Z"],
            "mirrorZ": ["mirror.Z"], "mirrorD": ["mirror.D"], "mirrorT": ["mirror.T"], "RGB": ["R", "G", "B"]}
TOLERANCE = {name: 1e-6 for name in CHANNELS} | {"RGB": 1e-5}
HALF_TOLERANCE = 1e-3
DETERMINED = 1e-8  # of the condition: some tens of roundings of the direction stay below tolerance

_worker = {}


def start_worker(path, image, exr):
    """Builds the reference once in each process."""
    _worker["reference"], _worker["image"] = Reference(path, image), exr_reader.read(exr)


def reference_pixel(pixel):
    """The reference record of one pixel, at the scene's own light delay."""
    reference, image = _worker["reference"], _worker["image"]

    def agrees(record):
        one = Comparison(image)
        one.take(record)
        return one.is_good()
    return reference.pixel(*pixel, reference.scene.effects.get("light_delay", True), agrees)


class Comparison:
    """Worst errors of one image, gathered pixel by pixel."""

    def __init__(self, image):
        self.image = image
        self.worst = {}         # name -> (error, pixel, value, reference)
        self.compared, self.skipped = {}, {}
        self.edges, self.id_errors, self.hits = 0, [], 0

    def take(self, record):
        """Adds one reference record."""
        i, j = record["pixel"]
        if record["edge"]:
            self.edges += 1
            return
        if record["objectId"] != self.image.at("objectId.V", i, j):
            self.id_errors.append((i, j, self.image.at("objectId.V", i, j), record["objectId"]))
            return
        self.hits += record["objectId"] > 0
        for name, channels in CHANNELS.items():
            if name in record and all(c in self.image.channels for c in channels):
                self._take_value(name, channels, record)

    def _take_value(self, name, channels, record):
        """Adds one value of a record, if its pixel determines it."""
        if record["condition"][name] > DETERMINED:
            self.skipped[name] = self.skipped.get(name, 0) + 1
            return
        self.compared[name] = self.compared.get(name, 0) + 1
        found = [mpf(v) for v in self.image.vector(channels, *record["pixel"])]
        error = relative_difference(found, record[name])
        if mp.isnan(error):
            error = mp.inf
        if name not in self.worst or error > self.worst[name][0]:
            self.worst[name] = (error, record["pixel"], found, record[name])

    def tolerance(self, name):
        """The tolerance of a group of channels."""
        half = any(self.image.types[c] == "e" for c in CHANNELS[name])
        return HALF_TOLERANCE if half else TOLERANCE[name]

    def is_good(self):
        """Whether all is within tolerance."""
        return not self.id_errors and all(worst[0] <= self.tolerance(name) for name, worst in self.worst.items())

    def report(self):
        """Prints the findings; True if all is within tolerance."""
        print(f"hits {self.hits}, edges {self.edges}, id mismatches {len(self.id_errors)}", *self.id_errors[:8])
        for name, (error, pixel, found, expected) in self.worst.items():
            within = error <= self.tolerance(name)
            print(f"  {name:13} worst {mp.nstr(error, 3):>10} at {pixel}, of {self.compared[name]}, "
                  f"undetermined {self.skipped.get(name, 0)}" + ("" if within else
                  f"  FAILS: {[mp.nstr(v, 10) for v in found]}, reference {[mp.nstr(v, 10) for v in expected]}"))
        return self.is_good()


def main():
    """Command line entry."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("exr")
    parser.add_argument("scene")
    parser.add_argument("--step", type=int, default=2, help="every Nth pixel of every Nth row")
    parser.add_argument("--frame", type=int, help="image of the animation")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    arguments = parser.parse_args()
    image = exr_reader.read(arguments.exr)
    comparison = Comparison(image)
    first = arguments.step // 2
    x0, y0 = image.origin
    pixels = [(x0 + i, y0 + j) for j in range(first, image.height, arguments.step)
              for i in range(first, image.width, arguments.step)]
    with multiprocessing.Pool(arguments.jobs, start_worker, (arguments.scene, arguments.frame, arguments.exr)) as pool:
        for record in pool.imap(reference_pixel, pixels, chunksize=16):
            comparison.take(record)
    sys.exit(0 if comparison.report() else 1)


if __name__ == "__main__":
    main()
