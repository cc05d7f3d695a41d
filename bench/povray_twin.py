"""Writes the classical twin of a scene for POV-Ray 3.7: the same things where they are seen, and nothing moves.

    povray_twin.py SCENE.toml TWIN.pov [--check]      --check: only tell, by the exit status, whether there is a twin

For speed alone: geometry, lamps and shadows are the same, which is what costs. What moves stands, unturned and unsqueezed, where the
camera sees it (its frame's origin) at t = 0. Where the two programs' surfaces differ, POV-Ray has the easier work: a texture
becomes a checker, the background a gradient, and colours are three numbers. Refused, with the reason and exit status 1, is a scene with
what has no twin: other projections than the perspective, formulas as surfaces, blends. Standard library only.
"""

import ast
import math
import operator
import os
import sys
import tomllib


class NoTwin(Exception):
    """What of a scene POV-Ray is not told of, and why."""


OPERATIONS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.Pow: operator.pow,
              ast.UAdd: operator.pos, ast.USub: operator.neg}
FUNCTIONS = {name: getattr(math, name) for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp",
                                                    "log", "sqrt", "floor")}
FUNCTIONS |= {"abs": abs, "min": min, "max": max, "cbrt": lambda x: math.copysign(abs(x) ** (1 / 3), x), "pow": pow, "mod": math.fmod}
MERGED = {"params": {}, "frame": {}, "material": {}, "light": [], "object": []}  # of included files, too


class Formulas:
    """Numbers of a scene: as they stand, or as formulas of its parameters at t = 0."""

    def __init__(self, parameters):
        self.parameters = parameters
        self.known = {"pi": math.pi, "e": math.e, "t": 0.0, "image_time": 0.0, "frame": 1.0}
        self.under_way = set()

    def number(self, value):
        if not isinstance(value, str):
            return float(value)
        try:
            return float(self.value_of(ast.parse(value.strip().replace("^", "**"), mode="eval").body))
        except (SyntaxError, ValueError, ArithmeticError, TypeError) as fault:
            raise NoTwin(f"the formula '{value}': {fault}") from None

    def numbers(self, values):
        return [self.number(value) for value in values]

    def value_of(self, node):
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
            return node.value
        if isinstance(node, ast.Name):
            return self.named(node.id)
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATIONS:
            return OPERATIONS[type(node.op)](self.value_of(node.left), self.value_of(node.right))
        if isinstance(node, ast.UnaryOp) and type(node.op) in OPERATIONS:
            return OPERATIONS[type(node.op)](self.value_of(node.operand))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS:
            return FUNCTIONS[node.func.id](*map(self.value_of, node.args))
        raise NoTwin(f"a formula with {type(node).__name__}")

    def named(self, name):
        if name not in self.known:
            if name not in self.parameters or name in self.under_way:
                raise NoTwin(f"a formula with {name}")
            self.under_way.add(name)
            self.known[name] = self.number(self.parameters[name])
        return self.known[name]


def read(path, seen=None):
    """The scene's tables, those of the files it includes before its own. A file that is included twice counts once."""
    seen = set() if seen is None else seen
    path = os.path.realpath(path)
    scene = {key: type(value)() for key, value in MERGED.items()}
    if path in seen:
        return scene
    seen.add(path)
    with open(path, "rb") as file:
        own = tomllib.load(file)
    included = own.get("include", [])
    parts = [read(os.path.join(os.path.dirname(path), name), seen) for name in ([included] if isinstance(included, str) else included)]
    for part in parts + [own]:
        for key, empty in MERGED.items():
            scene[key] = scene[key] + part.get(key, []) if isinstance(empty, list) else scene[key] | part.get(key, {})
    return scene | {key: value for key, value in own.items() if key not in MERGED}


def vector(numbers):
    return "<" + ",".join(f"{x:.9g}" for x in numbers) + ">"


