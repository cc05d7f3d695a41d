#!/usr/bin/env python3
"""Plays a farm: processes that render one animation into one folder, and what happens to farms.

  tests/farm/play.py [--seeds A-B] [--seconds S] [--jobs N] [--program FILE] [--misfortune FILE] [--keep]

One seed decides everything that the player does: how many processes and images there are, what claims were left behind
before, and when which process is killed (SIGKILL, SIGTERM, SIGHUP, SIGINT), asked for a snapshot, stopped and continued, has
its clock set, finds its disk full, and when the date of a claim is changed. (What the operating system does in between, no
seed decides.) A process that ended is begun again until it ends by itself. Then it must hold:

 1. Every process comes to an end. Its exit status is 0, or 128 + n after signal n, or 4 after its disk was full, or it was
    killed by the signal that the player sent.
 2. Every image has the bytes of a render that nobody disturbed.
 3. Nothing else is left but what a process that was ended in the middle of a step cannot remove: a hidden file with its number.
 4. An image is made once, by the lines of --stats: never more often than once and once more for each time that its claim was
    taken over from a process that was not gone (it hung for longer than the expiry time and came back); and lines are missing
    for no more images than processes were killed or had no room for the line.
 5. A claim is taken over only from a process that is gone, that was stopped for the expiry time, or that never was.

Where the machine was so busy that the player itself was late by a quarter of the expiry time, the processes may have been
too: then 5 is not judged, and the play is counted as "late".

Exits 0 only if all of it held; with the seed, the log of a play that failed, and its folder, if not. With --seconds, the
seeds from A on are played until the time is over."""
import argparse
import concurrent.futures
import mmap
import os
import pathlib
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parents[2]
EXPIRY = 0.6
MOST_FRAMES = 8
LONGEST_PLAY = 60.0
SCENE = """
[animation]
fps = 10
frames = [1, 8]
[film]
resolution = [24, 18]
samples = 1500
aovs = ["Z", "doppler"]
[camera]
position = [0, 0, -5]
look_at = [0, 0, 0]
velocity = [0, 0, 0.3]
[[light]]
type = "distant"
direction = [1, -1, 1]
irradiance = 3
[[object]]
shape = "torus"
major = 1
minor = 0.4
rotate = ["40*image_time", 20, 0]
velocity = [0.6, 0, 0]
"""
STOPS = (signal.SIGTERM, signal.SIGHUP, signal.SIGINT)


class Worker:
    """A process, and the one that follows when it has ended."""

    def __init__(self, play, number):
        self.play, self.number = play, number
        self.options = play.random.choice((["--resume"], [], ["--skip-existing"]))
        self.options += ["-t", str(play.random.randint(1, 2))]
        self.weather_file = play.folder / f"weather-{number}"
        self.weather_file.write_bytes(struct.pack("qq", 0, 0))
        with open(self.weather_file, "r+b") as file:
            self.weather = mmap.mmap(file.fileno(), 16)
        self.process, self.log, self.runs, self.succeeded = None, None, 0, False

    def set_weather(self, clock=None, full=None):
        before = struct.unpack("qq", self.weather[:16])
        self.weather[:16] = struct.pack("qq", before[0] if clock is None else clock, before[1] if full is None else full)
        self.had_full_disk |= bool(full)

    def begin(self):
        self.runs += 1
        self.sent, self.stopped_since = [], None
        self.had_full_disk = struct.unpack("qq", self.weather[:16])[1] != 0
        self.log = self.play.folder / f"log-{self.number}-{self.runs}"
        environment = dict(os.environ, LD_PRELOAD=str(self.play.misfortune), MISFORTUNE_WEATHER=str(self.weather_file))
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen(self.play.command + self.options, cwd=self.play.folder, env=environment,
                                            stdin=subprocess.DEVNULL, stdout=log, stderr=log)

    def runs_now(self):
        return self.process is not None and self.process.poll() is None

    def send(self, number):
        if not self.runs_now():
            return
        self.process.send_signal(number)
        self.sent.append(number)
        if number == signal.SIGSTOP:
            self.stopped_since = time.monotonic()
        elif number == signal.SIGCONT and self.stopped_since is not None:
            self.play.note_stop(self.process.pid, time.monotonic() - self.stopped_since)
            self.stopped_since = None

    def judge_end(self):
        code = self.process.returncode
        if self.stopped_since is not None:
            self.play.note_stop(self.process.pid, time.monotonic() - self.stopped_since)
        ends = [s for s in self.sent if s in STOPS]
        abrupt = code < 0 or len(ends) > 1
        if abrupt:
            self.play.abrupt.add(self.process.pid)
        self.play.gone.add(self.process.pid)
        may_lose_line = abrupt or self.had_full_disk
        self.play.may_lose_lines += 1 if may_lose_line else 0
        right = (code == 0 or code - 128 in ends or (code == 4 and self.had_full_disk) or -code in self.sent)
        if not right:
            self.play.fail(f"process {self.process.pid} ended with {code}, after the signals {self.sent}")
        self.succeeded = code == 0
        self.process = None


