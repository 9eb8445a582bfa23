"""Checks and converts arguments, so that an error names the wrong argument."""

from __future__ import annotations

import json
import math
import numbers
import os
from collections.abc import Iterable, Mapping
from typing import Any, Optional, Union

import numpy

from . import _trackbed

InputError = _trackbed.InputError
InternalError = _trackbed.InternalError
PreconditionError = _trackbed.PreconditionError
RunError = _trackbed.RunError
version: str = _trackbed.version

Scenario = Union[str, "os.PathLike[str]"]
Plants = Union[str, Iterable[str], None]
Overrides = Optional[Mapping[str, Any]]


def type_name(value: object) -> str:
    return type(value).__name__


def number(name: str, value: object) -> float:
    """Returns the finite number `value` of the argument `name`."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name} must be a number, not {type_name(value)}")
    try:
        result = float(value)
    except OverflowError:
        raise ValueError(f"{name} is too large; must be at most 1.8e308") from None
    if not math.isfinite(result):
        raise ValueError(f"{name} is {value}; must be finite")
    return result


def whole(name: str, value: object, least: int) -> int:
    """Returns the whole number `value` of the argument `name`, which must be at least `least`."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise TypeError(f"{name} must be a whole number, not {type_name(value)}")
    if value < least:
        raise ValueError(f"{name} is {value}; must be at least {least}")
    return int(value)


def text(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a str, not {type_name(value)}")
    return value


def instance(name: str, value: object, kind: type) -> None:
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be a trackbed.{kind.__name__}, not {type_name(value)}")


def array(name: str, value: object, shape: tuple[int, ...], finite: bool = True) -> numpy.ndarray:
    """Returns the argument `name` as an array of float64 with the given shape."""
    try:
        result = numpy.asarray(value, dtype=numpy.float64, order="C")
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be an array of numbers, not {type_name(value)}") from None
    if result.shape != shape:
        raise ValueError(f"{name} has the shape {numpy.shape(value)}; must be {shape}")
    if finite and not numpy.isfinite(result).all():
        raise ValueError(f"{name} has a value that is not finite")
    return result


def _plain(key: str, value: Any) -> Any:
    """Returns an override's value as JSON has it; arrays and scalars of NumPy become plain."""
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {text("a key in set", k): _plain(f"{key}.{k}", v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(key, v) for v in value]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError(f"set[{key!r}] is {value}; must be finite")
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    raise TypeError(
        f"set[{key!r}] must be a number, bool, str, None, list or dict, not {type_name(value)}"
    )


def overrides(set: Overrides, plants: Plants = None, seed: Optional[int] = None) -> list[str]:
    """Returns overrides as `trackbed run --set` takes them."""
    if set is not None and not isinstance(set, Mapping):
        raise TypeError(f"set must be a dict of keys and values, not {type_name(set)}")
    result = [
        f"{text('a key in set', key)}={json.dumps(_plain(key, value))}"
        for key, value in (set or {}).items()
    ]
    if plants is not None:
        if not isinstance(plants, Iterable):
            raise TypeError(f"plants must be a list of names, not {type_name(plants)}")
        names = [plants] if isinstance(plants, str) else list(plants)
        for name in names:
            text("a name in plants", name)
        result.append(f"drive.plants={json.dumps(names)}")
    if seed is not None:
        result.append(f"seed={whole('seed', seed, 0)}")
    return result


def load(
    scenario: Scenario, set: Overrides, plants: Plants = None, seed: Optional[int] = None
) -> _trackbed.Scenario:
    """Reads a scenario: a file, or the name of a scenario that comes with the package."""
    if not isinstance(scenario, (str, os.PathLike)):
        raise TypeError(f"scenario must be a str or a path, not {type_name(scenario)}")
    return _trackbed.load(os.fspath(scenario), overrides(set, plants, seed), [])
