"""Environment for Gymnasium: a car that follows a path.

    import gymnasium
    import trackbed.gym                      # registers the environment

    env = gymnasium.make("trackbed/PathTracking-v0", scenario="three_turns", plant="mujoco")
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Optional

import gymnasium
import numpy

from ._arguments import (
    Overrides,
    Scenario,
    array,
    items,
    mapping,
    number,
    text,
    texts,
    type_name,
    whole,
)
from ._loops import Loop, Observation, VectorLoop

OBSERVED = (
    "speed_mps",
    "yaw_rate_radps",
    "steering_actuator_rad",
    "cross_track_m",
    "heading_error_rad",
    "curvature_radpm",
    "planned_speed_mps",
)
"""Columns of VectorLoop.columns that the environment observes by default."""


class PathTracking(gymnasium.Env[numpy.ndarray, numpy.ndarray]):
    """A car that follows the path of a scenario; a step is one control period.

    Action: an array of float32 in [-1, 1] with the shape (1,), or (2,) if `max_acceleration` is
        given: the steering angle as a fraction of the car's largest angle, positive to the left, and
        the acceleration as a fraction of `max_acceleration`, positive if the car speeds up in the
        direction of its gear. Without an acceleration, the car follows the speeds of the plan.
    Observation: an array of float32 with the columns `observed` of VectorLoop.columns, in SI units,
        followed by the curvature [1/m] of the path at the distances `ahead` [m] before the car. NaN
        is observed as 0.
    Reward: minus the sum over `costs` of weight times squared column, after the step.
    Terminated: the run has ended other than by its time limit, or the cross-track error exceeds
        `max_cross_track` [m]. Truncated: the run has reached its time limit (drive.time_limit).
    Info: "status", how the run ended, such as "arrived"; None while it continues; and "t_s" [s].

    reset(seed=n) sets the scenario's seed, which selects the noise and the random planners;
    reset(options={"set": {...}}) reads the scenario with other values. Both plan again. Without them,
    the car returns to its start.

    scenario, plant, set: those of trackbed.Loop. The scenario must have a path.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        scenario: Scenario = "three_turns",
        plant: Optional[str] = None,
        set: Overrides = None,
        *,
        observed: Sequence[str] = OBSERVED,
        ahead: Sequence[float] = (2.0, 5.0, 10.0),
        costs: Mapping[str, float] = {"cross_track_m": 1.0, "heading_error_rad": 1.0},
        max_cross_track: float = 5.0,
        max_acceleration: Optional[float] = None,
    ) -> None:
        self._observed = [_column("observed", name) for name in texts("observed", observed)]
        if isinstance(ahead, (str, bytes)) or not isinstance(ahead, Iterable):
            raise TypeError(f"ahead must be a list of numbers, not {type_name(ahead)}")
        self._ahead = numpy.array([number("ahead", d) for d in items("ahead", ahead)], dtype=float)
        weights = mapping("costs", costs, "columns and weights")
        self._costs = {_column("costs", c): number(f"costs[{c!r}]", w) for c, w in weights.items()}
        self._max_cross_track = _positive("max_cross_track", max_cross_track)
        self._max_acceleration = (
            None if max_acceleration is None else _positive("max_acceleration", max_acceleration)
        )
        self._set = {} if set is None else dict(mapping("set", set, "keys and values"))
        self._loop = Loop(scenario, plant, set, log=False)
        if self._loop.path_length == 0.0:
            raise ValueError("scenario has no path to follow; it must have a plan section")
        actions = 1 if self._max_acceleration is None else 2
        size = len(self._observed) + len(self._ahead)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (actions,), numpy.float32)
        self.observation_space = gymnasium.spaces.Box(-numpy.inf, numpy.inf, (size,), numpy.float32)

    def _observe(self, seen: Observation) -> numpy.ndarray:
        own = [getattr(seen, name) for name in self._observed]
        points = self._loop.reference(seen.station_m + self._ahead)
        values = numpy.concatenate([own, points["curvature_radpm"]])
        return numpy.nan_to_num(values, nan=0.0).astype(numpy.float32)

    @staticmethod
    def _info(seen: Observation) -> dict[str, Any]:
        return {"status": seen.status, "t_s": seen.t_s}

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[numpy.ndarray, dict[str, Any]]:
        super().reset(seed=None if seed is None else whole("seed", seed, 0))
        changed = {} if options is None else dict(mapping("options", options, "names and values"))
        own = changed.pop("set", None)
        if own is not None:
            mapping("options['set']", own, "keys and values")
        if changed:
            raise ValueError(f"options has the unknown key {next(iter(changed))!r}; allowed: 'set'")
        if seed is None and own is None:
            seen = self._loop.reset()
        else:
            seen = self._loop.reset(seed, {**self._set, **(own or {})})
        return self._observe(seen), self._info(seen)

    def step(
        self, action: numpy.ndarray
    ) -> tuple[numpy.ndarray, float, bool, bool, dict[str, Any]]:
        command = numpy.clip(array("action", action, self.action_space.shape), -1.0, 1.0)
        acceleration = None
        if self._max_acceleration is not None:
            acceleration = float(command[1]) * self._max_acceleration
        seen = self._loop.step(float(command[0]) * self._loop.steering_limit, acceleration)
        cost = sum(w * numpy.nan_to_num(getattr(seen, c)) ** 2 for c, w in self._costs.items())
        truncated = seen.status == "time_limit"
        left_path = abs(seen.cross_track_m) > self._max_cross_track
        terminated = left_path or (seen.ended and not truncated)
        return self._observe(seen), -float(cost), bool(terminated), truncated, self._info(seen)


def _column(argument: str, name: object) -> str:
    if text(f"a name in {argument}", name) not in VectorLoop.columns:
        known = ", ".join(VectorLoop.columns)
        raise ValueError(f"{argument} has the unknown column {name!r}; allowed: {known}")
    return str(name)


def _positive(name: str, value: object) -> float:
    result = number(name, value)
    if result <= 0.0:
        raise ValueError(f"{name} is {value}; must be above 0")
    return result


gymnasium.register("trackbed/PathTracking-v0", entry_point=PathTracking)
