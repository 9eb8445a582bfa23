"""Environments for Gymnasium: a car that follows a path.

    import gymnasium
    import trackbed.gym                      # registers the environments

    env = gymnasium.make("trackbed/PathTracking-v0", scenario="three_turns", plant="mujoco")
    envs = gymnasium.make_vec("trackbed/PathTracking-v0", num_envs=64, plant="kinematic")
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Optional, Union

import gymnasium
import numpy
import numpy.typing
from gymnasium.vector.utils import batch_space

from . import _trackbed
from ._arguments import (
    Array,
    Floats,
    Overrides,
    Scenario,
    array,
    changes,
    items,
    listed,
    mapping,
    number,
    positive,
    similar,
    text,
    texts,
    type_name,
    whole,
)
from ._loops import Loop, Observation, VectorLoop
from ._runs import frame, pixels

if int(gymnasium.__version__.partition(".")[0]) < 1:
    raise ImportError(
        f"trackbed.gym needs Gymnasium 1.0 or newer, not {gymnasium.__version__}: "
        "pip install 'gymnasium>=1.0'"
    )

Observed = numpy.typing.NDArray[numpy.float32]
"""Observations of the environments."""
Actions = numpy.typing.NDArray[Any]
"""Actions of the environments."""
PerCar = numpy.typing.NDArray[Any]
"""Numbers or flags, one for each car."""

OBSERVED = (
    "speed_mps",
    "yaw_rate_radps",
    "steering_actuator_rad",
    "cross_track_m",
    "heading_error_rad",
    "curvature_radpm",
    "planned_speed_mps",
)
"""Columns of VectorLoop.columns that the environments observe by default."""

COSTS: Mapping[str, float] = {"cross_track_m": 1.0, "heading_error_rad": 1.0}
"""Weights of squared columns that the environments subtract from the reward by default."""


class _Tracking:
    """Arguments, spaces, rewards and pictures of both environments."""

    def __init__(
        self,
        scenario: Scenario = "three_turns",
        plant: Optional[str] = None,
        set: Overrides = None,
        *,
        observed: Sequence[str] = OBSERVED,
        ahead: Floats = (2.0, 5.0, 10.0),
        costs: Mapping[str, float] = COSTS,
        rewards: Mapping[str, float] = {},
        max_cross_track: float = 5.0,
        max_acceleration: Optional[float] = None,
        render_mode: Optional[str] = None,
        size: tuple[int, int] = (640, 360),
        camera: str = "chase",
    ) -> None:
        self._scenario, self._plant = scenario, plant
        self._set = {} if set is None else dict(mapping("set", set, "keys and values"))
        self._observed = [_column("observed", name) for name in texts("observed", observed)]
        if isinstance(ahead, (str, bytes)) or not isinstance(ahead, Iterable):
            raise TypeError(f"ahead must be a list of numbers, not {type_name(ahead)}")
        self._ahead = numpy.array([number("ahead", d) for d in items("ahead", ahead)], dtype=float)
        weights = mapping("costs", costs, "columns and weights")
        self._costs = {_column("costs", c): number(f"costs[{c!r}]", w) for c, w in weights.items()}
        weights = mapping("rewards", rewards, "metrics and weights")
        self._rewards = {_metric(m): number(f"rewards[{m!r}]", w) for m, w in weights.items()}
        self._max_cross_track = positive("max_cross_track", max_cross_track)
        self._max_acceleration = (
            None if max_acceleration is None else positive("max_acceleration", max_acceleration)
        )
        if render_mode is not None and (
            not isinstance(render_mode, str) or render_mode != "rgb_array"
        ):
            raise ValueError(f"render_mode is {render_mode!r}; must be None or 'rgb_array'")
        self.render_mode = render_mode
        self._size = pixels("size", size)
        self._camera = text("camera", camera)
        self._keeps_log = bool(self._rewards) or render_mode is not None
        actions = 1 if self._max_acceleration is None else 2
        width = len(self._observed) + len(self._ahead)
        self._actions = gymnasium.spaces.Box(-1.0, 1.0, (actions,), numpy.float32)
        self._observations = gymnasium.spaces.Box(-numpy.inf, numpy.inf, (width,), numpy.float32)
        self._start()

    def _start(self) -> None:
        """Makes the cars and the spaces from the checked arguments."""
        raise NotImplementedError

    def _metadata(self, loop: Loop) -> dict[str, Any]:
        """Returns the properties of an environment with this loop."""
        if loop.path_length == 0.0:
            raise ValueError("scenario has no path to follow; it must have a plan section")
        return {"render_modes": ["rgb_array"], "render_fps": max(1, round(1.0 / loop.period))}

    def _reset(
        self, loop: Loop, seed: Optional[int], changed: Optional[Mapping[str, Any]]
    ) -> Observation:
        """Returns a loop to its start, with other values of the scenario if any are given."""
        if seed is None and changed is None:
            return loop.reset()
        return loop.reset(seed, {**self._set, **(changed or {})})

    def _reward_at_end(self, loop: Loop) -> float:
        """Returns the weighted sum of the metrics of a finished episode."""
        if not self._rewards:
            return 0.0
        values = loop.result().metric_values(loop.plant)
        return sum(w * _value(name, values.get(name)) for name, w in self._rewards.items())

    def _draw(self, loop: Loop) -> numpy.typing.NDArray[numpy.uint8]:
        """Draws the car of a loop at the present moment."""
        run = loop.result()
        return frame(run, float(run[loop.plant]["t_s"][-1]), self._size, camera=self._camera)


class PathTracking(_Tracking, gymnasium.Env[Observed, Actions]):
    """A car that follows the path of a scenario; a step is one control period.

    Action: an array of float32 in [-1, 1] with the shape (1,), or (2,) if `max_acceleration` is
        given. The first number is the steering angle as a fraction of the car's largest angle,
        positive to the left. The second is the acceleration as a fraction of `max_acceleration`,
        positive if the car speeds up in the direction of its gear. Without an acceleration, the car
        follows the speeds of the plan.
    Observation: an array of float32 with the columns `observed` of VectorLoop.columns, in SI units,
        followed by the curvature [1/m] of the path at the distances `ahead` [m] before the car. NaN
        is observed as 0.
    Reward: minus the sum over `costs` of weight times squared column, after the step. The last step
        of an episode adds the sum over `rewards` of weight times metric, for the episode so far. The
        metrics have the names of `expect.metrics`, such as "cross_track.max"; an undefined metric
        counts as 0.
    Terminated: the run has ended other than by its time limit, or the cross-track error exceeds
        `max_cross_track` [m]. Truncated: the run has reached its time limit (drive.time_limit).
    Info: "status", how the run ended, such as "arrived"; None while it continues; and "t_s" [s].

    reset(seed=n) sets the scenario's seed, which selects the noise and the random planners;
    reset(options={"set": {...}}) reads the scenario with other values. Both plan again. Without
    options, the car returns to its start.

    With render_mode="rgb_array", render() draws the car off-screen: an array of uint8 with the shape
    (height, width, 3). `size` is (width, height) [px], `camera` one of `trackbed render`. A picture
    takes about 0.3 s; `trackbed.film(env.get_wrapper_attr("loop").result(), FILE)` films a whole
    episode faster.

    scenario, plant, set: those of trackbed.Loop. The scenario must have a path.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 50}

    def _start(self) -> None:
        self._loop = Loop(self._scenario, self._plant, self._set, log=self._keeps_log)
        self.metadata: dict[str, Any] = self._metadata(self._loop)
        self.action_space: gymnasium.Space[Actions] = self._actions
        self.observation_space: gymnasium.Space[Observed] = self._observations

    @property
    def loop(self) -> Loop:
        """The loop that the environment steps."""
        return self._loop

    def _observe(self, seen: Observation) -> Observed:
        own = [getattr(seen, name) for name in self._observed]
        points = self._loop.reference(seen.station_m + self._ahead)
        values = numpy.concatenate([own, points["curvature_radpm"]])
        return _observed_values(values)

    @staticmethod
    def _info(seen: Observation) -> dict[str, Any]:
        return {"status": seen.status, "t_s": seen.t_s}

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[Observed, dict[str, Any]]:
        """Returns the car to its start, and returns the first observation and info."""
        super().reset(seed=None if seed is None else whole("seed", seed, 0))
        seen = self._reset(self._loop, seed, changes(options))
        return self._observe(seen), self._info(seen)

    def step(
        self, action: Actions
    ) -> tuple[Observed, float, bool, bool, dict[str, Any]]:
        """Simulates one control period with an action of shape (1,) or (2,), in [-1, 1].

        Returns the observation, reward, terminated, truncated and info.
        """
        command = numpy.clip(array("action", action, self.action_space.shape or ()), -1.0, 1.0)
        acceleration = None
        if self._max_acceleration is not None:
            acceleration = float(command[1]) * self._max_acceleration
        seen = self._loop.step(float(command[0]) * self._loop.steering_limit, acceleration)
        cost = sum(w * _square(getattr(seen, c)) for c, w in self._costs.items())
        truncated = seen.status == "time_limit"
        left_path = abs(seen.cross_track_m) > self._max_cross_track
        terminated = bool(left_path or (seen.ended and not truncated))
        reward = -float(cost)
        if terminated or truncated:
            reward += self._reward_at_end(self._loop)
        return self._observe(seen), reward, terminated, truncated, self._info(seen)

    def render(self) -> Any:
        """Returns a picture of the car, an array of uint8 with the shape (height, width, 3)."""
        if self.render_mode is None:
            gymnasium.logger.warn('render() needs gymnasium.make(..., render_mode="rgb_array")')
            return None
        return self._draw(self._loop)


