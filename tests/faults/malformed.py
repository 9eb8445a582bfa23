#!/usr/bin/env python3
"""Changes the files of results, one value at a time, and lets every verb read them.

  malformed.py PROGRAM [--seed S] [--share P] [--only FILE,...] [--part I/N]

Every verb makes a small result. In each JSON file of the results, each key is removed, or its value
is replaced by a value of another type or far out of range; the whole file is replaced in the same
way. CSV and YAML files lose columns, lines or their end, and get other numbers, line ends, marks,
quotes and bytes that are not UTF-8. Then all verbs that read the file run on it. Each must succeed,
or explain the problem and end with the exit code 2 or 3. A message about a CSV or YAML file must name
it. No verb may end with 1, "internal error", a message of a library or a signal, nor take more than
20 s.

--share: the share of the changes that are tried, chosen at random. Prints a table with the numbers of
changes and faults of each file; ends with 1 if there was a fault.
"""
import argparse
import collections
import copy
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import zlib

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
QUICK = ["--plant", "kinematic", "--set", "drive.time_limit=0.3"]
REMOVED = object()
HUGE = "\0huge"  # becomes 1e999, which is valid JSON but too large for a double
NAN = "\0nan"  # becomes NaN, which is not valid JSON
VALUES = [REMOVED, None, True, False, 0, -1, 1, 7.5, -1e300, 1e300, 18446744073709551615, HUGE, NAN,
          "", "text", "NaN", "1e999", "../../x", "a/b", "\x1b[31m", [], [1], ["a"], [[]], {}, {"a": 1}]
WHOLE = ["", "{", "[]", "{}", "null", "1", "\"x\"", "[" * 100000, "{\"a\":" * 1000, "\xff\xfe", "\0"]
MALFORMED_WORDS = ("internal error", "json.exception", "terminate called", "basic_string", "vector::",
                   "bad_alloc", "out_of_range", "Assertion")


def text_of(value):
    text = json.dumps(value)
    return text.replace(json.dumps(HUGE), "1e999").replace(json.dumps(NAN), "NaN")


def places(value, path=()):
    """The paths of all values, but of long lists only of the first and the last element."""
    found = [path]
    if isinstance(value, dict):
        for key, inner in value.items():
            found += places(inner, path + (key,))
    elif isinstance(value, list):
        for i in sorted({0, len(value) - 1} if value else ()):
            found += places(value[i], path + (i,))
    return found


def changed(root, path, value):
    root = copy.deepcopy(root)
    at = root
    for step in path[:-1]:
        at = at[step]
    if value is REMOVED:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return root


class Results:
    """The results that are changed, in subfolders of a temporary folder."""

    def __init__(self, program):
        self.program = program
        self.root = tempfile.mkdtemp(prefix="trackbed_malformed_")
        self.environment = dict(os.environ, TRACKBED_DATA=SOURCE)

    def run(self, *args, cwd=".", timeout=20):
        return subprocess.run([self.program, *args], cwd=os.path.join(self.root, cwd), timeout=timeout,
                              env=self.environment, capture_output=True, check=False)

    def make(self, *args):
        done = self.run(*args, timeout=300)  # the bound is for changed files
        assert done.returncode in (0, 3), f"{args}: {done.stderr.decode(errors='replace')}"

    def write(self, name, text):
        with open(os.path.join(self.root, name), "w") as file:
            file.write(text)

    def make_all(self):
        self.make("run", "-q", "three_turns", "--plant", "kinematic", "single_track", "-o", "run",
                  "--set", "drive.time_limit=0.3")
        self.make("run", "-q", "winding", *QUICK, "-o", "other")
        self.make("run", "-q", "iso_3888_1_lane_change", *QUICK, "-o", "gates")
        self.make("compare", "-q", "run", "other", "--tolerance", "position=1", "-o", "pair")
        self.make("compare", "-q", "run", "-o", "run")
        shutil.copy(f"{SOURCE}/scenarios/winding.yaml", f"{self.root}/winding.yaml")
        base = "schema: 1\nname: study\nscenario: winding.yaml\n" \
               "set: {drive.plants: [kinematic], drive.time_limit: 0.2, expect: {}}\n"
        self.write("study.yaml", base + "vary: {mission.speed: [1, 2, 3]}\n"
                   "outputs: [metrics.kinematic.distance]\n"
                   "keep: worst 1 by metrics.kinematic.distance\n")
        self.make("sweep", "-q", "study.yaml", "-o", "sweep")
        self.write("bisect.yaml", base.replace(
            "expect: {}", "expect: {metrics: [{metric: distance, max: 0.3}]}") +
            "vary: {world.friction: [0.9]}\n"
            "bisect: {key: mission.speed, from: 1, to: 3, tolerance: 0.5}\n")
        self.make("sweep", "-q", "bisect.yaml", "-o", "bisect")
        claim = base.replace("expect: {}", "expect: {metrics: [{metric: distance, min: 0.5}]}")
        vary = "vary: {mission.speed: {distribution: uniform, from: 1, to: 5}}\n"
        self.write("claim.yaml", claim + vary + "sample: {count: 100, method: random}\n")
        self.make("verify", "-q", "claim.yaml", "-o", "verify", "--probability", "0.3")
        self.write("search.yaml", claim + vary + "search: {method: random, runs: 12, shrink_runs: 8}\n")
        self.make("falsify", "-q", "search.yaml", "-o", "falsify")
        self.write("identify.yaml", "schema: 1\nname: small\n"
                   f"fit: [{SOURCE}/scenarios/real/dart_ramp_02.yaml]\n"
                   "parameters:\n  - {name: p_ky1_front, from: -20, to: -2}\n"
                   "  - {name: p_dy1_front, from: 0.5, to: 1.5}\nstarts: 1\n")
        self.make("identify", "-q", "identify.yaml", "-o", "identify")


