#!/usr/bin/env python3
"""Interrupts one study repeatedly and resumes it each time.

  resume.py PROGRAM [--rows N] [--faults N] [--seed S]

The faults are SIGKILL and SIGTERM at random times and a disk that is full after some rows. After
each fault the finished rows must still exist. In the end sweep.csv, sweep.json and manifest.json must
have the same bytes as those of an undisturbed study. Prints the number of faults by kind and the
number of losses; ends with 1 if there was a loss.
"""
import argparse
import collections
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zlib

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
RESULT = ("sweep.csv", "sweep.json", "manifest.json")


def rows_in(folder):
    """The numbers of the complete rows in the records, read without the program."""
    try:
        with open(os.path.join(folder, "sweep.records"), "rb") as file:
            lines = file.read().split(b"\n")
    except FileNotFoundError:
        return set()
    rows = set()
    for number, line in enumerate(lines[:-1]):
        checksum, _, json = line.partition(b" ")
        if int(checksum, 16) != zlib.crc32(json):
            break
        if number > 0:
            rows.add(int(json[len(b'{"row":'):].split(b",")[0]))
    return rows


class Study:
    def __init__(self, options):
        self.program = options.program
        self.random = random.Random(options.seed)
        self.root = tempfile.mkdtemp(prefix="trackbed_resume_")
        shutil.copy(f"{SOURCE}/scenarios/winding.yaml", f"{self.root}/winding.yaml")
        with open(f"{self.root}/study.yaml", "w") as file:
            file.write("schema: 1\nname: study\nscenario: winding.yaml\n"
                       "set: {drive.time_limit: 0.1, drive.plants: [kinematic], expect: {}}\n"
                       f"sample: {{count: {options.rows}, method: random}}\n"
                       "vary: {mission.speed: {distribution: uniform, from: 1, to: 5}}\n"
                       "outputs: [metrics.kinematic.distance]\n")
        self.environment = dict(os.environ, TRACKBED_DATA=SOURCE)

    def command(self, out):
        return [self.program, "sweep", "-q", "-j", "2", "-o", out, "study.yaml"]

    def run(self, out):
        return subprocess.run(self.command(out), cwd=self.root, env=self.environment,
                              capture_output=True, text=True, check=False, timeout=600)

    def signaled(self, out, name, longest):
        process = subprocess.Popen(self.command(out), cwd=self.root, env=self.environment,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(self.random.uniform(0.0, longest))
        process.send_signal(getattr(signal, name))
        return process.wait(timeout=120)

    def full_disk(self, out):
        """Runs on a tmpfs with room for the existing files and some rows. None: not possible here."""
        folder = f"{self.root}/{out}"
        os.makedirs(folder, exist_ok=True)
        keep = f"{self.root}/keep"
        shutil.rmtree(keep, ignore_errors=True)
        shutil.copytree(folder, keep)
        pages = sum(-(-os.path.getsize(entry) // 4096) for entry in os.scandir(keep))
        size = 4 * (pages + self.random.randint(1, 8))
        script = (f"mount -t tmpfs -o size={size}k none '{folder}' || exit 99; "
                  f"cp -a '{keep}/.' '{folder}/'; \"$@\"; code=$?; rm -rf '{keep}'; "
                  f"cp -a '{folder}' '{keep}'; exit $code")
        process = subprocess.run(["unshare", "-Urm", "sh", "-c", script, "sh", *self.command(out)],
                                 cwd=self.root, env=self.environment, capture_output=True,
                                 check=False)
        if process.returncode == 99 or b"unshare" in process.stderr:
            return None
        shutil.rmtree(folder)
        shutil.move(keep, folder)
        return process.returncode

    def same(self, first, second):
        wrong = []
        for name in RESULT:
            with open(f"{self.root}/{first}/{name}", "rb") as a, \
                    open(f"{self.root}/{second}/{name}", "rb") as b:
                if a.read() != b.read():
                    wrong.append(name)
        return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("--rows", type=int, default=2000)
    parser.add_argument("--faults", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    study = Study(options)
    begin = time.monotonic()
    whole = study.run("whole")
    duration = time.monotonic() - begin
    assert whole.returncode == 0, whole.stderr
    faults = collections.Counter()
    losses = []
    out = "disturbed_0"
    kinds = ["SIGKILL", "SIGTERM", "full disk"]
    while sum(faults.values()) < options.faults:
        before = rows_in(f"{study.root}/{out}")
        kind = study.random.choice(kinds)
        if kind == "full disk":
            code = study.full_disk(out)
            if code is None:
                print("skipped: full disks, for which no namespace is to be had here")
                kinds.remove(kind)
                continue
        else:
            # The time is chosen so that all faults together take about as long as the study.
            code = study.signaled(out, kind, 20.0 * duration / options.faults + 0.1)
        faults[kind] += 1
        after = rows_in(f"{study.root}/{out}")
        if not before <= after:
            losses.append(f"{kind}: rows {sorted(before - after)[:5]} are lost")
        if code == 0 or len(after) == options.rows:
            final = study.run(out)
            wrong = study.same("whole", out)
            if final.returncode != 0 or wrong:
                losses.append(f"{out}: {wrong} differ, exit code {final.returncode}, {final.stderr}")
            shutil.rmtree(f"{study.root}/{out}")
            out = f"disturbed_{sum(faults.values())}"
    final = study.run(out)
    wrong = study.same("whole", out)
    if final.returncode != 0 or wrong:
        losses.append(f"{out}: {wrong} differ, exit code {final.returncode}, {final.stderr}")
    for loss in losses:
        print("LOSS " + loss)
    print(f"| a study of {options.rows} rows, interrupted and resumed: "
          f"{', '.join(f'{count} {kind}' for kind, count in sorted(faults.items()))} | "
          f"{sum(faults.values())} | {len(losses)} |")
    shutil.rmtree(study.root, ignore_errors=True)
    sys.exit(1 if losses else 0)


if __name__ == "__main__":
    main()
