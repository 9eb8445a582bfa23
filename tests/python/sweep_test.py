"""Studies that Python runs."""

import gc
import os
import pathlib
import signal
import subprocess
import sys
import time

import numpy
import pytest

import trackbed

STUDY = """\
schema: 1
name: speeds
scenario: {scenario}
set: {{drive.plants: [kinematic]}}
vary: {{mission.speed: [1, 2, 3, 4], control.distance: [3, 4]}}
outputs: [metrics.kinematic.cross_track.max, metrics.kinematic.status]
"""


@pytest.fixture
def study(tmp_path, scenarios):
    file = tmp_path / "speeds.yaml"
    file.write_text(STUDY.format(scenario=scenarios / "three_turns.yaml"))
    return file


def test_table_is_that_of_the_program(study, tmp_path):
    sweep = trackbed.sweep(study, tmp_path / "python", progress=False)
    assert sweep.complete and sweep.rows == sweep.rows_expected == 8
    program = os.environ["TRACKBED_PROGRAM"]
    subprocess.run([program, "sweep", study, "--out", tmp_path / "cpp", "--quiet"], check=True)
    assert (tmp_path / "python/sweep.csv").read_bytes() == (tmp_path / "cpp/sweep.csv").read_bytes()
    assert list(sweep) == sweep.columns
    numpy.testing.assert_array_equal(sweep["mission.speed"], [1, 1, 2, 2, 3, 3, 4, 4])
    assert set(sweep["status"]) <= {"passed", "failed"}
    assert sweep["metrics.kinematic.cross_track.max"].dtype == numpy.float64
    with pytest.raises(KeyError, match="mission.speed"):
        sweep["speed"]
    again = trackbed.sweep(study, tmp_path / "python", progress=False)
    numpy.testing.assert_array_equal(again["mission.speed"], sweep["mission.speed"])


def test_table_grows_while_the_study_runs(study):
    sweep = trackbed.sweep(study, jobs=1, wait=False)
    counts = {sweep.rows}
    while not sweep.wait(0.0):
        counts.add(sweep.rows)
        assert len(sweep["status"]) <= 8
    assert len(counts) > 1
    assert sweep.complete and sweep.numbers == list(range(8))
    assert repr(sweep) == "<Sweep speeds: 8 of 8 rows>"


def test_stops_and_goes_on(study, tmp_path):
    sweep = trackbed.sweep(study, tmp_path / "out", jobs=1, wait=False)
    while sweep.rows == 0:
        time.sleep(0.01)
    sweep.stop()
    done = sweep.rows
    assert 1 <= done < 8
    del sweep
    gc.collect()
    sweep = trackbed.sweep(study, tmp_path / "out", wait=False)
    assert sweep.rows >= done
    assert sweep.wait()
    assert sweep.complete


def test_ctrl_c_keeps_the_finished_rows(study):
    code = (
        "import sys, trackbed\n"
        "trackbed.metric('started')(lambda log: print('ready', flush=True))\n"
        f"sweep = trackbed.sweep({str(study)!r}, jobs=1)\n"
        "print(sweep.complete, sweep.rows > 0, len(sweep['status']) == sweep.rows, flush=True)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    assert process.stdout.readline() == "ready\n"
    process.send_signal(signal.SIGINT)
    last = process.communicate(timeout=120)[0].splitlines()[-1]
    assert last == "False True True"
    assert process.returncode == 0


def test_an_exception_of_a_plugin_is_the_error_of_its_row(study):
    def speed(log):
        if log["speed_mps"].max() > 3.5:
            raise ZeroDivisionError("too fast")
        return 1.0

    trackbed.metric("sweep_test.speed")(speed)
    sweep = trackbed.sweep(study, progress=False)
    trackbed.metric("sweep_test.speed", replace=True)(lambda log: None)
    assert [row for row, status in enumerate(sweep["status"]) if status == "error"] == [6, 7]
    assert sorted(sweep.exceptions) == [6, 7]
    assert isinstance(sweep.exceptions[6], ZeroDivisionError)
    assert sweep.exceptions[6].__traceback__ is not None


@pytest.mark.parametrize(
    "arguments, error, text",
    [
        (dict(study=3), TypeError, "study must be a str or a path, not int"),
        (dict(out=3), TypeError, "out must be a str or a path, not int"),
        (dict(jobs=0), ValueError, "jobs is 0; must be at least 1"),
        (dict(jobs=1.5), TypeError, "jobs must be a whole number"),
        (dict(set=3), TypeError, "set must be a dict"),
        (dict(study="robustnes"), trackbed.InputError, "robustness"),
        (dict(study="three_turns"), trackbed.InputError, "three_turns"),
    ],
)
def test_wrong_arguments_are_named(study, arguments, error, text):
    with pytest.raises(error, match=text):
        trackbed.sweep(**{"study": study, **arguments})


def test_to_pandas(study):
    pandas = pytest.importorskip("pandas")
    table = trackbed.sweep(study, progress=False).to_pandas()
    assert isinstance(table, pandas.DataFrame)
    assert len(table) == 8


@pytest.mark.parametrize(
    "body, code, told",
    [("while True: pass", 0, ""), ("time.sleep(600)", 1, "a plug-in on another thread does not return")],
)
def test_a_plugin_that_does_not_return_does_not_crash_the_end(study, body, code, told):
    program = (
        "import time, trackbed\n"
        "@trackbed.controller('stuck')\n"
        "def stuck(seen):\n"
        f"    {body}\n"
        f"sweep = trackbed.sweep({str(study)!r}, set={{'control': {{'method': 'stuck'}}}}, wait=False)\n"
        "time.sleep(0.5)\n"
    )
    text = study.read_text().replace(", control.distance: [3, 4]", "")
    study.write_text(text)
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == code, done.stderr
    assert told in done.stderr


DAEMONS = {
    "run": "trackbed.run('three_turns', plants=['mujoco'])",
    "plan": "trackbed.Loop('three_turns', 'kinematic')",
    "step": "loop.step() if not loop.observation.ended else loop.reset()",
    "vector": "cars.step(); cars.reset()",
    "plugin": "trackbed.run('three_turns', 'kinematic', {'control': {'method': 'own'}})",
}


@pytest.mark.parametrize("body", DAEMONS.values(), ids=DAEMONS)
def test_a_daemon_thread_does_not_crash_the_end(body):
    program = (
        "import sys, threading, time, trackbed\n"
        "trackbed.controller('own')(lambda seen: 0.0)\n"
        "loop = trackbed.Loop('three_turns', 'kinematic')\n"
        "cars = trackbed.VectorLoop('three_turns', 'kinematic', 8)\n"
        "began = threading.Event()\n"
        "def work():\n"
        "    while True:\n"
        f"        {body}\n"
        "        began.set()\n"
        "for _ in range(3):\n"
        "    threading.Thread(target=work, daemon=True).start()\n"
        "began.wait()\n"
        "sys.exit(7)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stderr) == (7, "")


def test_a_fork_during_a_study_works_alone(study):
    sweep = trackbed.sweep(study, wait=False, jobs=1)
    child = os.fork()
    if child == 0:
        code = 1
        try:
            trackbed.metric("test_fork")(lambda log: 4.0)
            run = trackbed.run("three_turns", plants="kinematic")
            code = 0 if run.metrics["kinematic"]["test_fork"] == 4.0 else 2
            del sweep
        finally:
            os._exit(code)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    sweep.stop()
