#!/usr/bin/env python3
"""Writes scenes/data/stars.csv, the 5,000 stars visible to the naked eye, from the npm package d3-celestial.

    npm pack d3-celestial@0.7.35 && tar xzf d3-celestial-0.7.35.tgz
    scripts/make_stars.py package/data/stars.6.json scenes/data/stars.csv

Input: GeoJSON; each feature is one star, its point (longitude, latitude) = (right ascension, declination) in degrees,
right ascension in (-180, 180]; `mag` the visual magnitude, `bv` the colour index B-V. Output: right ascension in
[0, 360) and declination in degrees (J2000), magnitude, B-V. Brightest first. A star without a colour index (two of
them) is left out: its temperature, and so its Doppler-shifted colour, would be a guess.
"""

import json
import sys


def read_stars(path):
    """Returns (right ascension, declination, magnitude, B-V) of every star with a colour index, brightest first."""
    with open(path, encoding="utf-8") as file:
        features = json.load(file)["features"]
    stars = []
    for feature in features:
        properties = feature["properties"]
        if properties["bv"] in ("", None):
            continue
        longitude, declination = feature["geometry"]["coordinates"]
        stars.append((longitude % 360.0, declination, float(properties["mag"]), float(properties["bv"])))
    return sorted(stars, key=lambda star: (star[2], star[0]))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    stars = read_stars(sys.argv[1])
    with open(sys.argv[2], "w", encoding="utf-8", newline="\n") as file:
        file.write("right_ascension,declination,magnitude,b_minus_v\n")
        for star in stars:
            file.write("{:.4f},{:.4f},{:.2f},{:.3f}\n".format(*star))
    print(f"{len(stars)} stars written to {sys.argv[2]}")


if __name__ == "__main__":
    main()
