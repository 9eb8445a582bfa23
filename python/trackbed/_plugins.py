"""Planners, controllers and plants that are written in Python.

Each decorator checks the signature of a function or class, and registers an adapter. C++ calls the
adapter, which checks what the user's code returns, so that an error names the wrong value.
"""

from __future__ import annotations

import copy
import inspect
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Callable, Optional, TypeVar

import numpy

from . import _trackbed
from ._arguments import (
    INT_MAX,
    Array,
    Floats,
    array,
    doubles,
    flag,
    number,
    require_core,
    text,
    texts,
    type_name,
    whole,
)
from ._signatures import (
    NAME,
    Key,
    keys_of,
    name_of,
    parameters_of,
    register_plugin,
    require_method,
    require_plain,
    returned,
)

PluginError = _trackbed.PluginError
Vehicle = _trackbed.Vehicle
PlantSetup = _trackbed.PlantSetup
ControllerInput = _trackbed.ControllerInput


def _copied(own: Any) -> Any:
    """Returns a copy of the user's object for a saved state."""
    try:
        return copy.deepcopy(own)
    except TypeError as error:
        raise TypeError(
            f"Loop.state copies {type_name(own)} with copy.deepcopy: {error}; give the class a method "
            "__deepcopy__(self, memo)"
        ) from error


class NoPath(Exception):
    """Raised by a planner if the mission has no path; the text is the reason in plan.json."""


_F = TypeVar("_F", bound=Callable[..., Any])
_Class = TypeVar("_Class", bound=type)


class PlannedPath:
    """The result of a planner.

    points: positions of the rear-axle center [m] in the order of travel, an array with the shape
        (n, 2), or (n, 3) with the yaw [rad] of the car. The car drives in reverse where its yaw is
        opposite to the step to the next point. The path is the smoothest curve within
        `max_deviation` of every point.
    speed: largest speeds at the points [m/s], at least 0; by default the mission's speed.
    notes: remarks, which the run shows.
    max_deviation: largest distance of the path from the points [m].
    """

    def __init__(
        self,
        points: Any,
        *,
        speed: Optional[Floats] = None,
        notes: Sequence[str] = (),
        max_deviation: float = 0.05,
    ) -> None:
        if isinstance(points, Iterator):
            points = list(points)
        self.points: Array = doubles("points", points).copy()
        shape = self.points.shape
        if len(shape) != 2 or shape[1] not in (2, 3):
            raise ValueError(f"points has the shape {shape}; must be (n, 2) or (n, 3)")
        if shape[0] < 2:
            raise ValueError(f"points has {shape[0]} rows; must have at least 2")
        if not numpy.isfinite(self.points).all():
            row = int(numpy.argwhere(~numpy.isfinite(self.points))[0][0])
            raise ValueError(f"points[{row}] is {self.points[row].tolist()}; must be finite")
        self.speed: Optional[list[float]] = (
            None if speed is None else array("speed", speed, (shape[0],)).tolist()
        )
        if self.speed is not None and min(self.speed) < 0.0:
            raise ValueError(f"speed has the value {min(self.speed)}; must be at least 0")
        self.notes: list[str] = texts("notes", notes)
        self.max_deviation: float = number("max_deviation", max_deviation)
        if self.max_deviation <= 0.0:
            raise ValueError(f"max_deviation is {max_deviation}; must be above 0")