class Play:
    def __init__(self, seed, base, arguments):
        self.seed, self.random, self.base = seed, random.Random(seed), base
        self.misfortune = arguments.misfortune
        self.folder = base / f"play-{seed}"
        self.made = self.folder / "made"
        self.made.mkdir(parents=True)
        self.frames = self.random.randint(3, MOST_FRAMES)
        self.command = [str(arguments.program), str(base / "scene.toml"), "-o", "made/a.exr", "-f", f"1-{self.frames}",
                        "--claim", "--claim-expires", str(EXPIRY), "--stats", "stats.json", "--progress", "none"]
        self.wrong, self.gone, self.abrupt, self.long_stops = [], set(), set(), set()
        self.may_lose_lines, self.latest, self.late = 0, 0.0, False

    def fail(self, what):
        self.wrong.append(what)

    def note_stop(self, pid, seconds):
        if seconds > 0.5 * EXPIRY:  # it may have renewed its claim long before it was stopped
            self.long_stops.add(pid)

    def image(self, frame):
        return f"a.{frame:04d}.exr"

    def leave_claims(self):
        for frame in self.random.sample(range(1, self.frames + 1), self.random.randint(0, 2)):
            claim = self.made / (self.image(frame) + ".claim")
            claim.write_text(self.random.choice(("", "backlight claim\nhost far\nprocess 12\nspace x\nstart 1\nnumber 0\n")))
            self.date(claim)

    def date(self, claim):
        when = time.time() + self.random.choice((-1e6, -3600.0, -1.0, 1.0, 3600.0, 1e6))
        try:
            os.utime(claim, (when, when))
        except FileNotFoundError:
            pass

    def script(self, workers):
        """What happens: (time, deed), in order."""
        happens = []
        for _ in range(self.random.randint(3, 12)):
            at = self.random.uniform(0.0, 0.7)
            worker = self.random.choice(workers)
            deed = self.random.choice(("kill", "end", "end", "snapshot", "stop", "stop", "clock", "full", "date"))
            if deed == "kill":
                happens.append((at, lambda w=worker: w.send(signal.SIGKILL)))
            elif deed == "end":
                happens.append((at, lambda w=worker, s=self.random.choice(STOPS): w.send(s)))
            elif deed == "snapshot":
                happens.append((at, lambda w=worker: w.send(signal.SIGUSR1)))
            elif deed == "stop":
                length = self.random.choice((0.05, 0.2, 1.5 * EXPIRY))
                happens.append((at, lambda w=worker: w.send(signal.SIGSTOP)))
                happens.append((at + length, lambda w=worker: w.send(signal.SIGCONT)))
            elif deed == "clock":
                happens.append((at, lambda w=worker, o=self.random.randint(-10**6, 10**6): w.set_weather(clock=o)))
            elif deed == "full":
                happens.append((at, lambda w=worker: w.set_weather(full=1)))
                happens.append((at + self.random.uniform(0.02, 0.3), lambda w=worker: w.set_weather(full=0)))
            else:
                frame = self.random.randint(1, self.frames)
                happens.append((at, lambda f=frame: self.date(self.made / (self.image(f) + ".claim"))))
        return sorted(happens, key=lambda event: event[0])

    def run(self):
        workers = [Worker(self, number) for number in range(self.random.randint(2, 4))]
        self.leave_claims()
        happens = self.script(workers)
        begin = last = time.monotonic()
        for worker in workers:
            worker.begin()
        while happens or not all(worker.succeeded for worker in workers):
            now = time.monotonic()
            self.latest, last = max(self.latest, now - last), now
            while happens and now - begin >= happens[0][0]:
                happens.pop(0)[1]()
            for worker in workers:
                if worker.process is not None and not worker.runs_now():
                    worker.judge_end()
                    if not worker.succeeded:
                        worker.begin()
            if now - begin > LONGEST_PLAY:
                self.fail("processes did not come to an end: " +
                          ", ".join(str(w.process.pid) for w in workers if w.runs_now()))
                for worker in workers:
                    worker.send(signal.SIGKILL)
                break
            time.sleep(0.005)
        self.late = self.latest > EXPIRY / 4
        last_run = subprocess.run(self.command + ["--resume"], cwd=self.folder, capture_output=True, text=True, timeout=60)
        if last_run.returncode != 0:
            self.fail(f"the last run, which nothing disturbed, ended with {last_run.returncode}: {last_run.stderr}")
        self.judge()
        return self

    def judge(self):
        for frame in range(1, self.frames + 1):
            path = self.made / self.image(frame)
            if not path.exists() or path.read_bytes() != (self.base / "right" / self.image(frame)).read_bytes():
                self.fail(f"{path.name} is missing or not right")
        expected = {self.image(frame) for frame in range(1, self.frames + 1)}
        for name in sorted(set(os.listdir(self.made)) - expected):
            number = re.search(r"-(\d+)-\d+(\.tmp)?$", name)
            if not (name.startswith(".backlight-") and number and int(number[1]) in self.abrupt):
                self.fail(f"left behind: {name}")
        self.judge_once()

    def judge_once(self):
        statistics = self.folder / "stats.json"
        lines = statistics.read_text().splitlines() if statistics.exists() else []
        made = [re.search(r'"file":"made/([^"]*)"', line)[1] for line in lines]
        taken_from_living = []
        for log in self.folder.glob("log-*"):
            for image, holder in re.findall(r"^made/(\S+)  taken over from (.*)$", log.read_text(errors="replace"), re.M):
                pid = re.fullmatch(r"process (\d+) on .*", holder)
                if pid is None or pid[1] == "12":
                    continue  # left behind before the play began
                if int(pid[1]) not in self.gone or int(pid[1]) in self.long_stops:
                    taken_from_living.append(image)
                if int(pid[1]) not in self.long_stops | self.gone and not self.late:
                    self.fail(f"{image} was taken over from process {pid[1]}, which was alive and not stopped")
        lost = 0
        for frame in range(1, self.frames + 1):
            image = self.image(frame)
            lost += 1 if made.count(image) == 0 else 0
            if made.count(image) > 1 + taken_from_living.count(image):
                self.fail(f"{image} was made {made.count(image)} times, and taken over from living processes "
                          f"{taken_from_living.count(image)} times")
        if lost > self.may_lose_lines:
            self.fail(f"{lost} images have no line in the statistics; {self.may_lose_lines} may")


