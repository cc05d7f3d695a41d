"""The measurements of scripts/bench.sh, which builds what is needed and calls this. Standard library only."""

import argparse
import csv
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "bench"))
import povray_twin  # noqa: E402

BACKLIGHT = "build/bench/bin/backlight"
FIELD = "build/bench/bench/sphere_field"
EMBREE = "build/bench/bench/embree_spheres"
YARDSTICKS = "bench/yardsticks"
RECORD = "docs/charts/beside.csv"
SCENES = {  # pictures that people make, each beside its twin at rest, and how many times as fast they are to be
    "fig2a": ("fig2a-tram-rest", "tram and street at rest", 10),
    "fig2b": ("fig2b-tram-terrell", "tram at 0.87c", 8),
    "fig7": ("fig7-tram-shadow", "tram at 0.9c, shadows, spectra", 8),
    "fig1": ("fig1-tram-interior", "camera at 0.9c, spectra", 6),
    "default": ("default", "toys at 0.5c, spectra", 6),
    "flicker": ("street-lamp-flicker", "street at rest, flashing lamp", 6),
}
ALGEBRAIC = "scenes/algebraic-0.9c.toml"
ROWS = ("spheres", "torus", "barth", "gyroid", "motion", "spectral", "many", "circling", "threads", *SCENES, "algebraic", "big-fig7", "process",
        "memory", "startup")
SLOW_ROWS = ("memory", "big-fig7")
PLAIN = ("-D", "effects.doppler=false")  # red, green and blue, with the searchlight effect


class Bench:
    """Subjects by name, each run once a round; every run's seconds by subject."""

    def __init__(self, folder, rounds):
        self.folder, self.rounds = folder, rounds
        self.subjects, self.runs, self.memory = {}, {}, {}

    def add(self, name, run):
        self.subjects[name] = run

    def measure(self):
        for number in range(self.rounds + 1):  # the first one warms up
            for name, run in self.subjects.items():
                traced, whole = run()
                if number > 0:
                    self.runs.setdefault(name, []).append((traced, whole))
            print(f"  round {number} of {self.rounds}", end="\r", file=sys.stderr, flush=True)
        print(" " * 30, end="\r", file=sys.stderr)

    def seconds(self, name):
        return statistics.median(traced for traced, _ in self.runs[name])

    def whole_seconds(self, name):
        return statistics.median(whole for _, whole in self.runs[name])


def run_quietly(command):
    begin = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"bench: failed: {' '.join(command)}\n{done.stderr}")
    return done, time.perf_counter() - begin


def on_cpus(threads):
    """One thread stays on one CPU."""
    return ["taskset", "-c", "0"] if threads == 1 else []


def render_command(bench, scene, *options, threads=1, size="720x526", name="picture"):
    path = os.path.join(bench.folder, name)
    return [BACKLIGHT, "render", scene, "-o", path + ".exr", "-q", "-r", size, "--threads", str(threads),
            "--stats", path + ".json", *options]


def traced_seconds(bench, name="picture"):
    with open(os.path.join(bench.folder, name + ".json"), encoding="utf-8") as file:
        return json.loads(file.readline())["seconds"]


def backlight(bench, scene, *options, threads=1, size="720x526"):
    """A run of the program: seconds of tracing, and of the whole process."""
    command = on_cpus(threads) + render_command(bench, scene, *options, threads=threads, size=size)

    def run():
        _, whole = run_quietly(command)
        return traced_seconds(bench), whole

    return run


def two_processes(bench, scene, *options, size):
    """Two processes of one thread at once, each on a CPU: seconds an image. What two CPUs of this machine can do,
    whatever a program does."""
    names = ("first", "second")
    commands = [["taskset", "-c", str(cpu)] + render_command(bench, scene, *options, size=size, name=name)
                for cpu, name in enumerate(names)]

    def run():
        begin = time.perf_counter()
        children = [subprocess.Popen(command) for command in commands]
        if any([child.wait() != 0 for child in children]):
            sys.exit(f"bench: failed: {' '.join(commands[0])}")
        whole = time.perf_counter() - begin
        return sum(traced_seconds(bench, name) for name in names) / 4, whole

    return run


