"""Runs, and what they leave."""

import copy
import csv
import gc
import json
import os
import pathlib
import pickle
import re
import signal
import subprocess
import sys
import threading
import time

import numpy
import pytest

import trackbed


@pytest.fixture(scope="module")
def run():
    return trackbed.run("three_turns", plants=["kinematic", "mujoco"], set={"mission.speed": 2})


def test_has_the_log_that_the_run_folder_has(run, tmp_path):
    run.write(tmp_path / "out")
    for plant in ("kinematic", "mujoco"):
        rows = list(csv.reader(open(tmp_path / "out" / f"{plant}.csv")))
        assert list(run[plant]) == rows[0]
        for i, name in enumerate(rows[0]):
            # The file has the shortest form from which the same double can be read.
            numpy.testing.assert_array_equal(run[plant][name], [float(row[i]) for row in rows[1:]])


def test_has_the_plan_and_metrics_that_the_run_folder_has(run, tmp_path):
    run.write(tmp_path / "out")
    metrics = json.load(open(tmp_path / "out" / "metrics.json"))
    assert run.metrics == metrics["plants"]
    assert run.verdict == metrics["verdict"]
    assert run.comparisons == metrics["between"]
    assert run.plan == json.load(open(tmp_path / "out" / "plan.json"))
    rows = list(csv.reader(open(tmp_path / "out" / "plan.csv")))
    assert list(run.path) == rows[0]
    numpy.testing.assert_array_equal(run.path["x_m"], [float(row[1]) for row in rows[1:]])
    assert run.passed == (metrics["verdict"]["passed"] is True)


def test_is_the_run_of_the_program(run, tmp_path):
    program = os.environ["TRACKBED_PROGRAM"]
    subprocess.run(
        [program, "run", "three_turns", "--plant", "kinematic", "mujoco", "--set", "mission.speed=2"]
        + ["-q", "-o", str(tmp_path / "of_program")],
        check=True,
    )
    run.write(tmp_path / "of_python")
    for file in ("kinematic.csv", "mujoco.csv", "plan.csv", "scenario.resolved.yaml"):
        first = (tmp_path / "of_program" / file).read_bytes()
        assert first == (tmp_path / "of_python" / file).read_bytes(), file
    first, second = (json.load(open(tmp_path / f / "metrics.json")) for f in ("of_program", "of_python"))
    # Program and module may have been built at different commits.
    del first["versions"], second["versions"]
    # Other test files of the same pytest process may have registered metrics.
    for kind, name in trackbed._signatures._registered:
        if kind == "metric":
            for plant in second["plants"].values():
                plant.pop(name.split(".")[0], None)
    assert first == second


def test_arrays_are_read_only_views_of_one_memory(run):
    array = run["mujoco"]["cross_track_m"]
    assert array.dtype == numpy.float64
    assert array.ndim == 1
    assert not array.flags.owndata
    assert not array.flags.writeable
    assert numpy.shares_memory(array, run["mujoco"]["cross_track_m"])
    with pytest.raises(ValueError):
        array[0] = 1.0
    with pytest.raises(ValueError):
        array.setflags(write=True)


def test_arrays_outlive_the_run():
    run = trackbed.run("three_turns", plants="kinematic")
    array = run["kinematic"]["x_m"]
    path = run.path["x_m"]
    before = array.copy(), path.copy()
    count = sys.getrefcount(array.base)
    other = [run["kinematic"]["y_m"] for _ in range(10)]
    more = sys.getrefcount(array.base)
    del other
    less = sys.getrefcount(array.base)
    assert (more, less) == (count + 10, count)
    del run
    gc.collect()
    [numpy.empty(100_000) for _ in range(20)]
    numpy.testing.assert_array_equal(array, before[0])
    numpy.testing.assert_array_equal(path, before[1])


def test_is_a_mapping_of_plants(run):
    assert list(run) == run.plants == ["kinematic", "mujoco"]
    assert len(run) == 2
    assert run.name == "three_turns"
    assert "three_turns: kinematic arrived" in repr(run)
    with pytest.raises(KeyError, match="kinematic, mujoco"):
        run["single_track"]
    with pytest.raises(KeyError, match="cross_track_m"):
        run["mujoco"]["cross_track"]


def test_override_values_of_all_kinds(tmp_path):
    changed = {
        "plan": {"method": "fillet"},
        "mission.speed": numpy.float64(1.5),
        "seed": numpy.int64(3),
        "drive.plants": ("kinematic",),
        "name": "other",
    }
    run = trackbed.run("three_turns", set=changed)
    assert run.name == "other"
    assert run.plants == ["kinematic"]
    assert max(abs(run["kinematic"]["speed_mps"])) == pytest.approx(1.5, abs=0.01)


