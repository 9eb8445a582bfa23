"""Adapts vehicle models and compares their total mass with the mass that MuJoCo's library computes."""
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

from result import Result

LIMIT = 1e-9  # of the mass


def library(program):
    """Returns the path of the MuJoCo library that the program is linked with, or None."""
    try:
        listed = subprocess.run(["ldd", program.path], capture_output=True, text=True, check=False).stdout
    except OSError:
        return None
    found = re.search(r"libmujoco\S* => (\S+)", listed)
    return found.group(1) if found else None


def mass(program, file):
    """Returns (mass, ""), or (None, reason) if the mass cannot be computed."""
    found = library(program)
    if not found:
        return None, "MuJoCo's library was not found"
    done = subprocess.run([sys.executable, str(pathlib.Path(__file__).with_name("masses.py")), found, str(file)],
                          capture_output=True, text=True, cwd=program.scratch, check=False, preexec_fn=program.bound)
    if done.returncode != 0:
        return None, "MuJoCo's library refuses it: " + (done.stderr.strip().splitlines() or ["?"])[-1]
    return float(done.stdout), ""


def urdf_mass(root):
    """Returns the sum of the masses in a URDF file. MuJoCo's library welds the base of the robot to the world, so it
    omits the mass of the base. A link without mass gets 1e-6 kg (docs/how-to/adapt.md)."""
    masses = [link.find("inertial/mass") for link in root.findall("link")]
    return sum(1e-6 if m is None or float(m.get("value")) == 0.0 else float(m.get("value")) for m in masses)


def expected_mass(program, file):
    root = ElementTree.parse(file).getroot()
    if root.tag == "robot":
        return urdf_mass(root), ""
    trees = movable_trees(root)
    return mass(program, file) if trees == 1 else (None, f"{trees} movable bodies in the file")


def movable_trees(root):
    """Returns the number of bodies that can move in the world; 1 for a file that includes other files."""
    if root.find(".//include") is not None:
        return 1
    bodies = root.findall("worldbody/body")
    return sum(b.find(".//joint") is not None or b.find(".//freejoint") is not None for b in bodies)


def survey(program, file, _, drive):
    result = Result("vehicle model")
    known = program.call("model", file, "--allow-assets", file.parent)
    car = file
    if known.accepted:
        result.detail = "as found"
    else:
        car = program.scratch / "car.xml"
        car.unlink(missing_ok=True)
        adapted = program.call("model", file, "--adapt", "-o", car, "--allow-assets", file.parent)
        result.add(adapted if not adapted.accepted else program.call("model", car))
        result.detail = "adapted"
    result.accepted = car.exists() and not result.messages
    if not result.accepted:
        return result
    compare(program, file, car, result)
    if drive:
        result.driven = program.drive({"vehicle": {"model": str(car)}, "mission": {
            "speed": 1.0, "start": {"speed": 0.0}, "waypoints": [[0, 0], [10, 0]]}, "plan": {"method": "fillet"}}, car.parent)
    return result


def compare(program, file, car, result):
    """Compares the mass of the car that the program simulates with the mass in the file."""
    composed = program.scratch / "composed.xml"
    saved = program.call("model", car, "--save", composed, "--allow-assets", file.parent)
    if not saved.accepted:
        result.add(saved)
        return
    expected, why = expected_mass(program, file)
    found, also = mass(program, composed)
    if expected is None or found is None:
        result.detail += ", mass not compared: " + (why or also)
        return
    result.detail += f", {found:.6g} kg"
    if abs(found - expected) > LIMIT * max(expected, 1.0):
        result.wrong(f"{found!r} kg instead of {expected!r} kg")
