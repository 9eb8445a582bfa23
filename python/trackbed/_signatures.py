"""Checks of the functions and classes that become plug-ins, and their registration."""

from __future__ import annotations

import inspect
import itertools
import numbers
import re
import sys
import traceback
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Callable, Optional

from . import _trackbed
from ._arguments import flag, mapping, number, text, texts, type_name

NAME = re.compile(r"[a-z][a-z0-9_]*")
METRIC_NAME = re.compile(r"[a-z][a-z0-9_]*(\.[a-z][a-z0-9_]*)*")
_registered: dict[tuple[str, str], dict[str, Any]] = {}
_registrations = itertools.count()


_text = text


class Key:
    """Unit, range and description of a keyword parameter, which is a key in scenarios.

    unit: such as "m/s". text: one line for users. min, max: allowed values, inclusive; above:
    exclusive. allowed: the allowed texts.
    """

    def __init__(
        self,
        unit: str = "",
        text: str = "",
        *,
        min: Optional[float] = None,
        max: Optional[float] = None,
        above: Optional[float] = None,
        allowed: Sequence[str] = (),
    ) -> None:
        self.unit: str = _text("unit", unit)
        self.text: str = _text("text", text)
        self.min: Optional[float] = None if min is None else number("min", min)
        self.max: Optional[float] = None if max is None else number("max", max)
        self.above: Optional[float] = None if above is None else number("above", above)
        self.allowed: list[str] = texts("allowed", allowed)
        if self.max is not None:
            if self.min is not None and self.min > self.max:
                raise ValueError(f"min is {min}, which exceeds max, {max}: no value is allowed")
            if self.above is not None and self.above >= self.max:
                raise ValueError(f"above is {above}, but max is {max}: no value is allowed")

    def refusal(self, value: Any) -> str:
        """Returns why the key refuses a value, such as "must be at least 0"; "" if it allows it."""
        values = list(value) if isinstance(value, (list, tuple)) else [value]
        if self.allowed and any(isinstance(v, str) and v not in self.allowed for v in values):
            return f"allowed are {', '.join(self.allowed)}"
        plain = [float(v) for v in values if isinstance(v, numbers.Real)]
        if self.min is not None and any(v < self.min for v in plain):
            return f"must be at least {self.min:g}"
        if self.max is not None and any(v > self.max for v in plain):
            return f"must be at most {self.max:g}"
        if self.above is not None and any(v <= self.above for v in plain):
            return f"must be above {self.above:g}"
        return ""


def print_traceback(exception: BaseException) -> None:
    traceback.print_exception(type(exception), exception, exception.__traceback__, file=sys.stderr)
    sys.stderr.flush()


def _own_type(default: Any, annotation: Any, where: str) -> str:
    hint = str(getattr(annotation, "__name__", annotation)).replace(" ", "")
    if default is None or default is inspect.Parameter.empty:
        kinds = {"float": "number", "int": "whole", "bool": "flag", "str": "text"}
        if default is None and ("float" in hint or annotation is inspect.Parameter.empty):
            return "optional"
        if default is not None and hint in kinds:
            return kinds[hint]
        if default is not None and hint.lower().startswith(("list", "sequence", "tuple")):
            return "numbers"
        raise TypeError(f"{where} needs a default, or the annotation float, int, bool, str or list")
    if isinstance(default, bool):
        return "flag"
    if isinstance(default, numbers.Integral) and hint != "float":
        return "whole"
    if isinstance(default, numbers.Real):
        return "number"
    if isinstance(default, str):
        return "text"
    if isinstance(default, (list, tuple)) and all(isinstance(v, numbers.Real) for v in default):
        return "numbers"
    raise TypeError(
        f"{where} has the default {default!r}; must be a number, bool, str, list of numbers or None"
    )


def require_plain(what: str, function: object, yields: bool = False) -> None:
    """Refuses functions whose call returns before they have run: async ones, and generators.

    yields: whether generators are allowed.
    """
    called = getattr(function, "func", function)  # The function of a functools.partial.
    if inspect.iscoroutinefunction(called) or inspect.isasyncgenfunction(called):
        raise TypeError(f"{what} must be a plain function, not an async one")
    if inspect.isgeneratorfunction(called) and not yields:
        raise TypeError(f"{what} must return its result, not yield it")


def parameters_of(
    what: str, function: Callable[..., Any], leading: Sequence[str], keys: bool = True
) -> list[Any]:
    """Returns the keyword parameters, after checking that `leading` are the positional ones.

    keys: whether the message may ask for keyword parameters.
    """
    try:
        parameters = list(inspect.signature(function).parameters.values())
    except (TypeError, ValueError):
        raise TypeError(f"{what} must be a function or a class with a signature") from None
    bound = getattr(function, "keywords", {})  # Those of a functools.partial are no keys.
    keywords = [
        p for p in parameters if p.kind is inspect.Parameter.KEYWORD_ONLY and p.name not in bound
    ]
    others = [p for p in parameters if p.kind is not inspect.Parameter.KEYWORD_ONLY]
    if [p for p in others if p.kind not in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]:
        raise TypeError(f"{what} must not have *args or **kwargs, because its keys must be known")
    if len(others) != len(leading):
        wanted = ", ".join((*leading, "*", "keys") if keys else leading)
        found = ", ".join(p.name for p in others) or "none"
        hint = "; keys come after '*'" if keys and len(others) > len(leading) else ""
        raise TypeError(
            f"{what} must have the parameters ({wanted}); its positional parameters are: {found}{hint}"
        )
    return keywords


