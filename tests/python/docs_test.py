"""Runs the Python blocks of the docs, each page in a folder of its own."""

import ast
import importlib.util
import inspect
import pathlib
import re

import pytest

import trackbed

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ["docs/how-to/python.md", "docs/tutorial-python.md"]

pytest_plugins = "trackbed.pytest_plugin"


@pytest.mark.parametrize("page", PAGES)
def test_blocks_run_in_their_order(page, tmp_path, monkeypatch, trackbed_run):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / page).read_text(encoding="utf-8")
    blocks = list(re.finditer(r"^```python\n(.*?)^```", text, re.M | re.S))
    assert blocks
    names = {}
    for block in blocks:
        if "import gymnasium" in block.group(1) and importlib.util.find_spec("gymnasium") is None:
            continue
        # The traceback of an example must show the line numbers of the page.
        before = text.count("\n", 0, block.start(1))
        exec(compile("\n" * before + block.group(1), page, "exec"), names)
    tests = [value for name, value in names.items() if name.startswith("test_")]
    for test in tests:
        test(trackbed_run)
    if page.endswith("tutorial-python.md"):
        # The page claims these two facts: the example raises the error, and the steering acts
        # against the errors and into the turn.
        assert names["cost"].min() ** 0.5 < 0.3
        assert (names["mean"][:2] < 0).all() and names["mean"][2] > 0


def test_every_page_with_python_blocks_is_run():
    pages = [p for p in sorted((ROOT / "docs").rglob("*.md")) if "```python" in p.read_text("utf-8")]
    found = [str(p.relative_to(ROOT)) for p in pages if "import trackbed" in p.read_text("utf-8")]
    assert sorted(found) == sorted(PAGES)


def _members(kind):
    """Returns the public functions and properties that a class defines itself, by name."""
    items = vars(kind).items()
    return {n: m for n, m in items if n[0] != "_" and (callable(m) or isinstance(m, property))}


def test_every_public_name_has_a_docstring():
    names = {name: getattr(trackbed, name) for name in trackbed.__all__ if name != "__version__"}
    if importlib.util.find_spec("gymnasium"):
        from trackbed import gym

        names.update({"PathTracking": gym.PathTracking, "VectorPathTracking": gym.VectorPathTracking})
    for name, kind in list(names.items()):
        if inspect.isclass(kind):
            names.update({f"{name}.{n}": member for n, member in _members(kind).items()})
    assert [name for name, member in names.items() if not inspect.getdoc(member)] == []


def test_numbers_of_compiled_classes_have_units():
    kinds = (trackbed.Observation, trackbed.ControllerInput, trackbed.PlantSetup, trackbed.Vehicle)
    others = {"name", "status", "ended", "vehicle"}
    without = [
        f"{kind.__name__}.{name}"
        for kind in kinds
        for name, member in _members(kind).items()
        if isinstance(member, property) and name not in others and not re.search(r"\[.+\]", member.__doc__)
    ]
    assert without == []


def _public(names):
    return {name for name in names if name[0] != "_"}


def _defined(statements):
    """Returns the public names of functions, classes, properties and variables in a stub."""
    functions = [s.name for s in statements if isinstance(s, (ast.FunctionDef, ast.ClassDef))]
    return _public(functions + [s.target.id for s in statements if isinstance(s, ast.AnnAssign)])


def test_stub_has_the_names_of_the_compiled_module():
    core = trackbed._trackbed
    stub = ast.parse(pathlib.Path(trackbed.__file__).with_name("_trackbed.pyi").read_text("utf-8"))
    assert _defined(stub.body) == _public(vars(core))
    for kind in (s for s in stub.body if isinstance(s, ast.ClassDef)):
        assert _defined(kind.body) == _public(vars(getattr(core, kind.name))), kind.name
