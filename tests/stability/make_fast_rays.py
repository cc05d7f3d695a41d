#!/usr/bin/env python3
"""Makes tests/stability/fast_rays.txt: a camera at rest, surfaces that move with γ up to 10^14, and what it sees of them, found
with 130 digits.

A line of the file is one ray:

    motion gamma surface celerity(3) origin(3) direction(3) sign lambda point(3) margin

The surface's frame has this celerity in the world, and its origin is at `origin` at world time 0. The camera is at rest in the world
and looks from its origin at time 0 along `direction`. All these are doubles, written so that reading gives them back exactly; what
follows is the answer for exactly these doubles. `sign` is 1 where the ray meets the surface at some lambda > 0; `lambda` is the first one,
and `point` where that is in the surface's own coordinates. `margin` is how far the surface would have to move for another answer.

The ray (-λ; λ direction) is taken into the surface's frame by the boost of docs/physics.md equation (1), in which the polynomial is
solved by make_rays.py.

Usage: make_fast_rays.py [GAMMA ...] > fast_rays.txt     (needs mpmath; a minute)
"""

import random
import sys

from mpmath import mp, mpf

import make_rays
from make_rays import unit

mp.dps = 130

DIGITS = 22


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def boosted(u, t, x):
    """The displacement (t; x) in the frame of celerity u."""
    gamma = mp.sqrt(1 + dot(u, u))
    along = dot(u, x)
    return gamma * t - along, [p + q * (along / (gamma + 1) - t) for p, q in zip(x, u)]


def across(rng, axis):
    """A unit vector at right angles to the axis."""
    v = unit(rng)
    along = dot(v, axis)
    w = [p - along * q for p, q in zip(v, axis)]
    length = mp.sqrt(dot(w, w))
    return [p / length for p in w]


def emit(motion, gamma, name, u, camera, looking):
    """`camera`: where the camera is in the surface's frame when it looks, for some time there that makes the numbers of the file small."""
    factor = mp.sqrt(1 + dot(u, u))
    speed = mp.sqrt(dot(u, u))
    axis = [p / speed for p in u] if speed else [mpf(1), mpf(0), mpf(0)]
    along = dot(camera, axis)
    # At frame time -β along, the camera's event is at world time 0: contracted along the motion.
    origin = [float(-(p + (along / factor - along) * q)) for p, q in zip(camera, axis)]
    direction = [float(p) for p in looking]
    d = [mpf(p) for p in direction]
    _, o = boosted(u, mpf(0), [-mpf(p) for p in origin])
    _, k = boosted(u, -mp.sqrt(dot(d, d)), d)
    lam, margin, _ = make_rays.answer(name, o, k)
    point = [mpf(0)] * 3 if lam is None else [p + lam * q for p, q in zip(o, k)]
    numbers = ["%.17g" % v for v in [float(v) for v in u] + origin + direction]
    exact = [mp.nstr(v, DIGITS) for v in [lam or mpf(0)] + point]
    print(motion.replace(" ", "-"), "%g" % gamma, name, *numbers, 0 if lam is None else 1, *exact, mp.nstr(min(margin, mpf(1)), 3))
    return lam


def looking_for(u, axis_in_frame):
    """The camera's unit looking direction whose image in the frame is along `axis_in_frame`."""
    minus = [-p for p in u]
    t, x = boosted(minus, mpf(-1), axis_in_frame)
    return [p / -t for p in x]


def in_frame(u, looking):
    t, x = boosted(u, mpf(-1), looking)
    return [p / -t for p in x], -t


def one(rng, motion, gamma, name):
    axis = [mpf(p) for p in ([1.0, 0.0, 0.0] if rng.random() < 0.4 else unit(rng))]
    celerity = mp.sqrt(mpf(gamma)**2 - 1)
    u = [mpf(float(celerity * p)) for p in axis]
    reach = {"sphere": 0.95, "torus": 1.2, "barth6": 1.2, "klein": 2.5}[name]
    target = [mpf(reach * rng.random() * p) for p in unit(rng)]
    if motion == "inside":
        emit(motion, gamma, name, u, [mpf(0.1) * p for p in target], [mpf(p) for p in unit(rng)])
        return
    if motion == "at the surface":
        # A point on the surface, 10^-3 to 10^-12 in front of it and behind it.
        start, way = make_rays.towards(rng, [float(p) for p in target], 6.0)
        lam, _, _ = make_rays.answer(name, start, way)
        if lam is None:
            return
        for side in (-1, 1):
            off = side * mpf(10)**-rng.choice((3, 6, 9, 12))
            camera = [mpf(p) + (lam + off) * mpf(q) for p, q in zip(start, way)]
            emit(motion, gamma, name, u, camera, looking_for(u, [mpf(p) for p in way]))
        return
    if motion == "approaching":  # seen from 5 of its own lengths away, which are 10 γ of the camera's
        tilt = [p + mpf(0.1) * q for p, q in zip([-p for p in axis], across(rng, axis))]
        length = mp.sqrt(dot(tilt, tilt))
        way, distance = [p / length for p in tilt], mpf(5)
    elif motion == "passing in its frame":
        way, distance = across(rng, axis), mpf(5)
    else:  # seen by light that travelled 6 of the camera's lengths
        if motion == "receding":
            looking = axis
        elif motion == "passing":
            looking = across(rng, axis)
        else:
            looking = [mpf(p) for p in unit(rng)]
        length = mp.sqrt(dot(looking, looking))
        way, rate = in_frame(u, [p / length for p in looking])
        distance = 6 * rate
    camera = [p - distance * q for p, q in zip(target, way)]
    emit(motion, gamma, name, u, camera, looking_for(u, way))


GAMMAS = (1, 1.1, 3, 10, 29, 31, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e10, 1e12, 1e14)


def main():
    gammas = [float(word) for word in sys.argv[1:]] or GAMMAS
    for gamma in gammas:
        rng = random.Random("%g" % gamma)
        for motion in ("approaching", "receding", "passing", "passing in its frame", "oblique", "at the surface", "inside"):
            for name in ("sphere", "torus", "barth6", "klein"):
                for _ in range(2):
                    one(rng, motion, gamma, name)


if __name__ == "__main__":
    main()
