"""Backlight from Python: a scene, as a dict or a file, becomes an image of NumPy arrays by name.

    import backlight
    image = backlight.render("scenes/first.toml", resolution=(360, 263))
    image["rgb"], image["doppler"], image["objectId"]

The program `backlight` does the work, as a process of its own: the one that the environment variable BACKLIGHT
names, the one this module was installed with, or the one in the PATH. Arrays need NumPy and OpenImageIO
(Debian: python3-numpy, python3-openimageio). docs/python.md has examples.
"""
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import warnings
import weakref
from typing import NamedTuple

__all__ = ["BacklightError", "BacklightWarning", "Diagnostic", "Image", "SceneError", "dumps", "read", "render"]


class Diagnostic(NamedTuple):
    """One thing that is wrong with a scene, and where; `text` is all that the program says about it."""
    file: str
    line: int
    column: int
    message: str
    text: str


class BacklightError(Exception):
    """An image could not be made or read. `status` is the program's exit status, 4 where it could not be run."""

    def __init__(self, message, status=1):
        super().__init__(message)
        self.status = status


class SceneError(BacklightError):
    """The scene is wrong. `errors` has all that was found; `file`, `line`, `column` and `message` are of the
    first. A scene that was a dict has the file "<stdin>", and its lines are those of dumps(scene)."""

    def __init__(self, errors, status=3):
        super().__init__("\n".join(error.text for error in errors), status)
        self.errors = errors
        self.file, self.line, self.column, self.message = errors[0][:4]


class BacklightWarning(UserWarning):
    """What the program warns of."""


# ---- A scene as TOML


_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+\Z")


def _text(value):
    # JSON's escapes are TOML's, but for DEL, which TOML wants escaped too.
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _key(name):
    if not isinstance(name, str):
        raise TypeError(f"a key must be a str, not {name!r}")
    return name if _BARE_KEY.match(name) else _text(name)