def povray(bench, scene, *options, threads=1, size=(720, 526)):
    command = on_cpus(threads) + ["povray", f"+I{scene}", f"+O{os.path.join(bench.folder, 'picture.png')}",
                                  f"+W{size[0]}", f"+H{size[1]}", "-A", "-D", f"+WT{threads}", *options]

    def run():
        done, whole = run_quietly(command)
        return float(re.search(r"Trace Time:.*?\(([\d.]+) seconds\)", done.stderr).group(1)), whole

    return run


def embree(mode):
    def run():
        done, whole = run_quietly(on_cpus(1) + [EMBREE, "200", "3"])
        seconds = {row["mode"]: float(row["seconds"]) for row in csv.DictReader(done.stdout.splitlines())}
        return min(seconds.values()) if mode == "best" else seconds[mode], whole

    return run


def field(bench, spheres, motion):
    ending = "pov" if motion == "povray" else "toml"
    path = os.path.join(bench.folder, f"spheres-{spheres}-{motion}.{ending}")
    if not os.path.exists(path):
        with open(path, "w", encoding="utf-8") as file:
            subprocess.run([FIELD, str(spheres), motion], stdout=file, check=True)
    return path


def twin(bench, name):
    path = os.path.join(bench.folder, name + ".pov")
    with open(path, "w", encoding="utf-8") as file:
        file.write(povray_twin.twin(f"scenes/{name}.toml"))
    return path


def peak_megabytes(command):
    """Of a process alone, from the moment it is started."""
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_maxrss / 1024 if child.returncode == 0 else float("nan")


def subjects(bench, rows):
    """What is timed, for the rows that are wanted."""
    spheres = {"spheres", "motion", "spectral", "many", "threads", "process"} & set(rows)
    if spheres:
        bench.add("200 spheres moving", backlight(bench, field(bench, 200, "distinct"), *PLAIN))
        bench.add("200 spheres at rest", backlight(bench, field(bench, 200, "rest")))
    if "spheres" in rows:
        bench.add("POV-Ray 200 spheres", povray(bench, field(bench, 200, "povray")))
        bench.add("Embree 200 spheres", embree("best"))
    for name, v in (("torus", "0.8"), ("barth", "0.8"), ("gyroid", "0.8")):
        if name in rows:
            scene = f"{YARDSTICKS}/{name}"
            bench.add(f"{name} moving", backlight(bench, scene + ".toml", "-D", f"params.v={v}"))
            bench.add(f"{name} at rest", backlight(bench, scene + ".toml"))
            bench.add(f"POV-Ray {name}", povray(bench, scene + ".pov"))
            if name in ("torus", "barth"):
                bench.add(f"POV-Ray {name} sturm", povray(bench, scene + ".pov", "Declare=Sturm=1"))
    if "spectral" in rows:
        bench.add("200 spheres spectral", backlight(bench, field(bench, 200, "distinct")))
    if "many" in rows:
        bench.add("10000 spheres moving", backlight(bench, field(bench, 10000, "distinct"), *PLAIN))
    if "circling" in rows:
        for motion in ("distinct", "circling"):
            for shadows in ("true", "false"):
                bench.add(f"1000 spheres {motion}, shadows {shadows}",
                          backlight(bench, field(bench, 1000, motion), *PLAIN, "-D", f"light.1.shadows={shadows}"))
    if "threads" in rows:
        big = {"size": "2880x2104"}
        for threads in (1, 2):
            bench.add(f"big, {threads} threads",
                      backlight(bench, field(bench, 200, "distinct"), *PLAIN, threads=threads, **big))
        bench.add("big, two processes", two_processes(bench, field(bench, 200, "distinct"), *PLAIN, **big))
        for threads in (1, 2):
            bench.add(f"POV-Ray big, {threads} threads",
                      povray(bench, field(bench, 200, "povray"), threads=threads, size=(2880, 2104)))
    for row, (name, _, _) in SCENES.items():
        if row in rows:
            bench.add(name, backlight(bench, f"scenes/{name}.toml", "--samples", "1"))
            bench.add(f"POV-Ray {name}", povray(bench, twin(bench, name)))
    if "algebraic" in rows:
        bench.add("algebraic-0.9c", backlight(bench, ALGEBRAIC, "--samples", "1"))
    if "big-fig7" in rows:
        for threads in (1, 2):
            bench.add(f"fig7, 1920x1080, {threads} threads",
                      backlight(bench, "scenes/fig7-tram-shadow.toml", "--samples", "16", threads=threads, size="1920x1080"))
    if "process" in rows:
        bench.add("process, 200 spheres moving", backlight(bench, field(bench, 200, "distinct"), *PLAIN, size="2880x2104"))
        bench.add("process, POV-Ray", povray(bench, field(bench, 200, "povray"), size=(2880, 2104)))
    if "startup" in rows:
        one = os.path.join(bench.folder, "one.toml")
        with open(one, "w", encoding="utf-8") as file:
            file.write('[camera]\nposition = [0, 0, -5]\n[[light]]\n[[object]]\nshape = "sphere"\nradius = 1\n')
        bench.add("one sphere, 64x64", backlight(bench, one, size="64x64"))


