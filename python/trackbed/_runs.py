"""Runs of scenarios, and what they leave: logs, plan, metrics, verdict, pictures."""

from __future__ import annotations

import html
import importlib
import os
import shutil
import tempfile
import weakref
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NoReturn, Optional, TypeVar, Union

import numpy
import numpy.typing

from . import _trackbed
from ._arguments import (
    INT_MAX,
    Array,
    Overrides,
    Plants,
    Scenario,
    flag,
    instance,
    load,
    number,
    path,
    require_core,
    similar,
    text,
    whole,
)


def no_attribute(owner: Any, name: str, items: Sequence[str], what: str) -> AttributeError:
    """Returns the error for an unknown attribute, which may be meant as one of the items."""
    hint = similar(name, items)
    if name in items:
        hint = f"; {what} is read by {type(owner).__name__.lower()}[{name!r}]"
    return AttributeError(f"{type(owner).__name__!r} object has no attribute {name!r}{hint}")


def no_array(owner: Any, instead: str) -> TypeError:
    """Returns the error for the conversion of a mapping to one array, which NumPy would fill with
    the names."""
    return TypeError(
        f"a {type(owner).__name__} is a mapping of names, not an array of numbers; use {instead}"
    )


class _Arrays:
    """The columns of an unpickled table, with the members of _trackbed.Columns."""

    def __init__(self, columns: dict[str, Array]) -> None:
        self._columns: dict[str, Array] = columns
        for column in columns.values():
            column.setflags(write=False)
        self.names: list[str] = list(columns)
        self.rows: int = max((len(column) for column in columns.values()), default=0)

    def column(self, name: str) -> Array:
        return self._columns[name]


def _unpickled(kind: type, columns: dict[str, Array], *arguments: Any) -> Any:
    return kind(_Arrays(columns), *arguments)


_Table = TypeVar("_Table", bound="Columns")


