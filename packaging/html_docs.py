#!/usr/bin/env python3
"""The documents as HTML, with links that work where they are installed (share/doc/backlight/html).

  packaging/html_docs.py TOP FOLDER        FOLDER is emptied first; needs pandoc

README.md becomes index.html, docs/NAME.md NAME.html. Pictures that a page shows are copied; scenes and scripts are linked to
in share/backlight, the licence as ../copyright. Of links to other files of the source the text is left; a link to what is not
there is an error.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

STYLE = """<style>
body { max-width: 52em; margin: 2em auto; padding: 0 1em; font: 16px/1.5 sans-serif; color: #222; background: #fff }
pre, code { font-family: monospace; font-size: 0.92em; background: #f3f3f3 }
pre { padding: 0.7em; overflow-x: auto }
img { max-width: 100%; height: auto }
table { border-collapse: collapse; display: block; overflow-x: auto }
th, td { border: 1px solid #ccc; padding: 0.25em 0.6em; text-align: left; vertical-align: top }
</style>
"""


NOWHERE = "not-installed"


def page_of(document):
    """Where a document of the source goes, below the folder."""
    if document == pathlib.PurePath("README.md"):
        return pathlib.PurePath("index.html")
    return document.relative_to("docs").with_suffix(".html")


def target_of(path, top, folder, page):
    """What a link to `path`, of the source, becomes on `page`."""
    if path.suffix == ".md" and (path.parts[0] == "docs" or path.name == "README.md" and len(path.parts) == 1):
        goal = page_of(path)
    elif path.parts[0] == "docs":
        goal = path.relative_to("docs")
        place = folder / goal
        place.parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if (top / path).is_dir() else shutil.copyfile)(top / path, place)
    elif path.parts[0] in ("scenes", "scripts"):
        goal = pathlib.PurePath("../../../backlight") / path
    elif path == pathlib.PurePath("LICENSE"):
        goal = pathlib.PurePath("../copyright")
    else:
        return None
    return os.path.relpath(goal, page.parent)


def convert(document, top, folder):
    page = page_of(document)
    text = (top / document).read_text(encoding="utf-8")
    title = re.search(r"^#\s+(.*)$", text, re.MULTILINE).group(1).replace("`", "")
    html = subprocess.run(
        ["pandoc", "--from", "gfm", "--to", "html5", "--standalone", "--no-highlight", "--metadata", f"pagetitle={title}",
         "--metadata", "lang=en-GB", "--variable", "document-css=false"],
        input=text, capture_output=True, check=True, encoding="utf-8").stdout

    def replaced(match):
        name, link = match.group(1), match.group(2)
        if re.match(r"[a-z]+:|#", link):
            return match.group(0)
        path, _, anchor = link.partition("#")
        source = pathlib.PurePath(os.path.normpath(document.parent / path))
        if not (top / source).exists():
            raise ValueError(f"a link to {link}, which is not there")
        goal = target_of(source, top, folder, page)
        if goal is None:
            return f'{name}="{NOWHERE}"'
        return f'{name}="{goal}{"#" + anchor if anchor else ""}"'

    try:
        html = re.sub(r'\b(href|src)="([^"]*)"', replaced, html)
    except ValueError as error:
        sys.exit(f"{document}: {error}")
    html = re.sub(rf'<a\s+href="{NOWHERE}">(.*?)</a>', r"\1", html, flags=re.DOTALL)
    home = "" if page.name == "index.html" and len(page.parts) == 1 else \
        f'<p><a href="{os.path.relpath("index.html", page.parent)}">Backlight</a></p>\n'
    html = re.sub(r"<style>.*?</style>\s*", "", html, flags=re.DOTALL)
    html = html.replace("</head>", STYLE + "</head>", 1).replace("<body>", "<body>\n" + home, 1)
    place = folder / page
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_text(html, encoding="utf-8")


def main():
    top, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    documents = [pathlib.PurePath("README.md")]
    documents += [path.relative_to(top) for path in sorted((top / "docs").rglob("*.md"))]
    for document in documents:
        convert(document, top, folder)


if __name__ == "__main__":
    main()
