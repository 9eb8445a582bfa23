"""The types of the package, of the Python blocks of the docs, and of the examples."""

import pathlib
import re
import subprocess
import sys

import pytest

import trackbed

pytest.importorskip("mypy", reason="scripts/setup python-tests installs mypy")
gymnasium = pytest.importorskip("gymnasium")
ROOT = pathlib.Path(__file__).resolve().parents[2]


# The libraries of the examples have no types, or are not installed.
CONFIGURATION = """[mypy]
follow_imports = silent
ignore_missing_imports = True
[mypy-trackbed.*]
disallow_any_generics = True
disallow_incomplete_defs = True
disallow_untyped_calls = True
disallow_untyped_defs = True
no_implicit_reexport = True
warn_return_any = True
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder in which only trackbed and Gymnasium are known beside the site-packages."""
    path = tmp_path_factory.mktemp("types")
    (path / "known").mkdir()
    for module in (trackbed, gymnasium):
        package = pathlib.Path(module.__file__).parent
        (path / "known" / package.name).symlink_to(package)
    (path / "mypy.ini").write_text(CONFIGURATION, encoding="utf-8")
    return path


def check(folder, *arguments):
    """Returns what mypy finds."""
    command = [sys.executable, "-m", "mypy", "--config-file", "mypy.ini", "--cache-dir", "cache",
               "--python-executable", sys.executable, *arguments]
    environment = {"MYPYPATH": str(folder / "known"), "PYTHONPATH": ":".join(sys.path)}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    return done.stdout + done.stderr


def test_the_package_has_types_throughout(folder):
    found = check(folder, "-p", "trackbed")
    assert found.startswith("Success"), found


def test_examples_of_the_docs_have_the_right_types(folder):
    files = list((ROOT / "docs/examples/python").glob("*.py"))
    for page in (ROOT / "docs").rglob("*.md"):
        blocks = re.findall(r"^```python\n(.*?)^```", page.read_text("utf-8"), re.M | re.S)
        if blocks:
            files.append(folder / f"{page.stem.replace('-', '_')}_page.py")
            files[-1].write_text("\n".join(blocks), encoding="utf-8")
    assert len(files) > 3
    found = check(folder, *files)
    assert found.startswith("Success"), found


def test_a_wrong_type_is_found(folder):
    wrong = folder / "wrong.py"
    wrong.write_text("import trackbed\ntrackbed.run('three_turns').plants + 1\n", encoding="utf-8")
    assert "[operator]" in check(folder, wrong)