class Columns(Mapping[str, Array]):
    """Columns of a table: read-only arrays of float64 with the shape (rows,), by name.

    The arrays refer to the memory of the table, without a copy, and keep it alive. A copy shares
    the memory, because the arrays are read-only. A pickled table contains the arrays.
    """

    def __init__(self, core: Union[_trackbed.Columns, _Arrays]) -> None:
        require_core(self, core, (_trackbed.Columns, _Arrays), self._source)
        self._core: Union[_trackbed.Columns, _Arrays] = core

    _source: str = "run[plant] returns"

    def __getitem__(self, name: str) -> Array:
        if not isinstance(name, str) or name not in self._core.names:
            names = self._core.names
            raise KeyError(
                f"no column {name!r}{similar(name, names)}; the columns are {', '.join(names)}"
            )
        return self._core.column(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._core.names)

    def __len__(self) -> int:
        return len(self._core.names)

    def __getattr__(self, name: str) -> NoReturn:
        names = [] if name.startswith("_") else self._core.names
        raise no_attribute(self, name, names, "a column")

    def __array__(self, *arguments: Any, **named: Any) -> NoReturn:
        raise no_array(self, "to_pandas(), or numpy.column_stack([table[name] for name in names])")

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self._core.rows

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with these columns. Needs pandas."""
        return _pandas().DataFrame({name: self[name] for name in self})

    def __copy__(self: _Table) -> _Table:
        return self

    def __deepcopy__(self: _Table, memo: dict[int, Any]) -> _Table:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (type(self), {name: self[name] for name in self}, *self._arguments())

    def _arguments(self) -> tuple[Any, ...]:
        """Returns the arguments of the constructor after the table."""
        return ()

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.rows} rows of {', '.join(self)}>"


class Log(Columns):
    """The log of one plant: one row for each control period (docs/conventions.md)."""

    def __init__(self, core: Union[_trackbed.Columns, _Arrays], plant: str) -> None:
        super().__init__(core)
        self.plant: str = plant

    def _arguments(self) -> tuple[Any, ...]:
        return (self.plant,)


class Path(Columns):
    """The planned path, points at most 0.1 m apart: s_m, x_m, y_m, yaw_rad, curvature_radpm, ..."""

    _source: str = "run.path returns"


class Run(Mapping[str, Log]):
    """A finished run of a scenario. `run["mujoco"]` is the log of the plant mujoco."""

    def __init__(self, core: _trackbed.RunResult) -> None:
        require_core(self, core, _trackbed.RunResult, "trackbed.run(scenario) returns")
        self._core: _trackbed.RunResult = core
        self._metrics: Optional[dict[str, Any]] = None
        self._logs: dict[str, Log] = {}
        self._written: Optional[str] = None

    def __getitem__(self, plant: str) -> Log:
        if not isinstance(plant, str) or plant not in self.plants:
            known = ", ".join(self.plants) or "none"
            raise KeyError(f"no plant {plant!r}{similar(plant, self.plants)}; the run has {known}")
        if plant not in self._logs:
            core = self._core.log(plant)
            assert core is not None
            self._logs[plant] = Log(core, plant)
        return self._logs[plant]

    def __getattr__(self, name: str) -> NoReturn:
        plants = [] if name.startswith("_") else self.plants
        raise no_attribute(self, name, plants, "the log of a plant")

    def __array__(self, *arguments: Any, **named: Any) -> NoReturn:
        raise no_array(self, "run[plant][column], or run.to_pandas()")

    def __iter__(self) -> Iterator[str]:
        return iter(self.plants)

    def __len__(self) -> int:
        return len(self.plants)

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self._core.name

    @property
    def plants(self) -> list[str]:
        """Names of the plants; empty if there is no plan."""
        return self._core.plants

    @property
    def yaml(self) -> str:
        """The resolved scenario, as in scenario.resolved.yaml."""
        return self._core.yaml

    def _all_metrics(self) -> dict[str, Any]:
        if self._metrics is None:
            self._metrics = self._core.metrics
        return self._metrics

    @property
    def metrics(self) -> dict[str, dict[str, Any]]:
        """The metrics of each plant, as in metrics.json, in SI units and radians."""
        result: dict[str, dict[str, Any]] = self._all_metrics()["plants"]
        return result

    def metric_values(self, plant: str) -> dict[str, Any]:
        """Returns the metrics of a plant by their names in `expect.metrics`.

        The names have dots, such as "cross_track.max". The values are numbers, bools, texts, or
        None for an undefined value.
        """
        self[plant]  # Raises KeyError for an unknown plant.
        return self._core.metric_values(plant)

    @property
    def verdict(self) -> dict[str, Any]:
        """The verdict, with all checks, as in metrics.json."""
        result: dict[str, Any] = self._all_metrics()["verdict"]
        return result

    @property
    def comparisons(self) -> list[dict[str, Any]]:
        """The differences of every pair of plants at equal stations, as in metrics.json."""
        result: list[dict[str, Any]] = self._all_metrics()["between"]
        return result

    @property
    def passed(self) -> bool:
        """Whether the run was judged and no check failed."""
        return self.verdict["passed"] is True

    @property
    def plan(self) -> Optional[dict[str, Any]]:
        """Status, method and properties of the plan, as in plan.json; None without `plan`."""
        return self._core.plan

    @property
    def path(self) -> Optional[Path]:
        """The planned path; None if there is none."""
        core = self._core.path()
        return None if core is None else Path(core)

    @property
    def notes(self) -> list[str]:
        """Remarks on the plan, then remarks of the verdict."""
        plan = self._core.plan_notes
        repeated = {f"plan: {note}" for note in plan}  # The verdict repeats the notes of the plan.
        return plan + [note for note in self._core.notes if note not in repeated]

    def write(self, folder: Union[str, os.PathLike[str]], *, mcap: bool = False) -> None:
        """Writes the run folder, as `trackbed run` does; with `mcap`, also run.mcap."""
        self._core.write(path("folder", folder), flag("mcap", mcap))

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame of all logs; the plant is the first index. Needs pandas."""
        tables = {plant: log.to_pandas() for plant, log in self.items()}
        return _pandas().concat(tables, names=["plant"])

    def report(self) -> str:
        """Returns the report with its replay, a self-contained HTML page."""
        return _trackbed.report_page(self._folder())

    def _folder(self) -> str:
        if self._written is None:
            parent = tempfile.mkdtemp(prefix="trackbed-")
            weakref.finalize(self, shutil.rmtree, parent, ignore_errors=True)
            # Pictures and reports show the name of the folder as the name of the run.
            folder = os.path.join(parent, self.name.replace("/", "_").lstrip(".") or "run")
            self._core.write(folder, False)
            self._written = folder
        return self._written

    def _repr_html_(self) -> str:
        return (
            '<iframe sandbox="allow-scripts" style="width: 100%; height: 720px; border: 0" '
            f'srcdoc="{html.escape(self.report())}"></iframe>'
        )

    def __copy__(self) -> Run:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Run:
        return self

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            "a Run cannot be pickled, for example to return it from another process; return "
            "run[plant], run.metrics or run.to_pandas(), or the folder of run.write(folder)"
        )

    def __eq__(self, other: object) -> bool:
        return self is other

    def __hash__(self) -> int:
        return id(self)

    def __repr__(self) -> str:
        return f"<Run {_trackbed.describe(self._core)}>"


