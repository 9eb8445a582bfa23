"""Uses an installed wheel: runs scenarios, steps a car, exports an FMU, and lists the libraries that
were loaded.

scripts/wheel --check calls this program in a new virtual environment and an empty folder.
"""

import bz2  # noqa: F401  The interpreter's own modules may load libraries of the system.
import json
import lzma  # noqa: F401
import pathlib
import re
import subprocess
import sys
import zipfile

import numpy

# Libraries of the C and C++ runtime, which every wheel for Linux expects from the system (PEP 600).
RUNTIME = re.compile(r"(ld-linux|libc|libm|libdl|libpthread|librt|libresolv|libstdc\+\+|libgcc_s|libz)(?=[.-])")


def libraries():
    lines = pathlib.Path("/proc/self/maps").read_text().splitlines()
    return {line.split()[-1] for line in lines if ".so" in line.split()[-1]}


before = libraries()
import trackbed  # noqa: E402

package = pathlib.Path(trackbed.__file__).parent
assert str(package).startswith(sys.prefix), package
run = trackbed.run("three_turns", plants=["kinematic", "single_track", "mujoco"])
assert run.passed, run.verdict
assert abs(run["mujoco"]["cross_track_m"]).max() < 0.5
assert len(run.report()) > 100_000
loop = trackbed.Loop("three_turns", "mujoco")
while not loop.observation.ended:
    loop.step()
numpy.testing.assert_array_equal(loop.log["x_m"], run["mujoco"]["x_m"])

# These commands need IPOPT, to plan a racing line, and PROJ, to project a path from longitude and
# latitude.
assert trackbed.run("kidney_minimum_curvature", plants="kinematic").path is not None
line = {"type": "LineString", "coordinates": [[11.0 + i * 1e-5, 48.0] for i in range(50)]}
pathlib.Path("line.geojson").write_text(json.dumps(line))
pathlib.Path("line.yaml").write_text(
    "schema: 1\nname: line\nvehicle: {model: prius}\nmission: {speed: 2}\n"
    "plan: {method: path_file, file: line.geojson}\ncontrol: {method: preview}\n"
)
assert trackbed.run("line.yaml").passed

# The FMU contains all libraries that it needs, and their licenses.
program = pathlib.Path(sys.prefix) / "bin/trackbed"
subprocess.run([program, "fmu", "-q", "three_turns", "--plant", "mujoco", "-o", "car.fmu"], check=True)
with zipfile.ZipFile("car.fmu") as fmu:
    fmu.extractall("car")
texts = pathlib.Path("car/documentation/licenses")
index = (texts / "license.txt").read_text()
assert "no text found" not in index, index
assert list(texts.glob("libproj-*.txt")), index
LOADED = """
import ctypes, glob
maps = lambda: {line.split()[-1] for line in open("/proc/self/maps")}
before = maps()
ctypes.CDLL(*glob.glob("car/binaries/*/trackbed.so"))
print(*(maps() - before), sep="\\n")
"""
loaded = subprocess.run([sys.executable, "-c", LOADED], check=True, capture_output=True, text=True)
strangers = [
    file
    for file in loaded.stdout.splitlines()
    if ".so" in file
    and not file.startswith(str(pathlib.Path("car").resolve()))
    and not RUNTIME.match(pathlib.Path(file).name)
]
assert not strangers, f"libraries that the FMU does not carry: {strangers}"

standard = str(pathlib.Path(json.__file__).parents[1])  # The folder of the standard library.
strangers = [
    file
    for file in sorted(libraries() - before)
    if not file.startswith((sys.prefix, standard)) and not RUNTIME.match(pathlib.Path(file).name)
]
assert not strangers, f"libraries that the wheel does not carry: {strangers}"
print(f"{package}: {run!r}")