class PlanRequest:
    """The input of a planner: the mission, the car and the obstacles.

    waypoints: shape (n, 2) [m], the first is the start of the route. headings: required yaw at
    each waypoint [rad], or empty. start: (x, y, yaw) of the rear-axle center [m, m, rad], where the
    path must begin. start_speed [m/s], start_steering [rad]. speed: the mission's speed [m/s].
    obstacles: shape (m, 5), rows of x, y, yaw, length and width of rectangles [m, m, rad, m, m].
    vehicle: the car (wheelbase, length, width, rear_overhang, min_turning_radius, ...), SI units.
    friction: factor on the tyres' friction. seed: for random numbers. max_waypoint_miss: largest
    distance of the path from a waypoint [m], or None.
    """

    def __init__(self, core: _trackbed.PlanRequest) -> None:
        require_core(self, core, _trackbed.PlanRequest, "a planner receives")
        self._core = core
        self.waypoints: Array = core.waypoints
        self.headings: list[float] = core.headings
        self.start: tuple[float, float, float] = core.start
        self.start_speed: float = core.start_speed
        self.start_steering: float = core.start_steering
        self.speed: float = core.speed
        self.obstacles: Array = core.obstacles
        self.vehicle: Vehicle = core.vehicle
        self.friction: float = core.friction
        self.seed: int = core.seed
        self.max_waypoint_miss: Optional[float] = core.max_waypoint_miss

    def clearance(self, poses: Any) -> Array:
        """Returns the distance [m] of the car's footprint from the nearest obstacle at each pose.

        poses: shape (n, 3), x, y and yaw of the rear-axle center. Negative where they overlap; at
        most the car's length, and at most 4 m.
        """
        count = numpy.shape(poses)[0] if numpy.ndim(poses) == 2 else -1
        return self._core.clearance(array("poses", poses, (max(count, 0), 3)))


# Planners


class _PlannerAdapter:
    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function

    def plan(self, core: _trackbed.PlanRequest, keys: dict[str, Any]) -> dict[str, Any]:
        try:
            path = self._function(PlanRequest(core), **keys)
        except NoPath as reason:
            return {"no_path": str(reason) or "the planner found no path"}
        if path is None:
            raise TypeError("the planner returned None; return points, or raise trackbed.NoPath")
        planned = path if isinstance(path, PlannedPath) else PlannedPath(path)
        return {
            "no_path": None,
            "points": planned.points,
            "speed": planned.speed,
            "max_deviation": planned.max_deviation,
            "notes": planned.notes,
        }


def planner(
    name: str,
    *,
    keys: Mapping[str, Key] = {},
    min_waypoints: int = 2,
    keeps_clear: bool = False,
    goes_backwards: bool = False,
    is_random: bool = False,
    replace: bool = False,
) -> Callable[[_F], _F]:
    """Registers a function as a planner, for `plan: {method: NAME}`.

        @trackbed.planner("sidestep")
        def sidestep(request, *, offset: float = 3.5):
            return numpy.array(...)

    The function receives a PlanRequest, and returns a PlannedPath, or its points alone. The path is
    fitted, its speeds are planned, and its feasibility is checked as for all planners. Keyword
    parameters are keys of the section `plan`; `keys` gives their units and ranges.

    min_waypoints: least number of waypoints of the mission, with the start; 0 if the planner
    defines its own course. keeps_clear: whether it avoids obstacles. goes_backwards: whether paths
    may have reverse pieces. is_random: whether the path depends on the seed.
    """
    own = name_of("planner", name)

    def register(function: _F) -> _F:
        what = f"planner {own!r}"
        if isinstance(function, type):
            raise TypeError(f"{what} must be a function, not the class {function.__name__}")
        require_plain(what, function, yields=True)
        specs = keys_of(what, parameters_of(what, function, ["request"]), keys, "plan")
        register_plugin(
            "planner",
            own,
            function,
            _PlannerAdapter(function),
            specs,
            replace,
            _trackbed.register_planner,
            min_waypoints=whole("min_waypoints", min_waypoints, 0, INT_MAX),
            keeps_clear=flag("keeps_clear", keeps_clear),
            goes_backwards=flag("goes_backwards", goes_backwards),
            is_random=flag("is_random", is_random),
        )
        return function

    return register


# Controllers


class _Function:
    """A function with one parameter as an object with the method `step`."""

    def __init__(self, function: Callable[..., Any], keys: dict[str, Any]) -> None:
        self._function, self._keys = function, keys

    def step(self, seen: ControllerInput) -> Any:
        return self._function(seen, **self._keys)


