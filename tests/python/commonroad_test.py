"""The example docs/examples/python/commonroad_planner.py, where the CommonRoad Route Planner is installed.

Runs the example in another process, because the planner brings its own NumPy.
"""

import os
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = pathlib.Path(os.environ["TRACKBED_PROGRAM"]).parent / "commonroad_packages"
DRIVE = """
import sys
import commonroad_planner, trackbed

file = sys.argv[1]
plan = {"method": "commonroad_route", "lanelets": file}
run = trackbed.run(file, plants=["kinematic", "mujoco"], set={"plan": plan})
assert run.passed, run.verdict
assert run.plan["method"] == "commonroad_route"
# Columns have steps, also with NumPy 2 of the planner's packages.
assert run["kinematic"]["s_m"][-1] > run["kinematic"]["s_m"][0], run["kinematic"]["s_m"].strides
try:
    trackbed.run(file, plants=["kinematic"], set={"plan": {**plan, "lanelets": "none.xml"}})
except trackbed.PluginError as error:
    assert "plan.lanelets is 'none.xml'; must be a CommonRoad file" in str(error), error
else:
    raise AssertionError("a missing file is accepted")
"""


@pytest.mark.skipif(not (PACKAGES / "installed.txt").exists(), reason="scripts/setup python-tests")
def test_a_planner_of_commonroad_meets_the_goal(tmp_path):
    folders = [ROOT / "docs/examples/python", PACKAGES, *filter(None, sys.path)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, folders))}
    file = ROOT / "scenarios/roads/two_lanes.xml"
    driven = subprocess.run([sys.executable, "-c", DRIVE, file], capture_output=True, text=True,
                            cwd=tmp_path, env=environment, check=False)
    assert driven.returncode == 0, driven.stderr
