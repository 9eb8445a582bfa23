"""Checks and converts arguments, so that an error names the wrong argument."""

from __future__ import annotations

import difflib
import json
import math
import numbers
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set, Sized
from typing import Any, Optional, Union

import numpy
import numpy.typing

from . import _trackbed

InputError = _trackbed.InputError
InternalError = _trackbed.InternalError
PreconditionError = _trackbed.PreconditionError
RunError = _trackbed.RunError
version: str = _trackbed.version

Scenario = Union[str, "os.PathLike[str]"]
Plants = Union[str, Iterable[str], None]
Overrides = Optional[Mapping[str, Any]]
Floats = Union[Sequence[float], "numpy.typing.NDArray[Any]"]
"""Numbers in one row."""

Array = numpy.typing.NDArray[numpy.float64]


def type_name(value: object) -> str:
    return type(value).__name__


def number(name: str, value: object) -> float:
    """Returns the finite number `value` of the argument `name`."""
    if isinstance(value, numpy.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name} must be a number, not {type_name(value)}")
    try:
        result = float(value)
    except OverflowError:
        raise ValueError(f"{name} is too large; must be at most 1.8e308") from None
    if not math.isfinite(result):
        raise ValueError(f"{name} is {value}; must be finite")
    return result


def whole(name: str, value: object, least: int, most: Optional[int] = None) -> int:
    """Returns the whole number `value` of the argument `name`, within its bounds."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise TypeError(f"{name} must be a whole number, not {type_name(value)}")
    result = int(value)
    if result < least:
        raise ValueError(f"{name} is {value}; must be at least {least}")
    if most is not None and result > most:
        raise ValueError(f"{name} is too large; must be at most {most}")
    return result


INT_MAX = 2**31 - 1
"""Largest whole number that C++ takes for sizes and counts."""


def positive(name: str, value: object) -> float:
    """Returns the finite number `value` of the argument `name`, which must be above 0."""
    result = number(name, value)
    if result <= 0.0:
        raise ValueError(f"{name} is {value}; must be above 0")
    return result


def at_least_zero(name: str, value: object) -> float:
    """Returns the finite number `value` of the argument `name`, which must be at least 0."""
    result = number(name, value)
    if result < 0.0:
        raise ValueError(f"{name} is {value}; must be at least 0")
    return result


def similar(name: object, known: Iterable[str]) -> str:
    """Returns a hint to the most similar of the known names, or an empty text."""
    found = difflib.get_close_matches(str(name), list(known), 1)
    return f"; did you mean {found[0]!r}?" if found else ""


def flag(name: str, value: object) -> bool:
    if not isinstance(value, (bool, numpy.bool_)):
        raise TypeError(f"{name} must be a bool, not {type_name(value)}")
    return bool(value)


def text(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a str, not {type_name(value)}")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{name} is {value!r}, which has no UTF-8 form") from None
    return value


def texts(name: str, value: object) -> list[str]:
    """Returns the texts in `value`, the argument `name`; a str counts as a text, not as a list."""
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable):
        raise TypeError(f"{name} must be a list of str, not {type_name(value)}")
    return [text(f"a name in {name}", item) for item in items(name, value)]


def items(name: str, value: Iterable[Any]) -> list[Any]:
    try:
        return list(value)
    except TypeError:  # An array of NumPy without dimensions counts as an Iterable.
        raise TypeError(f"{name} must be a list, not {type_name(value)}") from None


def mapping(name: str, value: object, of: str) -> Mapping[Any, Any]:
    """Returns the argument `name`, after checking that it is a dict."""
    if not isinstance(value, Mapping):
        raise TypeError(f"{name} must be a dict of {of}, not {type_name(value)}")
    return value


def listed(name: str, value: object, count: int) -> Sequence[Any]:
    """Returns the argument `name`, after checking that it is a list or an array with a value for each of
    `count` cars."""
    if isinstance(value, (str, bytes)) or not isinstance(value, (Sequence, numpy.ndarray)):
        raise TypeError(f"{name} must be a list of whole numbers, not {type_name(value)}")
    if isinstance(value, numpy.ndarray) and value.ndim != 1:
        raise ValueError(f"{name} has the shape {value.shape}; must be ({count},)")
    if len(value) != count:
        raise ValueError(f"{name} has {len(value)} values; must have {count}, one for each car")
    return value  # type: ignore[return-value]


def path(name: str, value: object) -> str:
    """Returns the path `value` of the argument `name` as a str."""
    try:
        result = os.fspath(value) if isinstance(value, (str, os.PathLike)) else None
    except TypeError:  # __fspath__ returned something else.
        result = None
    if not isinstance(result, str):
        raise TypeError(f"{name} must be a str or a path, not {type_name(value)}")
    if not result or "\0" in result:
        raise ValueError(f"{name} is {result!r}; must not be empty, or have the character 0")
    try:
        os.fsencode(result)
    except UnicodeEncodeError:
        raise ValueError(f"{name} is {result!r}, which no file name can contain") from None
    return result


def instance(name: str, value: object, kind: type) -> None:
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be a trackbed.{kind.__name__}, not {type_name(value)}")


def require_core(owner: object, core: object, kind: Union[type, tuple[type, ...]], source: str) -> None:
    """Refuses a constructor's argument that a user gives; `source` says what makes such objects."""
    if not isinstance(core, kind):
        name = type_name(owner)
        raise TypeError(f"trackbed.{name} takes no {type_name(core)}; {source} a {name}")