REPORT = ["report", "-q", "{}", "-o", "page.html"]
COMPARE = ["compare", "-q", "{}", "other", "-o", "again"]
RENDER = ["render", "-q", "{}", "--at", "0.1", "--size", "64x64", "-o", "p.png"]
MERGE = ["sweep", "merge", "-q", "{}", "-o", "merged"]
ROW = ["run", "-q", "--from-sweep", "{}", "--row", "1", "-o", "row", "--set", "drive.time_limit=0.1"]
AGAIN = ["run", "-q", "{}/scenario.resolved.yaml", "-o", "row", "--set", "drive.time_limit=0.1"]
# Each file, with the verbs that read it. {} stands for the folder of the file.
READERS = {
    "run/metrics.json": [REPORT, COMPARE, RENDER],
    "run/plan.json": [REPORT, RENDER],
    "run/compare.json": [REPORT],
    "run/timing.json": [REPORT],
    "run/manifest.json": [REPORT, COMPARE, RENDER,
                          ["run", "-q", "three_turns", *QUICK, "-o", "{}"],
                          ["plan", "-q", "three_turns", "-o", "{}"]],
    "gates/metrics.json": [REPORT],
    "gates/plan.json": [REPORT, RENDER],
    "pair/compare.json": [REPORT],
    "sweep/sweep.json": [REPORT],
    "sweep/sweep.records": [MERGE, ROW, ["sweep", "-q", "study.yaml", "-o", "{}"]],
    "bisect/sweep.json": [REPORT],
    "bisect/sweep.records": [MERGE, ["sweep", "-q", "bisect.yaml", "-o", "{}"]],
    "verify/verify.json": [REPORT],
    "verify/sweep.json": [REPORT],
    "verify/sweep.records": [MERGE, ["verify", "-q", "claim.yaml", "-o", "{}", "--probability", "0.3"]],
    "falsify/falsify.json": [REPORT],
    "falsify/sweep.json": [REPORT],
    "falsify/sweep.records": [MERGE, ["falsify", "-q", "search.yaml", "-o", "{}"]],
    "falsify/counterexample/metrics.json": [REPORT],
    "identify/identify.json": [REPORT],
    "identify/records/dart_ramp_02/metrics.json": [REPORT],
    "run/kinematic.csv": [REPORT, COMPARE, RENDER],
    "run/single_track.state.csv": [REPORT, COMPARE, RENDER],
    "run/plan.csv": [REPORT, COMPARE, RENDER],
    "run/schedule.csv": [REPORT, COMPARE],
    "run/scenario.resolved.yaml": [REPORT, COMPARE, RENDER, AGAIN],
    "run/compare.csv": [REPORT],
    "sweep/sweep.csv": [REPORT],
    "falsify/counterexample/scenario.resolved.yaml": [AGAIN],
    "identify/dart_ramp_02.residuals.csv": [REPORT],
}


def documents(text, name):
    """The JSON values of a file, each with the function that converts them back to the file's text."""
    if not name.endswith(".records"):
        yield "", json.loads(text), lambda new: new
        return
    lines = text.split("\n")[:-1]
    for number in sorted({0, 1, len(lines) - 1}):
        def make(new, number=number):
            own = list(lines)
            own[number] = f"{zlib.crc32(new.encode('utf-8', 'surrogateescape')):08x} {new}"
            return "\n".join(own) + "\n"
        yield f"line {number + 1} ", json.loads(lines[number][9:]), make


def table_changes(lines):
    """The changes of a table: without each column, and with another name for each column."""
    names = lines[0].split(",")
    for column, name in enumerate(names):
        rows = [line.split(",") for line in lines]
        yield f"no column {name}", "\n".join(
            ",".join(row[:column] + row[column + 1:]) for row in rows)
        for other in ("x", "", names[0], "\x1b[31m", '"'):
            yield f"column {name}: {other!r}", "\n".join(
                [",".join(names[:column] + [other] + names[column + 1:])] + lines[1:])


