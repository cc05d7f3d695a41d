#!/usr/bin/env python3
"""Measures equation (1) of the seed paper on rendered images: the dots of docs/images/fig4-aberration.png.

    scripts/fig4_aberration.py BACKLIGHT FOLDER

Renders scenes/fig4-aberration.toml, nineteen balls at known angles alpha around the camera, with the program BACKLIGHT at v/c =
0, 0.75 and 0.99 into FOLDER, as equirectangular images of nine rows, of which the middle row is the equator. There an object's
two edges, at alpha - asin(r/d) and alpha + asin(r/d) in the balls' frame, must each be seen at the angle that equation (1)
gives. Writes FOLDER/fig4-aberration.dat (v, alpha, beta in degrees, one line an edge) for scripts/fig4_aberration.gp
and fails if an edge is more than a pixel (0.05 degrees) off. Standard library only.
"""

import math
import os
import struct
import subprocess
import sys
import zlib

SPEEDS = (0.0, 0.75, 0.99)
WIDTH, HEIGHT = 7200, 9
BALL_RADIUS, BALL_DISTANCE = 0.8, 10.0  # as in the scene
SCENE = os.path.join(os.path.dirname(__file__), "..", "scenes", "fig4-aberration.toml")


def read_attributes(data):
    """The header of a single-part EXR file as {name: bytes}, and the offset behind it."""
    if data[:4] != b"\x76\x2f\x31\x01":
        sys.exit("not an EXR file")
    attributes, at = {}, 8
    while data[at]:
        name_end = data.index(0, at)
        type_end = data.index(0, name_end + 1)
        (size,) = struct.unpack_from("<i", data, type_end + 1)
        attributes[data[at:name_end].decode()] = data[type_end + 5:type_end + 5 + size]
        at = type_end + 5 + size
    return attributes, at + 1


def read_channels(block):
    """(name, bytes a sample) of each channel of the `channels` attribute, in file order."""
    channels, at = [], 0
    while block[at]:
        end = block.index(0, at)
        (kind,) = struct.unpack_from("<i", block, end + 1)
        channels.append((block[at:end].decode(), 2 if kind == 1 else 4))
        at = end + 17
    return channels


def unzip(packed, size):
    """Undoes OpenEXR's ZIP compression: deflate, then a running difference, then the split into odd and even bytes."""
    if len(packed) == size:
        return packed
    data = bytearray(zlib.decompress(packed))
    for i in range(1, size):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    half = (size + 1) // 2
    out = bytearray(size)
    out[0::2], out[1::2] = data[:half], data[half:]
    return bytes(out)


def read_row(path, channel, row):
    """One row of a float channel of a ZIP-compressed scanline EXR file."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = read_attributes(data)
    channels = read_channels(attributes["channels"])
    lines = {0: 1, 2: 1, 3: 16}[attributes["compression"][0]]
    _, y_min, _, y_max = struct.unpack("<4i", attributes["dataWindow"])
    x_min, _, x_max, _ = struct.unpack("<4i", attributes["dataWindow"])
    width = x_max - x_min + 1
    (start,) = struct.unpack_from("<Q", data, at + 8 * ((row - y_min) // lines))
    y_block, packed_size = struct.unpack_from("<ii", data, start)
    line_size = width * sum(size for _, size in channels)
    rows_here = min(lines, y_max - y_block + 1)
    block = unzip(data[start + 8:start + 8 + packed_size], line_size * rows_here)
    offset = (row - y_block) * line_size
    for name, size in channels:
        if name == channel:
            return struct.unpack_from(f"<{width}f", block, offset)
        offset += width * size
    sys.exit(f"{path} has no channel {channel}")


def aberrated(alpha, v):
    """Equation (1): the angle beta (radians) at which a moving camera sees what is at alpha in the frame at rest."""
    return 2 * math.atan2(math.sqrt(1 - v) * math.sin(alpha / 2), math.sqrt(1 + v) * math.cos(alpha / 2))


def edges(row):
    """{id: (first, last)}: the angles in degrees, 0...180 to the right, between which each object is seen."""
    seen = {}
    for column, identity in enumerate(row):
        if identity > 0 and column >= WIDTH // 2:
            seen.setdefault(int(identity), []).append(column)
    step = 360.0 / WIDTH
    return {identity: ((columns[0] - WIDTH // 2) * step, (columns[-1] + 1 - WIDTH // 2) * step)
            for identity, columns in seen.items()}


def render(program, folder, v):
    path = os.path.join(folder, f"fig4-aberration-{v}.exr")
    subprocess.run([program, "render", SCENE, "-o", path, "-r", f"{WIDTH}x{HEIGHT}", "-s", "1", "-q",
                    "--aov", "objectId", "-D", f"params.v={v}"], check=True)
    return path


def measure(program, folder, v):
    """(v, alpha, beta) of all edges seen at speed v, in degrees, and the largest departure from equation (1)."""
    half_angle = math.degrees(math.asin(BALL_RADIUS / BALL_DISTANCE))
    points, worst = [], 0.0
    row = read_row(render(program, folder, v), "objectId.V", HEIGHT // 2)
    for identity, (first, last) in sorted(edges(row).items()):
        centre = 10.0 * (identity - 1)
        for alpha, beta in ((centre - half_angle, first), (centre + half_angle, last)):
            if 0 < alpha < 180:
                worst = max(worst, abs(beta - math.degrees(aberrated(math.radians(alpha), v))))
                points.append((v, alpha, beta))
    return points, worst


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, folder = sys.argv[1:]
    os.makedirs(folder, exist_ok=True)
    failed = False
    with open(os.path.join(folder, "fig4-aberration.dat"), "w", encoding="utf-8") as file:
        file.write("# v/c, alpha and beta in degrees: edges of the balls of scenes/fig4-aberration.toml\n")
        for v in SPEEDS:
            points, worst = measure(program, folder, v)
            failed = failed or worst > 360.0 / WIDTH or len(points) != 36
            print(f"v = {v}c: {len(points)} edges, at most {worst:.3f} degrees from equation (1)")
            file.writelines("{} {:.4f} {:.4f}\n".format(*point) for point in points)
            file.write("\n\n")
    if failed:
        sys.exit("the rendered images do not obey equation (1)")


if __name__ == "__main__":
    main()
