"""Runs the program on scenarios in a scratch folder."""
import csv
import json
import re
import resource
import signal
import subprocess
import time


class Outcome:
    """Result of a call of the program: exit code (None: timed out), first message and duration [s]."""

    def __init__(self, code, text, seconds):
        self.code, self.text, self.seconds = code, text, seconds

    @property
    def accepted(self):
        return self.code == 0

    @property
    def fault(self):
        """The reason why this result is a fault of the program, or "". The exit codes 2 and 3 are no faults."""
        if self.code is None:
            return f"over {self.seconds:.0f} s"
        if self.code in (0, 2, 3):
            return ""
        return f"exit {self.code}"

    @property
    def message(self):
        """The first line that gives a reason, without colors, from the word that begins the error."""
        lines = [line.strip() for line in re.sub(r"\x1b\[[0-9;]*m", "", self.text).splitlines() if line.strip()]
        for line in lines:
            if "error" in line or "no plan" in line or "not " in line:
                return line
        return lines[0] if lines else ""


class Program:
    """The program, with a limit of its processor time [s], so that a busy machine does not cause a fault."""

    def __init__(self, path, scratch, limit=30):
        self.path, self.scratch, self.limit = path, scratch, limit
        self.calls = 0

    def bound(self):
        resource.setrlimit(resource.RLIMIT_CPU, (self.limit, self.limit + 1))

    def call(self, *arguments):
        self.calls += 1
        start = time.monotonic()
        done = subprocess.run([self.path, *map(str, arguments)], capture_output=True, text=True, errors="replace",
                              cwd=self.scratch, check=False, preexec_fn=self.bound)
        if done.returncode == -signal.SIGXCPU:
            return Outcome(None, f"ended after {self.limit} s", self.limit)
        return Outcome(done.returncode, done.stderr + done.stdout, time.monotonic() - start)

    def scenario(self, keys):
        """Writes a scenario; YAML contains JSON."""
        file = self.scratch / f"scenario_{self.calls}.yaml"
        file.write_text(json.dumps({"schema": 1, "name": "survey", **keys}))
        return file

    def plan(self, keys, assets):
        """Returns the outcome, the rows of plan.csv in the coordinates of the inputs, and plan.json."""
        return self.plan_file(self.scenario(keys), assets)

    def plan_file(self, file, assets=None):
        out = self.scratch / "plan"
        for name in ("plan.csv", "plan.json"):
            (out / name).unlink(missing_ok=True)
        outcome = self.call("plan", file, "-o", out, *(("--allow-assets", assets) if assets else ()))
        if not outcome.accepted or not (out / "plan.csv").exists():
            return outcome, [], {}
        with open(out / "plan.csv", newline="") as table:
            rows = [(float(r["x_m"]) + float(r.get("origin_x_m") or 0.0),
                     float(r["y_m"]) + float(r.get("origin_y_m") or 0.0), float(r["yaw_rad"]))
                    for r in csv.DictReader(table)]
        return outcome, rows, json.loads((out / "plan.json").read_text())

    def drive(self, keys, assets):
        """Returns "yes" if the kinematic car arrives, otherwise the reason."""
        outcome = self.call("run", self.scenario(keys), "-o", self.scratch / "run", "--allow-assets", assets,
                            "--plant", "kinematic", "-q")
        return "yes" if outcome.accepted else outcome.fault or "no: " + outcome.message