def shape_of(thing, formulas, materials):
    """The shape's words up to the point where its own modifiers begin."""
    shape = thing["shape"]
    number = lambda key, other=0.0: formulas.number(thing.get(key, other))  # noqa: E731
    if shape == "sphere":
        return f"sphere {{ 0, {number('radius'):.9g}"
    if shape == "box":
        half = [side / 2 for side in formulas.numbers(thing["size"])]
        return f"box {{ {vector([-x for x in half])}, {vector(half)}"
    if shape == "cylinder":
        half = number("height") / 2
        return f"cylinder {{ {-half:.9g}*y, {half:.9g}*y, {number('radius'):.9g}"
    if shape == "cone":
        half = number("height") / 2
        return f"cone {{ {-half:.9g}*y, {number('radius'):.9g}, {half:.9g}*y, {number('top_radius'):.9g}"
    if shape == "torus":
        return f"torus {{ {number('major'):.9g}, {number('minor'):.9g}"
    if shape == "disk":
        return f"disc {{ 0, y, {number('radius'):.9g}"
    if shape == "plane":
        return "plane { y, 0"
    if shape in ("union", "intersection", "difference") and "blend" not in thing:
        return f"{shape} {{ " + " ".join(part_of(part, formulas, materials) for part in thing["part"])
    raise NoTwin("blended parts" if "blend" in thing else f"shape = \"{shape}\"")


def placed(thing, formulas, at):
    words = []
    scale = thing.get("scale", 1)
    scale = formulas.numbers(scale) if isinstance(scale, list) else [formulas.number(scale)] * 3
    if scale != [1, 1, 1]:
        words.append(f"scale {vector(scale)}")
    if "rotate" in thing:  # about x, y, z, in right-handed axes, as the camera's `right` makes them
        words.append(f"rotate {vector(formulas.numbers(thing['rotate']))}")
    if any(at):
        words.append(f"translate {vector(at)}")
    return " ".join(words)


def part_of(thing, formulas, materials):
    """Its material is the whole's unless it has its own."""
    look = texture(thing["material"], formulas, materials) if "material" in thing else ""
    at = formulas.numbers(thing.get("position", [0, 0, 0]))
    return f"{shape_of(thing, formulas, materials)} {look} {placed(thing, formulas, at)} }}"


def texture(material, formulas, materials):
    if isinstance(material, str):
        if material not in materials:
            raise NoTwin(f"no material '{material}'")
        material = materials[material]
    if "checker" in material:
        first, second = (vector(formulas.numbers(colour)) for colour in material["checker"]["colors"])
        size = max(formulas.number(material["checker"].get("size", 1)), 0.02)
        pigment = f"checker rgb {first} rgb {second} scale {size:.9g}"
    elif "texture" in material:
        pigment = "checker rgb 0.3 rgb 0.6 scale 0.2"
    else:
        pigment = f"rgb {vector(formulas.numbers(material.get('color', [0.8, 0.8, 0.8])))}"
    return (f"pigment {{ {pigment} }} finish {{ ambient 0.1 emission {formulas.number(material.get('emission', 0)):.9g} diffuse 1 "
            f"phong {formulas.number(material.get('specular', 0)):.9g} phong_size {formulas.number(material.get('shininess', 50)):.9g} }}")


def velocity_of(thing, c, formulas):
    """By any of the keys that give one, in the scene's units."""
    if "velocity" in thing:
        return formulas.numbers(thing["velocity"])
    if "beta" in thing:
        return [c * x for x in formulas.numbers(thing["beta"])]
    beta = 0.0
    if "gamma" in thing:
        beta = math.sqrt(1 - formulas.number(thing["gamma"]) ** -2)
    elif "celerity" in thing:
        celerity = formulas.number(thing["celerity"])
        beta = celerity / math.hypot(1, celerity)
    elif "rapidity" in thing:
        beta = math.tanh(formulas.number(thing["rapidity"]))
    along = formulas.numbers(thing.get("along", [1, 0, 0]))
    return [c * beta * x / math.hypot(*along) for x in along]


def where_seen(at, time, velocity, eye, c):
    """Where from `eye` at time 0 a point is seen that is `at` a place at a time."""
    before = [a - v * time - e for a, v, e in zip(at, velocity, eye)]  # from the eye, at time 0
    # |before + velocity t| = -c t
    a = c * c - sum(v * v for v in velocity)
    half = sum(x * v for x, v in zip(before, velocity))
    t = (half - math.sqrt(half * half + a * sum(x * x for x in before))) / a if a > 0 else 0.0
    return [x + v * t + e for x, v, e in zip(before, velocity, eye)]


