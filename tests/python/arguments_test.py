"""Wrong arguments of every public function: an error names the argument."""

import array
import collections
import decimal
import fractions
import functools
import math
import warnings

import numpy
import pytest

import trackbed

STUDY = """\
schema: 1
name: speeds
scenario: {scenario}
set: {{drive.plants: [kinematic]}}
vary: {{mission.speed: [2]}}
outputs: [metrics.kinematic.status]
"""
# Names of things that the fixture `things` makes.
RUN, BOTH, COMPARISON, LOOP, CARS = "@run", "@both", "@comparison", "@loop", "@cars"
SWEEP, FILE = "@sweep", "@file"


class BadPath:
    def __fspath__(self):
        return 3


OTHER = [object(), int, Ellipsis, b"x", {1, 2}, lambda: 0, NotImplemented]
WRONG = {
    "number": [*OTHER, "1", True, [1.0], 1j, math.nan, math.inf, 10**400, decimal.Decimal(1)],
    "whole": [*OTHER, "1", True, 1.5, [1], math.nan, -1, 10**30, 10**400],
    "flag": [*OTHER, None, 1, 0.0, "true", [], numpy.zeros((2, 2))],
    "text": [*OTHER, 1, ["a"], ("a",), numpy.array(["a"]), "\udc80"],
    "path": [*OTHER, 1, ["a"], "", "a\0b", BadPath(), numpy.array(["a"]), "\ud800"],
    "array": [*OTHER, "1", ["1", "2"], [1j], [10**400, 1], [[1.0]] * 7, numpy.array(["1"]), 1.0],
    "texts": [*OTHER[:-3], 1, "speed_mps", [1], [None], numpy.array(1.0), ["\udc80"]],
    "dict": [*OTHER, 1, "a", [1], [("a", 1)], numpy.zeros(2)],
}


def refuses(use, argument, kind):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for value in WRONG[kind]:
            with pytest.raises((TypeError, ValueError), match=argument):
                use(**{argument: value})
                pytest.fail(f"{argument}={value!r} is accepted")


@pytest.fixture(scope="module")
def things(tmp_path_factory, scenarios):
    both = trackbed.run("three_turns", plants=["kinematic", "mujoco"])
    study = tmp_path_factory.mktemp("study") / "speeds.yaml"
    study.write_text(STUDY.format(scenario=scenarios / "three_turns.yaml"))
    return {
        RUN: trackbed.run("three_turns", plants="kinematic"),
        BOTH: both,
        COMPARISON: trackbed.compare(both, "kinematic", "mujoco"),
        LOOP: trackbed.Loop("three_turns", "kinematic"),
        CARS: trackbed.VectorLoop("three_turns", "kinematic", 2),
        FILE: study,
        SWEEP: trackbed.sweep(study, progress=False),
    }


STEPS = {"scenario": "path", "plant": "text", "set": "dict", "log": "flag"}
DRAWN = {"run": "text", "size": "array", "camera": "text", "quality": "text"}
FUNCTIONS = [
    (trackbed.run, ["three_turns"], {"scenario": "path", "set": "dict", "seed": "whole"}),
    (trackbed.Loop, ["three_turns"], {**STEPS, "seed": "whole"}),
    (trackbed.VectorLoop, ["three_turns"], {**STEPS, "threads": "whole", "seeds": "array", "count": "whole"}),
    (trackbed.VectorLoop.step, [CARS], {"steering": "array", "acceleration": "array"}),
    (trackbed.Loop.reset, [LOOP], {"set": "dict", "seed": "whole"}),
    (trackbed.Loop.reference, [LOOP], {"stations": "array"}),
    (trackbed.VectorLoop.curvature_ahead, [CARS], {"distances": "array"}),
    (trackbed.Run.write, [RUN, "out"], {"folder": "path", "mcap": "flag"}),
    (trackbed.frame, [RUN, 1.0], {**DRAWN, "t": "number"}),
    (trackbed.film, [RUN, "a.png"], {**DRAWN, "file": "path", "fps": "number"}),
    (trackbed.tracks_within, [RUN, 1.0], {"run": "text", "limit": "number"}),
    (trackbed.stays_within, [BOTH, "a", "b", 1.0], {"first": "text", "second": "text", "limit": "number"}),
    (trackbed.keeps_clearance, [RUN, 1.0], {"run": "text", "distance": "number"}),
    (trackbed.reaches_goal, [RUN, 1.0], {"run": "text", "distance": "number"}),
    (trackbed.steers_calmly, [RUN], {"run": "text"}),
    (trackbed.satisfies, [RUN, "a"], {"run": "text", "formula": "text"}),
    (trackbed.meets_its_expectations, [RUN], {"run": "text"}),
    (trackbed.compare, [BOTH, "kinematic", "mujoco"], {"first": "text", "second": "text", "plant": "text"}),
    (
        trackbed.differs_by_at_most,
        [COMPARISON],
        dict.fromkeys(("position", "heading", "yaw_rate", "steering"), "number"),
    ),
    (
        trackbed.sweep,
        [FILE],
        {
            **{"study": "path", "out": "path", "set": "dict", "jobs": "whole"},
            **dict.fromkeys(("restart", "progress", "wait"), "flag"),
        },
    ),
    (trackbed.Sweep.wait, [SWEEP], {"seconds": "number"}),
    (
        trackbed.Key,
        [],
        {
            **{"unit": "text", "text": "text", "allowed": "texts"},
            **dict.fromkeys(("min", "max", "above"), "number"),
        },
    ),
    (
        trackbed.PlannedPath,
        [[[0, 0], [1, 1]]],
        {"points": "array", "speed": "array", "notes": "texts", "max_deviation": "number"},
    ),
]


