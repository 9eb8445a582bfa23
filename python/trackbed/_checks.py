"""Assertions on runs, which fail with the texts of the GoogleTest matchers of trackbed::testing."""

from __future__ import annotations

from typing import Any, Optional, Union

from . import _trackbed
from ._arguments import at_least_zero, instance, text
from ._runs import Comparison, Run


def _check(run: Run, check: Any) -> None:
    __tracebackhide__ = True
    instance("run", run, Run)
    failures = check.failures(run._core)
    if failures:
        raise AssertionError(
            f"Expected: {check.description}\n"
            f"  Actual: {_trackbed.describe(run._core)}, {'; '.join(failures)}"
        )


def tracks_within(run: Run, limit: float) -> None:
    """Asserts that the largest cross-track error of every plant is at most `limit` [m]."""
    __tracebackhide__ = True
    _check(run, _trackbed.tracks_within(at_least_zero("limit", limit)))


def stays_within(run: Run, first: str, second: str, limit: float) -> None:
    """Asserts that two plants at equal stations are never further apart than `limit` [m]."""
    __tracebackhide__ = True
    names = text("first", first), text("second", second)
    _check(run, _trackbed.stays_within(*names, at_least_zero("limit", limit)))


def keeps_clearance(run: Run, distance: float) -> None:
    """Asserts that every plant stays at least `distance` [m] from every obstacle."""
    __tracebackhide__ = True
    _check(run, _trackbed.keeps_clearance(at_least_zero("distance", distance)))


def reaches_goal(run: Run, distance: float) -> None:
    """Asserts that every plant arrives, at most `distance` [m] from the end of the path."""
    __tracebackhide__ = True
    _check(run, _trackbed.reaches_goal(at_least_zero("distance", distance)))


def steers_calmly(run: Run) -> None:
    """Asserts that no plant's steering command oscillates without an end, as in a limit cycle."""
    __tracebackhide__ = True
    _check(run, _trackbed.steers_calmly())


def satisfies(run: Run, formula: str) -> None:
    """Asserts that every plant's log satisfies a formula of temporal logic over its columns.

    Raises InputError (a ValueError) if `formula` is no formula, or names an unknown column.
    """
    __tracebackhide__ = True
    instance("run", run, Run)
    _trackbed.require_formula(run._core, text("formula", formula))
    _check(run, _trackbed.satisfies(text("formula", formula)))


def meets_its_expectations(run: Run) -> None:
    """Asserts that the run meets the `expect` section of its scenario."""
    __tracebackhide__ = True
    _check(run, _trackbed.meets_its_expectations())


def compare(first: Run, second: Union[Run, str], plant: str) -> Comparison:
    """Compares plants at equal stations.

    compare(run, "kinematic", "mujoco") compares two plants of one run;
    compare(run, other_run, "mujoco") compares one plant in two runs.
    """
    instance("first", first, Run)
    if isinstance(second, Run):
        return Comparison(_trackbed.compare_runs(first._core, second._core, text("plant", plant)))
    return Comparison(_trackbed.compare(first._core, text("second", second), text("plant", plant)))


def differs_by_at_most(
    comparison: Comparison,
    *,
    position: Optional[float] = None,
    heading: Optional[float] = None,
    yaw_rate: Optional[float] = None,
    steering: Optional[float] = None,
) -> None:
    """Asserts bounds on the differences of two plants at equal stations.

    position [m], heading [rad], yaw_rate [rad/s], steering [rad]; None: no bound.
    """
    __tracebackhide__ = True
    instance("comparison", comparison, Comparison)
    given = {"position": position, "heading": heading, "yaw_rate": yaw_rate, "steering": steering}
    bounds = {key: at_least_zero(key, bound) for key, bound in given.items() if bound is not None}
    if not bounds:
        raise ValueError(f"no bound is given; give at least one of {', '.join(given)}")
    description, failures = comparison._core.exceeded(bounds)
    if failures:
        raise AssertionError(
            f"Expected: differ by at most {description}\n"
            f"  Actual: {comparison._core.description}, {'; '.join(failures)}"
        )