def test_a_run_without_a_plan_is_a_result():
    blocked = {"world.obstacles": [{"box": {"x": 0, "y": 0, "length": 1, "width": 1, "height": 1}}]}
    run = trackbed.run("three_turns", set=blocked)
    assert run.plants == []
    assert run.path is None
    assert not run.passed
    assert run.plan["status"] == "start_blocked"
    with pytest.raises(AssertionError, match="no plan"):
        trackbed.tracks_within(run, 1.0)


@pytest.mark.parametrize(
    "arguments, error, text",
    [
        (dict(scenario=3), TypeError, "scenario must be a str or a path, not int"),
        (dict(scenario="three_turns", set=3), TypeError, "set must be a dict"),
        (dict(scenario="three_turns", set={3: 4}), TypeError, "a key in set must be a str"),
        (dict(scenario="three_turns", set={"a": {1}}), TypeError, r"set\['a'\] must be"),
        (dict(scenario="three_turns", set={"a": float("nan")}), ValueError, r"set\['a'\] is nan"),
        (dict(scenario="three_turns", plants=3), TypeError, "plants must be a list"),
        (dict(scenario="three_turns", plants=[3]), TypeError, "a name in plants must be a str"),
        (dict(scenario="three_turns", seed=1.5), TypeError, "seed must be a whole number"),
        (dict(scenario="three_turns", seed=-1), ValueError, "seed is -1; must be at least 0"),
        (dict(scenario="three_turms"), trackbed.InputError, "did you mean 'three_turns'"),
        (dict(scenario="three_turns", plants="kinetic"), trackbed.InputError, "kinematic"),
        (dict(scenario="three_turns", set={"mission.sped": 2}), trackbed.InputError, "speed"),
    ],
)
def test_wrong_arguments_are_named(arguments, error, text):
    with pytest.raises(error, match=text):
        trackbed.run(**arguments)


def test_errors_are_python_errors_with_the_text_of_the_program(tmp_path):
    file = tmp_path / "wrong.yaml"
    file.write_text("name: wrong\nmission: {speed: fast}\n")
    program = os.environ["TRACKBED_PROGRAM"]
    told = subprocess.run([program, "run", str(file)], capture_output=True, text=True).stderr
    with pytest.raises(ValueError) as error:
        trackbed.run(file)
    assert isinstance(error.value, trackbed.InputError)
    for line in str(error.value).splitlines():
        assert line in told
    run = trackbed.run("three_turns", plants="kinematic")
    (tmp_path / "file").write_text("")
    with pytest.raises(RuntimeError) as error:
        run.write(tmp_path / "file" / "out")
    assert isinstance(error.value, trackbed.RunError)


def test_other_threads_run_meanwhile():
    count = 0
    done = threading.Event()

    def work():
        trackbed.run("three_turns", plants="mujoco", set={"mission.speed": 1})
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not done.wait(0.001):
        count += 1
    thread.join()
    # If the run of half a second held the GIL, this thread would continue only once or twice.
    assert count > 20


def test_runs_on_threads_are_the_runs_of_one_thread():
    first = trackbed.run("three_turns", plants="mujoco")
    runs = [None] * 4

    def work(i):
        runs[i] = trackbed.run("three_turns", plants="mujoco")

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for run in runs:
        for name in first["mujoco"]:
            numpy.testing.assert_array_equal(first["mujoco"][name], run["mujoco"][name])


