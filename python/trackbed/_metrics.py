"""Metrics and requirements that are written in Python."""

from __future__ import annotations

import inspect
from typing import Any, Callable, Optional, TypeVar

import numpy

from . import _trackbed
from ._arguments import flag, text, type_name
from ._runs import Log, Path
from ._signatures import METRIC_NAME, name_of, register_plugin, require_plain, returned


_Function = TypeVar("_Function", bound=Callable[..., Any])


class _MetricAdapter:
    def __init__(self, function: Callable[..., Any], takes_path: bool, located: bool) -> None:
        self._function = function
        self._takes_path = takes_path
        self._located = located

    def measure(
        self, core: _trackbed.Columns, plant: str, path: Optional[_trackbed.Columns]
    ) -> Optional[tuple[float, Optional[float], Optional[float]]]:
        own: list[Any] = [Log(core, plant)]
        if self._takes_path:
            own.append(None if path is None else Path(path))
        value = self._function(*own)
        if value is None:
            return None
        if not self._located:
            if isinstance(value, (bool, numpy.bool_)):
                value = float(value)
            return returned("the function", value, "the value"), None, None
        if not isinstance(value, (tuple, list)) or len(value) != 3:
            raise TypeError("the function must return (value, station, time), or None")
        names = ("the value", "the station [m]", "the time [s]")
        value, s, t = (returned("the function", v, n) for v, n in zip(value, names))
        return value, s, t


def metric(
    name: str,
    *,
    unit: str = "",
    label: Optional[str] = None,
    located: bool = False,
    headline: bool = False,
    replace: bool = False,
) -> Callable[[_Function], _Function]:
    """Registers a function as a metric, for metrics.json, `expect.metrics`, studies and reports.

        @trackbed.metric("roll_max", unit="rad", label="Largest roll angle")
        def roll_max(log):
            return abs(log["roll_rad"]).max()

    The function receives the Log of a plant, and the planned Path (or None) if it has a second
    parameter. It returns a number, or None if the run has no value. With `located`, it returns
    (value, station [m], time [s]) of a moment, which metrics.json lists as NAME_s and NAME_t.
    """
    own = name_of("metric", name, METRIC_NAME)

    def register(function: _Function) -> _Function:
        what = f"metric {own!r}"
        if not callable(function) or isinstance(function, type):
            raise TypeError(f"{what} must be a function, not {type_name(function)}")
        require_plain(what, function)
        parameters = [
            p
            for p in inspect.signature(function).parameters.values()
            if p.kind is not p.KEYWORD_ONLY or p.default is p.empty
        ]
        if len(parameters) not in (1, 2) or any(
            p.kind not in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD) for p in parameters
        ):
            raise TypeError(f"{what} must have the parameters (log) or (log, path)")
        adapter = _MetricAdapter(function, len(parameters) == 2, flag("located", located))
        register_plugin(
            "metric",
            own,
            _Labeled(function, label),
            adapter,
            [],
            replace,
            _trackbed.register_metric,
            unit=text("unit", unit),
            located=flag("located", located),
            headline=flag("headline", headline),
        )
        return function

    return register


class _Labeled:
    """A function whose documentation is the label of a metric."""

    def __init__(self, function: Callable[..., Any], label: Optional[str]) -> None:
        self.func = function
        name = getattr(getattr(function, "func", function), "__name__", type(function).__name__)
        words = name.replace("_", " ").capitalize()
        self.__doc__ = words if label is None else text("label", label)


def requirement(
    name: str, *, unit: str = "", replace: bool = False
) -> Callable[[_Function], _Function]:
    """Registers a function as a requirement: a metric that must be at least 0.

        @trackbed.requirement("calm", unit="m/s^2")
        def calm(log):
            return 3.0 - abs(log["lateral_acceleration_mps2"]).max()

    The function returns the robustness: how far the log is from violating the requirement,
    negative if it violates it. Scenarios require it by
    `expect: {metrics: [{metric: NAME, min: 0}]}`; `falsify` searches for a negative value.
    """
    return metric(name, unit=unit, headline=True, replace=replace)
