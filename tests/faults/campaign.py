#!/usr/bin/env python3
"""Kills the program, makes its calls on files fail, and removes files and devices that it needs.

  campaign.py PROGRAM SHIM [--kills N] [--each-kill] [--errors NAME,...] [--share P] [--seed S]
              [--only PART,...] [--cases NAME,...]

For every verb that writes (see Cases), the campaign makes a folder with an earlier result. The fault
happens while the verb writes a new result. Afterwards:

  * the folder contains the complete earlier result or the complete new one, never files of both; an
    incomplete result is marked as incomplete (manifest.json, .trackbed.complete);
  * if a call failed, either the exit code is 2 with one line on stderr, besides those that the verb
    prints without a fault, or it is 0 and the new result is complete; no temporary files are left;
  * the same verb without a fault then succeeds, with the new result and nothing else.

Prints a table with the numbers of faults and of losses; ends with 1 if there was a loss.
"""
import argparse
import errno
import fcntl
import hashlib
import json
import os
import pty
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import termios
import time
import xml.etree.ElementTree as xml

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHORT = ["--set", "drive.time_limit=0.1", "expect={}"]
# Files whose bytes differ between repetitions: durations, and rows in the order in which they
# finished.
CHANGING = {"timing.json", "sweep.records"}
ADDITIONS = {"report.html", "video.mp4", "picture.png", "timing.json", "manifest.json"}


class Case:
    """A verb that writes to `out`, which contains the result of the verb `old`."""

    def __init__(self, name, args, out, old=None, before=(), check=None):
        self.name = name
        self.args = args
        self.out = out
        self.old = old  # args of the verb that left the earlier result; None: no earlier result
        self.before = list(before)  # verbs that make the inputs
        self.check = check or same_bytes
        self.codes = ()


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def contents(folder):
    """Paths, relative to the folder, and hashes of all files except CHANGING."""
    found = {}
    for at, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(at, name)
            if name not in CHANGING and not (name == "j.xml" and is_junit(path)):
                found[os.path.relpath(path, folder)] = digest(path)
            elif name == "j.xml":
                found[os.path.relpath(path, folder)] = "junit"  # its times differ
    return found


def is_junit(path):
    try:
        return xml.parse(path).getroot().tag == "testsuites"
    except xml.ParseError:
        return False


def is_temporary(name):
    return ".trackbed" in name


def visible(files):
    return {name: what for name, what in files.items() if not is_temporary(name)}


def same_bytes(folder, now, old, new):
    """Each file has the contents of the earlier or of the new result."""
    return [f"{name} is neither the earlier nor the new one" for name, what in visible(now).items()
            if what not in (old.get(name), new.get(name))]


def one_film(folder, now, old, new):
    """All frames belong to one film, and their numbers start at 0."""
    now = visible(now)
    if sorted(now) != [f"f_{i:05}.png" for i in range(len(now))]:
        return ["frames are missing"]
    if any(all(film.get(name) == what for name, what in now.items()) for film in (old, new)):
        return []
    return ["frames of two films"]


def one_result(folder, now, old, new):
    """The folder contains only files of the earlier state or only files of the new state."""
    wrong = same_bytes(folder, {k: v for k, v in now.items() if k != "manifest.json"}, old, new)
    if any(".trackbed.complete" in name for name in now):
        return wrong  # the folder itself says that it is between two results
    names = visible(now)
    if not names:
        return wrong
    if "manifest.json" not in names:
        return wrong + ["no manifest"] if set(names) - ADDITIONS else wrong
    if names["manifest.json"] not in (old.get("manifest.json"), new.get("manifest.json")):
        wrong.append("some results are earlier ones, some new, or missing")
    with open(os.path.join(folder, "manifest.json")) as file:
        results = json.load(file)["results"]
    listed = {}
    for files in results.values():
        for name, entry in files.items():
            listed[name] = entry["sha256"]
            if names.get(name) != entry["sha256"]:
                wrong.append(f"{name} is not what the manifest says")
    wrong += [f"{name} is in no result" for name in names if name not in listed | dict.fromkeys(ADDITIONS)]
    sides = [{name for name in listed if listed[name] != side.get(name)} for side in (old, new)]
    if all(sides):
        wrong.append(f"files of two results: {sorted(sides[0])} not of the earlier, "
                     f"{sorted(sides[1])} not of the new one")
    return wrong