class VectorPathTracking(
    _Tracking, gymnasium.vector.VectorEnv[Observed, Actions, PerCar]
):
    """Many cars of PathTracking, which are stepped together on several threads without the GIL.

    gymnasium.make_vec makes this class. Every car has the observations and rewards of PathTracking,
    and its episodes end as those of PathTracking. A car whose episode has ended returns to its
    start in the next step, whose reward is 0 (AutoresetMode.NEXT_STEP).

    num_envs: number of cars. threads: number of threads; by default, the number of processors. The
    other arguments are those of PathTracking. reset(seed=n) gives car i the seed n + i; a list has
    one seed for each car. render() returns a tuple with a picture of each car.
    """

    def __init__(
        self, num_envs: int = 1, *arguments: Any, threads: Optional[int] = None, **named: Any
    ) -> None:
        self.num_envs: int = whole("num_envs", num_envs, 1)
        self._threads = threads
        super().__init__(*arguments, **named)

    def _start(self) -> None:
        self._cars = VectorLoop(
            self._scenario,
            self._plant,
            self.num_envs,
            set=self._set,
            threads=self._threads,
            log=self._keeps_log,
        )
        self.metadata: dict[str, Any] = self._metadata(self._cars.loops[0])
        modes = getattr(gymnasium.vector, "AutoresetMode", None)  # Since Gymnasium 1.1.
        if modes is not None:
            self.metadata["autoreset_mode"] = modes.NEXT_STEP
        self.single_action_space: gymnasium.Space[Any] = self._actions
        self.single_observation_space: gymnasium.Space[Any] = self._observations
        self.action_space: gymnasium.Space[Any] = batch_space(self._actions, self.num_envs)
        self.observation_space: gymnasium.Space[Any] = batch_space(self._observations, self.num_envs)
        self._column = {name: i for i, name in enumerate(VectorLoop.columns)}
        self._indices = [self._column[name] for name in self._observed]
        self._done = numpy.zeros(self.num_envs, dtype=bool)

    @property
    def loops(self) -> tuple[Loop, ...]:
        """The loops that the environment steps."""
        return self._cars.loops

    def _observe(self, seen: Array) -> Observed:
        ahead = self._cars.curvature_ahead(self._ahead)
        values = numpy.concatenate([seen[:, self._indices], ahead], axis=1)
        return _observed_values(values)

    def _info(self, seen: Array, statuses: list[Optional[str]]) -> dict[str, Any]:
        every = numpy.ones(self.num_envs, dtype=bool)
        return {
            "status": numpy.array(statuses, dtype=object),
            "_status": every,
            "t_s": seen[:, self._column["t_s"]].copy(),
            "_t_s": every.copy(),
        }

    def reset(
        self,
        *,
        seed: Union[int, Sequence[Optional[int]], None] = None,
        options: Optional[dict[str, Any]] = None,
    ) -> tuple[Observed, dict[str, Any]]:
        """Returns all cars to their starts, and returns the first observations and infos."""
        changed = changes(options)
        if seed is None:
            seeds: list[Optional[int]] = [None] * self.num_envs
        elif isinstance(seed, (Sequence, numpy.ndarray)) and not isinstance(seed, (str, bytes)):
            named = enumerate(listed("seed", seed, self.num_envs))
            seeds = [None if s is None else whole(f"seed[{i}]", s, 0) for i, s in named]
        else:
            first = whole("seed", seed, 0)
            super().reset(seed=first)
            seeds = [first + i for i in range(self.num_envs)]
        for loop, one in zip(self._cars.loops, seeds):
            self._reset(loop, one, changed)
        self._done[:] = False
        seen = self._cars.observations
        return self._observe(seen), self._info(seen, self._cars.statuses)

    def step(
        self, actions: Actions
    ) -> tuple[Observed, PerCar, PerCar, PerCar, dict[str, Any]]:
        """Simulates one control period with actions of shape (num_envs, 1) or (num_envs, 2).

        Returns observations, rewards, terminated, truncated and infos, with one row for each car.
        """
        cars = self._cars
        commands = numpy.clip(array("actions", actions, self.action_space.shape or ()), -1.0, 1.0)
        limits = numpy.array([loop.steering_limit for loop in cars.loops])
        rates = None if self._max_acceleration is None else commands[:, 1] * self._max_acceleration
        seen = cars.step(commands[:, 0] * limits, rates)
        restarted = self._done
        if restarted.any():
            for i in numpy.flatnonzero(restarted):
                cars.loops[i].reset()
            seen = cars.observations
        statuses = cars.statuses
        truncated = numpy.array([status == "time_limit" for status in statuses])
        ended = numpy.array([status is not None for status in statuses])
        left_path = numpy.abs(seen[:, self._column["cross_track_m"]]) > self._max_cross_track
        terminated = (left_path | (ended & ~truncated)) & ~restarted
        truncated &= ~restarted
        cost = numpy.zeros(self.num_envs)
        for name, weight in self._costs.items():
            cost = cost + weight * _square(seen[:, self._column[name]])
        rewards = numpy.where(restarted, 0.0, -cost)
        self._done = terminated | truncated
        for i in numpy.flatnonzero(self._done):
            rewards[i] += self._reward_at_end(cars.loops[i])
        return self._observe(seen), rewards, terminated, truncated, self._info(seen, statuses)

    def render(self) -> Any:
        """Returns a tuple with a picture of each car, as PathTracking.render does."""
        if self.render_mode is None:
            gymnasium.logger.warn('render() needs gymnasium.make_vec(..., render_mode="rgb_array")')
            return None
        return tuple(self._draw(loop) for loop in self._cars.loops)


