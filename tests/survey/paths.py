"""Plans along paths, racing lines and tracks, and compares them with the points and headings of the file."""
import math

import globe
import tables
from near import distances, to_segment
from result import Result

AHEAD = 0.3  # [m]: with headings, the path is that of a point this far behind the points of the file


def reach(points, rows):
    """Returns the number of segments of the plan in three times the longest step of the points, plus 20."""
    length = sum(math.dist(a[:2], b[:2]) for a, b in zip(rows, rows[1:]))
    step = max(math.dist(a, b) for a, b in zip(points, points[1:]))
    return 20 + int(3.0 * step / max(length / len(rows), 1e-6))


def offset(points, rows):
    """Returns the largest distance of the points from the plan."""
    return max(distances(points, [row[:2] for row in rows], reach(points, rows)))


def aside(rows, points):
    """How far the plan of a closed track swings aside of the straight lines between the points."""
    line = points + points[:1]
    return max(min(to_segment(row, a, b) for a, b in zip(line, line[1:])) for row in rows[::20])


def tangents(points):
    """Directions of central differences."""
    last = len(points) - 1
    pairs = ((points[max(i - 1, 0)], points[min(i + 1, last)]) for i in range(last + 1))
    return [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in pairs]


def behind(points, headings, d):
    return [(x - d * math.cos(h), y - d * math.sin(h)) for (x, y), h in zip(points, headings)]


def turns(headings):
    return max(abs((b - a + math.pi) % (2.0 * math.pi) - math.pi) for a, b in zip(headings, headings[1:]))


def keys_of(file, size, deviation, **plan):
    model = "f1tenth" if size < 3.0 else "prius"
    return {"vehicle": {"model": model}, "mission": {"speed": 2.0},
            "plan": {"method": "path_file", "file": str(file), "max_deviation": deviation, "infeasible": "allow", **plan}}


def attempt(program, result, file, keys, drive):
    outcome, rows, details = program.plan(keys, file.parent)
    result.add(outcome)
    if rows:
        result.accepted = True
        if drive and not result.driven:
            result.driven = program.drive(keys, file.parent)
    return rows, details


def path(program, file, _, drive):
    """Checks the points of a path. With headings, also checks a point behind each, which a wrong heading moves."""
    result = Result("path")
    table = tables.read(file) if file.suffix.lower() not in (".yaml", ".yml", ".json", ".xml") else {}
    points = list(zip(table["x"], table["y"])) if "x" in table else tables.poses(file)
    if len(points) < 3:
        rows, _ = attempt(program, result, file, keys_of(file, 9.0, 0.05), drive)
        result.detail = "no points found by the survey"
        return result
    step = sum(math.dist(a, b) for a, b in zip(points, points[1:])) / len(points)
    rows, _ = attempt(program, result, file, keys_of(file, 10.0 * step, 0.05), drive)
    if rows:
        off = offset(points, rows)
        result.detail = f"{len(points)} points, {off:.3f} m"
        if off > 0.05 + 0.001:
            result.wrong(f"a point is {off:.3f} m off the plan")
    if "yaw" not in table:
        return result
    result.kind = "path with headings"
    rows, _ = attempt(program, result, file, keys_of(file, 10.0 * step, 0.05, ahead=AHEAD), False)
    if rows:
        headings = tangents(points)
        off = offset(behind(points, headings, AHEAD), rows)
        limit = 0.05 + 0.001 + AHEAD * turns(headings)
        result.detail += f", headings to {off / AHEAD:.3f} rad"
        if off > limit:
            result.wrong(f"headings of the file are off by about {off / AHEAD:.2f} rad")
    return result


def positions(program, file, _, drive):
    """Checks positions on the globe; reads a file with several lines line by line."""
    result = Result("positions")
    lines = globe.lines(file)
    for number in range(1, max(len(lines), 1) + 1):
        extra = {"line": number} if len(lines) > 1 else {}
        rows, _ = attempt(program, result, file, keys_of(file, 9.0, 2.0, **extra), drive)
        if not rows:
            continue
        off = min((offset(globe.local(line), rows) for line in lines), default=math.inf)
        result.detail = f"{len(lines)} lines, {off:.2f} m"
        if off > 2.0 + 0.01:
            result.wrong(f"line {number}: a position is {off:.2f} m off the plan")
    return result


def track(program, file, _, drive):
    """Checks the center line of a track, which the program may smooth by the distance that the plan states."""
    result = Result("track")
    table = tables.read(file)
    points = list(zip(table["x"], table["y"]))
    width = min(table["right"] + table["left"])
    length = sum(math.dist(a, b) for a, b in zip(points, points[1:]))
    keys = {"vehicle": {"model": "f1tenth" if width < 1.8 else "prius"},
            "mission": {"speed": 2.0, "track": {"file": str(file)}}, "plan": {"method": "center_line"}}
    rows, details = attempt(program, result, file, keys, drive)
    if rows:
        stated = float(details.get("deviation_max_m", 0.0))
        # The plan begins at the start line and joins the line on its way; the comparison leaves out these parts.
        begin = max(1, int(0.15 * len(points)))
        start = min(range(len(rows)), key=lambda i: math.dist(rows[i][:2], points[begin]))
        off = offset(points[begin:-1], rows[max(start - 2, 0):])
        result.detail = f"{len(points)} points, {length:.0f} m, {off:.3f} m, smoothed by {stated:.3f} m"
        if off > stated + 0.02 or stated > 0.5 * width:
            result.wrong(f"a point is {off:.3f} m off the plan")
        swing = aside(rows, points)
        if swing > width:
            result.wrong(f"the plan is {swing:.2f} m off the lines between the points")
    return result


def recording(program, file, _, __):
    """Reads a log with the column map that the program proposes for it."""
    result = Result("recording")
    listing = program.call("import", file, "--list", "--allow-assets", file.parent)
    result.add(listing)
    if not listing.accepted:
        return result
    chart = program.scratch / "map.yaml"
    chart.write_text(listing.text)
    outcome = program.call("import", file, "--map", chart, "-o", program.scratch / "import", "-q")
    result.add(outcome)
    result.accepted = outcome.accepted
    return result