@pytest.mark.parametrize(
    "function, given, argument, kind",
    [(f, given, a, kind) for f, given, arguments in FUNCTIONS for a, kind in arguments.items()],
    ids=[f"{f.__qualname__}-{a}" for f, _, arguments in FUNCTIONS for a in arguments],
)
def test_wrong_arguments_are_named(function, given, argument, kind, things, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = list(function.__code__.co_varnames) if hasattr(function, "__code__") else []
    if not names:
        names = list(function.__init__.__code__.co_varnames)[1:]
    known = {name: things.get(value, value) if isinstance(value, str) else value
             for name, value in zip(names, given)}
    refuses(lambda **wrong: function(**{**known, **wrong}), argument, kind)
    assert not list(tmp_path.iterdir())


FLAGS = {
    "planner": ["keeps_clear", "goes_backwards", "is_random", "replace"],
    "controller": ["needs_plan", "replace"],
    "plant": ["replace"],
    "metric": ["located", "headline", "replace"],
    "requirement": ["replace"],
}


class Car:
    def __init__(self, setup):
        pass

    def step(self, steering, acceleration):
        pass

    def state(self):
        return {}


@pytest.mark.parametrize("kind", FLAGS)
def test_wrong_arguments_of_decorators_are_named(kind):
    register = getattr(trackbed, kind)
    own = Car if kind == "plant" else lambda seen: 0.0
    use = lambda **wrong: register(**{"name": "test_arguments", **wrong})(own)  # noqa: E731
    for argument in FLAGS[kind]:
        refuses(use, argument, "flag")
    for argument in {"planner": ["keys"], "controller": ["keys"]}.get(kind, []):
        refuses(use, argument, "dict")
    if kind in ("metric", "requirement"):
        refuses(use, "unit", "text")
    if kind == "planner":
        refuses(use, "min_waypoints", "whole")
    if kind == "controller":
        refuses(use, "station", "text")


@pytest.mark.parametrize("value", WRONG["text"])
def test_wrong_keys_are_missing_keys(value, things):
    for table in (things[RUN], things[RUN]["kinematic"], things[SWEEP], things[COMPARISON]):
        with pytest.raises((KeyError, TypeError)):
            table[value]
    assert 3 not in things[RUN] and 3 not in things[RUN]["kinematic"]


@pytest.mark.parametrize("value", ["\udc80", object(), [object()], {"a": {1}}, math.nan, [math.inf]])
def test_wrong_overrides_are_named(value):
    with pytest.raises((TypeError, ValueError), match=r"mission\.speed"):
        trackbed.run("three_turns", set={"mission.speed": value})


def test_overrides_may_be_rows_and_numbers_of_any_library():
    deque = collections.deque([(1, 2), numpy.ones(2), array.array("d", [3])])
    rows = {"a": range(3), "b": deque, "c": fractions.Fraction(1, 4)}
    expected = ["a=[0, 1, 2]", "b=[[1, 2], [1.0, 1.0], [3.0]]", "c=0.25"]
    assert trackbed._arguments.overrides(rows) == expected


@pytest.mark.parametrize("values", [iter([1]), zip([0], [1]), (x for x in [1])])
def test_an_override_that_can_be_read_once_is_refused(values):
    with pytest.raises(TypeError, match=r"set\['a'\] is a \w+, which can be read once; give a list"):
        trackbed._arguments.overrides({"a": values})


@pytest.mark.parametrize(
    "kind, source",
    [
        (trackbed.Run, "trackbed.run"),
        (trackbed.Path, "run.path"),
        (trackbed.Comparison, "trackbed.compare"),
        (trackbed.Sweep, "trackbed.sweep"),
        (trackbed.PlanRequest, "a planner receives a PlanRequest"),
    ],
)
def test_results_that_are_constructed_name_their_function(kind, source):
    with pytest.raises(TypeError, match=rf"trackbed\.{kind.__name__} takes no str; {source}"):
        kind("three_turns")
    with pytest.raises(TypeError, match=r"trackbed\.Log takes no dict; run\[plant\] returns a Log"):
        trackbed.Log({"x_m": [1.0]}, "mujoco")
    with pytest.raises(TypeError, match=r"trackbed\.LoopState takes no int; loop\.state returns"):
        trackbed.LoopState(1, 2, "mujoco")


def test_a_check_without_a_bound_is_refused(things):
    with pytest.raises(ValueError, match="give at least one of position, heading"):
        trackbed.differs_by_at_most(things[COMPARISON])


def test_a_report_leaves_no_warning(things):
    run = trackbed.run("three_turns", plants="kinematic")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run.report()
        del run