def _column(argument: str, name: object) -> str:
    if text(f"a name in {argument}", name) not in VectorLoop.columns:
        known = VectorLoop.columns
        hint = similar(name, known) or f"; allowed: {', '.join(known)}"
        raise ValueError(f"{argument} has the unknown column {name!r}{hint}")
    return str(name)


def _metric(name: object) -> str:
    known = _trackbed.metric_names()
    if text("a name in rewards", name) not in known:
        hint = similar(name, known) or f"; allowed: {', '.join(known)}"
        raise ValueError(f"rewards has the unknown metric {name!r}{hint}")
    return str(name)


def _observed_values(values: Array) -> Observed:
    """Returns observed values as float32, with NaN as 0."""
    result: Observed = numpy.nan_to_num(values, nan=0.0).astype(numpy.float32)
    return result


def _square(values: Any) -> Any:
    """Returns the squares; those of NaN are 0. `**` would round numbers and arrays differently."""
    known = numpy.nan_to_num(values, nan=0.0)
    return known * known


def _value(name: str, value: Any) -> float:
    if isinstance(value, str):
        raise ValueError(f"rewards has the metric {name!r}, which is a text; must be a number")
    return 0.0 if value is None else float(value)


gymnasium.register(
    "trackbed/PathTracking-v0",
    entry_point="trackbed.gym:PathTracking",
    vector_entry_point="trackbed.gym:VectorPathTracking",
)
