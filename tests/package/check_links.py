#!/usr/bin/env python3
"""Follows every link and picture of the HTML pages below a folder: its file is there, and its anchor in it.

  tests/package/check_links.py FOLDER
"""
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src") and value is not None:
                self.links.append(value)
            elif name in ("id", "name"):
                self.anchors.add(value)


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    pages = {path: Page(path) for path in folder.rglob("*.html")}
    followed, broken = 0, []
    for path, page in pages.items():
        for link in page.links:
            address = urllib.parse.urlsplit(link)
            if address.scheme:
                continue
            followed += 1
            goal = (path.parent / urllib.parse.unquote(address.path)).resolve() if address.path else path
            if not goal.exists():
                broken.append(f"{path.relative_to(folder)}: {link}: no such file")
            elif address.fragment and goal in pages and urllib.parse.unquote(address.fragment) not in pages[goal].anchors:
                broken.append(f"{path.relative_to(folder)}: {link}: no such anchor")
    print(f"{len(pages)} pages, {followed} links")
    if broken or len(pages) < 15 or followed < 100:
        sys.exit("\n".join(broken) or "too few pages or links")


if __name__ == "__main__":
    main()
