#!/usr/bin/env python3
"""Writes scenes/textures/clouds.png: a summer sky with fair-weather clouds, as an equirectangular texture.

    scripts/make_clouds.py scenes/textures/clouds.png

The clouds are fractal value noise on a plane at the height of the cloud base, looked up where each direction of the sky
meets that plane, so that they shrink towards the horizon as real ones do. The plane is curved down a little (as the Earth's
atmosphere is), which keeps the lookup finite at the horizon. Seeded: the same bytes on every run. Standard library only.
"""

import math
import struct
import sys
import zlib

WIDTH, HEIGHT = 1024, 512
SEED = 1905
OCTAVES = 6
CURVATURE = 0.10  # height/radius of the cloud shell: sets how far away the clouds at the horizon are
COVER = 0.50  # noise above this is cloud
ZENITH, HORIZON = (38, 92, 178), (176, 203, 232)  # 8-bit sRGB
CLOUD_LIT, CLOUD_SHADE = (255, 253, 248), (158, 168, 188)
GROUND_NEAR, GROUND_FAR = (74, 88, 62), (140, 156, 150)  # below the horizon, seen only where a scene has no floor
LEVELS = 2  # colours are rounded to multiples of this: invisible, and it halves the file


def lattice(ix, iy):
    """A reproducible number in [0, 1) for a lattice point: integer hash with the mixing steps of MurmurHash3."""
    h = (ix * 0x9E3779B1 ^ iy * 0x85EBCA77 ^ SEED * 0xC2B2AE3D) & 0xFFFFFFFF
    h = ((h ^ (h >> 16)) * 0x85EBCA6B) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 0xC2B2AE35) & 0xFFFFFFFF
    return (h ^ (h >> 16)) / 2.0**32


def value_noise(x, y):
    """Smoothly interpolated lattice values (quintic fade, so that slopes and curvatures are continuous)."""
    ix, iy = math.floor(x), math.floor(y)
    fx, fy = x - ix, y - iy
    u = fx * fx * fx * (fx * (6 * fx - 15) + 10)
    v = fy * fy * fy * (fy * (6 * fy - 15) + 10)
    bottom = lattice(ix, iy) * (1 - u) + lattice(ix + 1, iy) * u
    top = lattice(ix, iy + 1) * (1 - u) + lattice(ix + 1, iy + 1) * u
    return bottom * (1 - v) + top * v


def fractal_noise(x, y):
    """Sum of octaves, each of twice the frequency and half the amplitude, rotated so that the lattices do not line up."""
    total, amplitude, norm = 0.0, 1.0, 0.0
    for _ in range(OCTAVES):
        total += amplitude * value_noise(x, y)
        norm += amplitude
        amplitude *= 0.5
        x, y = 1.6 * x - 1.2 * y + 17.3, 1.2 * x + 1.6 * y + 5.9
    return total / norm


def smooth_step(low, high, x):
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    return tuple(p + (q - p) * t for p, q in zip(a, b))


def sky_colour(longitude, latitude):
    """Colour of the sky in a direction; latitude above the horizon, radians."""
    sine = math.sin(latitude)
    blue = mix(HORIZON, ZENITH, smooth_step(0.0, 1.0, sine) ** 0.6)
    # Distance to a shell of height 1 around a ball of radius 1/CURVATURE, divided out so that it is 1 at the zenith.
    radius = 1.0 / CURVATURE
    distance = math.sqrt((radius * sine) ** 2 + 2 * radius + 1) - radius * sine
    x = distance * math.cos(latitude) * math.cos(longitude)
    y = distance * math.cos(latitude) * math.sin(longitude)
    thickness = fractal_noise(1.3 * x + 40.0, 1.3 * y + 40.0)
    cover = smooth_step(COVER, COVER + 0.10, thickness)
    shade = smooth_step(COVER + 0.06, COVER + 0.24, thickness)
    cloud = mix(CLOUD_LIT, CLOUD_SHADE, 0.6 * shade)
    haze = math.exp(-7.0 * sine)
    return mix(mix(blue, cloud, cover), HORIZON, 0.85 * haze)


def ground_colour(latitude):
    return mix(GROUND_FAR, GROUND_NEAR, smooth_step(0.0, 0.5, -math.sin(latitude)))


def rows():
    """The picture's rows, top to bottom, as bytes of RGB."""
    for j in range(HEIGHT):
        latitude = (0.5 - (j + 0.5) / HEIGHT) * math.pi
        row = bytearray()
        for i in range(WIDTH):
            longitude = ((i + 0.5) / WIDTH - 0.5) * 2 * math.pi
            colour = sky_colour(longitude, latitude) if latitude > 0 else ground_colour(latitude)
            row += bytes(min(255, LEVELS * round(c / LEVELS)) for c in colour)
        yield bytes(row)


def png(lines):
    """An 8-bit RGB PNG, each row filtered by the difference to the row above."""

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    above = bytes(3 * WIDTH)
    filtered = bytearray()
    for line in lines:
        filtered += b"\x02" + bytes((p - q) & 255 for p, q in zip(line, above))
        above = line
    header = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"sRGB", b"\x00")
            + chunk(b"IDAT", zlib.compress(bytes(filtered), 9)) + chunk(b"IEND", b""))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], "wb") as file:
        file.write(png(rows()))


if __name__ == "__main__":
    main()