def text_changes(text, name):
    """As changes, for tables and YAML files."""
    lines = text.split("\n")
    if name.endswith(".csv"):
        yield from table_changes(lines)
    for number in sorted({0, 1, len(lines) // 2, len(lines) - 2}):
        for what, body in (("removed", []), ("doubled", 2 * [lines[number]]),
                           ("longer", [lines[number] + ",1"]), ("quote", ['"' + lines[number]]),
                           ("NUL", [lines[number] + "\0"]), ("not UTF-8", [lines[number] + "\udcff"])):
            yield f"line {number + 1} {what}", "\n".join(lines[:number] + body + lines[number + 1:])
    numbers = list(re.finditer(r"(?<![\w.])-?\d+\.?\d*(?![\w.])", text))
    for match in numbers[::max(1, len(numbers) // 10)]:
        for value in ("", "-" + match.group(), "nan", "1e308", "-1e308", "1e-300", "1e999", "0", "x",
                      "18446744073709551616", "[1]"):
            yield f"byte {match.start()}: {match.group()} -> {value}", (
                text[:match.start()] + value + text[match.end():])
    for end in (1, len(text) // 3, len(text) - 2):
        yield f"cut at {end}", text[:end]
    yield "byte order mark", "\ufeff" + text
    yield "CR LF", text.replace("\n", "\r\n")
    yield "CR", text.replace("\n", "\r")
    for body in WHOLE:
        yield f"all: {body[:20]!r}", body


def changes(text, name):
    """The name of the change, and the new text of the file."""
    if name.endswith((".csv", ".yaml")):
        yield from text_changes(text, name)
        return
    for where, root, make in documents(text, name):
        for path in places(root):
            for value in VALUES:
                if path:
                    new = changed(root, path, value)
                elif value is REMOVED:
                    continue
                else:
                    new = value
                shown = "removed" if value is REMOVED else json.dumps(value)
                # The text contains no blanks, like the lines of the file of records.
                body = text_of(new) if make("") == "" else json.dumps(
                    new, separators=(",", ":")).replace(json.dumps(HUGE), "1e999").replace(
                        json.dumps(NAN), "NaN")
                yield f"{where}{'.'.join(map(str, path)) or 'all'}: {shown}", make(body)
        for body in WHOLE:
            yield f"{where}all: {body[:20]!r}", make(body)


def restore(root, pristine, folder):
    """Restores the files of the folder, and removes all other files."""
    shutil.rmtree(f"{root}/{folder}")
    shutil.copytree(f"{pristine}/{folder}", f"{root}/{folder}")
    for other in set(os.listdir(root)) - set(os.listdir(pristine)):
        if os.path.isdir(f"{root}/{other}"):
            shutil.rmtree(f"{root}/{other}")
        else:
            os.remove(f"{root}/{other}")


def fault_of(done, name):
    said = (done.stdout + done.stderr).decode(errors="replace")
    if done.returncode not in (0, 2, 3):
        return f"exit code {done.returncode}: {said.strip()[-300:]}"
    if any(word in said for word in MALFORMED_WORDS):
        return f"says: {said.strip()[-300:]}"
    if done.returncode == 2 and not said.strip():
        return "says nothing"
    is_text = name.endswith((".csv", ".yaml"))
    if done.returncode == 2 and is_text and os.path.basename(name) not in said:
        return f"does not name the file: {said.strip()[-300:]}"
    return ""


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    options.add_argument("program")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--share", type=float, default=1.0)
    options.add_argument("--only", default="")
    options.add_argument("--part", default="1/1")
    options = options.parse_args()
    part, parts = map(int, options.part.split("/"))
    chosen = random.Random(options.seed)
    results = Results(os.path.abspath(options.program))
    counts = collections.Counter()
    faults = []
    try:
        results.make_all()
        # The checksums in a manifest would reveal every change.
        for at, _, names in os.walk(results.root):
            if "manifest.json" in names and not at.endswith("/run"):
                os.remove(os.path.join(at, "manifest.json"))
        pristine = results.root + "_pristine"
        shutil.copytree(results.root, pristine)
        number = 0
        for name, verbs in READERS.items():
            if options.only and not any(word in name for word in options.only.split(",")):
                continue
            with open(f"{pristine}/{name}") as file:
                text = file.read()
            for what, new in changes(text, name):
                for verb in verbs:
                    number += 1
                    if chosen.random() >= options.share or number % parts != part - 1:
                        continue
                    restore(results.root, pristine, name.split("/", maxsplit=1)[0])
                    if name.startswith("run/") and not name.endswith("manifest.json"):
                        os.remove(f"{results.root}/run/manifest.json")
                    with open(f"{results.root}/{name}", "w", encoding="utf-8",
                              errors="surrogateescape") as file:
                        file.write(new)
                    counts[name] += 1
                    folder = os.path.dirname(name)
                    try:
                        fault = fault_of(results.run(*[word.format(folder) for word in verb]), name)
                    except subprocess.TimeoutExpired:
                        fault = "more than 20 s"
                    if fault:
                        faults.append((name, what, " ".join(verb), fault))
                        print(f"{name}: {what}: {' '.join(verb)}: {fault}", flush=True)
    finally:
        shutil.rmtree(results.root, ignore_errors=True)
        shutil.rmtree(results.root + "_pristine", ignore_errors=True)
    for name, count in counts.items():
        print(f"{name:<45} {count:>7} changes {sum(own[0] == name for own in faults):>5} faults")
    print(f"{sum(counts.values())} changes, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
