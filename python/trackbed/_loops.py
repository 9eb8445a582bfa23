"""Loops that Python steps by one control period at a time."""

from __future__ import annotations

import copy
import os
from collections.abc import Mapping, Sequence
from typing import Any, NoReturn, Optional, Union

import numpy
import numpy.typing

from . import _trackbed
from ._arguments import (
    INT_MAX,
    Array,
    Floats,
    Overrides,
    Scenario,
    array,
    changes,
    flag,
    instance,
    listed,
    load,
    number,
    require_core,
    row,
    text,
    type_name,
    whole,
)
from ._runs import Log, Run

Observation = _trackbed.Observation


_NEEDS_STEERING = (
    "acceleration is given without steering; give both, or none of them to let the scenario's "
    "controller drive"
)


def _moment(seen: Observation) -> str:
    return f"{seen.status or 'driving'} at {seen.t_s:.6g} s"


class LoopState:
    """The complete state of a loop: car, controller, plan, disturbances and log."""

    def __init__(self, core: _trackbed.LoopState, prepared: _trackbed.Prepared, plant: str) -> None:
        require_core(self, core, _trackbed.LoopState, "loop.state returns")
        self._core = core
        self._prepared = prepared
        self._plant = plant

    def __copy__(self) -> LoopState:
        return self  # A state does not change.

    def __deepcopy__(self, memo: dict[int, Any]) -> LoopState:
        return self

    def __reduce__(self) -> NoReturn:
        raise TypeError("a LoopState cannot be pickled; it belongs to a loop of this process")


