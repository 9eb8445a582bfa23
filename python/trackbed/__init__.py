"""Vehicle testbed: plans paths, drives cars along them in simulation, measures and judges.

    import trackbed

    run = trackbed.run("three_turns", plants=["kinematic", "mujoco"], set={"mission.speed": 2})
    print(run)                                   # one line: how the plants ended
    run["mujoco"]["cross_track_m"]               # a column of the log, a NumPy array
    run.metrics["mujoco"]["cross_track"]["max"]  # the numbers of metrics.json

`Loop` steps a car by one control period at a time, `VectorLoop` steps many cars on several threads.
Quantities are in SI units and radians; the names of columns end with their units.
"""

from ._arguments import InputError, InternalError, PreconditionError, RunError
from ._arguments import version as __version__
from ._checks import (
    compare,
    differs_by_at_most,
    keeps_clearance,
    meets_its_expectations,
    reaches_goal,
    satisfies,
    stays_within,
    steers_calmly,
    tracks_within,
)
from ._loops import Loop, LoopState, Observation, VectorLoop
from ._metrics import metric, requirement
from ._plugins import (
    ControllerInput,
    Key,
    NoPath,
    PlannedPath,
    PlanRequest,
    PlantSetup,
    PluginError,
    Vehicle,
    controller,
    planner,
    plant,
)
from ._runs import Comparison, Log, Path, Run, film, frame, run
from ._sweeps import Sweep, sweep

__all__ = [
    "Comparison",
    "ControllerInput",
    "InputError",
    "InternalError",
    "Key",
    "Log",
    "Loop",
    "LoopState",
    "NoPath",
    "Observation",
    "Path",
    "PlanRequest",
    "PlannedPath",
    "PlantSetup",
    "PluginError",
    "PreconditionError",
    "Run",
    "RunError",
    "Sweep",
    "VectorLoop",
    "Vehicle",
    "__version__",
    "compare",
    "controller",
    "differs_by_at_most",
    "film",
    "frame",
    "keeps_clearance",
    "meets_its_expectations",
    "metric",
    "planner",
    "plant",
    "reaches_goal",
    "requirement",
    "run",
    "satisfies",
    "stays_within",
    "steers_calmly",
    "sweep",
    "tracks_within",
]