def place_of(thing, scene, formulas, eye=None):
    """Of the thing itself if it moves by itself, else with its frame."""
    c = formulas.number(scene.get("c", 1))
    at = formulas.numbers(thing.get("position", [0, 0, 0]))
    if eye is not None and any(velocity := velocity_of(thing, c, formulas)):
        return where_seen(at, 0.0, velocity, eye, c)
    name, inside = thing.get("frame", "world"), set()
    while name != "world":
        if name not in scene["frame"] or name in inside:
            raise NoTwin(f"no frame '{name}'")
        inside.add(name)
        frame = scene["frame"][name]
        origin = formulas.numbers(frame.get("origin", [0, 0, 0]))
        if eye is not None:
            origin = where_seen(origin, formulas.number(frame.get("origin_time", 0)), velocity_of(frame, c, formulas), eye, c)
        at = [a + b for a, b in zip(at, origin)]
        name = frame.get("within", "world")
    return at


def objects(scene, formulas, eye):
    for thing in scene["object"]:
        look = texture(thing.get("material", {}), formulas, scene["material"])
        shadow = "" if thing.get("casts_shadow", True) else "no_shadow "
        place = place_of(thing, scene, formulas, eye)
        repeat = thing.get("repeat", {"count": [1, 1, 1], "step": [0, 0, 0]})
        counts, step = [int(formulas.number(n)) for n in repeat["count"]], formulas.numbers(repeat["step"])
        words = shape_of(thing, formulas, scene["material"])
        for i in range(counts[0]):
            for j in range(counts[1]):
                for k in range(counts[2]):
                    at = [p + n * s for p, n, s in zip(place, (i, j, k), step)]
                    yield f"{words} {look} {shadow}{placed(thing, formulas, at)} }}"


def lamps(scene, formulas, eye):
    for lamp in scene["light"]:
        shadow = "" if lamp.get("shadows", True) else "shadowless "
        kind = lamp.get("type", "point")
        if kind == "point":
            strength = formulas.number(lamp.get("intensity", 1)) / math.pi
            yield (f"light_source {{ {vector(place_of(lamp, scene, formulas, eye))} rgb {strength:.9g} fade_distance 1 fade_power 2 {shadow}}}")
        elif kind == "distant":
            towards = [-1000 * x for x in formulas.numbers(lamp["direction"])]
            yield (f"light_source {{ {vector(towards)} rgb {formulas.number(lamp.get('irradiance', 1)) / math.pi:.9g} parallel point_at 0 "
                   f"{shadow}}}")
        elif kind != "ambient":  # that one is in every finish
            raise NoTwin(f"a light of type \"{kind}\"")


def camera(scene, formulas):
    """Its words, and where it is."""
    own = scene.get("camera", {})
    own = own[0] if isinstance(own, list) else own
    if own.get("projection", "perspective") != "perspective" or "stereo" in own:
        raise NoTwin("a camera without perspective, or with two eyes")
    at = place_of(own, scene, formulas)
    towards = formulas.numbers(own["look_at"]) if "look_at" in own else [
        a + b for a, b in zip(at, formulas.numbers(own.get("direction", [0, 0, 1])))]
    up = formulas.numbers(own.get("up", [0, 1, 0]))
    return (f"camera {{ perspective location {vector(at)} right -x*image_width/image_height up y sky {vector(up)} "
            f"angle {formulas.number(own.get('fov', 60)):.9g} look_at {vector(towards)} }}"), at


def background(scene):
    """A gradient in place of a picture, and one colour in place of one colour."""
    if "texture" in scene.get("background", {}):
        return "sky_sphere { pigment { gradient y color_map { [0 rgb 0.4] [1 rgb <0.4, 0.6, 1>] } } }"
    return "background { rgb 0 }"


def twin(path):
    """The text of the twin of a scene file; NoTwin, if it has none."""
    scene = read(path)
    formulas = Formulas(scene["params"])
    looking, eye = camera(scene, formulas)
    lines = ["#version 3.7;", "global_settings { assumed_gamma 1 max_trace_level 1 }", looking, background(scene)]
    return "\n".join(lines + list(lamps(scene, formulas, eye)) + list(objects(scene, formulas, eye))) + "\n"


def main():
    if len(sys.argv) not in (3, 4) or sys.argv[3:] not in ([], ["--check"]):
        sys.exit("usage: povray_twin.py SCENE.toml TWIN.pov [--check]")
    try:
        text = twin(sys.argv[1])
    except NoTwin as reason:
        sys.exit(f"povray_twin: {sys.argv[1]} has no twin: {reason}")
    except (OSError, KeyError, tomllib.TOMLDecodeError) as fault:
        sys.exit(f"povray_twin: {sys.argv[1]}: {fault!r}")
    if sys.argv[3:] != ["--check"]:
        with open(sys.argv[2], "w", encoding="utf-8") as file:
            file.write(text)


if __name__ == "__main__":
    main()