def play(seed, base, arguments):
    one = Play(seed, base, arguments)
    one.run()
    if one.wrong:
        for log in sorted(one.folder.glob("log-*")):
            one.wrong.append(f"--- {log.name}\n{log.read_text(errors='replace').rstrip()}")
    elif not arguments.keep:
        shutil.rmtree(one.folder)
    return one


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="1-200")
    parser.add_argument("--seconds", type=float, default=0.0)
    parser.add_argument("--jobs", type=int, default=3 * len(os.sched_getaffinity(0)))
    parser.add_argument("--program", type=pathlib.Path, default=TOP / "build/release/bin/backlight")
    parser.add_argument("--misfortune", type=pathlib.Path, default=TOP / "build/release/tests/support/libmisfortune.so")
    parser.add_argument("--keep", action="store_true")
    arguments = parser.parse_args()
    first, _, last = arguments.seeds.partition("-")
    first, last = int(first), int(last or first)
    base = pathlib.Path(tempfile.mkdtemp(prefix="backlight-play-"))
    (base / "scene.toml").write_text(SCENE)
    subprocess.run([arguments.program, base / "scene.toml", "-o", base / "right/a.exr", "-q"], check=True)

    begin, done, late, failed = time.monotonic(), 0, 0, 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        seeds, running = iter(range(first, 10**9 if arguments.seconds else last + 1)), set()
        while True:
            over = (arguments.seconds and time.monotonic() - begin > arguments.seconds) or failed >= 5
            while len(running) < arguments.jobs and not over:
                seed = next(seeds, None)
                if seed is None:
                    break
                running.add(pool.submit(play, seed, base, arguments))
            if not running:
                break
            ended, running = concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in ended:
                one = future.result()
                done, late = done + 1, late + one.late
                if one.wrong:
                    failed += 1
                    print(f"seed {one.seed}: {one.folder}\n  " + "\n  ".join(one.wrong), flush=True)
    print(f"play.py: {done} plays from seed {first} on in {time.monotonic() - begin:.0f} s, {late} of them late: "
          + (f"{failed} FAILED" if failed else "all right"))
    if not failed and not arguments.keep:
        shutil.rmtree(base)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