class Comparison(Mapping[str, Any]):
    """The differences of two plants or runs at equal stations, as in metrics.json."""

    def __init__(self, core: _trackbed.PlantComparison) -> None:
        require_core(self, core, _trackbed.PlantComparison, "trackbed.compare(run, first, second) returns")
        self._core = core
        self._values = core.values

    def __reduce__(self) -> NoReturn:
        raise TypeError("a Comparison cannot be pickled; use dict(comparison)")

    def __getitem__(self, key: str) -> Any:
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"<Comparison {self._core.description}>"


def run(
    scenario: Scenario, plants: Plants = None, set: Overrides = None, *, seed: Optional[int] = None
) -> Run:
    """Plans, simulates, measures and judges a scenario, as `trackbed run` does.

    scenario: a YAML file, or the name of a scenario that comes with the package.
    plants: names of the plants, instead of those of the scenario.
    set: keys of the scenario and their values, such as {"mission.speed": 2}. A key that names a
        section, such as {"plan": {...}}, replaces the whole section.
    seed: the scenario's seed, at least 0.

    Raises InputError (a ValueError) for a wrong scenario, and RunError (a RuntimeError) if the
    environment fails. A run without a plan is a result: its verdict has failed. Other threads of
    Python continue during a run. Ctrl-C ends a simulation; a planner first finishes its plan.
    """
    return Run(_trackbed.run(load(scenario, set, plants, seed)))


def pixels(name: str, value: object) -> tuple[int, int]:
    """Returns the width and the height [px] of the argument `name`."""
    if isinstance(value, numpy.ndarray):
        value = value.tolist()
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise TypeError(f"{name} must be (width, height) in pixels")
    return whole(f"{name}[0]", value[0], 1, INT_MAX), whole(f"{name}[1]", value[1], 1, INT_MAX)


def frame(
    run: Run,
    t: float,
    size: tuple[int, int] = (640, 360),
    *,
    camera: str = "chase",
    quality: str = "draft",
) -> numpy.typing.NDArray[numpy.uint8]:
    """Draws the run at the time `t` [s], off-screen.

    Returns an array of uint8 with the shape (height, width, 3): red, green and blue, from the top
    left. `size` is (width, height), at least (64, 64). `camera` and `quality` are those of `trackbed render`.
    """
    instance("run", run, Run)
    width, height = pixels("size", size)
    return _trackbed.frame(
        run._folder(), number("t", t), width, height, text("camera", camera), text("quality", quality)
    )


def film(
    run: Run,
    file: Union[str, os.PathLike[str]],
    size: tuple[int, int] = (1280, 720),
    *,
    fps: float = 30.0,
    camera: str = "chase",
    quality: str = "draft",
) -> None:
    """Films the run; the extension of `file` is .mp4, .webp, .apng or .png (one file per frame).

    `size` is (width, height), at least (64, 64), and even for .mp4. `fps` is the number of frames per
    second of the run, 1 to 240. Ctrl-C ends the film, which is then not written.
    """
    instance("run", run, Run)
    width, height = pixels("size", size)
    _trackbed.film(
        run._folder(),
        path("file", file),
        width,
        height,
        number("fps", fps),
        text("camera", camera),
        text("quality", quality),
    )


def _pandas() -> Any:
    try:
        return importlib.import_module("pandas")
    except ImportError:
        raise ImportError("to_pandas() needs pandas: pip install trackbed[pandas]") from None