class Loop:
    """A car that is driven by one control period at a time.

        loop = trackbed.Loop("three_turns", plant="kinematic")
        seen = loop.reset()
        while not seen.ended:
            seen = loop.step(steering=-0.3 * seen.cross_track_m - seen.heading_error_rad)

    A loop simulates exactly what `trackbed.run` simulates: stepped without arguments, the log is
    the log of the run, bit for bit. Different loops may be stepped by different threads.

    scenario: a YAML file, or the name of a scenario that comes with the package.
    plant: name of the plant; by default the first plant of the scenario.
    set: keys of the scenario and their values.
    seed: the scenario's seed, at least 0.
    log: whether to keep all rows of the log; if false, the log only has its last row.

    A copy (copy.copy, copy.deepcopy) is another loop in the same state.

    Raises RunError if the scenario has no plan.
    """

    _core: _trackbed.Loop

    def __init__(
        self,
        scenario: Scenario,
        plant: Optional[str] = None,
        set: Overrides = None,
        *,
        seed: Optional[int] = None,
        log: bool = True,
    ) -> None:
        self._scenario = scenario
        self._plant = None if plant is None else text("plant", plant)
        self._keeps_log = flag("log", log)
        self._prepare(set, seed)

    def _prepare(self, set: Overrides, seed: Optional[int]) -> None:
        scenario = load(self._scenario, set, self._plant, seed)
        prepared = _trackbed.prepare(scenario)
        plant = scenario.plants[0] if self._plant is None else self._plant
        self._start(prepared, plant)

    def _start(self, prepared: _trackbed.Prepared, plant: str) -> None:
        if hasattr(self, "_core"):
            self._core.restart(prepared, plant, self._keeps_log)
        else:
            self._core = _trackbed.Loop(prepared, plant, self._keeps_log)
        self._prepared = prepared
        self.plant = plant

    def __copy__(self) -> Loop:
        result = type(self).__new__(type(self))
        result.__dict__.update({k: v for k, v in self.__dict__.items() if k != "_core"})
        result._start(self._prepared, self.plant)
        result._core.restore(self._core.save())
        return result

    def __deepcopy__(self, memo: dict[int, Any]) -> Loop:
        return self.__copy__()

    def __reduce__(self) -> NoReturn:
        raise TypeError("a Loop cannot be pickled; make a loop in each process")

    def __repr__(self) -> str:
        return f"<Loop {self._prepared.name} on {self.plant}: {_moment(self.observation)}>"

    def reset(
        self,
        seed: Optional[int] = None,
        set: Overrides = None,
        *,
        options: Optional[Mapping[str, Any]] = None,
    ) -> Observation:
        """Returns the car to its start, and returns the first observation.

        Without arguments, nothing is read or planned again. With `seed` or `set`, the scenario is
        read and planned again with these values instead of those of the constructor.
        `options={"set": {...}}` is the same as `set={...}`, as in Gymnasium.
        """
        own = changes(options)
        if own is not None:
            if set is not None:
                raise ValueError("set and options['set'] are both given; give one of them")
            set = own
        if seed is None and set is None:
            self._start(self._prepared, self.plant)
        else:
            self._prepare(set, seed)
        return self._core.observe()

    def step(
        self, steering: Optional[float] = None, acceleration: Optional[float] = None
    ) -> Observation:
        """Simulates one control period, and returns what the controller sees after it.

        steering: commanded steering angle of the bicycle model [rad], positive to the left. Without
            it, the scenario's controller steers and sets the speed, and `acceleration` must be None.
        acceleration: commanded acceleration [m/s^2], positive if the car speeds up in the direction
            of its gear. Without an acceleration, the car follows the speeds of the plan.

        Raises RunError if the run has ended.
        """
        if steering is None:
            if acceleration is not None:
                raise ValueError(_NEEDS_STEERING)
        elif type(steering) is not float:
            steering = number("steering", steering)
        if acceleration is not None and type(acceleration) is not float:
            acceleration = number("acceleration", acceleration)
        try:
            return self._core.step(steering, acceleration)
        except _trackbed.PreconditionError:
            number("steering", steering)
            if acceleration is not None:
                number("acceleration", acceleration)
            raise

    @property
    def observation(self) -> Observation:
        """What the controller sees now."""
        return self._core.observe()

    @property
    def period(self) -> float:
        """Length of a control period [s]."""
        return self._prepared.period

    @property
    def steering_limit(self) -> float:
        """Largest steering angle of the car [rad]."""
        return self._prepared.steering_limit

    @property
    def path_length(self) -> float:
        """Length of the plan at the start [m]; 0 without a path."""
        return self._prepared.path_length

    @property
    def state(self) -> LoopState:
        """The state of the loop. Set it to return to that state exactly, as often as you like."""
        return LoopState(self._core.save(), self._prepared, self.plant)

    @state.setter
    def state(self, state: LoopState) -> None:
        instance("state", state, LoopState)
        if state._prepared is not self._prepared or state._plant != self.plant:
            raise ValueError("state is the state of a loop with another scenario or plant")
        self._core.restore(state._core)

    def reference(self, stations: Floats) -> dict[str, Array]:
        """Returns points of the present plan at `stations` [m], an array with the shape (n,).

        Stations count as Observation.station_m; a plan that stops on the way has one part for each
        stretch between two stops. Returns arrays with the shape (n,): x_m, y_m, yaw_rad,
        curvature_radpm, speed_mps, direction. Beyond its ends, the path is straight.
        """
        return self._core.reference(row("stations", stations))

    @property
    def log(self) -> Log:
        """The log so far, with the columns of `run[plant]`."""
        return Log(self._core.log(), self.plant)

    def result(self) -> Run:
        """Returns the drive so far as a Run with one plant: measured, judged, and ready to draw.

        If the drive has not ended, its status is "interrupted", and its log ends with the present
        moment. With `log=False`, the run has only this moment, which its metrics describe.
        """
        return Run(self._core.result(self._prepared, self.plant))