def test_ctrl_c_interrupts_a_run():
    code = (
        "import trackbed\n"
        "print('ready', flush=True)\n"
        "try:\n"
        "    while True: trackbed.run('grand_tour', plants='mujoco')\n"
        "except KeyboardInterrupt:\n"
        "    print('interrupted', flush=True)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=120)[0] == "interrupted\n"
    assert process.returncode == 0


def test_runs_in_a_forked_process():
    trackbed.run("three_turns", plants="kinematic")
    child = os.fork()
    if child == 0:
        try:
            trackbed.run("three_turns", plants="mujoco")
            os._exit(0)
        finally:
            os._exit(1)
    assert os.waitpid(child, 0)[1] == 0


def test_to_pandas(run):
    pandas = pytest.importorskip("pandas")
    table = run["mujoco"].to_pandas()
    assert list(table.columns) == list(run["mujoco"])
    numpy.testing.assert_array_equal(table["x_m"], run["mujoco"]["x_m"])
    both = run.to_pandas()
    assert isinstance(both, pandas.DataFrame)
    numpy.testing.assert_array_equal(both.loc["mujoco"]["x_m"], run["mujoco"]["x_m"])


def test_to_pandas_names_the_missing_package(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r"pip install trackbed\[pandas\]"):
        run["mujoco"].to_pandas()


def test_frame_is_the_frame_of_the_program(run):
    image = trackbed.frame(run, 5.0, (160, 96))
    assert image.shape == (96, 160, 3)
    assert image.dtype == numpy.uint8
    # The scene has a sky, a ground and a car.
    assert len(numpy.unique(image.reshape(-1, 3), axis=0)) > 50
    numpy.testing.assert_array_equal(image, trackbed.frame(run, 5.0, (160, 96)))
    assert (image != trackbed.frame(run, 15.0, (160, 96))).any()


@pytest.mark.parametrize(
    "change, error, text",
    [
        (dict(run=3), TypeError, "run must be a trackbed.Run, not int"),
        (dict(t="a"), TypeError, "t must be a number"),
        (dict(t=float("inf")), ValueError, "t is inf"),
        (dict(t=1e6), trackbed.InputError, ""),
        (dict(size=3), TypeError, "size must be"),
        (dict(size=(3.5, 4)), TypeError, r"size\[0\] must be a whole number"),
        (dict(size=(64, 0)), ValueError, r"size\[1\] is 0"),
        (dict(camera=3), TypeError, "camera must be a str"),
        (dict(camera="selfie"), trackbed.InputError, "selfie"),
    ],
)
def test_wrong_arguments_of_frame_are_named(run, change, error, text):
    arguments = {"run": run, "t": 1.0, "size": (64, 64), **change}
    with pytest.raises(error, match=text):
        trackbed.frame(**arguments)


def test_shows_its_report_in_a_notebook(run):
    page = run.report()
    assert page.lstrip().lower().startswith("<!doctype html>")
    shown = run._repr_html_()
    assert shown.startswith("<iframe sandbox=")
    assert "&lt;!doctype html&gt;" in shown.lower()


def test_removes_its_temporary_folder():
    run = trackbed.run("three_turns", plants="kinematic")
    run.report()
    folder = pathlib.Path(run._folder())
    assert folder.exists()
    del run
    gc.collect()
    assert not folder.exists()


def test_version_is_that_of_the_program():
    program = os.environ["TRACKBED_PROGRAM"]
    told = subprocess.run([program, "--version"], capture_output=True, text=True).stdout
    assert re.match(r"\d+\.\d+\.\d+", trackbed.__version__)
    assert trackbed.__version__.split()[0] in told


def test_logs_and_paths_can_be_pickled():
    run = trackbed.run("three_turns", plants=["kinematic"])
    for table in (run["kinematic"], run.path):
        again = pickle.loads(pickle.dumps(table))
        assert type(again) is type(table) and list(again) == list(table) and again.rows == table.rows
        for name in table:
            numpy.testing.assert_array_equal(again[name], table[name])
            assert not again[name].flags.writeable
    assert pickle.loads(pickle.dumps(run["kinematic"])).plant == "kinematic"
    with pytest.raises(TypeError, match="a Run cannot be pickled.*return run.plant., run.metrics"):
        pickle.dumps(run)
    assert copy.deepcopy(run) is run and copy.deepcopy(run.path)["x_m"][0] == run.path["x_m"][0]


def test_metric_values_are_those_of_the_file():
    run = trackbed.run("three_turns", plants=["kinematic"])
    values, metrics = run.metric_values("kinematic"), run.metrics["kinematic"]
    assert values["cross_track.max"] == metrics["cross_track"]["max"]
    assert values["turns[1].lateral_offset"] == metrics["turns"][1]["lateral_offset"]
    with pytest.raises(KeyError, match="no plant 'kinematik'; did you mean 'kinematic'"):
        run.metric_values("kinematik")
    with pytest.raises(KeyError, match="no column 'cross_track'; did you mean 'cross_track_m'"):
        run["kinematic"]["cross_track"]
    with pytest.raises(AttributeError, match=r"a column is read by log\['cross_track_m'\]"):
        run["kinematic"].cross_track_m


def test_pictures_bear_the_name_of_the_run():
    run = trackbed.run("three_turns", plants=["kinematic"], set={"drive.time_limit": 1, "expect": {}})
    other = trackbed.run("three_turns", plants=["kinematic"], set={"drive.time_limit": 1, "expect": {}})
    numpy.testing.assert_array_equal(
        trackbed.frame(run, 0.5, (160, 90)), trackbed.frame(other, 0.5, numpy.array([160, 90]))
    )


def test_a_table_is_no_array(run):
    for table in (run, run["mujoco"], run.path):
        with pytest.raises(TypeError, match="is a mapping of names, not an array"):
            numpy.array(table)
        with pytest.raises(TypeError, match="is a mapping of names, not an array"):
            numpy.asarray(table, dtype=float)
    with pytest.raises(AttributeError, match=r"the log of a plant is read by run\['mujoco'\]"):
        run.mujoco


def test_ctrl_c_interrupts_a_film(run, tmp_path):
    # The film has 14 000 frames, at least 2 ms each: it takes above 28 s without an interruption.
    timer = threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    start = time.process_time()
    with pytest.raises(KeyboardInterrupt):
        trackbed.film(run, tmp_path / "film.webp", (64, 64), fps=240)
    assert time.process_time() - start < 14.0
    assert list(tmp_path.iterdir()) == []