def report(bench, rows):
    """The table: (work, ours, its seconds, other, its seconds, ratio, wanted)."""
    lines = []

    def ratio(work, numerator, denominator, wanted, seconds=bench.seconds):
        a, b = seconds(numerator), seconds(denominator)
        lines.append((work, numerator, f"{a:.4f} s", denominator, f"{b:.4f} s", f"{a / b:.2f}", wanted))

    if "spheres" in rows:
        ratio("200 moving spheres", "POV-Ray 200 spheres", "200 spheres moving", ">= 10")
        ratio("the same at rest", "POV-Ray 200 spheres", "200 spheres at rest", ">= 14")
        ratio("  beside Embree's best mode", "Embree 200 spheres", "200 spheres at rest", ">= 1.0")
    if "torus" in rows:
        ratio("torus at 0.8c", "POV-Ray torus", "torus moving", ">= 4")
        ratio("  beside sturm", "POV-Ray torus sturm", "torus moving", "")
    if "barth" in rows:
        ratio("Barth's sextic at 0.8c", "POV-Ray barth", "barth moving", ">= 12")
        ratio("  beside sturm", "POV-Ray barth sturm", "barth moving", "")
    if "gyroid" in rows:
        ratio("gyroid at 0.8c, isosurface 1e-3", "POV-Ray gyroid", "gyroid moving", ">= 6")
    if "motion" in rows:
        ratio("cost of motion", "200 spheres moving", "200 spheres at rest", "<= 1.2")
    for name in ("torus", "barth", "gyroid"):
        if "motion" in rows and name in rows:
            ratio(f"  {name}", f"{name} moving", f"{name} at rest", "<= 1.2")
    if "spectral" in rows:
        ratio("spectra beside RGB", "200 spheres spectral", "200 spheres moving", "<= 2.5")
    if "many" in rows:
        ratio("10 000 spheres beside 200", "10000 spheres moving", "200 spheres moving", "<= 10")
    if "circling" in rows:
        for shadows, what in (("true", "1000 spheres on circles beside straight ways"), ("false", "  without shadows")):
            ratio(what, f"1000 spheres circling, shadows {shadows}", f"1000 spheres distinct, shadows {shadows}", "<= 5")
    if "threads" in rows:
        ratio("two threads, 2880x2104", "big, 1 threads", "big, 2 threads", ">= 1.9")
        ratio("  two processes at once, each on its CPU", "big, 1 threads", "big, two processes", "")
        ratio("  POV-Ray's", "POV-Ray big, 1 threads", "POV-Ray big, 2 threads", "")
        ratio("  POV-Ray beside ours, two", "POV-Ray big, 2 threads", "big, 2 threads", "")
    for row, (name, what, wanted) in SCENES.items():
        if row in rows:
            ratio(f"{row}: {what}", f"POV-Ray {name}", name, f">= {wanted}")
    if "big-fig7" in rows:
        ratio("fig7, two threads, 1920x1080, 16 samples", "fig7, 1920x1080, 1 threads", "fig7, 1920x1080, 2 threads", ">= 1.95")
    if "process" in rows:
        ratio("whole process, 200 moving spheres, 2880x2104", "process, POV-Ray", "process, 200 spheres moving", ">= 12",
              bench.whole_seconds)
    return lines


