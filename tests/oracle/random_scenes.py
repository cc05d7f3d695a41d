#!/usr/bin/env python3
"""Writes a scene made at random, of one kind, to be compared with the reference.

    random_scenes.py KIND SEED -o OUT.toml       KIND: solids, glass, meshes or things

A seed makes the same scene every time. A mesh goes into a file beside the scene. Some scenes are refused by Backlight, as
what cannot be shown to be slower than light; other seeds are then to be taken.
"""
import argparse
import math
import os
import random

from toml_writer import document_text

AOVS = ["Z", "doppler", "emissionTime", "properTime", "P", "N", "objectId", "mirror"]


class Maker:
    """Random numbers, and tables made of them."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def between(self, low, high):
        """A number, short enough to be read."""
        return round(self.random.uniform(low, high), 3)

    def triple(self, size):
        """Three numbers between -size and size."""
        return [self.between(-size, size) for _ in range(3)]

    def beta(self, least, most):
        """A velocity of a size in between, in any direction."""
        v = [self.random.gauss(0, 1) for _ in range(3)]
        size = self.between(least, most) / math.sqrt(sum(x * x for x in v))
        return [round(size * x, 4) for x in v]

    def chance(self, share):
        """True so often."""
        return self.random.random() < share

    def color(self):
        """Red, green and blue."""
        return [self.between(0.2, 0.9) for _ in range(3)]

    def material(self):
        """A diffuse one, with a highlight or not."""
        made = {"color": self.color()}
        if self.chance(0.4):
            made |= {"specular": self.between(0.1, 0.5), "shininess": self.between(5, 20)}
        return made

    # Motions

    def waves(self, size, speed):
        """Three formulas of t: to and fro, so far and so fast at most."""
        made = []
        for _ in range(3):
            rate = self.between(0.5, 1.5) * speed / size
            made.append(f"{self.between(-size, size)} + {round(speed / rate / 1.8, 4)}*sin({round(rate, 4)}*t + "
                        f"{self.between(-3, 3)})")
        return made

    def turning(self, degrees):
        """Three angles, one of which grows, so many degrees in a unit of time at most, or swings."""
        made = self.triple(180)
        axis = self.random.randrange(3)
        rate = self.between(0.3, 1) * degrees
        made[axis] = (f"{made[axis]} + {round(rate, 3)}*t" if self.chance(0.6) else
                      f"{made[axis]} + {round(rate, 3)}*sin(t)")
        return made

    def motion(self, reach):
        """Keys that move a body that reaches so far, within its frame or with it."""
        kind = self.random.choice(["turn", "swing", "both", "rocket", "frame"])
        place = [self.between(-1.6, 1.6), self.between(-0.6, 1), self.between(-1, 1.5)]
        degrees = 57.3 / reach
        if kind == "turn":
            return {"position": place, "rotate": self.turning(0.6 * degrees)}
        if kind == "swing":
            return {"position": self.waves(1.2, 0.5), "rotate": self.triple(180)}
        if kind == "both":
            return {"position": self.waves(1.0, 0.25), "rotate": self.turning(0.3 * degrees)}
        if kind == "rocket":
            return {"position": place, "rotate": self.triple(180),
                    "rocket": {"acceleration": self.between(0.05, 0.25), "along": self.triple(1)}}
        return {"position": place, "frame": "passing", "rotate": self.turning(0.6 * degrees)}

    # Shapes

    def leaf(self, size, kinds=("sphere", "box", "cylinder", "cone", "torus")):
        """A shape that reaches about so far."""
        kind = self.random.choice(kinds)
        return {"shape": kind} | {
            "sphere": lambda: {"radius": self.between(0.6 * size, size)},
            "box": lambda: {"size": [self.between(0.7 * size, 1.2 * size) for _ in range(3)]},
            "cylinder": lambda: {"radius": self.between(0.4 * size, 0.7 * size), "height": self.between(size, 1.5 * size)},
            "cone": lambda: {"radius": self.between(0.6 * size, 0.8 * size),
                             "top_radius": self.between(0, 0.4 * size), "height": self.between(size, 1.4 * size)},
            "torus": lambda: {"major": self.between(0.6 * size, 0.7 * size), "minor": self.between(0.2 * size, 0.3 * size)},
        }[kind]()

    def solid(self, size, parts_move, depth=0):
        """A union, intersection or difference."""
        kind = self.random.choice(["union", "intersection", "difference"])
        parts = []
        for k in range(self.random.choice([2, 2, 3])):
            if depth == 0 and self.chance(0.25):
                part = self.solid(0.8 * size, parts_move, 1)
            else:
                part = self.leaf((0.9 if k == 0 or kind == "intersection" else 0.6) * size)
            part |= {"position": self.triple(0.35 * size if k > 0 else 0.1), "rotate": self.triple(180)}
            if parts_move and self.chance(0.4):
                part["position"] = self.waves(0.25 * size, 0.1)
            if parts_move and self.chance(0.3):
                part["rotate"] = self.turning(0.1 * 57.3 / size)
            if self.chance(0.3):
                part["scale"] = [self.between(0.7, 1.2) for _ in range(3)]
            if self.chance(0.5):
                part["material"] = self.material()
            parts.append(part)
        return {"shape": kind, "part": parts}

    def blend(self, size):
        """Parts that flow into each other."""
        parts = [self.leaf(0.8 * size, ("sphere", "box", "cylinder", "torus")) |
                 {"position": self.triple(0.5 * size), "rotate": self.triple(180), "material": self.material()}
                 for _ in range(2)]
        return {"shape": "union", "blend": self.between(0.1, 0.4), "part": parts}

    # Scenes

    def stage(self):
        """A camera, a floor, lamps and a frame that passes."""
        lamps = [{"type": "point", "position": [self.between(-4, 4), self.between(3, 6), self.between(-5, -1)],
                  "intensity": self.between(60, 150)}]
        if self.chance(0.7):
            lamps.append({"type": "point", "position": [f"{self.between(-1, 1)} + 2*sin({self.between(0.1, 0.3)}*t)",
                                                        f"{self.between(3, 4)} + {self.between(-0.3, 0.3)}*sin(t)",
                                                        f"{self.between(-4, -2)} + {self.between(-0.2, 0.2)}*t"],
                          "intensity": f"{self.between(20, 60)}*(1.3 + sin({self.between(1, 3)}*t))"})
        if self.chance(0.5):
            lamps.append({"type": "distant", "direction": [self.between(-1, 1), -1, self.between(0, 1)],
                          "irradiance": self.between(0.3, 1), "beta": self.beta(0, 0.6)})
        return {
            "film": {"resolution": [64, 48], "samples": 1, "aovs": AOVS},
            "camera": {"position": [self.between(-1, 1), self.between(0.8, 2), self.between(-7, -5)],
                       "look_at": [self.between(-0.2, 0.2), self.between(0, 0.4), 0], "time": self.between(-2, 3),
                       "fov": 38, "beta": self.beta(0, 0.4)},
            "effects": {"doppler": False, "searchlight": self.random.choice(["exact", "exact", "paper", "off"])},
            "frame": {"passing": {"beta": self.beta(0.3, 0.9), "origin": [0.0, 0.3, 0.0],
                                  "origin_time": self.between(-7, -3)}},
            "light": lamps,
            "object": [{"shape": "disk", "radius": 9, "position": [0, -1.6, 0], "material": self.material()}],
        }

    def solids(self):
        """Solids and blends that turn, swing and accelerate."""
        scene = self.stage()
        for _ in range(2):
            size = self.between(0.7, 1.1)
            solid = self.blend(size) if self.chance(0.25) else self.solid(size, self.chance(0.5))
            moves = self.motion(1.5 * size)
            scene["object"].append(solid | moves | {"material": self.material()})
        return scene

    # Glass

    def clear(self, index=None):
        """A material of glass."""
        glass = {"index": index or self.between(1.2, 1.8)}
        if self.chance(0.6):
            glass["tint"] = [self.between(0.5, 1) for _ in range(3)]
        return {"glass": glass}

    def ball_of_glass(self):
        """A ball, or another body, with something in it."""
        inner = self.random.choice([self.clear(1.0), self.clear(), {"color": self.color()}])
        outer = self.leaf(1.2, ("sphere", "sphere", "cylinder"))
        return [outer | {"rotate": self.triple(90), "material": self.clear()},
                self.leaf(0.35, ("sphere", "box", "torus")) | {"position": self.triple(0.15), "rotate": self.triple(180),
                                                               "material": inner}]

    def slabs(self):
        """Two slabs that touch, and a box that stands on them."""
        low, high = 0.25 * self.random.randint(1, 3), 0.25 * self.random.randint(1, 3)
        width, depth = self.between(1.5, 2.5), self.between(1, 2)
        return [{"shape": "box", "size": [width, low, depth], "position": [0, -low / 2, 0], "material": self.clear()},
                {"shape": "box", "size": [width, high, depth], "position": [0, high / 2, 0], "material": self.clear()},
                {"shape": "box", "size": [0.5, 0.5, 0.5], "position": [self.between(-0.4, 0.4), high + 0.25, 0],
                 "material": {"color": self.color()}}]

    def solid_of_glass(self):
        """A solid of one glass."""
        solid = self.solid(1.2, False)
        for part in solid["part"]:
            part.pop("material", None)
            for inner in part.get("part", []):
                inner.pop("material", None)
        return [solid | {"rotate": self.triple(180), "material": self.clear()}]

    def water(self):
        """All below a plane, a floor under it and what swims."""
        return [{"shape": "plane", "position": [0, 0.2, 0], "rotate": [self.between(-4, 4), 0, self.between(-4, 4)],
                 "material": self.clear(1.33)},
                {"shape": "disk", "radius": 8, "position": [0, -1.4, 0], "material": self.checker(0.03)},
                self.leaf(0.8) | {"position": self.triple(0.3), "rotate": self.triple(180),
                                  "material": {"color": self.color()}}]

    def checker(self, size):
        """Two colours in turn."""
        return {"checker": {"colors": [self.color(), self.color()], "size": size}}

    def glass(self):
        """Glass, and what is seen through it."""
        kind = self.random.choice(["ball_of_glass", "ball_of_glass", "slabs", "solid_of_glass", "water"])
        bodies = getattr(self, kind)()
        fast = [] if self.chance(0.25) else [self.between(0.5, 0.8) if kind == "water" else self.between(0.8, 0.99)] * 2
        frame = {"beta": self.beta(*fast) if fast else [0, 0, 0], "origin": [0, 0, 0], "origin_time": -6}
        look = {"position": [self.between(-0.5, 0.5), self.between(1, 2), -5.5], "look_at": [0, 0, 0], "world_time": 0,
                "fov": 34}
        inside = self.chance(0.3) and kind != "solid_of_glass"
        if inside:
            place = {"ball_of_glass": [0.0, 0.3, -0.6], "slabs": [0.1, -0.1, -0.3], "water": [0.3, -0.3, -3]}[kind]
            look = {"position": place, "direction": self.triple(0.4)[:2] + [1], "frame": "glass", "time": 0, "fov": 75}
        elif self.chance(0.5):
            look["beta"] = self.beta(0, 0.5)
        things = [{"shape": "sphere", "radius": 0.8, "position": [self.between(-2, 2), self.between(-1, 1), 3],
                   "beta": self.beta(0, 0.4), "material": {"color": self.color()}},
                  {"shape": "box", "size": [1, 1, 1], "position": [self.between(-2, 2), self.between(-0.5, 1), 4],
                   "rotate": self.turning(30), "material": self.material()},
                  {"shape": "sphere", "radius": 0.5, "position": [2.5, 2, 2], "material": {"emission": 30}}]
        if kind != "water":
            things.append({"shape": "plane", "position": [0, -1.6, 0], "material": self.checker(1.5)})
        lamps = [{"type": "point", "position": [self.between(-3, 3), self.between(3, 6), self.between(-4, 1)],
                  "intensity": self.between(60, 150)},
                 {"type": "distant", "direction": [self.between(-1, 1), -1, self.between(-0.5, 1)], "irradiance": 0.8}]
        if kind == "water":  # what is met in it is at rest in its frame
            things = [thing for thing in things if "emission" in thing["material"]]
        return {
            "film": {"resolution": [64, 48], "samples": 1, "bounces": 5, "aovs": AOVS},
            "camera": look,
            "effects": {"doppler": False, "searchlight": self.random.choice(["exact", "exact", "paper", "off"])},
            "background": {"color": self.color()} | ({"frame": "glass"} if inside or kind == "water" else {}),
            "frame": {"glass": frame}, "light": lamps,
            "object": things + [body | {"frame": "glass"} for body in bodies]}

    # Meshes

    def ball_of_triangles(self, rings, around):
        """(places, triangles) of a bumpy ball."""
        places = [[0, 1, 0]]
        for i in range(1, rings):
            for k in range(around):
                bump, a, b = self.between(0.8, 1.1), math.pi * i / rings, 2 * math.pi * k / around
                places.append([bump * math.sin(a) * math.cos(b), bump * math.cos(a), bump * math.sin(a) * math.sin(b)])
        places.append([0, -1, 0])
        at = lambda i, k: 0 if i == 0 else len(places) - 1 if i == rings else 1 + (i - 1) * around + k % around
        triangles = []
        for i in range(rings):
            for k in range(around):
                a, b, c, d = at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)
                triangles += [t for t in ([a, d, b], [d, c, b]) if len(set(t)) == 3]
        return places, triangles

    def ring_of_triangles(self, around, tube):
        """The same of a ring."""
        places = []
        for i in range(around):
            for k in range(tube):
                a, b, r = 2 * math.pi * i / around, 2 * math.pi * k / tube, self.between(0.25, 0.35)
                places.append([(0.8 + r * math.cos(b)) * math.cos(a), r * math.sin(b),
                               (0.8 + r * math.cos(b)) * math.sin(a)])
        at = lambda i, k: (i % around) * tube + k % tube
        triangles = []
        for i in range(around):
            for k in range(tube):
                a, b, c, d = at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)
                triangles += [[a, b, c], [a, c, d]]
        return places, triangles

    def mesh(self, number):
        """A mesh and its file, with or without normals and texture coordinates of the file's own."""
        places, triangles = self.ball_of_triangles(6, 8) if self.chance(0.5) else self.ring_of_triangles(8, 6)
        normals, texture = self.chance(0.4), self.chance(0.5)
        name = f"{self.stem}_{number}.obj"
        with open(os.path.join(self.folder, name), "w", encoding="ascii") as stream:
            for place in places:
                stream.write("v %.4f %.4f %.4f\n" % tuple(place))
            for place in places if normals else []:
                stream.write("vn %.3f %.3f %.3f\n" % tuple(p + q for p, q in zip(place, self.triple(0.2))))
            for _ in places if texture else []:
                stream.write("vt %.3f %.3f\n" % (self.between(0, 1), self.between(0, 1)))
            for triangle in triangles:
                form = " {0}/{0}/{0}" if texture and normals else " {0}/{0}" if texture else " {0}//{0}" if normals else " {0}"
                stream.write("f" + "".join(form.format(n + 1) for n in triangle) + "\n")
        return {"shape": "mesh", "file": name, "smooth": self.chance(0.6)}

    def meshes(self):
        """Meshes, also as parts of solids, mirrors and glass, at up to a Lorentz factor of a million."""
        scene = self.stage()
        gamma = self.random.choice([1.2, 2.5, 10, 1000, 1e6])
        scene["frame"]["fast"] = {"gamma": gamma, "along": self.triple(1), "origin": [self.between(-1, 1), 0.3, 0],
                                  "origin_time": scene["camera"]["time"] - 6}
        scene["camera"].pop("beta")
        materials = [self.material(), self.checker(0.125), {"mirror": [0.8, 0.7, 0.6], "color": [0.1, 0.1, 0.1]},
                     self.clear()]
        for number, moves in enumerate([{"frame": "fast"}, {"position": [self.between(-2, 2), 0, 1],
                                                            "beta": self.beta(0, 0.7)}]):
            body = self.mesh(number)
            if self.chance(0.3):
                body = {"shape": self.random.choice(["union", "difference"]),
                        "part": [body, self.leaf(0.7) | {"position": self.triple(0.4), "rotate": self.triple(180)}]}
            scene["object"].append(body | moves | {"rotate": self.triple(180), "material": self.random.choice(materials),
                                                   "scale": [self.between(0.7, 1.2) for _ in range(3)]})
        return scene

    # What else moves, shines and looks

    def things(self):
        """Spot lamps that move, materials in their own time, flows, what comes and goes, and cameras that move."""
        scene = self.stage()
        lamp = {"type": "spot", "position": [self.between(-2, 2), 4, -3], "direction": [self.between(-0.5, 0.5), -1, 0.6],
                "angle": self.between(40, 90), "edge": self.between(0, 1), "intensity": self.between(60, 200)}
        lamp |= self.random.choice([{"beta": self.beta(0.2, 0.8)}, {"position": self.waves(1.0, 0.5)[:1] + ["4", "-3 + 0.2*t"]},
                                    {"rocket": {"acceleration": 0.2, "along": self.triple(1)}}])
        scene["light"] = scene["light"][:1] + [lamp]
        own_time = {"color": [f"0.5 + 0.3*sin({self.between(1, 4)}*t)", self.between(0.2, 0.8), "0.4 + 0.2*cos(2*t)"],
                    "emission": f"{self.between(0.1, 0.5)}*(1 + sin({self.between(1, 4)}*t))",
                    "specular": "0.2 + 0.1*sin(t)", "shininess": "12 + 3*sin(t)"}
        w = self.between(-0.5, 0.5)
        whirl = {"shape": "implicit", "f": "x^2 + 1.2*y^2 + z^2 - 0.8", "bounds": [[-1, -1, -1], [1, 1, 1]],
                 "matter_velocity": [f"{w}*z", 0, f"{-w}*x"]}
        bodies = [whirl, self.leaf(0.9), self.leaf(0.9)]
        for body in bodies:
            body |= self.motion(1.5)
            body["material"] = self.random.choice([own_time, self.checker(self.random.choice([0.125, 0.0625])),
                                                   {"mirror": 0.7, "color": [0.2, 0.2, 0.2]}])
        bodies[1]["visible"] = f"{self.between(0.2, 1)} + sin({self.between(2, 5)}*t)"
        bodies[2]["name"] = "ship"
        bodies[2]["casts_shadow"] = self.chance(0.5)
        scene["object"] += bodies
        camera = scene["camera"]
        kind = self.random.choice(["still", "path", "rocket", "aboard"])
        if kind != "still":
            camera.pop("beta")
        if kind == "path":
            camera["position"] = [f"{camera['position'][0]} + 0.5*sin(0.7*t)", "1.5 + 0.2*cos(t)", "-6 + 0.1*t"]
            camera.pop("look_at")
        if kind == "rocket":
            camera["rocket"] = {"acceleration": self.between(0.05, 0.2), "along": self.triple(1)}
        if kind == "aboard":
            camera |= {"aboard": "ship", "position": [0, 1.3, 0], "direction": self.triple(1), "fov": 80}
            camera.pop("look_at")
        return scene


def write(kind, seed, path):
    """Writes the scene of a kind and a seed."""
    maker = Maker(f"{kind} {seed}")
    maker.folder, maker.stem = os.path.dirname(os.path.abspath(path)), os.path.splitext(os.path.basename(path))[0]
    scene = getattr(maker, kind)()
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(f"# Made by tests/oracle/random_scenes.py {kind} {seed}.\n" + document_text(scene))


def main():
    """Command line entry."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("kind", choices=["solids", "glass", "meshes", "things"])
    parser.add_argument("seed", type=int)
    parser.add_argument("-o", "--output", required=True)
    arguments = parser.parse_args()
    write(arguments.kind, arguments.seed, arguments.output)


if __name__ == "__main__":
    main()
