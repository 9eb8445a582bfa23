"""Plug-ins in the program: `python3 -m trackbed VERB --import MODULE`."""

import os
import signal
import subprocess
import sys
import time

import pytest

SCENARIO = """\
schema: 1
name: own
vehicle: {model: prius}
mission: {speed: 3, waypoints: [[0, 0], [40, 0]]}
plan: {method: dubins}
control: {method: from_module}
drive: {plants: [kinematic]}
"""

MODULE = """\
import trackbed

@trackbed.controller("from_module")
def steer(seen, *, gain: float = 0.1):
    if gain == 9:
        raise ValueError("gain 9 burns the motor")
    if gain == 8:
        while True:
            pass
    return -gain * seen.cross_track_m - seen.heading_error_rad

@trackbed.metric("from_module.rows")
def rows(log):
    return log.rows
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "my_module.py").write_text(MODULE)
    (tmp_path / "own.yaml").write_text(SCENARIO)
    return tmp_path


def program(folder, *arguments, timeout=120):
    command = [sys.executable, "-m", "trackbed", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=timeout)


def test_program_imports_modules(folder):
    told = program(folder, "run", "--import", "my_module", "own.yaml", "--out", "out")
    assert told.returncode == 0, told.stderr
    assert "from_module" in (folder / "out/scenario.resolved.yaml").read_text()
    assert '"rows"' in (folder / "out/metrics.json").read_text()
    told = program(folder, "list", "controllers", "--import=my_module")
    assert "from_module" in told.stdout
    told = program(folder, "check", "own.yaml")
    assert told.returncode == 2 and "from_module" in told.stderr


def test_program_prints_the_traceback_of_a_plugin(folder):
    told = program(folder, "run", "--import", "my_module", "own.yaml", "--set", "control.gain=9")
    assert told.returncode == 1
    assert "in steer" in told.stderr and 'raise ValueError("gain 9 burns the motor")' in told.stderr
    assert "controller 'from_module' (my_module.steer): ValueError: gain 9" in told.stderr
    assert "internal error" not in told.stderr


def test_an_fmu_contains_no_plugin(folder):
    told = program(folder, "fmu", "--import", "my_module", "own.yaml", "-o", "car.fmu")
    assert told.returncode == 2 and not (folder / "car.fmu").exists()
    assert "the FMU would not start: scenario.yaml:" in told.stderr, told.stderr
    assert "an FMU contains no Python, so that its scenario cannot use the plug-ins" in told.stderr
    assert "from_module" in told.stderr.splitlines()[-1]


def test_versions_of_fmi_have_their_usual_names(folder):
    told = program(folder, "fmu", "three_turns", "--plant", "kinematic", "--fmi", "2.0", "-o", "car.fmu")
    assert told.returncode == 0 and "(FMI 2.0)" in told.stdout, told.stderr
    told = program(folder, "fmu", "three_turns", "--fmi", "1", "-o", "car.fmu")
    assert told.returncode == 2 and "--fmi: unknown version '1'; allowed: 2, 3" in told.stderr


def test_program_says_why_it_cannot_import(folder):
    for name, text in [
        ("other", "no module 'other' in the working folder"),
        ("my_module.py", "'my_module.py' is a file; give the name of the module, my_module"),
        ("wrong", "ZeroDivisionError"),
        ("", "--import needs the name of a Python module"),
    ]:
        (folder / "wrong.py").write_text("1 / 0\n")
        told = program(folder, "run", "--import", name, "own.yaml")
        assert told.returncode == 2 and text in told.stderr, told.stderr
    own = os.environ["TRACKBED_PROGRAM"]
    command = [own, "run", "--import", "my_module", "own.yaml"]
    told = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert told.returncode == 2 and "python3 -m trackbed" in told.stderr


def test_program_ends_a_plugin_that_does_not_return(folder):
    command = [sys.executable, "-m", "trackbed", "run", "--import", "my_module", "own.yaml"]
    process = subprocess.Popen([*command, "--set", "control.gain=8"], cwd=folder)
    time.sleep(3.0)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=60) == 130


def test_sweep_of_the_program_goes_on_after_an_exception(folder):
    (folder / "study.yaml").write_text(
        "schema: 1\nname: gains\nscenario: own.yaml\nvary: {control.gain: [0.1, 9, 0.2]}\n"
        "outputs: [metrics.kinematic.from_module.rows]\n"
    )
    told = program(folder, "sweep", "--import", "my_module", "study.yaml", "--out", "out")
    table = (folder / "out/sweep.csv").read_text()
    assert [row.split(",")[1] for row in table.splitlines()[1:]] == ["passed", "error", "passed"]
    assert "gain 9 burns the motor" in table
    assert told.returncode == 1


def test_falsify_of_the_program_searches_a_requirement(folder):
    module = (folder / "my_module.py").read_text()
    (folder / "my_module.py").write_text(
        module + "\n@trackbed.requirement('slow')\ndef slow(log):\n    return 4 - log['speed_mps'].max()\n"
    )
    scenario = (folder / "own.yaml").read_text()
    (folder / "own.yaml").write_text(scenario + "expect: {metrics: [{metric: slow, min: 0}]}\n")
    (folder / "study.yaml").write_text(
        "schema: 1\nname: search\nscenario: own.yaml\n"
        "vary: {mission.speed: {distribution: uniform, from: 1, to: 6}}\n"
        "search: {method: random, runs: 30, shrink_runs: 3}\n"
    )
    told = program(folder, "falsify", "--import", "my_module", "study.yaml", "--out", "out")
    # A run fails with the probability 2/5, so 30 runs all pass with a probability of 2e-7. The seed
    # is fixed.
    assert told.returncode == 3, told.stderr
    assert "slow" in told.stdout and (folder / "out/counterexample/counterexample.yaml").exists()
