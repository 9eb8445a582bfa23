"""Studies: one scenario with many values of some keys, in one table."""

from __future__ import annotations

import atexit
import os
import sys
import time
import weakref
from collections.abc import Iterator, Mapping
from typing import Any, NoReturn, Optional, Union

import numpy
import numpy.typing

from . import _trackbed
from ._arguments import (
    INT_MAX,
    Overrides,
    Scenario,
    flag,
    number,
    overrides,
    path,
    require_core,
    similar,
    whole,
)
from ._runs import _pandas, no_array


class Sweep(Mapping[str, "numpy.typing.NDArray[Any]"]):
    """The table of a study: a column for each key that varies, then `status` and the outputs.

    sweep["status"] is an array of text, one for each finished row in the order of the study.
    Columns of numbers are arrays of float64, with NaN where a run has no value. While the study
    runs, the table grows with every finished row.
    """

    def __init__(self, job: _trackbed.SweepJob) -> None:
        require_core(self, job, _trackbed.SweepJob, "trackbed.sweep(study) returns")
        self._job = job

    @property
    def name(self) -> str:
        """Name of the study."""
        return self._job.name

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return self._job.columns

    @property
    def rows(self) -> int:
        """Number of finished rows."""
        return self._job.count

    @property
    def rows_expected(self) -> int:
        """Number of rows of the complete study."""
        return self._job.rows_expected

    @property
    def complete(self) -> bool:
        """Whether all rows have finished."""
        return self.rows == self.rows_expected

    @property
    def numbers(self) -> list[int]:
        """Numbers of the finished rows, from 0."""
        return list(self._job.rows)

    @property
    def exceptions(self) -> dict[int, BaseException]:
        """Exceptions of plug-ins, with their tracebacks, by the numbers of the rows."""
        return self._job.causes

    def __getitem__(self, name: str) -> numpy.typing.NDArray[Any]:
        if not isinstance(name, str) or name not in self.columns:
            names = self.columns
            raise KeyError(
                f"no column {name!r}{similar(name, names)}; the columns are {', '.join(names)}"
            )
        column = self.columns.index(name)
        return _column([cells[column] for cells in self._job.rows.values()])

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    def wait(self, seconds: Optional[float] = None) -> bool:
        """Waits until the study has finished, or for some seconds; returns whether it has."""
        end = None if seconds is None else time.monotonic() + number("seconds", seconds)
        while not self._job.wait(0.1):
            if end is not None and time.monotonic() >= end:
                return False
        return True

    def __array__(self, *arguments: Any, **named: Any) -> NoReturn:
        raise no_array(self, "sweep[column], or sweep.to_pandas()")

    def stop(self) -> None:
        """Ends the study after the runs' present control period. The finished rows remain."""
        self._job.stop()
        self.wait()

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame of the finished rows. Needs pandas."""
        rows = self._job.rows
        columns = list(zip(*rows.values())) or [()] * len(self.columns)
        data = {name: _column(list(cells)) for name, cells in zip(self.columns, columns)}
        return _pandas().DataFrame(data, index=list(rows))

    def _repr_html_(self) -> Optional[str]:
        try:
            table = self.to_pandas()
        except ImportError:
            return None
        result: Optional[str] = table._repr_html_()
        return result

    def __reduce__(self) -> NoReturn:
        raise TypeError("a Sweep cannot be pickled; use sweep.to_pandas() or dict(sweep)")

    def __repr__(self) -> str:
        return f"<Sweep {self.name}: {self.rows} of {self.rows_expected} rows>"


def _column(cells: list[str]) -> numpy.typing.NDArray[Any]:
    try:
        return numpy.array([float(cell) if cell else numpy.nan for cell in cells])
    except ValueError:
        return numpy.array(cells, dtype=object)


class _Bar:
    """A progress bar on a terminal; elsewhere, one line at the end."""

    def __init__(self, sweep: Sweep, shown: bool) -> None:
        self._sweep = sweep
        self._shown = shown and sys.stderr.isatty()
        self._start, self._before = time.monotonic(), sweep.rows

    def show(self) -> None:
        if not self._shown:
            return
        done, rows = self._sweep.rows, self._sweep.rows_expected
        width = 30
        filled = width * done // max(rows, 1)
        left = ""
        if done > self._before and done < rows:
            per_row = (time.monotonic() - self._start) / (done - self._before)
            left = f", {per_row * (rows - done):.0f} s left"
        bar = "#" * filled + "." * (width - filled)
        sys.stderr.write(f"\r\x1b[K{self._sweep.name} [{bar}] {done}/{rows}{left}")
        sys.stderr.flush()

    def end(self) -> None:
        if self._shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()


_running: weakref.WeakSet[_trackbed.SweepJob] = weakref.WeakSet()


def _has_finished(job: _trackbed.SweepJob) -> bool:
    try:
        return job.wait(0.05)
    except BaseException:  # The study ended with an error.
        return job.wait(0.0)


def _forget_threads() -> None:
    """Forgets the threads that a forked process does not have."""
    _running.clear()
    _trackbed.forget_other_threads()


os.register_at_fork(after_in_child=_forget_threads)


@atexit.register
def _end() -> None:
    """Ends studies, plug-ins and runs on other threads before the interpreter ends."""
    _trackbed.begin_end()
    jobs = list(_running)
    for job in jobs:
        job.stop()
    start = time.monotonic()
    while True:
        waited = time.monotonic() - start
        finished = all([_has_finished(job) for job in jobs])
        # A plug-in has one second to return before it is interrupted.
        inside = _trackbed.interrupt_plugins() if waited > 1.0 or finished else 0
        if finished and not inside and (not _trackbed.running_functions() or waited > 5.0):
            return
        if waited > 5.0:
            sys.stderr.write("trackbed: a plug-in on another thread does not return\n")
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(1)
        time.sleep(0.05)


def sweep(
    study: Scenario,
    out: Union[str, os.PathLike[str], None] = None,
    set: Overrides = None,
    *,
    jobs: Optional[int] = None,
    restart: bool = False,
    progress: bool = True,
    wait: bool = True,
) -> Sweep:
    """Runs a study as `trackbed sweep` does, and returns its table.

    study: a YAML file, or the name of a study that comes with the package.
    out: folder for sweep.csv, sweep.json and the finished rows; a study that was interrupted goes on
        there. By default, nothing is written. Run folders (`keep`) are not written.
    set: keys of the scenario and their values, in all runs.
    jobs: number of runs at the same time, by default one for each processor.
    restart: whether rows that are already in `out` are run again.
    progress: whether a terminal shows a progress bar.
    wait: if false, returns at once; the table grows while the study runs.

    Ctrl-C ends the study and returns the table of the finished rows (Sweep.complete). A row whose
    plug-in raises an exception has the status "error" (Sweep.exceptions).
    """
    file = path("study", study)
    folder = None if out is None else path("out", out)
    count = len(os.sched_getaffinity(0)) if jobs is None else whole("jobs", jobs, 1, INT_MAX)
    shows, waits = flag("progress", progress), flag("wait", wait)
    job = _trackbed.sweep(file, overrides(set), folder, flag("restart", restart))
    result = Sweep(job)
    _running.add(job)
    job.start(count)
    if not waits:
        return result
    bar = _Bar(result, shows)
    try:
        while not job.wait(0.1):
            bar.show()
    except KeyboardInterrupt:
        job.stop()
        while not job.wait(0.1):  # A second Ctrl-C leaves the loop.
            pass
        bar.end()
        sys.stderr.write(f"{result.name}: interrupted after {result.rows} rows\n")
    finally:
        bar.end()
    return result
