"""Reads CommonRoad scenarios, tyre files and bags, and compares plans with independent evaluations."""
import math
import xml.etree.ElementTree as ElementTree

from near import to_segment
from result import Result

OUTSIDE = 0.02  # [m], of the plan outside of all lanelets


def bound(lanelet, name):
    return [(float(p.findtext("x")), float(p.findtext("y"))) for p in lanelet.findall(f"{name}/point")]


def inside(p, polygon):
    odd = False
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        if (a[1] > p[1]) != (b[1] > p[1]) and p[0] < a[0] + (p[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1]):
            odd = not odd
    return odd


def outside(p, polygons):
    """Returns the distance of a point from the nearest polygon; 0 inside."""
    best = math.inf
    for polygon, (x0, x1, y0, y1) in polygons:
        if x0 - best < p[0] < x1 + best and y0 - best < p[1] < y1 + best:
            if inside(p, polygon):
                return 0.0
            best = min(best, min(to_segment(p, a, b) for a, b in zip(polygon, polygon[1:] + polygon[:1])))
    return best


def lanelets(root):
    found = []
    for lanelet in root.findall("lanelet"):
        polygon = bound(lanelet, "leftBound") + bound(lanelet, "rightBound")[::-1]
        if len(polygon) > 3:
            x, y = zip(*polygon)
            found.append((polygon, (min(x), max(x), min(y), max(y))))
    return found


def commonroad(program, file, _, drive):
    """Checks that the plan begins at the initial state, and that the rear axle stays on lanelets once it is on one."""
    result = Result("CommonRoad scenario")
    outcome, rows, _ = program.plan_file(file)
    result.add(outcome)
    result.accepted = bool(rows)
    if not rows:
        return result
    root = ElementTree.parse(file).getroot()
    polygons = lanelets(root)
    away = [outside(row[:2], polygons) for row in rows[:: max(1, len(rows) // 200)]]
    # The rear axle may start behind the first lanelet, and a plan may end straight ahead behind the last one.
    on_road = [i for i, d in enumerate(away) if d == 0.0] or [0]
    worst = max(away[on_road[0]:on_road[-1] + 1])
    start = root.find("planningProblem/initialState/position/point")
    result.detail = f"{worst:.3f} m outside"
    if worst > OUTSIDE:
        result.wrong(f"the plan is {worst:.2f} m outside of all lanelets")
    if start is not None:
        center = float(start.findtext("x")), float(start.findtext("y"))
        # The state is that of the center of gravity of vehicle 2, 1.42 m ahead of the rear axle.
        yaw = root.findtext("planningProblem/initialState/orientation/exact")
        x, y, yaw = rows[0][0], rows[0][1], rows[0][2] if yaw is None else float(yaw)
        off = math.hypot(x + 1.4227 * math.cos(yaw) - center[0], y + 1.4227 * math.sin(yaw) - center[1])
        if off > 0.05:
            result.wrong(f"the plan begins {off:.2f} m from the initial state")
    if drive:
        done = program.call("run", file, "-o", program.scratch / "run", "--plant", "kinematic", "-q")
        result.driven = "yes" if done.accepted else done.fault or "no: " + done.message
    return result


def tyre(program, file, _, __):
    """Checks whether the program reads a tyre file; tests/vehicle compares forces."""
    result = Result("tyre")
    keys = {"vehicle": {"model": "prius", "tyre_file": str(file)}, "plan": {"method": "fillet"},
            "mission": {"speed": 2.0, "waypoints": [[0, 0], [20, 0]]}}
    outcome = program.call("check", program.scenario(keys), "--allow-assets", file.parent)
    result.add(outcome)
    result.accepted = outcome.accepted
    return result


def bag(program, file, _, __):
    """Imports a bag that contains poses, with the topic map that the program proposes for it."""
    result = Result("bag")
    listing = program.call("import", file, "--list")
    result.add(listing)
    result.accepted = listing.accepted
    if listing.accepted and "\nposition:" in listing.text:
        chart = program.scratch / "map.yaml"
        chart.write_text(listing.text)
        outcome = program.call("import", file, "--map", chart, "-o", program.scratch / "import", "-q")
        result.add(outcome)
        result.accepted = outcome.accepted
    return result