def doubles(name: str, value: object) -> Array:
    """Returns the argument `name` as an array of float64, which has the memory of `value` if it can.

    Refuses texts, complex numbers and times, which NumPy would convert. Masked values are NaN.
    """
    try:
        result = numpy.asarray(value)
        if result.dtype.kind == "O" and not all(
            item is None or isinstance(item, numbers.Real) for item in result.flat
        ):
            raise TypeError
        if result.dtype.kind not in "biufO":
            raise TypeError
        plain: Array = numpy.asarray(result, dtype=numpy.float64, order="C")
        if isinstance(value, numpy.ma.MaskedArray):
            plain = numpy.where(numpy.asarray(value.mask), numpy.nan, plain)
        return plain
    except OverflowError:
        raise ValueError(f"{name} has a value that is too large; must be at most 1.8e308") from None
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be an array of numbers, not {type_name(value)}") from None


def array(name: str, value: object, shape: tuple[int, ...], finite: bool = True) -> Array:
    """Returns the argument `name` as an array of float64 with the given shape."""
    result = doubles(name, value)
    if result.shape != shape:
        raise ValueError(f"{name} has the shape {result.shape}; must be {shape}")
    if finite and not numpy.isfinite(result).all():
        raise ValueError(f"{name} has a value that is not finite")
    return result


def row(name: str, value: object) -> Array:
    """Returns the argument `name` as an array of finite float64 with one dimension."""
    result = doubles(name, value)
    if result.ndim != 1:
        raise ValueError(f"{name} has the shape {result.shape}; must be (n,)")
    return array(name, result, result.shape)


def changes(options: object) -> Optional[Mapping[str, Any]]:
    """Returns the keys and values that the options of reset() set in the scenario."""
    changed = {} if options is None else dict(mapping("options", options, "names and values"))
    own = changed.pop("set", None)
    if changed:
        raise ValueError(
            f"options has the unknown key {next(iter(changed))!r}; allowed: 'set', with keys of the "
            "scenario and their values"
        )
    return None if own is None else mapping("options['set']", own, "keys and values")


def _repeats(value: object) -> bool:
    """Returns whether a value is a row of values that can be read again, such as a range, a deque
    or a column of pandas or polars."""
    others = (str, bytes, bytearray, memoryview, Mapping, Set, Iterator, os.PathLike)
    return isinstance(value, Iterable) and isinstance(value, Sized) and not isinstance(value, others)


def _plain(key: str, value: Any) -> Any:
    """Returns an override's value as JSON has it; arrays and scalars of NumPy become plain."""
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        value = value.tolist()
    if isinstance(value, numbers.Real) and not isinstance(value, (bool, int)):
        return number(f"set[{key!r}]", value)
    if isinstance(value, Mapping):
        return {text("a key in set", k): _plain(f"{key}.{k}", v) for k, v in value.items()}
    if isinstance(value, (list, tuple)) or _repeats(value):
        return [_plain(key, v) for v in value]
    if isinstance(value, os.PathLike):
        return path(f"set[{key!r}]", value)
    if value is None or isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, Iterator):  # Some callers read the values several times.
        raise TypeError(f"set[{key!r}] is a {type_name(value)}, which can be read once; give a list")
    raise TypeError(
        f"set[{key!r}] must be a number, bool, str, None, list or dict, not {type_name(value)}"
    )


# Characters that YAML reads only as escapes, or as ends of lines.
_ESCAPES = {c: f"\\u{c:04x}" for c in (*range(0x7F, 0xA0), 0x2028, 0x2029, 0xFEFF)}


def _json(value: Any) -> str:
    """Returns JSON that is YAML, too: YAML knows no pairs of escapes for characters beyond U+FFFF."""
    return json.dumps(value, ensure_ascii=False).translate(_ESCAPES)


def overrides(set: Overrides, plants: Plants = None, seed: Optional[int] = None) -> list[str]:
    """Returns overrides as `trackbed run --set` takes them."""
    if set is not None:
        mapping("set", set, "keys and values")
    result = [
        f"{text('a key in set', key)}={_json(_plain(key, value))}"
        for key, value in (set or {}).items()
    ]
    if isinstance(plants, Mapping):
        raise TypeError("plants must be a list of str, not dict; give the keys as set={...}")
    if plants is not None:
        names = texts("plants", [plants] if isinstance(plants, str) else plants)
        result.append(f"drive.plants={_json(names)}")
    if seed is not None:
        result.append(f"seed={whole('seed', seed, 0)}")
    return result


def load(
    scenario: Scenario, set: Overrides, plants: Plants = None, seed: Optional[int] = None
) -> _trackbed.Scenario:
    """Reads a scenario: a file, or the name of a scenario that comes with the package."""
    return _trackbed.load(path("scenario", scenario), overrides(set, plants, seed), [])
