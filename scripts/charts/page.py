"""Writes docs/speed-accuracy.md: the text of a template, with tables made from the charts' CSV files. Called by scripts/charts.sh.

    page.py FOLDER TEMPLATE PAGE [--check]

With --check nothing is written: exit status 1 tells that the page is not that of the CSV files and the template.

In the template, a line <!-- table NAME --> stands for a table, <!-- machine --> for what was measured on, and (chart:NAME.png) for
a path to a chart. Standard library only.
"""

import csv
import math
import os
import re
import statistics
import sys


def rows(folder, name):
    with open(os.path.join(folder, name + ".csv"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def short(text, digits=2):
    """A number of the CSV with few digits: 1.2e-15, 0.034, 1200."""
    value = float(text)
    if value == 0:
        return "0"
    if value != value or value in (float("inf"), float("-inf")):
        return "-" if value != value else "∞"
    if 100 <= abs(value) < 1e4:
        return f"{value:.0f}"
    return f"{value:.{digits}g}" if 1e-3 <= abs(value) < 1e4 else f"{value:.{digits - 1}e}".replace("e-0", "e-").replace("e+0", "e")


def thousands(text):
    value = float(text)
    return f"{value / 1e6:.1f} M" if value >= 1e6 else f"{value / 1e3:.0f} k" if value >= 1e4 else f"{value:.0f}"


def table(heading, lines):
    out = ["| " + " | ".join(heading) + " |", "|" + " --- |" * len(heading)]
    return out + ["| " + " | ".join(line) + " |" for line in lines]


def roots(folder):
    lines = []
    for row in rows(folder, "roots"):
        missed, invented = (row[c] if row[c] == "0" else f"**{row[c]}**" for c in ("missed", "invented"))
        lines.append((row["surface"], row["method"], thousands(row["rays_per_second"]), short(row["worst_error"]),
                      short(row["median_error"]), missed, invented, row["hits"]))
    return table(("surface", "method", "rays/s", "worst error", "median", "missed", "invented", "true hits"), lines)


def arithmetic(folder):
    all_rows = rows(folder, "arithmetic")
    methods = list(dict.fromkeys(row["method"] for row in all_rows))
    by = {(row["method"], float(row["gamma"])): row for row in all_rows}
    lines = []
    for gamma in (3.0, 29.0, 31.0, 1e3, 1e6, 1e8):
        lines.append([f"{gamma:g}".replace("e+0", "e")] + [
            f"{short(by[m, gamma]['doppler_error'])}, {short(by[m, gamma]['hit_error'])}"
            + (f", **{by[m, gamma]['lost']} of {by[m, gamma]['hits']} lost**" if int(by[m, gamma]["lost"]) else "")
            for m in methods])
    lines.append(["ns a boost, γ = 29; 31"] + [
        f"{short(by[m, 29.0]['nanoseconds'])}; {short(by[m, 31.0]['nanoseconds'])}" for m in methods])
    return table(["γ"] + methods, lines)


def wavelengths(folder):
    cost = {row["wavelengths"]: row["times_rgb"] for row in rows(folder, "wavelengths-cost")}
    lines = [("3 lines, no spectra", "1", *(short(row[c]) for c in ("mean", "percentile99", "worst")))
             for row in rows(folder, "wavelengths") if row["rule"] == "three lines"]
    lines += [(f"**{row['wavelengths']}**" if row["wavelengths"] == "56" else row["wavelengths"],
               short(cost[row["wavelengths"]]), *(short(row[c]) for c in ("mean", "percentile99", "worst")))
              for row in rows(folder, "wavelengths") if row["rule"] == "Backlight"]
    return table(("wavelengths", "time / RGB", "mean ΔE2000", "99 % below", "worst"), lines)


def sampling(folder):
    all_rows, lines = rows(folder, "dial"), []
    for scene in dict.fromkeys(row["scene"] for row in all_rows):
        mine = [row for row in all_rows if row["scene"] == scene]
        uniform = [row for row in mine if row["method"] == "uniform"]
        for row in mine:
            if row["method"] != "tolerance" or float(row["setting"]) not in (0.02, 0.005):
                continue
            near = min(uniform, key=lambda u, t=float(row["cpu_seconds"]): abs(float(u["cpu_seconds"]) - t))
            delivered = short(row["rms"])
            if float(row["rms"]) > float(row["setting"]):
                delivered = f"**{delivered}**"
            lines.append((scene, row["setting"], delivered, short(row["cpu_seconds"]), short(row["samples"]),
                          f"{near['setting']}: {short(near['cpu_seconds'])} s, {short(near['rms'])}"))
    return table(("scene", "asked", "delivered", "CPU s", "samples a pixel", "even samples in about that time: CPU s, error"), lines)


def objects(folder):
    all_rows = [row for row in rows(folder, "objects") if row["path"] == "sheets"]
    kinds = list(dict.fromkeys(row["motion"] for row in all_rows))
    by = {(row["motion"], row["spheres"]): row["cpu_seconds"] for row in all_rows}
    lines = [[n] + [short(by[kind, n]) for kind in kinds] for n in dict.fromkeys(row["spheres"] for row in all_rows)]
    return table(["spheres"] + [kind + ", CPU s" for kind in kinds], lines)


def pixels(folder):
    all_rows = rows(folder, "pixels")
    by = {(row["motion"], row["pixels"]): float(row["cpu_seconds"]) for row in all_rows}
    lines = []
    for row in all_rows:
        if row["motion"] == "moving":
            size = (row["width"] + "x" + row["height"], row["pixels"])
            lines.append((size[0], *(f"{short(by[m, size[1]])} s, {1e9 * by[m, size[1]] / int(size[1]):.0f} ns"
                                     for m in ("at rest", "moving"))))
    return table(("pixels", "at rest: CPU time, and of a pixel", "every one its own velocity"), lines)


def scenes(folder):
    all_rows = rows(folder, "scenes")
    by = {(row["scene"], row["pixels"]): 1e9 * float(row["cpu_seconds"]) / int(row["pixels"]) for row in all_rows}
    sizes = {row["pixels"]: row["width"] + "x" + row["height"] for row in all_rows}
    of_scene = {row["scene"]: (row["scene"], row["surfaces"], row["frames"], row["colours"]) for row in all_rows}
    return table(("scene", "surfaces", "frames", "colours", *(f"{size}: ns a pixel" for size in sizes.values())),
                 [(*words, *(f"{by[name, pixels]:.0f}" for pixels in sizes)) for name, words in of_scene.items()])


def threads(folder):
    return table(("scene", "threads", "seconds", "times as fast"),
                 [(row["scene"], row["threads"], short(row["wall_seconds"], 3), short(row["speed_up"], 3))
                  for row in rows(folder, "threads")])


def ablation(folder):
    all_rows, lines = rows(folder, "ablation"), []
    for piece in dict.fromkeys(row["left_out"] for row in all_rows):
        if piece == "nothing":
            continue
        mine = [row for row in all_rows if row["left_out"] == piece]
        time = [float(row["times_whole"]) for row in mine]
        error = [float(row["rms"]) for row in mine]
        worst = max(mine, key=lambda row: float(row["rms"]))["scene"] if max(error) > 0 else "none"
        lines.append((piece, short(statistics.median(time)), f"{short(min(time))} ... {short(max(time))}",
                      short(statistics.median(error)), short(max(error)), worst))
    return table(("left out", "time left, median", "over the figures", "error, median", "largest", "in"), lines)


# Whose roots the rows of `beside` are about: their surface, our method and the other's, as `roots` has them.
ERRORS = {
    "POV-Ray torus": ("torus", "Backlight: torus", "POV-Ray: torus"),
    "POV-Ray torus sturm": ("torus", "Backlight: torus", "POV-Ray: torus sturm"),
    "POV-Ray barth": ("Barth's sextic", "Backlight", "POV-Ray: polynomial"),
    "POV-Ray barth sturm": ("Barth's sextic", "Backlight", "POV-Ray: polynomial sturm"),
    "POV-Ray gyroid": ("gyroid", "Backlight", "POV-Ray: isosurface 1e-3"),
    "POV-Ray 200 spheres": ("sphere", "Backlight: sphere", "POV-Ray: sphere"),
}


def worst_errors(folder, work):
    """Ours and the other's, of chart a; empty where a row is not about roots."""
    if work not in ERRORS:
        return "", ""
    surface, ours, other = ERRORS[work]
    of = {row["method"]: row["worst_error"] for row in rows(folder, "roots") if row["surface"] == surface}
    return (max((float(error) for method, error in of.items() if method.startswith(ours)), default=float("nan")),
            float(of.get(other, "nan")))


def beside(folder):
    lines = []
    for row in rows(folder, "beside"):
        errors = worst_errors(folder, row["this"])
        lines.append((row["work"], row["this"], row["this_time"], row["beside"], row["beside_time"], f"**{row['ratio']}**",
                      row["wanted"], ", ".join(short(error) for error in errors if error != "")))
    return table(("work", "this", "time", "beside", "time", "ratio", "aim", "worst error of a hit: ours, its"), lines)


def cost_of_error(uniform, error):
    """The time that even samples would take for an error, between those measured; beyond the finest, that of the finest."""
    points = sorted((float(row["rms"]), float(row["cpu_seconds"])) for row in uniform)
    for (low, dear), (high, cheap) in zip(points, points[1:]):
        if low <= error <= high:
            part = math.log(error / low) / math.log(high / low)
            return math.exp(math.log(dear) + part * math.log(cheap / dear))
    return points[0][1] if error < points[0][0] else points[-1][1]


def dial(folder):
    """What chart d and e say in a sentence, from the numbers."""
    all_rows = rows(folder, "dial")
    gains, ratios = {}, {}
    for row in all_rows:
        delivered, asked = float(row["rms"]), float(row["setting"])
        if row["method"] != "tolerance" or delivered == 0:
            continue
        uniform = [u for u in all_rows if u["scene"] == row["scene"] and u["method"] == "uniform"]
        gains.setdefault(asked, []).append((cost_of_error(uniform, delivered) / float(row["cpu_seconds"]), row["scene"]))
        ratios.setdefault(asked, []).append((delivered / asked, row["scene"]))
    lines = []
    for asked in sorted(gains, reverse=True):
        gain, ratio = sorted(gains[asked]), sorted(ratios[asked])
        worst = f"**{short(ratio[-1][0])}**" if ratio[-1][0] > 1 else short(ratio[-1][0])
        lines.append((f"{asked:g}", f"{short(statistics.median(g for g, _ in gain))}", f"{short(gain[0][0])}, {gain[0][1]}",
                      f"{short(gain[-1][0])}, {gain[-1][1]}", f"{short(statistics.median(r for r, _ in ratio))}", f"{worst}, {ratio[-1][1]}"))
    return table(("asked", "times as fast as even samples of the same error: median", "least", "most", "delivered / asked: median", "most"), lines)


def polygons(folder):
    """The first number of triangles by which what 99 % of the pixels show is right to a tenth of a pixel."""
    lines = []
    all_rows = rows(folder, "polygons")
    for beta in dict.fromkeys(row["beta"] for row in all_rows):
        of_speed = [row for row in all_rows if row["beta"] == beta]
        rays = next(row for row in of_speed if row["method"] == "rays")
        drawn = [row for row in of_speed if row["method"] == "polygons"]
        good = next((row for row in drawn if float(row["percentile99_pixels"]) <= 0.1), drawn[-1])
        fair = next((row for row in drawn if float(row["wrong_share"]) <= 0.001), drawn[-1])
        milli = lambda row: f"{short(1000 * float(row['cpu_seconds']))} ms"
        lines.append((f"{beta} c", thousands(good["triangles"]), milli(good), f"{100 * float(good['wrong_share']):.2g} %",
                      thousands(fair["triangles"]), milli(fair), milli(rays)))
    return table(("speed", "triangles for 0.1 pixel within bodies", "time", "outlines wrong then", "triangles for outlines right to 0.1 %", "time", "rays"), lines)


TABLES = {"dial": dial, "polygons": polygons, "roots": roots, "arithmetic": arithmetic, "wavelengths": wavelengths, "sampling": sampling, "objects": objects,
          "pixels": pixels, "scenes": scenes, "threads": threads, "ablation": ablation, "beside": beside}


def machine(folder):
    with open(os.path.join(folder, "machine.txt"), encoding="utf-8") as file:
        return [file.read().strip()]


def main():
    if len(sys.argv) not in (4, 5) or sys.argv[4:] not in ([], ["--check"]):
        sys.exit(__doc__)
    folder, template, page = sys.argv[1:4]
    charts = os.path.relpath(folder, os.path.dirname(page))
    out = []
    with open(template, encoding="utf-8") as file:
        for line in file.read().splitlines():
            found = re.fullmatch(r"<!-- table (\w+) -->", line)
            try:
                if found:
                    out += TABLES[found.group(1)](folder)
                elif line == "<!-- machine -->":
                    out += machine(folder)
                else:
                    out.append(re.sub(r"\(chart:([\w.-]+)\)", lambda m: f"({charts}/{m.group(1)})", line))
            except FileNotFoundError as missing:
                out.append(f"(not measured yet: {os.path.basename(missing.filename)})")
    text = "\n".join(out) + "\n"
    if sys.argv[4:]:
        with open(page, encoding="utf-8") as file:
            sys.exit(0 if file.read() == text else f"{page} is not up to date: scripts/charts.sh --draw")
    with open(page + ".new", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(page + ".new", page)


if __name__ == "__main__":
    main()