class _ControllerObject:
    def __init__(self, own: Any) -> None:
        self._own = own
        columns = getattr(own, "columns", ())
        if isinstance(columns, str) or not isinstance(columns, Sequence):
            raise TypeError(f"columns must be a list of names, not {type_name(columns)}")
        for name in columns:
            if not NAME.fullmatch(text("a name in columns", name)):
                raise ValueError(f"columns has the name {name!r}; must be of a-z, 0-9 and '_'")
            if name in _trackbed.log_columns or list(columns).count(name) > 1:
                raise ValueError(f"columns has the name {name!r}, which the log already has")
        self.columns = list(columns)

    def step(self, seen: ControllerInput) -> tuple[float, Optional[float], Any]:
        command = self._own.step(seen)
        if isinstance(command, numpy.ndarray) and command.ndim == 1:
            command = command.tolist()
        acceleration = None
        if isinstance(command, (tuple, list)):
            if len(command) != 2:
                raise ValueError(
                    f"step returned {len(command)} values; must return the steering angle, or "
                    "(steering angle, acceleration)"
                )
            command, acceleration = command
        steering = returned("step", command, "the steering angle [rad]")
        if acceleration is not None:
            acceleration = returned("step", acceleration, "the acceleration [m/s^2]")
        values = None
        if self.columns:
            own = getattr(self._own, "values", None)
            if own is None:
                raise TypeError(f"step must set values, one number for each of {self.columns}")
            values = array("values", own, (len(self.columns),), finite=False).tolist()
        return steering, acceleration, values

    def copy(self) -> _ControllerObject:
        return _ControllerObject(_copied(self._own))


class _ControllerAdapter:
    def __init__(self, own: Callable[..., Any]) -> None:
        self._own = own

    def make(self, keys: dict[str, Any]) -> _ControllerObject:
        made = self._own(**keys) if isinstance(self._own, type) else _Function(self._own, keys)
        return _ControllerObject(made)


def controller(
    name: str,
    *,
    keys: Mapping[str, Key] = {},
    needs_plan: bool = True,
    station: str = "projection",
    replace: bool = False,
) -> Callable[[_F], _F]:
    """Registers a class or a function as a controller, for `control: {method: NAME}`.

        @trackbed.controller("proportional")
        class Proportional:
            def __init__(self, *, gain: float = 0.2):
                self.gain = gain

            def step(self, seen):
                return -self.gain * seen.cross_track_m - seen.heading_error_rad

    Once per control period, `step` receives a ControllerInput: the fields of an Observation, and
    `seen.period` [s], `seen.vehicle` and `seen.reference(stations)`. It returns the steering angle
    [rad], positive to the left, or (steering angle, acceleration [m/s^2]). A function has the
    parameters (seen, *, keys). Keyword parameters are keys of the section `control`.

    An object may have `columns`, names of further columns of the log, and then sets `values`, one
    number for each column, in every step. Loop.state copies the object with copy.deepcopy.

    needs_plan: whether the scenario needs a plan. station: "projection", the nearest point of the
    path, or "odometer", the driven distance.
    """
    own = name_of("controller", name)
    if text("station", station) not in ("projection", "odometer"):
        raise ValueError(f"station is {station!r}; must be 'projection' or 'odometer'")

    def register(function: _F) -> _F:
        what = f"controller {own!r}"
        if isinstance(function, type):
            require_method(what, function, "step", ["seen"])
            parameters = parameters_of(what, function, [])
        else:
            require_plain(what, function)
            parameters = parameters_of(what, function, ["seen"])
        specs = keys_of(what, parameters, keys, "control")
        register_plugin(
            "controller",
            own,
            function,
            _ControllerAdapter(function),
            specs,
            replace,
            _trackbed.register_controller,
            needs_plan=flag("needs_plan", needs_plan),
            odometer=station == "odometer",
        )
        return function

    return register


