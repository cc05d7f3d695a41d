#!/usr/bin/env python3
"""Compares the images of a scene and of its redescription (redescribe.py): they must be the same.

    compare_pair.py OLD.exr NEW.exr NEW.json

Ids must be equal but at edges, which are pixels with another id among their four neighbours. Z, doppler,
properTime, P and N (turned back by the Wigner rotation of their frame) must agree within 1e-6 of the
value or of the distance that the ray travelled in the rest frame, colours within 1e-5. Where the colour or
the normal jumps to a neighbour (a shadow's or a face's edge) that channel is left out too. Exit code 0 or 1.
"""
import argparse
import json
import math
import sys

import exr_reader

AOV_TOLERANCE, COLOUR_TOLERANCE, HALF_TOLERANCE = 1e-6, 1e-5, 1e-3
POSITION, NORMAL, COLOUR = ["P.X", "P.Y", "P.Z"], ["N.X", "N.Y", "N.Z"], ["R", "G", "B"]
COLOUR_JUMP, NORMAL_JUMP = 0.1, 0.3


def distance(a, b):
    """Euclidean distance; infinite for values that are not numbers unless both are the same infinity."""
    total = math.sqrt(sum(0.0 if x == y else (x - y) ** 2 for x, y in zip(a, b)))
    return math.inf if math.isnan(total) else total


def turned_back(rotation, vector):
    """Transpose of `rotation` times `vector`."""
    return [sum(rotation[k][i] * vector[k] for k in range(3)) for i in range(3)]


class Pair:
    """The two images and what is known of the change of description."""

    def __init__(self, old, new, sidecar):
        self.old, self.new, self.sidecar = old, new, sidecar
        self.worst, self.id_errors, self.edges, self.hits = {}, [], 0, 0
        self.background = 0

    def neighbours(self, i, j):
        """The four neighbours that are in the image."""
        x0, y0 = self.old.origin
        steps = ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1))
        return [(x, y) for x, y in steps
                if 0 <= x - x0 < self.old.width and 0 <= y - y0 < self.old.height]

    def note(self, name, error, pixel):
        """Keeps the worst error of a name."""
        if error > self.worst.get(name, (-1.0, None))[0]:
            self.worst[name] = (error, pixel)

    def smooth(self, channels, i, j, jump):
        """Whether the old image's channels change little from (i, j) to its neighbours."""
        here = self.old.vector(channels, i, j)
        size = max(distance(here, [0, 0, 0]), 1e-30)
        return all(distance(self.old.vector(channels, *n), here) <= jump * size for n in self.neighbours(i, j))

    def take(self, i, j):
        """Compares one pixel."""
        object_id = self.old.at("objectId.V", i, j)
        new_id = self.new.at("objectId.V", i, j)
        if any(self.old.at("objectId.V", *n) != object_id for n in self.neighbours(i, j)):
            self.edges += 1
            return
        mapped = self.sidecar["id_map"][str(int(new_id))] if new_id else 0
        if mapped != object_id:
            self.id_errors.append((i, j, object_id, mapped))
            return
        self.take_colour(i, j)
        if object_id:
            self.hits += 1
            self.take_aovs(i, j, self.sidecar["rotation"][str(int(new_id))])
        else:
            self.background += 1

    def take_colour(self, i, j):
        """Compares the colour of one pixel."""
        old = self.old.vector(COLOUR, i, j)
        error = distance(old, self.new.vector(COLOUR, i, j))
        if error and self.smooth(COLOUR, i, j, COLOUR_JUMP):
            self.note("RGB", error / max(distance(old, [0, 0, 0]), 1e-30), (i, j))
        else:
            self.note("RGB", 0.0, (i, j))

    def take_aovs(self, i, j, rotation):
        """Compares the other channels of one pixel on an object."""
        old, new, pixel = self.old, self.new, (i, j)
        travelled = old.at("Z", i, j) / max(old.at("doppler.D", i, j), 1e-300)
        for name, scale in (("Z", 0.0), ("doppler.D", 0.0), ("properTime.T", travelled / self.sidecar["c"])):
            value = old.at(name, i, j)
            self.note(name, distance([value], [new.at(name, i, j)]) / max(abs(value), scale, 1e-300), pixel)
        place = old.vector(POSITION, i, j)
        error = distance(place, turned_back(rotation, new.vector(POSITION, i, j)))
        self.note("P", error / max(distance(place, [0, 0, 0]), travelled), pixel)
        if self.smooth(NORMAL, i, j, NORMAL_JUMP):
            normal = turned_back(rotation, new.vector(NORMAL, i, j))
            self.note("N", distance(old.vector(NORMAL, i, j), normal), pixel)

    def report(self):
        """Prints the findings; True if all is within tolerance."""
        good = not self.id_errors and self.hits > 0
        print(f"hits {self.hits}, background {self.background}, edges {self.edges}, "
              f"id mismatches {len(self.id_errors)}", *self.id_errors[:8])
        for name, (error, pixel) in self.worst.items():
            tolerance = AOV_TOLERANCE
            if name == "RGB":
                tolerance = HALF_TOLERANCE if self.old.types["R"] == "e" else COLOUR_TOLERANCE
            good = good and error <= tolerance
            print(f"  {name:13} worst {error:.3g} at {pixel}" + ("" if error <= tolerance else "  FAILS"))
        return good


def main():
    """Command line entry."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("sidecar")
    arguments = parser.parse_args()
    with open(arguments.sidecar, encoding="utf-8") as stream:
        sidecar = json.load(stream)
    pair = Pair(exr_reader.read(arguments.old), exr_reader.read(arguments.new), sidecar)
    for j in range(pair.old.height):
        for i in range(pair.old.width):
            pair.take(i + pair.old.origin[0], j + pair.old.origin[1])
    sys.exit(0 if pair.report() else 1)


if __name__ == "__main__":
    main()
