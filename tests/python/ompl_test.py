"""The example docs/examples/python/ompl_planner.py, where OMPL 2 is installed."""

import pathlib

import pytest

pytest.importorskip("ompl.base")
EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "docs/examples/python"


def test_a_planner_of_ompl_avoids_obstacles(monkeypatch):
    import trackbed

    monkeypatch.syspath_prepend(str(EXAMPLES))
    import ompl_planner  # noqa: F401  Registers the planner.

    box = {"box": {"x": 20, "y": 0, "length": 4, "width": 4, "height": 1}}
    change = {
        "plan": {"method": "ompl", "safe_distance": 0.5},
        "mission": {"speed": 3, "start": {"speed": 0}, "waypoints": [[0, 0], [50, 0]]},
        "world.obstacles": [box],
        "expect": {"reach_goal": 1.0, "max_cross_track": 0.5},
    }
    run = trackbed.run("three_turns", plants=["kinematic", "mujoco"], set=change)
    assert run.passed, run.verdict
    trackbed.keeps_clearance(run, 0.1)