# Plants

_POSE = ("x_m", "y_m", "yaw_rad")


class _PlantObject:
    def __init__(self, own: Any) -> None:
        self._own = own
        step = inspect.signature(own.step)
        self._takes_gear = "gear" in step.parameters

    def step(self, steering: float, acceleration: float, gear: int) -> tuple[Any, ...]:
        if self._takes_gear:
            self._own.step(steering, acceleration, gear=gear)
        else:
            self._own.step(steering, acceleration)
        return self.state()

    def state(self) -> tuple[Any, ...]:
        state = self._own.state()
        if not isinstance(state, Mapping):
            raise TypeError(f"state must return a dict of columns, not {type_name(state)}")
        for name in (*_POSE, "speed_mps"):
            if name not in state:
                raise ValueError(f"state returned no {name!r}")
        known = (*_POSE, *_trackbed.state_columns)
        for name in state:
            if name not in known:
                raise ValueError(f"state returned {name!r}; the columns are {', '.join(known)}")
        return tuple(
            returned("state", state[name], name) if name in state else None for name in known
        )

    def offset(self, left: float) -> tuple[Any, ...]:
        if not hasattr(self._own, "offset"):
            raise TypeError("the scenario displaces the car, but the plant has no offset(self, left)")
        self._own.offset(left)
        return self.state()

    def push(self, force: float) -> None:
        if hasattr(self._own, "push"):
            self._own.push(force)

    def copy(self) -> _PlantObject:
        return _PlantObject(_copied(self._own))


class _PlantAdapter:
    def __init__(self, own: type) -> None:
        self._own = own

    def make(self, setup: PlantSetup) -> _PlantObject:
        return _PlantObject(self._own(setup))


def plant(name: str, *, replace: bool = False) -> Callable[[_Class], _Class]:
    """Registers a class as a plant, for `drive: {plants: [NAME]}`.

        @trackbed.plant("my_car")
        class MyCar:
            def __init__(self, setup): ...
            def step(self, steering, acceleration): ...
            def state(self): return {"x_m": ..., "y_m": ..., "yaw_rad": ..., "speed_mps": ...}

    setup is a PlantSetup: `timestep` [s], `vehicle`, `friction`, and the start `x_m`, `y_m`,
    `yaw_rad`, `speed_mps` and `steering_rad` of the rear-axle center. `step` advances by one
    timestep with the commanded steering angle [rad] and acceleration [m/s^2]; with a parameter
    `gear`, it also receives +1 or -1. `state` returns the columns of the log at the present time.
    Missing columns are 0, except the yaw rate, which follows from the yaw, and the steering angles,
    which are the command. The yaw must not be wrapped.

    Optional methods: `offset(left)` displaces the car [m], `push(force)` applies a lateral force
    [N] during the next step. Loop.state copies the object with copy.deepcopy.
    """
    own = name_of("plant", name)

    def register(function: _Class) -> _Class:
        what = f"plant {own!r}"
        if not isinstance(function, type):
            raise TypeError(f"{what} must be a class, not {type_name(function)}")
        if parameters_of(what, function, ["setup"], keys=False):
            raise TypeError(f"{what} must have no keyword parameters, because plants have no keys")
        parameters = inspect.signature(getattr(function, "step", lambda self: None)).parameters
        gear = ["gear"] if "gear" in parameters else []
        require_method(what, function, "step", ["steering", "acceleration", *gear])
        require_method(what, function, "state", [])
        adapter = _PlantAdapter(function)
        register_plugin("plant", own, function, adapter, [], replace, _trackbed.register_plant)
        return function

    return register


__all__ = [
    "ControllerInput",
    "Key",
    "NoPath",
    "PlanRequest",
    "PlannedPath",
    "PlantSetup",
    "PluginError",
    "Vehicle",
    "controller",
    "planner",
    "plant",
]