def whole_or_refused(program):
    """The result is the earlier or the new one, or a mixture that `report` refuses."""
    def check(folder, now, old, new):
        now = {name: what for name, what in now.items() if not is_temporary(name)
               or ".trackbed.complete" in name}
        wrong = same_bytes(folder, {name: what for name, what in now.items()
                                    if os.path.basename(name) != "manifest.json"}, old, new)
        if now in (visible(old), visible(new)):
            return wrong
        with tempfile.TemporaryDirectory() as elsewhere:
            code = subprocess.run([program, "report", "-q", folder, "-o", f"{elsewhere}/page.html"],
                                  capture_output=True, env=dict(os.environ, TRACKBED_DATA=SOURCE)
                                  ).returncode
        return wrong + (["report takes files of two results"] if code != 2 else [])
    return check


def one_study(folder, now, old, new):
    """Checks the table like one_result; each row's run is complete, or its manifest lists the missing files."""
    top = {name: what for name, what in now.items() if not name.startswith("rows/")}
    wrong = one_result(folder, top, old, new)
    rows = {name: what for name, what in now.items() if name.startswith("rows/")}
    if not any(".trackbed.complete" in name for name in rows):
        wrong += same_bytes(folder, rows, old, new)
    return wrong


def cases(program):
    film = ["--size", "128x72", "-q"]
    make_run = ["run", "-q", "-o", "r", "a.yaml", *SHORT]
    small_car = f"{SOURCE}/tests/data/models/small_car.xml"
    one_shard = ["sweep", "-q", "-o", "shards", "study.yaml", "--shard"]
    check_path = ["check-path", "-q", "path.csv", *SHORT, "drive.plants=[kinematic]", "--speed"]
    has_video = b"video off" not in subprocess.run([program, "--version"], capture_output=True).stdout
    all_cases = [
        Case("run", ["run", "-q", "-o", "r", "a.yaml", *SHORT], "r",
             ["run", "-q", "--mcap", "--report", "-o", "r", "b.yaml", *SHORT], check=one_result),
        Case("run into nothing", ["run", "-q", "-o", "r", "a.yaml", *SHORT], "r", check=one_result),
        Case("run --mcap --report", ["run", "-q", "--mcap", "--report", "-o", "r", "b.yaml", *SHORT],
             "r", ["run", "-q", "--report", "-o", "r", "a.yaml", *SHORT], check=one_result),
        Case("plan", ["plan", "-q", "-o", "p", "b.yaml"], "p", ["plan", "-q", "-o", "p", "a.yaml"],
             check=one_result),
        Case("sweep", ["sweep", "-q", "--restart", "-j", "2", "-o", "s", "study.yaml"], "s",
             ["sweep", "-q", "-o", "s", "study.yaml", "--set", "drive.time_limit=0.05"],
             check=one_result),
        Case("sweep with kept rows", ["sweep", "-q", "--restart", "-o", "s", "kept.yaml"], "s",
             ["sweep", "-q", "-o", "s", "kept.yaml", "--set", "drive.time_limit=0.05"],
             check=one_study),
        Case("sweep merge", ["sweep", "merge", "shards", "-o", "s"], "s", check=one_result,
             before=[[*one_shard, "1/2"], [*one_shard, "2/2"]]),
        Case("sweep submit", ["sweep", "submit", "study.yaml", "--tasks", "3", "-o", "s"], "s",
             ["sweep", "submit", "study.yaml", "--tasks", "2", "-o", "s"], check=one_result),
        Case("falsify", ["falsify", "-q", "--restart", "-o", "s", "search.yaml"], "s",
             ["falsify", "-q", "-o", "s", "search.yaml", "--set", "drive.time_limit=0.05"],
             check=whole_or_refused(program)),
        Case("verify", ["verify", "-q", "--restart", "-o", "s", "sample.yaml"], "s",
             ["verify", "-q", "-o", "s", "sample.yaml", "--set", "drive.time_limit=0.05"],
             check=one_result),
        Case("identify", ["identify", "-q", "-o", "i", "fit.yaml"], "i",
             ["identify", "-q", "-o", "i", "other_fit.yaml"], check=whole_or_refused(program),
             before=[["import", "-q", f"{SOURCE}/tests/data/recordings/autoware.csv", "--map",
                      f"{SOURCE}/scenarios/real/maps/autoware.yaml", "--vehicle",
                      f"{SOURCE}/tests/data/models/small_car.xml", "-o", "record"]]),
        Case("compare (scenario)", ["compare", "-q", "-o", "c", "b.yaml", *SHORT], "c",
             ["compare", "-q", "-o", "c", "a.yaml", *SHORT], check=one_result),
        Case("compare (runs)", ["compare", "-q", "-o", "c", "r", "r2"], "c",
             ["compare", "-q", "-o", "c", "r2", "r"], check=one_result,
             before=[make_run, ["run", "-q", "-o", "r2", "b.yaml", *SHORT]]),
        Case("import", ["import", "-q", f"{SOURCE}/tests/data/recordings/autoware.csv", "--map",
                        f"{SOURCE}/scenarios/real/maps/autoware.yaml", "--vehicle", small_car, "-o",
                        "r"], "r", ["run", "-q", "-o", "r", "a.yaml", *SHORT], check=one_result),
        Case("check-path --drive", [*check_path, "3", "--drive", "-o", "r"], "r",
             [*check_path, "2", "--drive", "-o", "r"], check=one_result),
        Case("check-path --report", [*check_path, "3", "--report", "h/p.html"], "h",
             [*check_path, "2", "--report", "h/p.html"]),
        Case("report", ["report", "-q", "r"], "r", ["report", "-q", "r2", "-o", "r/report.html"],
             check=one_result, before=[make_run, ["run", "-q", "-o", "r2", "b.yaml", *SHORT]]),
        Case("render --at", ["render", "r", "--at", "0.1", *film], "r",
             ["render", "r", "--at", "0", *film], check=one_result, before=[make_run]),
        Case("render frames", ["render", "r", "--fps", "40", "-o", "f/f.png", *film], "f",
             ["render", "r", "--fps", "50", "--camera", "top", "-o", "f/f.png", *film],
             check=one_film, before=[make_run]),
        Case("test --junit", ["test", "-q", "--junit", "t/j.xml", "a.yaml", *SHORT], "t",
             ["test", "-q", "--junit", "t/j.xml", "b.yaml", *SHORT]),
        Case("model --save", ["model", "bmw320i", "--save", "m/car.xml"], "m",
             ["model", "prius", "--save", "m/car.xml"], before=[["plan", "-q", "-o", "m", "a.yaml"]]),
        Case("model --adapt", ["model", small_car, "--adapt", "-o", "m/car.xml"], "m",
             ["model", "dart", "--adapt", "-o", "m/car.xml"]),
        Case("model --ggv", ["model", small_car, "--ggv", "-o", "m/ggv.csv"], "m",
             ["model", "dart", "--ggv", "-o", "m/ggv.csv"]),
        Case("fmu", ["fmu", "-q", "a.yaml", "--plant", "kinematic", "-o", "u/car.fmu"], "u",
             ["fmu", "-q", "b.yaml", "--plant", "kinematic", "-o", "u/car.fmu"]),
        Case("experiment", ["experiment", "optimal_steering", "-q", "--evaluations", "20", "--speeds",
                            "2", "--searches", "crs2", "-o", "e/e.csv"], "e",
             ["experiment", "optimal_steering", "-q", "--evaluations", "20", "--speeds", "1",
              "--searches", "crs2", "-o", "e/e.csv"]),
        Case("docs", ["docs", "d/cli.md"], "d"),
    ]
    if has_video:
        at = [case.name for case in all_cases].index("render frames")
        all_cases.insert(at, Case("render film", ["render", "r", "--fps", "100", *film], "r",
                                 ["render", "r", "--fps", "50", *film], check=one_result,
                                 before=[make_run]))
    return all_cases


