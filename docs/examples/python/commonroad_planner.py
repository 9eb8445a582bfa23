"""A planner of CommonRoad: the reference path of commonroad-route-planner on the lanelets of a file.

    pip install commonroad-route-planner==2025.1.0
    python3 -m trackbed run --import commonroad_planner two_lanes.xml \
        --set 'plan={method: commonroad_route, lanelets: two_lanes.xml}'
"""

import pathlib

import numpy
from commonroad.common.file_reader import CommonRoadFileReader
from commonroad_route_planner.fast_api import fast_api

import trackbed


@trackbed.planner(
    "commonroad_route",
    keys={
        "lanelets": trackbed.Key("", "CommonRoad file with the lanelets and the planning problem"),
        "join": trackbed.Key("m", "distance in which the car joins the path", above=0, max=200),
        "beyond": trackbed.Key("m", "of the path beyond the goal, to stop", min=0, max=500),
    },
    min_waypoints=0,
)
def plan(request, *, lanelets: str, join: float = 30.0, beyond: float = 20.0):
    """Reference path on lanelets, by the CommonRoad Route Planner"""
    if not pathlib.Path(lanelets).is_file():
        raise ValueError(f"plan.lanelets is {lanelets!r}; must be a CommonRoad file")
    scenario, problems = CommonRoadFileReader(lanelets).open()
    [problem, *_] = problems.planning_problem_dict.values()
    route = fast_api.generate_reference_path_from_scenario_and_planning_problem(scenario, problem)
    if route is None:
        raise trackbed.NoPath("the CommonRoad Route Planner found no route to the goal")
    points = numpy.asarray(route.reference_path, dtype=float)
    steps = numpy.hypot(*numpy.diff(points, axis=0).T)
    points = points[numpy.append(True, steps > 1e-6)]
    s = numpy.append(0.0, numpy.cumsum(numpy.hypot(*numpy.diff(points, axis=0).T)))

    # The car starts beside the path: shift the path so that it begins at the car. The lateral shift
    # of the path is a quintic polynomial that decreases to zero over `join` meters. The car's
    # center has to reach the goal, so the path of the rear axle continues beyond the goal.
    start = numpy.array(request.start[:2])
    fine = numpy.arange(0.0, s[-1], 0.25)
    path = numpy.column_stack([numpy.interp(fine, s, points[:, axis]) for axis in (0, 1)])
    first = int(numpy.argmin(numpy.hypot(*(path - start).T)))
    path = path[first:]
    u = numpy.clip((fine[first:] - fine[first]) / join, 0.0, 1.0)
    fade = 1.0 - u**3 * (10.0 - 15.0 * u + 6.0 * u**2)
    path = path + fade[:, None] * (start - path[0])
    ahead = (path[-1] - path[-2]) / numpy.hypot(*(path[-1] - path[-2]))
    end = path[-1] + ahead * numpy.arange(0.25, beyond, 0.25)[:, None]
    return trackbed.PlannedPath(numpy.vstack([path, end]), max_deviation=0.2)
