"""Reads tables of numbers with any common separators, comments and headers."""
import math
import re

NAMES = {
    "x": ("x_m", "x", "pos_x", "easting", "x[m]"), "y": ("y_m", "y", "pos_y", "northing", "y[m]"),
    "yaw": ("psi_rad", "yaw", "yaw_rad", "heading", "heading_rad", "theta"), "time": ("t", "t_s", "time", "time_s"),
    "lat": ("lat", "latitude", "latitude_deg"), "lon": ("lon", "lng", "longitude", "longitude_deg"),
    "right": ("w_tr_right_m", "width_right", "w_right"), "left": ("w_tr_left_m", "width_left", "w_left"),
}


def cells(line):
    separator = next((s for s in (";", "\t", ",") if s in line), ",")
    return [cell.strip().strip('"') for cell in line.split(separator)]


def numbers(line):
    try:
        return [float(cell) if cell else math.nan for cell in cells(line)]
    except ValueError:
        return None


def columns(names):
    found = {}
    lower = [name.lower() for name in names]
    for key, words in NAMES.items():
        for word in words:
            if word in lower:
                found[key] = lower.index(word)
                break
    return found


def head(text):
    """Returns the column indices of the names in the header, the last line before the rows; {} without a header."""
    before = ""
    for line in text.splitlines():
        line = line.strip()
        if not line:
            continue
        if not line.startswith("#") and numbers(line) is not None:
            return columns(cells(before.lstrip("# ")))
        before = line
    return {}


def kind(text):
    found = head(text)
    if "lat" in found and "lon" in found and "x" not in found:
        return "positions"
    if "x" not in found or "y" not in found:
        return None
    if "right" in found:
        return "track"
    if "time" in found and "yaw" in found:
        return "recording"
    return "path"


def read(file):
    """Returns the columns of a table whose names are in NAMES, as {name: [values]}."""
    text = file.read_text(errors="replace")
    found = head(text)
    rows = []
    for line in text.splitlines():
        line = line.strip()
        if line and not line.startswith("#"):
            row = numbers(line)
            if row is not None and len(row) > max(found.values(), default=0):
                rows.append(row)
    return {key: [row[i] for row in rows] for key, i in found.items()}


def poses(file):
    """Returns (x, y) of the poses of a nav_msgs/Path, in the order of its text."""
    text = re.sub(r"[\"{},]", " ", file.read_text(errors="replace"))
    return [(float(a), float(b)) for a, b in
            re.findall(r"position\s*:\s*x\s*:\s*([-+.\deE]+)\s+y\s*:\s*([-+.\deE]+)", text)]