def report_process(bench, rows):
    """What of a whole process is measured, in lines of the same form."""
    lines = []
    if "algebraic" in rows:
        seconds = bench.seconds("algebraic-0.9c")
        lines.append(("algebraic-0.9c, Mray/s of the camera", "algebraic-0.9c", f"{seconds:.4f} s", "", "",
                      f"{720 * 526 / seconds / 1e6:.2f}", ""))
    if "memory" in rows:
        scene = field(bench, 100000, "distinct")
        command = [BACKLIGHT, "render", scene, "-o", os.path.join(bench.folder, "picture.exr"), "-q", "-r", "1920x1080",
                   *PLAIN]
        begin = time.perf_counter()
        megabytes = peak_megabytes(command)
        lines.append(("peak memory, MB", "100000 spheres moving, 1920x1080", f"{time.perf_counter() - begin:.1f} s", "", "",
                      f"{megabytes:.0f}", "<= 400"))
    if "startup" in rows:
        whole = bench.whole_seconds("one sphere, 64x64")
        lines.append(("start-up, ms", "one sphere, 64x64", f"{whole:.4f} s", "", "", f"{1000 * whole:.1f}", "<= 20"))
    return lines


HEADING = ("work", "this", "its time", "beside", "its time", "ratio", "wanted")


def print_table(lines):
    table = [HEADING] + lines
    widths = [max(len(line[i]) for line in table) for i in range(len(HEADING))]
    for line in table:
        print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())


def write_rows(path, heading, lines):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(heading)
        writer.writerows(lines)


def main():
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--record", action="store_true")
    parser.add_argument("rows", nargs="*", metavar="ROW")
    options = parser.parse_args()
    unknown = [row for row in options.rows if row not in ROWS]
    if unknown or options.rounds < 1:
        sys.exit(f"bench: no row {unknown[0] if unknown else options.rounds}; there are: {' '.join(ROWS)}")
    rows = options.rows or [row for row in ROWS if not (options.quick and row in SLOW_ROWS)]
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(folder, 2 if options.quick else options.rounds)
        subjects(bench, rows)
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            cpu = re.search(r"model name\s*:\s*(.*)", file.read())
        print(f"{cpu.group(1) if cpu else 'this machine'}, {os.cpu_count()} CPUs; medians of {bench.rounds} interleaved "
              "runs, one thread unless said, tracing alone as each program tells it")
        bench.measure()
        lines = report(bench, rows) + report_process(bench, rows)
        print_table(lines)
        write_rows("out/bench.csv", ("subject", "run", "traced_seconds", "process_seconds"),
                   [(name, i + 1, f"{t:.6f}", f"{w:.6f}")
                    for name, runs in bench.runs.items() for i, (t, w) in enumerate(runs)])
        if options.record:
            columns = ("work", "this", "this_time", "beside", "beside_time", "ratio", "wanted")
            write_rows(RECORD, columns, [tuple(cell.strip() for cell in line) for line in lines])
            print(f"{RECORD}: for the table of docs/speed-accuracy.md, which scripts/charts.sh --draw writes")
    print(f"{time.perf_counter() - begin:.0f} s in all; out/bench.csv has every run")


if __name__ == "__main__":
    main()
