"""Reads every file of folders with the program, and prints a table of the results (docs/how-to/survey.md)."""
import argparse
import collections
import pathlib
import random
import sys
import tempfile
import traceback
import zlib

import kinds
import lanelet2
import maps
import models
import paths
import roads
import scenes
from program import Program
from result import Result

SURVEYS = {
    "road network": roads.survey, "CommonRoad scenario": scenes.commonroad, "vehicle model": models.survey,
    "track": paths.track, "path": paths.path, "positions": paths.positions, "recording": paths.recording,
    "bag": scenes.bag, "tyre": scenes.tyre, "map": maps.survey, "Lanelet2": lanelet2.survey,
}


def files_of(folders):
    for folder in folders:
        if folder.is_file():
            yield folder.parent, folder
        for file in sorted(folder.rglob("*")):
            if file.is_file() and ".git" not in file.parts:
                yield folder, file


def surveyed(program, kind, file, seed, drive):
    """Returns the result of a file. The random numbers depend only on the seed and on the name of the file."""
    numbers = random.Random(zlib.crc32(f"{seed} {file.name}".encode()))
    try:
        return SURVEYS[kind](program, file, numbers, drive)
    except Exception as error:  # pylint: disable=broad-except
        traceback.print_exc()
        result = Result(kind)
        result.note(f"the survey itself failed: {error!r}")
        result.faults.append("not compared")
        return result


def cell(text):
    return text.replace("|", "/").replace("\n", " ")


def row(folder, file, result, scratch):
    state = "accepted" if result.accepted else "refused"
    messages = "; ".join(result.messages + result.faults).replace(str(scratch), "").replace(str(file), file.name)
    wrong = "; ".join(result.wrongs) or "-"
    return "| " + " | ".join(map(cell, (result.kind, str(file.relative_to(folder)), state, messages or "-",
                                        result.driven or "-", result.detail or "-", wrong))) + " |"


def totals(results):
    """Returns a table with the numbers of results of each kind of file."""
    counts = collections.defaultdict(collections.Counter)
    for result in results:
        c = counts[result.kind.replace(" with headings", "")]
        c["files"] += 1
        c["accepted"] += result.accepted
        c["refused"] += not result.accepted
        c["driven"] += result.driven == "yes"
        c["faults"] += bool(result.faults)
        c["wrong"] += bool(result.wrongs)
    names = ("files", "accepted", "refused", "driven", "faults", "wrong")
    lines = ["| kind | " + " | ".join(names) + " |", "|---|" + "---|" * len(names)]
    return lines + [f"| {kind} | " + " | ".join(str(c[name]) for name in names) + " |" for kind, c in sorted(counts.items())]


def main():
    parser = argparse.ArgumentParser(prog="scripts/survey", description=__doc__)
    parser.add_argument("folders", nargs="+", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--drive", action="store_true", help="also drive what is planned, with the kinematic car")
    parser.add_argument("--seed", type=int, default=0, help="of the routes on road networks")
    parser.add_argument("-o", "--out", type=pathlib.Path, metavar="TABLE.md", help="write the table to this file")
    parser.add_argument("--program", required=True, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    missing = [str(folder) for folder in arguments.folders if not folder.exists()]
    if missing:
        parser.error("no such folder: " + ", ".join(missing))
    lines = ["| kind | file | state | messages | driven | compared | wrong |", "|---|---|---|---|---|---|---|"]
    results = []
    with tempfile.TemporaryDirectory(prefix="survey_") as folder:
        scratch = pathlib.Path(folder)
        program = Program(arguments.program, scratch)
        for base, file in files_of([f.resolve() for f in arguments.folders]):
            kind = kinds.kind(file)
            if kind is None:
                continue
            results.append(surveyed(program, kind, file, arguments.seed, arguments.drive))
            lines.append(row(base, file, results[-1], scratch))
            if arguments.out:
                print(lines[-1], file=sys.stderr, flush=True)
    text = "\n".join(lines + [""] + totals(results)) + "\n"
    if arguments.out:
        arguments.out.write_text(text)
    else:
        print(text, end="")
    return 1 if any(r.wrongs or r.faults for r in results) else 0


if __name__ == "__main__":
    sys.exit(main())
