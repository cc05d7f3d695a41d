#!/usr/bin/env python3
"""The course as one page: scripts/course.sh says how it is called.

Pandoc makes HTML of the lessons. Each picture docs/course/images/NAME.jpg becomes the slider NAME of docs/course/sliders.toml: its images are
rendered, and what `backlight probe` says at the marks of each goes into the page as data, for page.js.
"""

import argparse
import base64
import concurrent.futures
import html
import json
import os
import pathlib
import re
import subprocess
import sys
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parent.parent
COURSE = TOP / "docs/course"
PROBED = "Z,doppler,emissionTime,properTime,P,objectId"
FOLDED = {"Read it off": "Read it off", "Answer": "The answer"}


def run(*command):
    """What a command prints; its own words, where it fails."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"course.sh: {' '.join(str(word) for word in command)}\n{done.stderr}")
    return done.stdout


def data_uri(picture):  # a JPEG
    return "data:image/jpeg;base64," + base64.b64encode(picture.read_bytes()).decode()


def significant(value):
    """Numbers in six figures: what a float of an image is good for."""
    if isinstance(value, list):
        return [significant(v) for v in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value


class Images:
    """Renders the images of the sliders into a folder, a process for each CPU."""

    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder

    def stem(self, slider, view, value):
        return self.folder / f"{slider['name']}-{slider['view'].index(view)}-{value}"

    def render(self, slider, view, value):
        """What the probe says at the marks of one image."""
        image = f"{self.stem(slider, view, value)}.exr"
        scene = TOP / "scenes/course" / f"{slider.get('scene', slider['name'])}.toml"
        run(self.arguments.program, scene, "-q", "--skip-existing", "--threads", "1", "-r", self.arguments.resolution, "-s", self.arguments.samples,
            "--aov", PROBED, *view.get("options", []), "-D", f"params.{slider['parameter']}={value}", "-o", image)
        width, height = (int(n) for n in self.arguments.resolution.split("x"))
        pixels = [f"{x * width // 641},{y * height // 361}" for x, y in slider["marks"].values()]
        lines = run(self.arguments.program, "probe", image, *pixels, "--json").splitlines()
        return [{row: significant(told.get(row)) for row in slider["rows"]} for told in map(json.loads, lines)]

    def show(self, slider, view):
        """The images of one view as JPEGs, shown alike: loading a library once for all of them."""
        stems = [self.stem(slider, view, value) for value in slider["values"]]
        pngs = self.folder / f"{slider['name']}-{slider['view'].index(view)}"
        run(self.arguments.program, "view", *[f"{stem}.exr" for stem in stems], "-q", "--exposure", view.get("exposure", "0"),
            "--tone", view.get("tone", "none"), "-o", f"{pngs}/")
        run("oiiotool", "--nosoftwareattrib", *[word for stem in stems
                          for word in (pngs / f"{stem.name}.png", "--compression", "jpeg:85", "-o", f"{stem}.jpg")])
        return [data_uri(pathlib.Path(f"{stem}.jpg")) for stem in stems]

    def make_all(self, sliders):
        """{name: what page.js needs of the slider}"""
        jobs = [(slider, view, value) for slider in sliders for view in slider["view"] for value in slider["values"]]
        rows = [(slider, view) for slider in sliders for view in slider["view"]]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            readings = iter(list(pool.map(lambda job: self.render(*job), jobs)))
            pictures = iter(list(pool.map(lambda row: self.show(*row), rows)))
        made = {}
        for slider in sliders:
            views = [{"name": view["name"], "pictures": next(pictures), "readings": [next(readings) for _ in slider["values"]]}
                     for view in slider["view"]]
            made[slider["name"]] = {key: slider[key] for key in ("label", "unit", "values", "shown", "marks")} | {"views": views}
        return made


def folded(markdown):
    """The lesson with its readings and its answer folded, until they are opened."""
    parts = re.split(r"^## (.*)$", markdown, flags=re.M)
    text = parts[0]
    for heading, body in zip(parts[1::2], parts[2::2]):
        if heading in FOLDED:
            text += f'<details>\n<summary>{FOLDED[heading]}</summary>\n\n{body}\n\n</details>\n'
        else:
            text += f"\n## {heading}\n{body}"
    return text


def embedded(match, sliders, folder):
    """A picture of a lesson: as a slider, or as it is."""
    source, alt = match["source"], match["alt"]
    name = pathlib.Path(source).stem
    if name in sliders:
        slider = sliders[name]
        first = slider["views"][0]["pictures"][slider["values"].index(slider["shown"])]
        return f'<figure class="slider" data-slider="{name}"><div class="picture"><img src="{first}" alt="{alt}"></div></figure>'
    picture = COURSE / source
    if picture.suffix != ".jpg":
        picture = folder / f"{name}-embedded.jpg"
        run("oiiotool", "--nosoftwareattrib", COURSE / source, "--resize", "720x0", "--ch", "R,G,B", "--compression", "jpeg:85", "-o", picture)
    return f'<figure><img src="{data_uri(picture)}" alt="{alt}"></figure>'


def as_section(file, sliders, folder):
    """A lesson as a section of the page: no link leads out of it but to other lessons."""
    markdown = folded(file.read_text())
    source = folder / "lesson.md"
    source.write_text(markdown)
    text = run("pandoc", "-f", "gfm", "-t", "html5", "--no-highlight", "--shift-heading-level-by=1", f"--id-prefix={file.stem}-", source)
    text = re.sub(r'(?:<figure>\s*|<p>)?<img\s+src="(?P<source>[^"]+)"\s+alt="(?P<alt>[^"]*)"\s*/>(?:\s*<figcaption.*?</figcaption>\s*</figure>|</p>)?',
                  lambda match: embedded(match, sliders, folder), text, flags=re.S)
    text = re.sub(r'<a\s+href="(\d\d-[^"#]*|teachers|README)\.md"', r'<a href="#\1"', text)
    text = re.sub(r'<a\s+href="(?!#)[^"]*"[^>]*>(.*?)</a>', r"<cite>\1</cite>", text, flags=re.S)
    text = re.sub(r"<li>(<p>)?(<strong>[A-C](?:, [A-C])?\.</strong>.*?)</li>", with_prediction(file.stem), text, flags=re.S)
    text = text.replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")
    return f'<section id="{file.stem}">\n{text}\n</section>'


def with_prediction(lesson):
    def change(match):
        name = re.search(r"<strong>(.*?)\.</strong>", match[0])[1]
        field = f'<input type="text" aria-label="My prediction, {name}" placeholder="my prediction" autocomplete="off">'
        return match[0].replace("</li>", f" {field}</li>")

    return change


def main():
    parser = argparse.ArgumentParser(prog="scripts/course.sh")
    parser.add_argument("program")
    parser.add_argument("-o", "--output", default=TOP / "out/course.html", type=pathlib.Path)
    parser.add_argument("--resolution", default="641x361")
    parser.add_argument("--samples", default="4")
    parser.add_argument("--refresh-docs", action="store_true")
    parser.add_argument("slider", nargs="*")
    arguments = parser.parse_intermixed_args()

    sliders = tomllib.loads((COURSE / "sliders.toml").read_text())["slider"]
    unknown = set(arguments.slider) - {slider["name"] for slider in sliders}
    if unknown:
        parser.error(f"no slider '{unknown.pop()}'; there are: {' '.join(slider['name'] for slider in sliders)}")
    if arguments.slider:
        sliders = [slider for slider in sliders if slider["name"] in arguments.slider]
    folder = arguments.output.with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)

    data = Images(arguments, folder).make_all(sliders)
    if arguments.refresh_docs:
        (COURSE / "images").mkdir(exist_ok=True)
        for slider in sliders:
            shown = folder / f"{slider['name']}-0-{slider['shown']}.jpg"
            (COURSE / "images" / f"{slider['name']}.jpg").write_bytes(shown.read_bytes())

    files = [COURSE / "README.md", *sorted(COURSE.glob("[0-9][0-9]-*.md")), COURSE / "teachers.md"]
    sections = [as_section(file, data, folder) for file in files]
    page = (HERE / "page.html").read_text()
    page = page.replace("/* page.css */", (HERE / "page.css").read_text())
    page = page.replace("/* page.js */", (HERE / "page.js").read_text())
    page = page.replace("<!-- sections -->", "\n".join(sections))
    page = page.replace("{} // data", json.dumps(data).replace("</", "<\\/"))
    arguments.output.write_text(page)
    print(f"{arguments.output}: {arguments.output.stat().st_size / 1e6:.1f} MB")


main()