def _plain(value):
    """Arrays and numbers of NumPy, tuples and paths as what TOML has."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, tuple):
        return list(value)
    return str(value) if isinstance(value, os.PathLike) else value


def _inline(value, where):
    value = _plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, list):
        return "[" + ", ".join(_inline(one, f"{where}[{i}]") for i, one in enumerate(value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(k)} = {_inline(v, f'{where}.{k}')}" for k, v in value.items()) + "}"
    raise TypeError(f"{where}: a scene has no {type(value).__name__}")


def _write_table(table, path, lines):
    later = []
    for name, value in table.items():
        value, inner = _plain(value), path + [_key(name)]
        where = ".".join(inner)
        if isinstance(value, dict):
            later.append((f"[{where}]", value, inner))
        elif isinstance(value, list) and value and all(isinstance(one, dict) for one in value):
            later += [(f"[[{where}]]", one, inner) for one in value]
        else:
            lines.append(f"{inner[-1]} = {_inline(value, where)}")
    for heading, inner_table, inner in later:
        lines += ["", heading]
        _write_table(inner_table, inner, lines)


def dumps(scene):
    """A scene, or any dict of what TOML knows, as TOML text. TypeError names what TOML has no form for."""
    lines = []
    _write_table(scene, [], lines)
    return "\n".join(lines).lstrip("\n") + "\n"


# ---- The program


def _program():
    named = os.environ.get("BACKLIGHT")
    beside = pathlib.Path(__file__).resolve().parents[3:4]  # PREFIX/lib/python3/dist-packages/backlight.py
    installed = [folder / "bin" / "backlight" for folder in beside if (folder / "bin" / "backlight").is_file()]
    found = named or (str(installed[0]) if installed else shutil.which("backlight"))
    if not found:
        raise BacklightError("there is no program backlight: put it into the PATH, or name it in BACKLIGHT", 4)
    return found


def _run(arguments, stdin="", folder=None):
    """Standard output of the program; errors are raised, warnings warned of."""
    command = [_program(), *map(str, arguments)]
    try:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   cwd=folder, encoding="utf-8", errors="replace")
    except OSError as error:
        raise BacklightError(f"cannot run {command[0]}: {error.strerror}", 4) from None
    try:
        out, told = process.communicate(stdin)
    except BaseException:  # Ctrl-C in a notebook reaches Python alone
        process.send_signal(signal.SIGINT)
        process.communicate()
        raise
    errors = _diagnostics(told)
    if process.returncode == 0:
        return out
    if process.returncode == 3 and errors:
        raise SceneError(errors)
    raise BacklightError(told.strip().removeprefix("backlight: ").removeprefix("error: "), process.returncode)


_PLACE = re.compile(r"(?P<file>.*?):(?P<line>\d+):(?P<column>\d+): (?P<kind>error|warning): (?P<message>.*)\Z")
_PROGRAM = re.compile(r"backlight: (?P<kind>error|warning): (?P<message>.*)\Z")


def _diagnostics(told):
    """The errors of a scene in what the program said; warnings are warned of."""
    entries = []
    for line in told.splitlines():
        match = _PLACE.match(line) or _PROGRAM.match(line)
        if match:
            entries.append((match.groupdict(), [line]))
        elif entries and line.startswith("  "):
            entries[-1][1].append(line)  # the line of the scene, the mark under it, a hint
    errors = []
    for found, lines in entries:
        if found["kind"] == "warning":
            warnings.warn("\n".join(lines), BacklightWarning, stacklevel=4)
        elif "file" in found:
            errors.append(Diagnostic(found["file"], int(found["line"]), int(found["column"]), found["message"],
                                     "\n".join(lines)))
    return errors


# ---- Images


class Image:
    """An image of Backlight. `image[name]` is a NumPy array of float32, row 0 at the top:

    rgb                 height x width x 3, linear, of the colour; alpha, Z height x width
    P, N                height x width x 3, where the file has them
    doppler, emissionTime, properTime, objectId, unresolved, samples: height x width, where the file has them
    light.N, light.Y    channels of a layer that is no vector, by their full names

    The right eye of a stereo pair has the same names after "right.". `names` lists them. Of an image that is only
    a part of one (--crop) the arrays are that part, whose place is `window`: x0, y0, x1, y1.
    """

    def __init__(self, file):
        self._file = pathlib.Path(file)
        info = json.loads(_run(["info", "--json", self._file]).splitlines()[0])
        self.width, self.height = info["width"], info["height"]
        self.window = tuple(info["dataWindow"])
        self.header = info["attributes"]  #: what made it, by the names of docs/command-line.md
        self._arrays = _arrays(self._file, info["views"])

    def __getitem__(self, name):
        try:
            return self._arrays[name]
        except KeyError:
            raise KeyError(f"the image has no '{name}'; it has {', '.join(self.names)}") from None

    def __contains__(self, name):
        return name in self._arrays

    @property
    def names(self):
        return list(self._arrays)

    @property
    def objects(self):
        """The names of the objects: objectId is 1 for the first of them. Some may be empty."""
        return self.header.get("backlight/objects", [])

    def __repr__(self):
        return f"<backlight.Image {self.width}x{self.height}: {', '.join(self.names)}>"

    def png(self, *arguments):
        """The bytes of a PNG, shown as `backlight view` shows it with these arguments: png("--exposure", 1)."""
        with tempfile.TemporaryDirectory(prefix="backlight-") as folder:
            file = pathlib.Path(folder, "image.png")
            _run(["view", "-q", self._file, "-o", file, *arguments])
            return file.read_bytes()

    def _repr_png_(self):
        return self.png()

    def probe(self, x, y, *arguments):
        """What is at pixel x, y from the top left of the whole image: a dict with the members that
        `backlight probe --json` has."""
        return json.loads(_run(["probe", "--json", self._file, f"{x},{y}", *arguments]))

    def save(self, file):
        """Copies the OpenEXR file, with its header."""
        shutil.copyfile(self._file, file)


def _arrays(file, views):
    import numpy
    import OpenImageIO
    opened = OpenImageIO.ImageInput.open(str(file))
    if opened is None:
        raise BacklightError(f"cannot read {file}: {OpenImageIO.geterror()}", 4)
    pixels = opened.read_image("float")
    channels = opened.spec().channelnames
    opened.close()
    layers = {}  # by name: planes by component
    for i, channel in enumerate(channels):
        parts = channel.split(".")
        eye = next((view for view in views[1:] if view in parts[:-1]), "")
        parts = [part for part in parts if part not in views]
        prefix = eye + "." if eye else ""
        component = parts[-1]
        layer = ".".join(parts[:-1]) or {"A": "alpha", "Z": "Z"}.get(component, "rgb")
        layers.setdefault(prefix + layer, {})[component] = pixels[:, :, i]
    arrays = {}
    for layer, planes in layers.items():
        if set(planes) in ({"R", "G", "B"}, {"X", "Y", "Z"}):
            arrays[layer] = numpy.stack([planes[name] for name in sorted(planes, key="RGBXYZ".index)], axis=-1)
        elif len(planes) == 1:
            arrays[layer] = numpy.ascontiguousarray(next(iter(planes.values())))
        else:
            arrays.update({f"{layer}.{name}": numpy.ascontiguousarray(plane) for name, plane in planes.items()})
    return arrays


def read(file):
    """The image of an OpenEXR file. BacklightError if it cannot be read."""
    return Image(file)


def render(scene, *, resolution=None, samples=None, tolerance=None, aovs="all", frame=None, time=None, camera=None,
           overrides=None, arguments=(), folder=None, **params):
    """Renders one image of a scene.

    scene        the path of a scene file, or a dict as its TOML would be read: {"camera": {...}, "object": [...]}
    resolution   (width, height) in pixels; samples, tolerance, camera as the options of `backlight render`
    aovs         data channels: "all", "none", or their names ("doppler,Z" or a list)
    frame, time  the number of the image in the animation (default: 1), or an instant in seconds
    overrides    a dict: {"camera.fov": 40} changes a value of the scene as -D camera.fov=40 does
    arguments    further options of `backlight render`, as a list
    folder       where relative paths of a dict start; default: the current folder
    params       any other keyword changes a parameter of the scene's [params]: v=0.9 is -D params.v=0.9

    Raises SceneError where the scene is wrong, BacklightError for all else, and TypeError where a value has no
    form in a scene. Warnings of the program are BacklightWarnings.
    """
    is_dict = isinstance(scene, dict)
    command = ["render", "-" if is_dict else scene, "--progress", "none", "-q"]
    named = {"-r": resolution and "{}x{}".format(*resolution), "-s": samples, "--tolerance": tolerance, "--time": time,
             "--camera": camera, "--aov": aovs if isinstance(aovs, str) else ",".join(aovs) or "none"}
    if time is not None and frame is not None:
        raise TypeError("frame and time: an image has one or the other")
    if time is None:
        named["-f"] = 1 if frame is None else frame
    for option, value in named.items():
        if value is not None:
            command += [option, value]
    changed = {**(overrides or {}), **{f"params.{_key(name)}": value for name, value in params.items()}}
    for path, value in changed.items():
        command += ["-D", f"{path}={_inline(value, path)}"]
    text = dumps(scene) if is_dict else ""
    made = pathlib.Path(tempfile.mkdtemp(prefix="backlight-"))
    try:
        _run([*command, *arguments, "-o", made / "image.exr"], text, folder if is_dict else None)
        [file] = made.glob("*.exr")  # of an animation, with the number in its name
        image = Image(file)
    except BaseException:
        shutil.rmtree(made, ignore_errors=True)
        raise
    weakref.finalize(image, shutil.rmtree, made, ignore_errors=True)
    return image