def keys_of(what: str, parameters: Iterable[Any], given: Mapping[str, Key], section: str) -> list[Any]:
    mapping("keys", given, "names and trackbed.Key")
    taken = _trackbed.keys_of_section(section)
    result = []
    names = [p.name for p in parameters]
    for name in given:
        if name not in names:
            raise ValueError(f"keys[{name!r}] is no keyword parameter of {what}: {', '.join(names)}")
    for parameter in parameters:
        where = f"the parameter {parameter.name} of {what}"
        if parameter.name in taken:
            raise ValueError(f"{where} has the name of a key that every {section} section has")
        key = given.get(parameter.name, Key())
        if not isinstance(key, Key):
            raise TypeError(f"keys[{parameter.name!r}] must be a trackbed.Key, not {type_name(key)}")
        default = parameter.default
        required = default is inspect.Parameter.empty
        refusal = "" if required else key.refusal(default)
        if refusal:
            raise ValueError(f"{where} has the default {default!r}; {refusal}")
        result.append(
            {
                "name": parameter.name,
                "unit": key.unit,
                "text": key.text or f"parameter of {what}",
                "type": _own_type(default, parameter.annotation, where),
                "required": required,
                "default": None if required else default,
                "min": key.min,
                "max": key.max,
                "above": key.above,
                "allowed": key.allowed,
            }
        )
    return result


def _place(function: Any) -> str:
    """Returns module and name of a function or class; of other callables, those of the class."""
    named = getattr(function, "func", function)  # The function of a functools.partial.
    named = named if hasattr(named, "__qualname__") else type(named)
    return f"{named.__module__}.{named.__qualname__}"


def register_plugin(
    kind: str,
    name: str,
    function: Any,
    adapter: Any,
    keys: list[Any],
    replace: bool,
    register: Callable[[dict[str, Any]], None],
    **properties: Any,
) -> None:
    place = _place(function)
    before = _registered.get((kind, name))
    replaces = flag("replace", replace)
    if before is not None and before["place"] == place and "<" not in place:
        replaces = True  # The same definition again: a reloaded module, or a repeated notebook cell.
    if before is not None and not replaces:
        raise ValueError(
            f"{kind} {name!r} is already registered, by {before['place']}; give {place} another "
            "name, or register it with replace=True"
        )
    if before is not None and before["properties"] != properties:
        raise ValueError(
            f"{kind} {name!r} is registered with {before['properties']}; replace=True cannot change "
            f"them to {properties}"
        )
    summary = (inspect.getdoc(function) or "").strip().split("\n")[0].rstrip(".")
    plugin = {
        "kind": kind,
        "name": name,
        "summary": summary or f"{place}, written in Python",
        "place": place,
        "adapter": adapter,
        "keys": keys,
    }
    try:
        register({**plugin, **properties})
    except _trackbed.PreconditionError as error:
        raise ValueError(f"{kind} {name!r} ({place}): {error}") from None
    number = next(_registrations)
    _registered[(kind, name)] = {"place": place, "properties": properties, "number": number}


def names_of(kinds: Sequence[str]) -> list[str]:
    """Returns the names of the registered plug-ins of these kinds."""
    return [name for kind, name in _registered if kind in kinds]


def latest_registration() -> int:
    """Returns the number of the latest registration, which no other state of the plug-ins has."""
    return max((known["number"] for known in _registered.values()), default=-1)


def name_of(kind: str, name: object, pattern: re.Pattern[str] = NAME) -> str:
    if callable(name):
        raise TypeError(f"{kind} needs a name: @trackbed.{kind}(\"name\")")
    if not pattern.fullmatch(text("name", name)):
        raise ValueError(f"name is {name!r}; must be of a-z, 0-9 and '_', and begin with a letter")
    return str(name)


def returned(what: str, value: object, meaning: str) -> float:
    if value is None:
        raise TypeError(f"{what} returned None; must return {meaning}")
    try:
        return number(f"{what} returned {meaning}, which", value)
    except ValueError:
        shown = value if isinstance(value, float) else "that is too large"
        raise ValueError(f"{what} returned {meaning} {shown}; must be finite") from None


def require_method(what: str, own: type, name: str, parameters: Sequence[str]) -> None:
    """Checks that a class has a method with these parameters."""
    method = getattr(own, name, None)
    wanted = f"{name}({', '.join(('self', *parameters))})"
    if not callable(method):
        raise TypeError(f"{what} must be a class with the method {wanted}")
    require_plain(f"{name} of {what}", method)
    found = [
        p
        for p in inspect.signature(method).parameters.values()
        if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD) or p.name in parameters
    ]
    needed = [p for p in found if p.default is inspect.Parameter.empty]
    bound = isinstance(inspect.getattr_static(own, name), (staticmethod, classmethod))
    count = len(parameters) + (0 if bound else 1)
    if not len(needed) <= count <= len(found):
        raise TypeError(f"{what}: {name} must have the parameters of {wanted}")
