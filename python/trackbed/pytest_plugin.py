"""Plugin for pytest: the fixture trackbed_run, and scenario files as tests.

`pytest scenarios/` collects the scenarios in the folders and files that the command line names, and
fails for each scenario that does not meet its expectations. A YAML file counts as a scenario if it
has at least two of the sections that every scenario may have.
"""

from __future__ import annotations

import os
import pathlib
import re
from collections.abc import Iterator
from typing import Any, Callable, Optional

import pytest

import trackbed
from trackbed import _arguments, _signatures, _trackbed

_SECTIONS = re.compile(r"^(vehicle|mission|plan|control|world|disturb|drive|record|expect)\s*:", re.M)


TrackbedRun = Callable[..., trackbed.Run]
"""Type of the fixture trackbed_run."""


@pytest.fixture(scope="session")
def trackbed_run() -> TrackbedRun:
    """Runs scenarios as trackbed.run does, each only once in a session.

    Call it with the arguments of trackbed.run. A second call with the same arguments returns the
    same run, unless the scenario's file or a plug-in has changed. Changes of other files that the
    scenario names are not noticed.
    """
    runs: dict[tuple[str, str, int], trackbed.Run] = {}

    def run(
        scenario: _arguments.Scenario,
        plants: _arguments.Plants = None,
        set: _arguments.Overrides = None,
        *,
        seed: Optional[int] = None,
    ) -> trackbed.Run:
        content = _arguments.load(scenario, set, plants, seed).yaml
        key = (os.path.abspath(scenario), content, _signatures.latest_registration())
        if key not in runs:
            runs[key] = trackbed.run(scenario, plants, set, seed=seed)
        return runs[key]

    return run


def _named_on_command_line(config: pytest.Config, file: pathlib.Path) -> bool:
    folder = config.invocation_params.dir
    named = {
        pathlib.Path(os.path.abspath(folder / str(argument).split("::")[0]))
        for argument in config.invocation_params.args
        if not str(argument).startswith("-")
    }
    return file in named or any(parent in named for parent in file.parents)


def _is_scenario(file: pathlib.Path) -> bool:
    text = file.read_text(encoding="utf-8", errors="replace")
    return len(set(_SECTIONS.findall(text))) >= 2


def pytest_collect_file(file_path: pathlib.Path, parent: pytest.Collector) -> Optional[Any]:
    if file_path.suffix not in (".yaml", ".yml"):
        return None
    if not _named_on_command_line(parent.config, file_path) or not _is_scenario(file_path):
        return None
    return _ScenarioFile.from_parent(parent, path=file_path)


class _ScenarioFile(pytest.File):
    def collect(self) -> Iterator[pytest.Item]:
        yield _ScenarioItem.from_parent(self, name=self.path.stem)


class _ScenarioItem(pytest.Item):
    def runtest(self) -> None:
        run = trackbed.run(self.path)
        if run.verdict["passed"] is None:
            pytest.skip("the scenario has no expectations")
        trackbed.meets_its_expectations(run)

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        if isinstance(excinfo.value, (AssertionError, _trackbed.InputError, _trackbed.RunError)):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[os.PathLike[str], Optional[int], str]:
        return self.path, None, self.path.name