class Campaign:
    def __init__(self, options):
        self.options = options
        self.random = random.Random(options.seed)
        self.rows = []
        self.losses = []
        self.root = tempfile.mkdtemp(prefix="trackbed_faults_")
        # Takes the place of Slurm's command.
        self.commands = os.path.join(self.root, "commands")
        os.mkdir(self.commands)
        with open(f"{self.commands}/sbatch", "w") as file:
            file.write("#!/bin/sh\necho 1\n")
        os.chmod(f"{self.commands}/sbatch", 0o755)

    # Running the program.

    def environment(self):
        return dict(os.environ, TRACKBED_DATA=SOURCE,
                    PATH=f"{self.commands}:{os.environ['PATH']}")

    def new_lines(self, error):
        """The lines on stderr that the verb does not print without a fault."""
        return [line for line in error.splitlines() if line not in self.said]

    def start(self, args, env=None, **keys):
        environment = self.environment()
        environment.update(env or {})
        environment = {key: value for key, value in environment.items() if value is not None}
        keys.setdefault("stdout", subprocess.DEVNULL)
        keys.setdefault("stderr", subprocess.PIPE)
        return subprocess.Popen([self.options.program, *args], cwd=self.work, env=environment, **keys)

    def run(self, args, env=None, **keys):
        process = self.start(args, env, **keys)
        error = process.communicate(timeout=120)[1] or b""
        return process.returncode, error.decode(errors="replace")

    def fresh(self, name):
        self.work = os.path.join(self.root, name)
        shutil.rmtree(self.work, ignore_errors=True)
        os.mkdir(self.work)
        with open(f"{SOURCE}/scenarios/winding.yaml") as file:
            text = file.read()
        for scenario, speed in (("a", "3"), ("b", "4")):
            with open(f"{self.work}/{scenario}.yaml", "w") as file:
                file.write(re.sub(r"speed: [0-9.]+", f"speed: {speed}", text, count=1))
        with open(f"{self.work}/path.csv", "w") as file:
            file.write("x_m,y_m\n0,0\n10,0\n20,1\n30,3\n")
        with open(f"{self.work}/study.yaml", "w") as file:
            file.write("schema: 1\nname: study\nscenario: a.yaml\n"
                       "set: {drive.time_limit: 0.1, drive.plants: [kinematic], expect: {}}\n"
                       "vary: {mission.speed: [1, 2, 3]}\noutputs: [metrics.kinematic.distance]\n")
        study = ("schema: 1\nname: study\nscenario: a.yaml\n"
                 "set: {drive.time_limit: 0.1, drive.plants: [kinematic],"
                 " expect: {metrics: [{metric: status, equals: goal_reached}]}}\n")
        random_speed = "vary: {mission.speed: {distribution: uniform, from: 1, to: 4}}\n"
        fit = ("schema: 1\nname: fit\nfit: [record/scenario.resolved.yaml]\nstarts: 1\n"
               "evaluations: 1\n")
        for name, text in (
                ("kept", study + "vary: {mission.speed: [1, 2]}\nkeep: all\n"),
                ("search", study + random_speed + "search: {runs: 2, shrink_runs: 0}\n"),
                ("sample", study + random_speed + "sample: {count: 3, method: random}\n"),
                ("fit", fit + "parameters: [{name: yaw_inertia, from: 0.02, to: 0.2}]\n"),
                ("other_fit", fit + "parameters: [{name: mass, from: 2, to: 5}]\n")):
            with open(f"{self.work}/{name}.yaml", "w") as file:
                file.write(text)

    def prepare(self, case):
        """Makes the state before the verb runs and the state after it, once for each case."""
        self.fresh("work")
        os.makedirs(f"{self.work}/{case.out}")
        if case.name == "docs":
            with open(f"{SOURCE}/docs/cli.md") as page:
                text = page.read()
            with open(f"{self.work}/d/cli.md", "w") as page:
                page.write(text.replace("| `--report` |", "| old |"))
        for args in case.before + ([case.old] if case.old else []):
            code, error = self.run(args)
            assert code in (0, 3), (args, code, error)
        self.before = os.path.join(self.root, "before")
        shutil.rmtree(self.before, ignore_errors=True)
        shutil.copytree(self.work, self.before)
        self.old = contents(f"{self.work}/{case.out}")
        log = os.path.join(self.root, "calls")
        if os.path.exists(log):
            os.remove(log)
        code, error = self.run(case.args, self.shim(case, 0, 0, log))
        assert code in (0, 3), (case.args, code, error)
        case.codes = (code,)  # 3: the car does not arrive within the time limit
        self.restore(case)
        begin = time.monotonic()
        code, error = self.run(case.args)
        self.said = error.splitlines()
        self.duration = time.monotonic() - begin
        self.new = contents(f"{self.work}/{case.out}")
        assert self.old != self.new or case.name == "test --junit", case.name
        with open(log) as file:
            self.calls = [line.split(" ", 2)[1:] for line in file.read().splitlines()]

    def restore(self, case):
        shutil.rmtree(self.work, ignore_errors=True)
        shutil.copytree(self.before, self.work)

    def shim(self, case, at, error, log=""):
        return {"LD_PRELOAD": self.options.shim, "FAULT_FOLDER": f"{self.work}/{case.out}",
                "FAULT_AT": str(at), "FAULT_ERRNO": str(error), "FAULT_LOG": log,
                "FAULT_HALF": "1" if at % 2 and error >= 0 else ""}

    # Conditions on the files.

    def lose(self, case, what, wrong):
        self.losses.append(f"{case.name}: {what}: {wrong}")
        print("LOSS " + self.losses[-1], flush=True)

    def check_state(self, case, what, temporaries):
        folder = f"{self.work}/{case.out}"
        now = contents(folder)
        wrong = case.check(folder, now, self.old, self.new)
        if not temporaries and not any(".trackbed.complete" in name for name in now):
            wrong += [f"{name} was left" for name in now if is_temporary(name)]
        return now, wrong

    def check_next(self, case):
        """The next start succeeds, and the folder then contains nothing but the new result."""
        code, error = self.run(case.args)
        now = contents(f"{self.work}/{case.out}")
        wrong = [] if code in case.codes else [f"the next start ends with {code}: {error.strip()}"]
        if now != self.new:
            wrong.append("the next start leaves other files: "
                         f"{sorted(set(now.items()) ^ set(self.new.items()))}")
        return wrong

    def judge(self, case, what, wrong):
        if wrong:
            self.lose(case, what, "; ".join(wrong))
        return bool(wrong)

    # Faults.

    def killed_at_random(self, case, count):
        lost = 0
        for _ in range(count):
            self.restore(case)
            process = self.start(case.args, stderr=subprocess.DEVNULL)
            moment = self.random.uniform(0, 1.1 * self.duration)
            time.sleep(moment)
            process.kill()
            process.wait()
            wrong = self.check_state(case, "", True)[1] + self.check_next(case)
            lost += self.judge(case, f"killed after {moment:.4f} s", wrong)
        self.count("kill at a random moment", count, lost)

    def killed_at_calls(self, case):
        lost = 0
        chosen = self.chosen(range(1, len(self.calls) + 1))
        for at in chosen:
            self.restore(case)
            self.run(case.args, self.shim(case, at, 0))
            wrong = self.check_state(case, "", True)[1] + self.check_next(case)
            lost += self.judge(case, f"killed at call {at}, {' '.join(self.calls[at - 1])}", wrong)
        self.count("kill at each call on a file", len(chosen), lost)

    def failing_calls(self, case, name):
        lost = 0
        chosen = self.chosen(range(1, len(self.calls) + 1))
        for at in chosen:
            self.restore(case)
            code, error = self.run(case.args, self.shim(case, at, getattr(errno, name)))
            now, wrong = self.check_state(case, "", self.calls[at - 1][0] in ("unlink", "rmdir"))
            if code in case.codes:
                if {k: v for k, v in now.items() if not is_temporary(k)} != self.new:
                    wrong.append(f"ends with {code}, but has not the new result")
            elif code != 2 or len(self.new_lines(error)) != 1:
                wrong.append(f"ends with {code}: {error.strip()!r}")
            wrong += self.check_next(case)
            lost += self.judge(case, f"{name} from call {at}, {' '.join(self.calls[at - 1])}", wrong)
        self.count(f"each call on a file fails once: {name}", len(chosen), lost)

    def signals(self, case, count):
        lost = 0
        for number in range(count):
            for name in ("SIGINT", "SIGTERM", "SIGHUP"):
                self.restore(case)
                process = self.start(case.args)
                moment = self.random.uniform(0, self.duration)
                time.sleep(moment)
                process.send_signal(getattr(signal, name))
                error = process.communicate(timeout=120)[1].decode()
                code = process.returncode
                now, wrong = self.check_signaled(case, code, -getattr(signal, name), error)
                lost += self.judge(case, f"{name} after {moment:.4f} s", wrong)
        self.count("SIGINT, SIGTERM, SIGHUP", 3 * count, lost)

    def check_signaled(self, case, code, killed, error):
        folder = f"{self.work}/{case.out}"
        now = contents(folder)
        wrong = []
        if code == killed:  # before the program had begun
            wrong = [] if now == self.old else ["changed files"]
        elif code in case.codes:
            wrong = [] if now == self.new else ["ends well, but has not the new result"]
        elif code == 130:
            # The log of the run so far is kept. All other files are those of the earlier or of the
            # new result.
            if case.check not in (same_bytes, one_film):
                new = dict(now)
                wrong = case.check(folder, now, self.old, new)
            else:
                wrong = case.check(folder, now, self.old, self.new)
            wrong += [f"{name} was left" for name in now if is_temporary(name)]
        else:
            wrong = [f"ends with {code}: {error.strip()!r}"]
        if len(error.splitlines()) > 2:
            wrong.append(f"says {error!r}")
        return now, wrong

    # Faults in the surroundings of the program.

    def in_other_surroundings(self, case):
        def same(what, **env):
            self.restore(case)
            code, error = self.run(case.args, env)
            now = contents(f"{self.work}/{case.out}")
            wrong = [] if code in case.codes else [f"ends with {code}: {error.strip()!r}"]
            wrong += [] if now == self.new else [
                f"other files: {sorted(set(now) ^ set(self.new)) or 'of other content'}"]
            self.count(what, 1, self.judge(case, what, wrong))

        same("HOME unset", HOME=None)
        same("no fonts", FONTCONFIG_FILE="/nonexistent", FONTCONFIG_PATH="/nonexistent",
             XDG_DATA_HOME="/nonexistent", XDG_DATA_DIRS="/nonexistent")
        if self.locale:
            same("decimal comma (LC_ALL=de_DE.UTF-8)", LOCPATH=self.locale, LC_ALL="de_DE.UTF-8",
                 LANG="de_DE.UTF-8")
        # Standard streams may be closed. The next opened file must not take their place.
        for closed in ((0,), (1,), (2,), (0, 1, 2)):
            loud = [arg for arg in case.args if arg != "-q"]
            self.restore(case)
            process = self.start(loud, stdout=subprocess.PIPE,
                                 preexec_fn=lambda closed=closed: [os.close(one) for one in closed])
            error = process.communicate(timeout=120)[1].decode(errors="replace")
            now = contents(f"{self.work}/{case.out}")
            code = process.returncode
            allowed = set(case.codes) | ({2} if 1 in closed else set())
            wrong = [] if code in allowed else [f"ends with {code}: {error!r}"]
            wrong += [] if now == self.new else ["other files: " + str(
                sorted(set(now) ^ set(self.new)) or "of other content")]
            what = {(0,): "closed stdin", (1,): "closed stdout", (2,): "closed stderr"}.get(
                closed, "all three closed")
            self.count("closed stdin, stdout, stderr, all three", 1, self.judge(case, what, wrong))

    def closed_terminal(self, case, count):
        """The terminal closes while the program runs: the program gets SIGHUP and can no longer print."""
        lost = 0
        loud = [arg for arg in case.args if arg != "-q"]
        for _ in range(count):
            self.restore(case)
            terminal, its_end = pty.openpty()
            process = self.start(loud, stdin=its_end, stdout=its_end, stderr=its_end,
                                 preexec_fn=lambda: (os.setsid(),
                                                     fcntl.ioctl(0, termios.TIOCSCTTY, 0)))
            os.close(its_end)
            time.sleep(self.random.uniform(0, self.duration))
            os.close(terminal)
            code = process.wait(timeout=120)
            if code == 2:  # it could not print
                code = 130
            wrong = self.check_signaled(case, code, -signal.SIGHUP, "")[1]
            lost += self.judge(case, "closed terminal", wrong)
        self.count("closed terminal", count, lost)

    def two_processes(self, case):
        """While one process is stopped in the middle of its work, a second one is refused or does no harm."""
        self.restore(case)
        folder = f"{self.work}/{case.out}"
        middle = len(self.calls) // 2 + 1
        # The first process stops itself, because the shim sends SIGSTOP instead of causing a
        # failure.
        env = self.shim(case, middle, -1)
        first = self.start(case.args, env)
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and not self.is_stopped(first.pid):
            if first.poll() is not None:
                break
            time.sleep(0.002)
        code, error = self.run(case.args)
        wrong = []
        refused = code == 2 and re.search(r"is being written by another trackbed \(process \d+\)\n$",
                                          error)
        if refused:
            if f"(process {first.pid})" not in error:
                wrong.append(f"names another process: {error.strip()}")
        elif code not in case.codes:
            wrong.append(f"the second ends with {code}: {error.strip()!r}")
        elif case.check is one_result and case.name not in ADDERS:
            wrong.append("the second was not refused")
        first.send_signal(signal.SIGCONT)
        error = first.communicate(timeout=120)[1].decode()
        if first.returncode not in case.codes:
            wrong.append(f"the first ends with {first.returncode}: {error.strip()!r}")
        if contents(folder) != self.new:
            wrong.append("other files than the new ones: " +
                         str(sorted(set(contents(folder).items()) ^ set(self.new.items()))))
        self.count("two processes in one folder", 1, self.judge(case, "two processes", wrong))

    @staticmethod
    def is_stopped(pid):
        try:
            with open(f"/proc/{pid}/stat") as file:
                return file.read().rsplit(")", 1)[1].split()[0] == "T"
        except OSError:
            return True

    def vanished_folder(self, case):
        """The output folder is removed while the program runs: the result is written nevertheless, or
        one line says that it is not."""
        lost = 0
        moments = self.chosen(range(1, len(self.calls) + 1))[:12]
        for at in moments:
            self.restore(case)
            process = self.start(case.args, self.shim(case, at, -1))
            while not self.is_stopped(process.pid) and process.poll() is None:
                time.sleep(0.002)
            shutil.rmtree(f"{self.work}/{case.out}", ignore_errors=True)
            process.send_signal(signal.SIGCONT)
            error = process.communicate(timeout=120)[1].decode()
            code = process.returncode
            wrong = []
            if code not in (*case.codes, 2) or (code == 2 and len(self.new_lines(error)) != 1):
                wrong.append(f"ends with {code}: {error!r}")
            if os.path.exists(f"{self.work}/{case.out}"):
                wrong += case.check(f"{self.work}/{case.out}", contents(f"{self.work}/{case.out}"),
                                    self.old, self.new)
            lost += self.judge(case, f"vanished at call {at}, {' '.join(self.calls[at - 1])}", wrong)
        self.count("output folder vanishes", len(moments), lost)

    def read_only(self, case):
        """A read-only file system, in a private namespace. It prevents even root from writing."""
        self.restore(case)
        out = f"{self.work}/{case.out}"
        script = f"mount --bind '{out}' '{out}' && mount -o remount,bind,ro '{out}' || exit 99; exec \"$@\""
        process = subprocess.run(["unshare", "-Urm", "sh", "-c", script, "sh", self.options.program,
                                  *case.args], cwd=self.work, capture_output=True,
                                 env=self.environment())
        if process.returncode == 99 or b"unshare" in process.stderr:
            self.skipped.add("read-only folder: no namespace here that may mount")
            return
        error = process.stderr.decode()
        wrong = []
        if process.returncode != 2 or len(self.new_lines(error)) != 1 or "Read-only" not in error:
            wrong.append(f"ends with {process.returncode}: {error!r}")
        if contents(out) != self.old:
            wrong.append("changed files")
        self.count("read-only folder", 1, self.judge(case, "read-only folder", wrong))

    def full_disk(self, case):
        """A tmpfs of growing size in pages, up to the first size that suffices: every size up to 64
        pages, then steps of a 32nd, because an FMU has thousands of pages."""
        lost = 0
        sizes = 0
        code = 2
        pages = 1
        step = self.options.disk_step
        while code == 2 and pages < 1 << 18:  # 1 GB
            self.restore(case)
            out = f"{self.work}/{case.out}"
            keep = f"{self.root}/keep"
            shutil.rmtree(keep, ignore_errors=True)
            need = sum(-(-os.path.getsize(os.path.join(at, name)) // 4096)
                       for at, _, names in os.walk(out) for name in names)
            script = (f"cp -a '{out}' '{keep}'; mount -t tmpfs -o size={4 * (need + pages)}k none '{out}'"
                      f" || exit 99; cp -a '{keep}/.' '{out}/'; \"$@\"; code=$?; rm -rf '{keep}'; "
                      f"cp -a '{out}' '{keep}'; exit $code")
            process = subprocess.run(["unshare", "-Urm", "sh", "-c", script, "sh",
                                      self.options.program, *case.args], cwd=self.work,
                                     capture_output=True, env=self.environment())
            code = process.returncode
            if code == 99 or b"unshare" in process.stderr:
                self.skipped.add("tmpfs of growing size: no namespace here that may mount")
                return
            error = process.stderr.decode()
            now = contents(keep)
            wrong = case.check(keep, now, self.old, self.new)
            wrong += [f"{name} was left" for name in now if is_temporary(name)]
            if code in case.codes:
                wrong += [] if now == self.new else ["has not the new result"]
            elif code != 2 or len(self.new_lines(error)) != 1 or "No space left" not in error:
                wrong.append(f"ends with {code}: {error!r}")
            lost += self.judge(case, f"{pages} pages left", wrong)
            sizes += 1
            pages += max(step, pages // 32)
        self.count("tmpfs of growing size up to enough", sizes, lost)

    # The campaign.

    def chosen(self, numbers):
        numbers = list(numbers)
        share = self.options.share
        return [number for number in numbers if share >= 1 or self.random.random() < share]

    def count(self, fault, injected, lost):
        for row in self.rows:
            if row[0] == fault:
                row[1] += injected
                row[2] += lost
                return
        self.rows.append([fault, injected, int(lost)])

    def make_locale(self):
        """Returns the locale de_DE.UTF-8, which writes 0,5, or None if this machine cannot make it."""
        folder = os.path.join(self.root, "locale")
        os.mkdir(folder)
        made = shutil.which("localedef") and subprocess.run(
            ["localedef", "-i", "de_DE", "-f", "UTF-8", f"{folder}/de_DE.UTF-8"],
            capture_output=True).returncode == 0
        if not made:
            self.skipped.add("decimal comma: localedef cannot make de_DE.UTF-8 here")
        return folder if made else None

    def go(self):
        options = self.options
        self.skipped = set()
        self.locale = self.make_locale()
        all_cases = cases(options.program)
        if options.cases:
            all_cases = [case for case in all_cases if case.name in options.cases.split(",")]
        parts = options.only.split(",")
        part, of = (int(number) for number in options.part.split("/"))
        for number, case in enumerate(all_cases):
            if number % of != part - 1:
                continue
            # A case gets the same faults whether it runs in one part or in another.
            self.random.seed(f"{options.seed} {case.name}")
            self.prepare(case)
            begin = time.monotonic()
            if "kill" in parts:
                share = options.kills // len(all_cases) + (number < options.kills % len(all_cases))
                self.killed_at_random(case, share)
                self.killed_at_calls(case)
            if "error" in parts:
                for name in options.errors.split(","):
                    self.failing_calls(case, name)
            if "disk" in parts:
                self.full_disk(case)
            if "around" in parts:
                self.signals(case, options.signals)
                self.closed_terminal(case, options.signals)
                self.in_other_surroundings(case)
                self.two_processes(case)
                self.vanished_folder(case)
                self.read_only(case)
            print(f"{case.name}: {len(self.calls)} calls on files, {self.duration:.2f} s; "
                  f"{time.monotonic() - begin:.0f} s of faults", flush=True)
        print("\n| fault | injected | losses |\n|---|---|---|")
        for fault, injected, lost in self.rows:
            print(f"| {fault} | {injected} | {lost} |")
        for line in sorted(self.skipped):
            print("skipped: " + line)
        shutil.rmtree(self.root, ignore_errors=True)
        return 1 if self.losses else 0


# Several of these verbs may write to the same folder at the same time.
ADDERS = {"report", "render --at", "render film", "render frames"}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("shim", type=os.path.abspath)
    parser.add_argument("--kills", type=int, default=1000)
    parser.add_argument("--errors", default="ENOSPC,EIO,EACCES")
    parser.add_argument("--share", type=float, default=1.0, help="of the calls, at random")
    parser.add_argument("--signals", type=int, default=8, help="of each kind, per verb")
    parser.add_argument("--disk-step", type=int, default=1, help="pages")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="kill,error,disk,around")
    parser.add_argument("--cases", default="")
    parser.add_argument("--part", default="1/1", help="I/N: every Nth of the cases, from the Ith on")
    sys.exit(Campaign(parser.parse_args()).go())


if __name__ == "__main__":
    main()
