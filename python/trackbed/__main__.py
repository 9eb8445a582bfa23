"""The program `trackbed` with plug-ins: `trackbed run --import my_module scenario.yaml`."""

from __future__ import annotations

import importlib
import os
import sys
import traceback

from . import _signatures, _trackbed

_BAD_INPUT = 2


def _split(arguments: list[str]) -> tuple[list[str], list[str]]:
    """Returns the modules of the options --import, and the other arguments."""
    modules, others = [], []
    rest = iter(arguments)
    for argument in rest:
        if argument == "--import":
            modules.append(next(rest, ""))
        elif argument.startswith("--import="):
            modules.append(argument[len("--import=") :])
        else:
            others.append(argument)
    return modules, others


def _import(name: str) -> None:
    """Imports a module by its name, from the working folder or the path of Python."""
    if not name:
        print("--import needs the name of a Python module, such as my_planner", file=sys.stderr)
        raise SystemExit(_BAD_INPUT)
    if name.endswith(".py") or os.sep in name:
        print(
            f"--import: '{name}' is a file; give the name of the module, "
            f"{os.path.splitext(os.path.basename(name))[0]}, and its folder in PYTHONPATH",
            file=sys.stderr,
        )
        raise SystemExit(_BAD_INPUT)
    try:
        importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name is None or not (name == error.name or name.startswith(error.name + ".")):
            traceback.print_exc()
        else:
            print(
                f"--import: no module '{name}' in the working folder, PYTHONPATH or the packages of "
                f"{sys.executable}",
                file=sys.stderr,
            )
        raise SystemExit(_BAD_INPUT) from None
    except Exception:
        traceback.print_exc()
        print(f"--import: the module '{name}' raised an exception", file=sys.stderr)
        raise SystemExit(_BAD_INPUT) from None


def main() -> int:
    """Runs the program with the arguments of the command line, and returns its exit code."""
    modules, arguments = _split(sys.argv[1:])
    if modules and arguments[:2] == ["sweep", "submit"]:
        print(
            "--import: `sweep submit` writes scripts that call the program without Python; let your "
            "own script call `srun python3 -m trackbed sweep --shard I/N --import ...`",
            file=sys.stderr,
        )
        return _BAD_INPUT
    folder = os.getcwd()
    if folder not in sys.path:
        sys.path.insert(0, folder)
    for name in modules:
        _import(name)
    sys.stdout.flush()
    code = _trackbed.main(["trackbed", *arguments])
    parts = _signatures.names_of(("planner", "controller", "plant"))
    if code == _BAD_INPUT and arguments[:1] == ["fmu"] and parts:
        print(
            "--import: an FMU contains no Python, so that its scenario cannot use the plug-ins "
            f"{', '.join(parts)}",
            file=sys.stderr,
        )
    return code


if __name__ == "__main__":
    sys.exit(main())