class VectorLoop:
    """Many cars that are stepped together on several threads, without the GIL.

    The results are the same as those of single loops, whatever the number of threads.

    scenario, plant, set: those of Loop, the same for all cars.
    count: number of cars.
    seeds: one seed for each car; by default, all cars have the scenario's seed.
    threads: number of threads; by default, the number of processors.
    log: whether every loop keeps all rows of its log.

    A copy (copy.copy, copy.deepcopy) has other cars in the same states.
    """

    columns: tuple[str, ...] = tuple(_trackbed.observation_columns)
    """Names of the columns of an observation."""

    def __init__(
        self,
        scenario: Scenario,
        plant: Optional[str] = None,
        count: int = 1,
        *,
        seeds: Union[Sequence[int], numpy.typing.NDArray[Any], None] = None,
        set: Overrides = None,
        threads: Optional[int] = None,
        log: bool = False,
    ) -> None:
        self.count: int = whole("count", count, 1, INT_MAX)
        own = self._seeds(seeds)
        if threads is None:
            threads = len(os.sched_getaffinity(0))
        self._threads = whole("threads", threads, 1, INT_MAX)
        first = Loop(scenario, plant, set, seed=None if own is None else own[0], log=log)
        loops = [first]
        for i in range(1, self.count):
            if own is None:
                loop = Loop.__new__(Loop)
                loop.__dict__.update(first.__dict__)
                del loop._core
                loop._start(first._prepared, first.plant)
            else:
                loop = Loop(scenario, plant, set, seed=own[i], log=log)
            loops.append(loop)
        self.loops: tuple[Loop, ...] = tuple(loops)
        """The loops, which may also be stepped alone."""
        self._join()

    def __copy__(self) -> VectorLoop:
        result = type(self).__new__(type(self))
        result.__dict__.update({k: v for k, v in self.__dict__.items() if k != "_core"})
        result.loops = tuple(copy.copy(loop) for loop in self.loops)
        result._join()
        return result

    def __deepcopy__(self, memo: dict[int, Any]) -> VectorLoop:
        return self.__copy__()

    def __reduce__(self) -> NoReturn:
        raise TypeError("a VectorLoop cannot be pickled; make the loops in each process")

    def _join(self) -> None:
        self._core = _trackbed.VectorLoop([loop._core for loop in self.loops], self._threads)

    def __len__(self) -> int:
        return self.count

    def __repr__(self) -> str:
        first = self.loops[0]
        ended = int(self.ended.sum())
        return f"<VectorLoop {first._prepared.name} on {first.plant}: {ended} of {self.count} ended>"

    def reset(
        self,
        seeds: Union[Sequence[int], numpy.typing.NDArray[Any], None] = None,
        set: Overrides = None,
    ) -> Array:
        """Returns all cars to their starts, and returns the first observations.

        Without arguments, nothing is read or planned again. With `seeds`, one for each car, or
        `set`, every car reads and plans the scenario again with these values.
        """
        own = self._seeds(seeds)
        for i, loop in enumerate(self.loops):
            loop.reset(None if own is None else own[i], set)
        return self._core.observe()

    def _seeds(self, seeds: object) -> Optional[list[int]]:
        """Returns the seed of each car, after checking the argument `seeds`."""
        if seeds is None:
            return None
        given = listed("seeds", seeds, self.count)
        return [whole(f"seeds[{i}]", seed, 0) for i, seed in enumerate(given)]

    def step(
        self,
        steering: Optional[Floats] = None,
        acceleration: Optional[Floats] = None,
    ) -> Array:
        """Simulates one control period of every car that has not ended.

        steering [rad] and acceleration [m/s^2]: arrays with the shape (count,), as in Loop.step. An
        acceleration of NaN follows the speeds of the plan. Without `steering`, the scenario's
        controllers drive, and `acceleration` must be None.

        Returns the observations, an array of float64 with the shape (count, len(columns)).
        """
        if steering is None and acceleration is not None:
            raise ValueError(_NEEDS_STEERING)
        shape = (self.count,)
        angles = None if steering is None else array("steering", steering, shape)
        if acceleration is None:
            rates = None
        else:
            rates = array("acceleration", acceleration, shape, finite=False)
            if numpy.isinf(rates).any():
                raise ValueError("acceleration has an infinite value")
        return self._core.step(angles, rates)

    @property
    def observations(self) -> Array:
        """The present observations, an array of float64 with the shape (count, len(columns))."""
        return self._core.observe()

    def curvature_ahead(self, distances: Floats) -> Array:
        """Returns the curvature [1/m] of each car's present plan ahead of the car.

        distances: distances from station_m [m], an array with the shape (n,). Returns an array of
        float64 with the shape (count, n). Beyond its ends, the path is straight.
        """
        return self._core.curvature_ahead(row("distances", distances))

    @property
    def statuses(self) -> list[Optional[str]]:
        """How each car's run ended, such as "arrived"; None while it continues."""
        return self._core.statuses

    @property
    def ended(self) -> numpy.typing.NDArray[numpy.bool_]:
        """Whether each car's run has ended, an array of bool with the shape (count,)."""
        return self._core.ended
