#!/usr/bin/env python3
"""The page of scripts/course.sh, in a real headless Chromium: moved by its keys and by a mouse, on a screen, a phone and paper.

    page_test.py PROGRAM FOLDER [--page PAGE.html]

Works in FOLDER, which is emptied first; the screenshots stay there. It makes a small page with three sliders, or looks at PAGE.html, which has all.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib
import unittest

from browser import Browser

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
ENTER, END, HOME, LEFT, UP, RIGHT, DOWN, TAB = 13, 35, 36, 37, 38, 39, 40, 9
SOME = ["aberration", "contraction", "twins"]
SLIDERS = {slider["name"]: slider for slider in tomllib.loads((TOP / "docs/course/sliders.toml").read_text())["slider"]}


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.names = list(SLIDERS)
        cls.page = page
        if not page:
            shutil.rmtree(folder, ignore_errors=True)
            cls.names, cls.page = SOME, folder / "course.html"
            subprocess.run([TOP / "scripts/course.sh", "-o", cls.page, "--resolution", "129x73", "--samples", "1", *SOME], check=True,
                           env=os.environ | {"BACKLIGHT": program}, stdout=subprocess.DEVNULL)
        folder.mkdir(parents=True, exist_ok=True)

        cls.browser = Browser(folder / "chromium.log")
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.browser.screen(1200, 900)
        self.browser.ask("Emulation.setEmulatedMedia", features=[])
        self.browser.open(self.page)

    def focus(self, name, what='input[type="range"]'):
        """Opens the answer, where the slider is in it."""
        self.browser.value(f"""(() => {{
          const input = document.querySelector('[data-slider="{name}"] {what}');
          const fold = input.closest("figure").closest("details");
          if (fold) fold.open = true;
          input.focus();
        }})()""")

    def state(self, name):
        return self.browser.value(f"""(async () => {{
          const figure = document.querySelector('[data-slider="{name}"]'), image = figure.querySelector("img"), range = figure.querySelector('[type="range"]');
          await image.decode();
          return {{ at: Number(range.value), told: range.getAttribute("aria-valuetext"), output: figure.querySelector("output").textContent,
            source: image.src.length + image.src.slice(-4000), alt: image.alt, width: image.naturalWidth,
            readings: [...figure.querySelectorAll(".readings tr")].map(row => [...row.cells].map(cell => cell.textContent)) }};
        }})()""")

    def test_nothing_fails_and_nothing_is_fetched(self):
        self.browser.value("Promise.all([...document.images].map(image => image.decode()))")
        failures = [event for event in self.browser.events if event.get("method") in ("Runtime.exceptionThrown", "Network.loadingFailed")]
        self.assertEqual(failures, [])
        asked = {event["params"]["request"]["url"] for event in self.browser.events if event.get("method") == "Network.requestWillBeSent"}
        self.assertEqual({url[:5] for url in asked}, {"file:", "data:"})
        self.assertEqual(sum(url.startswith("file:") for url in asked), 1)
        self.assertNotRegex(self.page.read_text(), r"(?:src|href)=\"(?!data:|#)")
        self.assertLess(self.page.stat().st_size, 15e6)
        self.assertNotIn(str(folder), self.page.read_text())

    def test_links_lead_to_places_of_the_page(self):
        self.assertEqual(self.browser.value("[...document.querySelectorAll('a')].map(a => a.getAttribute('href')).filter(h => !document.querySelector(h.replace(/^#/, '#\\\\3') && `[id=\"${h.slice(1)}\"]`))"), [])
        self.assertEqual(self.browser.value("document.querySelectorAll('section').length"), 12)
        self.assertEqual(self.browser.value("(() => { const ids = [...document.querySelectorAll('[id]')].map(e => e.id); return ids.length - new Set(ids).size })()"), 0)

    def test_keys_move_the_sliders(self):
        for name in self.names:
            with self.subTest(name):
                values, shown = SLIDERS[name]["values"], SLIDERS[name]["shown"]
                before = self.state(name)
                self.assertEqual(before["at"], values.index(shown))
                self.focus(name)
                self.browser.press("ArrowRight", RIGHT)
                after = self.state(name)
                self.assertEqual(after["at"], values.index(shown) + 1)
                self.assertEqual(after["told"], after["output"])
                self.assertEqual(float(after["told"].split()[0]), values[values.index(shown) + 1])
                self.assertNotEqual(after["source"], before["source"])
                self.assertIn(after["told"], after["alt"])
                self.assertNotEqual(after["readings"], before["readings"])
                self.browser.press("Home", HOME)
                self.assertEqual(self.state(name)["at"], 0)
                self.browser.press("End", END)
                self.assertEqual(self.state(name)["at"], len(values) - 1)
                self.assertEqual(self.browser.value(f"course['{name}'].views.map(v => v.pictures.length)"), [len(values)] * len(SLIDERS[name]["view"]))

    def test_keys_choose_the_view_and_show_the_marks(self):
        name = "contraction"
        photographed = self.state(name)
        self.focus(name, 'input[type="radio"]')
        self.browser.press("ArrowRight", RIGHT)
        now = self.state(name)
        self.assertNotEqual(now["source"], photographed["source"])
        self.assertIn("where it is at one time", now["alt"])
        self.focus(name, 'input[type="checkbox"]')
        visible = "[...document.querySelectorAll('[data-slider=\"contraction\"] .mark')].map(m => m.getClientRects().length)"
        self.assertEqual(self.browser.value(visible), [0, 0])
        self.browser.press(" ", 32, " ")
        self.assertEqual(self.browser.value(visible), [1, 1])
        self.browser.screenshot(folder / "marks.png")

    def test_all_can_be_clicked(self):
        # What a link leads to is there at once, not scrolled to while the next thing is clicked.
        self.browser.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
        for name in self.names:
            figure = f"document.querySelector('[data-slider=\"{name}\"]')"
            values = SLIDERS[name]["values"]
            for across, value in ((0.999, values[-1]), (0.001, values[0])):
                self.browser.click(f"{figure}.querySelector('[type=\"range\"]')", across)
                self.assertEqual(float(self.state(name)["output"].split()[0]), value)
            views = SLIDERS[name]["view"]
            for i in reversed(range(len(views) if len(views) > 1 else 0)):
                self.browser.click(f"{figure}.querySelectorAll('[type=\"radio\"]')[{i}]")
                self.assertIn(views[i]["name"], self.state(name)["alt"])
            self.browser.click(f"{figure}.querySelector('[type=\"checkbox\"]')")
            self.assertTrue(self.browser.value(f"[...{figure}.querySelectorAll('.mark')].every(m => m.getClientRects().length === 1)"), name)
        links = self.browser.value("[...document.querySelectorAll('a')].map(a => a.getAttribute('href'))")
        for i, link in enumerate(links):
            self.browser.click(f"document.querySelectorAll('a')[{i}]", 0.1)
            self.assertEqual(self.browser.value("location.hash"), link)
        for i in range(self.browser.value("document.querySelectorAll('summary').length")):
            fold = f"document.querySelectorAll('summary')[{i}]"
            before = self.browser.value(f"{fold}.parentElement.open")
            self.browser.click(fold, 0.1)
            self.assertNotEqual(self.browser.value(f"{fold}.parentElement.open"), before)

    def test_readings_are_those_of_the_lessons(self):
        def reading(name, row, column):
            table = self.state(name)["readings"]
            return next(cells for cells in table if cells[0] == row)[table[0].index(column)]

        # A small page has pixels of its own: what is read off is near.
        near = 0.06 if self.state("aberration")["width"] < 641 else 1e-3
        self.assertAlmostEqual(float(reading("aberration", "Doppler factor D", "A")), 5 / 3, delta=near)
        self.assertAlmostEqual(float(reading("twins", "its own time then", "ship")), 2, delta=near)
        self.assertEqual(reading("aberration", "object", "A"), "hoop at 90 degrees")
        self.focus("contraction")
        self.browser.press("Home", HOME)
        self.assertAlmostEqual(float(reading("contraction", "Doppler factor D", "B")), 1, delta=1e-6)

    def test_everything_can_be_reached_by_the_tab_key(self):
        can = self.browser.value("[...document.querySelectorAll('a, input, summary')].filter(e => e.type !== 'radio' || e.checked)"
                                 ".filter(e => e.checkVisibility()).length")
        self.browser.value("(() => { window.reached = new Set(); addEventListener('focusin', event => reached.add(event.target)); return 0 })()")
        for _ in range(can + 5):
            self.browser.press("Tab", TAB)
        seen = self.browser.value("[reached.size, [...document.querySelectorAll('a, input, summary')].filter(e => e.type !== 'radio' || e.checked)"
                                  ".filter(e => e.checkVisibility() && !reached.has(e)).map(e => e.outerHTML)]")
        self.assertEqual(seen[1], [])

    def test_pictures_have_alternative_texts_and_inputs_have_names(self):
        short = self.browser.value("[...document.images].filter(image => image.alt.trim().split(' ').length < 4).map(image => image.alt)")
        self.assertEqual(short, [])
        nameless = self.browser.value("[...document.querySelectorAll('input')].filter(i => !i.ariaLabel && !i.labels.length).map(i => i.outerHTML)")
        self.assertEqual(nameless, [])
        self.assertEqual(self.browser.value("document.documentElement.lang"), "en")

    def test_answers_are_folded_until_they_are_opened(self):
        self.assertEqual(self.browser.value("document.querySelectorAll('details[open]').length"), 0)
        folds = self.browser.value("[...document.querySelectorAll('section')].slice(1, 11).map(s => [...s.querySelectorAll('details:not(.readings) > summary')].map(e => e.textContent).join())")
        self.assertEqual(folds, ["Read it off,The answer"] * 10)
        self.browser.value("document.querySelectorAll('summary')[0].focus()")
        self.browser.press("Enter", ENTER, "\r")
        self.assertEqual(self.browser.value("document.querySelectorAll('details[open]').length"), 1)

    def test_a_phone_shows_it_without_moving_sideways(self):
        for width in (320, 390):
            self.browser.screen(width, 800, 2, True)
            self.browser.value("document.querySelectorAll('details').forEach(fold => { fold.open = true; })")
            self.assertLessEqual(self.browser.value("document.documentElement.scrollWidth"), width)
            small = self.browser.value("[...document.querySelectorAll('p, td, li, label')].filter(e => parseFloat(getComputedStyle(e).fontSize) < 13).length")
            self.assertEqual(small, 0)
        self.browser.value("document.querySelector('[data-slider]').scrollIntoView({ behavior: 'instant' })")
        self.browser.screenshot(folder / "phone.png")

    def test_text_can_be_read_on_its_ground(self):
        contrast = """(() => {
          const luminance = hex => { const c = [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16) / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
            return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; };
          const style = getComputedStyle(document.documentElement), of = name => luminance(style.getPropertyValue(name).trim());
          return [["--ink", "--page"], ["--ink", "--card"], ["--accent", "--page"], ["--accent", "--card"], ["--soft", "--page"]].map(([a, b]) => {
            const [low, high] = [of(a), of(b)].sort((x, y) => x - y); return (high + 0.05) / (low + 0.05); });
        })()"""
        for scheme in ("light", "dark"):
            self.browser.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
            self.assertGreater(min(self.browser.value(contrast)), 4.5, scheme)
            self.browser.value("document.querySelector('[data-slider]').scrollIntoView({ behavior: 'instant' })")
            self.browser.screenshot(folder / f"{scheme}.png")

    def test_paper_has_all_of_it(self):
        self.browser.paper(folder / "course.pdf")
        self.assertEqual(self.browser.value("document.querySelectorAll('details[open]').length"), 0)  # folded again
        if shutil.which("pdftotext"):
            text = subprocess.run(["pdftotext", "-layout", folder / "course.pdf", "-"], capture_output=True, text=True, check=True).stdout
            self.assertIn("hoop at 90 degrees", text)
            self.assertGreaterEqual(text.count("The answer"), 10)
        pages = len(re.findall(rb"/Type\s*/Page\b", (folder / "course.pdf").read_bytes()))
        self.assertTrue(12 <= pages <= 48, pages)


if __name__ == "__main__":
    program, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    page = pathlib.Path(sys.argv[4]).resolve() if sys.argv[3:4] == ["--page"] else None
    unittest.main(argv=[sys.argv[0], *sys.argv[5 if page else 3:]])
