"""Tests that the report of every shipped scenario has at most 3 MB without its film.

size_test.py PROGRAM SCENARIOS [I/N]: runs each scenario of a folder, or the Ith of N parts of them, and writes its
report. Prints the sizes, the largest first, and the size of the replay scene per minute and plant.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

LARGEST = 3_000_000  # [B]
LARGEST_SCENE = 500_000  # [B] for a minute and plant


def scene_size(page):
    """Size of the replay scene per minute and plant [B], of runs that are long enough."""
    data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S).group(1))
    sizes = [0]
    for run in data["runs"]:
        for plant in run["plants"]:
            duration = plant["log"]["t"][-1]
            if duration > 20 and "motion" in plant:
                sizes.append(len(json.dumps([plant["motion"], plant["tyres"]])) * 60 / duration)
    return max(sizes)


def main():
    program, scenarios = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    part, parts = (int(number) for number in (sys.argv[3] if len(sys.argv) > 3 else "1/1").split("/"))
    files = [
        file
        for file in sorted(scenarios.rglob("*.yaml"))
        if "studies" not in file.parts and "maps" not in file.parts and "\nparameters:" not in file.read_text()
    ]
    if len(files) < 30:
        sys.exit(f"only {len(files)} scenarios in {scenarios}")
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for scenario in files[part - 1 :: parts]:
            out = pathlib.Path(folder) / scenario.stem
            done = subprocess.run(
                [program, "run", "-q", "--report", scenario, "-o", out], capture_output=True, text=True, check=False
            )
            if done.returncode not in (0, 3):
                sys.exit(f"{scenario}: {done.stdout}{done.stderr}")
            page = out / "report.html"
            found.append((page.stat().st_size, scene_size(page.read_text()), scenario.stem))
    for size, scene, name in sorted(found, reverse=True):
        print(f"{size / 1e6:5.2f} MB, scene {scene / 1e6:.3f} MB/min/plant: {name}")
    sys.exit(int(any(size > LARGEST or scene > LARGEST_SCENE for size, scene, _ in found)))


if __name__ == "__main__":
    main()
