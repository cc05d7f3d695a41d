"""Runs scripts/charts.sh on the smallest pictures, and looks at what it wrote.

    charts_test.py SOURCE PROGRAMS FOLDER      PROGRAMS: the folder with the measuring programs; FOLDER is emptied
"""

import csv
import math
import os
import shutil
import subprocess
import sys

SURE = {  # columns that are there, and rows that there are at least
    "roots": (("surface", "method", "rays_per_second", "worst_error", "missed", "invented"), 5),
    "arithmetic": (("method", "gamma", "doppler_error", "hit_error", "nanoseconds"), 20),
    "wavelengths": (("rule", "wavelengths", "mean", "percentile99", "worst"), 40),
    "wavelengths-cost": (("wavelengths", "cpu_seconds", "times_rgb"), 13),
    "dial": (("scene", "method", "setting", "cpu_seconds", "samples", "rms"), 12),
    "objects": (("motion", "path", "spheres", "cpu_seconds"), 10),
    "pixels": (("motion", "pixels", "cpu_seconds"), 8),
    "scenes": (("scene", "surfaces", "frames", "colours", "pixels", "cpu_seconds"), 6),
    "threads": (("scene", "threads", "wall_seconds", "speed_up"), 2),
    "polygons": (("beta", "method", "triangles", "cpu_seconds", "wrong_share", "rms_pixels", "percentile99_pixels"), 12),
    "ablation": (("scene", "left_out", "cpu_seconds", "times_whole", "rms"), 22),
}
FINITE = ("cpu_seconds", "rms", "times_whole", "times_rgb", "samples", "rays_per_second", "speed_up", "mean")
PICTURES = ("roots", "arithmetic", "wavelengths", "sampling", "dial", "scaling", "ablation", "polygons")


def expect(is_so, what):
    if not is_so:
        sys.exit("charts_test: " + what)


def read(folder, name):
    with open(os.path.join(folder, name + ".csv"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def check_numbers(folder):
    for name, (columns, least) in SURE.items():
        rows = read(folder, name)
        expect(len(rows) >= least, f"{name}.csv has {len(rows)} rows, not {least}")
        for row in rows:
            expect(None not in row and None not in row.values(), f"{name}.csv: a row of another length: {row}")
            expect(all(column in row for column in columns), f"{name}.csv lacks one of {columns}")
            for column in FINITE:
                expect(column not in row or math.isfinite(float(row[column])), f"{name}.csv: {column} = {row.get(column)}")


def check_meaning(folder):
    ours = [row for row in read(folder, "roots") if row["method"].startswith("Backlight")]
    expect(len(ours) == 4, "the three searches and the closed form")
    expect(sum("(chosen)" in row["method"] for row in ours) == 1, "one search is chosen")
    expect(all(row["missed"] == row["invented"] == "0" for row in ours), "no search misses or invents a root")
    ablation = {(row["scene"], row["left_out"]): float(row["rms"]) for row in read(folder, "ablation")}
    expect(ablation["fig3-earth", "robust arithmetic"] == 0.0, "robust arithmetic is in no figure")
    expect(ablation["ahead", "robust arithmetic"] > 0.01, "and is missed where the camera is fast")
    for scene in ("fig3-earth", "ahead"):
        for piece in ("SIMD: two lanes instead of the widest", "sheets and cones: every ray asks every frame"):
            expect(ablation[scene, piece] == 0.0, f"{piece} changes bits of {scene}")
    for row in read(folder, "dial"):
        if row["method"] == "tolerance":
            expect(float(row["rms"]) <= float(row["setting"]), f"delivered {row['rms']} of {row['setting']}")


def main():
    source, programs, folder = sys.argv[1:]
    shutil.rmtree(folder, ignore_errors=True)
    run = subprocess.run([os.path.join(source, "scripts/charts.sh"), "--smoke", folder], cwd=source, text=True, capture_output=True,
                         env={**os.environ, "CHART_PROGRAMS": programs}, check=False)
    expect(run.returncode == 0, f"exit status {run.returncode}\n{run.stdout}\n{run.stderr}")
    check_numbers(folder)
    check_meaning(folder)
    with open(os.path.join(folder, "speed-accuracy.md"), encoding="utf-8") as page:
        text = page.read()
    expect("<!-- table" not in text and "| fig3-earth |" in text, "the page has its tables")
    if shutil.which("gnuplot"):
        for picture in PICTURES:
            expect(os.path.getsize(os.path.join(folder, picture + ".png")) > 5000, f"{picture}.png is drawn")
    else:
        expect("gnuplot is not installed" in run.stderr, "that there are no pictures is told")


if __name__ == "__main__":
    main()
