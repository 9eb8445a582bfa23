"""Plans random routes of an OpenDRIVE file and compares them with lane centers computed from the standard."""
import math

import open_drive
from near import distances
from result import Result

LIMIT = 0.02  # [m], of the lane centers
JOINT_LIMIT = 0.05  # [m], within a meter of a joint of lanes or of their polynomials: the plan rounds kinks
ROUTES = 4
CARS = ("prius", "f1tenth")  # The second one where a lane is too tight for the first one.
LONGEST = 300.0  # [m]
STEP = 0.5  # [m], between the compared points of lane centers
PLAN_STEP = 0.1  # [m], between the rows of plan.csv; chords of a circle of 3 m radius are 0.4 mm off


def deviation(points, rows):
    """Returns by how much the distance of the lane centers from the plan exceeds its limit, and the largest distance.

    A plan bridges gaps in the file, so the limit is larger by the gap."""
    off = distances([p[:2] for p in points], [row[:2] for row in rows], int(4.0 * STEP / PLAN_STEP))
    beyond = max(d - (JOINT_LIMIT if near else LIMIT) - gap for d, (_, _, near, gap) in zip(off, points))
    ends = max(math.hypot(p[0] - row[0], p[1] - row[1]) for p, row in ((points[0], rows[0]), (points[-1], rows[-1])))
    return max(beyond, ends - JOINT_LIMIT), max(max(off), ends)


def keys_of(file, legs, model):
    places = [{"road": legs[0][0].id, "lane": legs[0][2], "s": legs[0][3]}]
    places += [{"road": road.id, "lane": lane, "s": 0.5 * (a + b)} for road, _, lane, a, b in legs[1:-1]]
    places.append({"road": legs[-1][0].id, "lane": legs[-1][2], "s": legs[-1][4]})
    return {"vehicle": {"model": model}, "world": {"road_network": str(file)}, "plan": {"method": "lane_route"},
            "mission": {"speed": 5.0, "start": {"speed": 0.0}, "route": places}}


def survey(program, file, random, drive):
    try:
        network = open_drive.Network(file)
    except (open_drive.ElementTree.ParseError, ValueError, TypeError) as reason:
        return refused_whole(program, file, f"not read by the survey: {reason}")
    lanes = sorted(network.lanes(), key=lambda x: (x[0].id, x[1], x[2]))
    if not lanes:
        return refused_whole(program, file, "no drivable lane")
    result = Result("road network")
    tried = planned = small = 0
    worst = 0.0
    for _ in range(ROUTES):
        legs = open_drive.stations(network, network.random_route(random, lanes, LONGEST))
        try:
            points = open_drive.sampled(legs, STEP)
        except (open_drive.Unclear, KeyError) as reason:
            result.note(f"road {legs[0][0].id}: {reason}")
            continue
        tried += 1
        for model in CARS:
            keys = keys_of(file, legs, model)
            outcome, rows, _ = program.plan(keys, file.parent)
            result.add(outcome)
            if rows or outcome.code != 3:
                break
        if not rows:
            continue
        planned += 1
        small += model != CARS[0]
        beyond, off = deviation(points, rows)
        worst = max(worst, off)
        if beyond > 0.0:
            result.wrong(f"{off:.3f} m off the lane centers on roads {' '.join(leg[0].id for leg in legs)}")
        if drive and not result.driven:
            result.driven = program.drive(keys, file.parent)
    result.accepted = planned > 0
    result.detail = f"{planned} of {tried} routes, {1e3 * worst:.1f} mm"
    if small:
        result.detail += f"; {small} with a 1:10 car"
    return result


def refused_whole(program, file, why):
    """Reads a file in which no route was found: the program must refuse a route that does not exist."""
    keys = {"world": {"road_network": str(file)}, "plan": {"method": "lane_route"},
            "mission": {"speed": 5.0, "route": [{"road": "1", "lane": -1, "s": 1}, {"road": "1", "lane": -1, "s": 2}]}}
    result = Result("road network")
    outcome, rows, _ = program.plan(keys, file.parent)
    result.add(outcome)
    result.accepted = bool(rows)
    result.no_route = True
    result.detail = why
    return result
