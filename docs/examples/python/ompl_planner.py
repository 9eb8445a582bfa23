"""A planner of another library: RRT-Connect of OMPL over Dubins curves.

    pip install "ompl>=2"
    python3 -m trackbed run --import ompl_planner scenario.yaml      # plan: {method: ompl}
"""

import numpy
from ompl import base, geometric, util

import trackbed

util.RNG.setSeed(1)  # OMPL can be seeded only once in a process.
util.setLogLevel(util.LogLevel.LOG_WARN)

# Largest distance of the smoothed path from the Dubins curves, whose curvature jumps [m].
DEVIATION = 0.3


@trackbed.planner(
    "ompl",
    keys={
        "safe_distance": trackbed.Key("m", "distance from obstacles", min=0, max=3),
        "seconds": trackbed.Key("s", "time limit of the search", above=0, max=60),
        "margin": trackbed.Key("m", "of the searched area around the waypoints", min=0, max=100),
    },
    keeps_clear=True,
    is_random=True,
)
def plan(request, *, safe_distance: float = 0.3, seconds: float = 5.0, margin: float = 15.0):
    """Dubins curves around obstacles, by OMPL's RRT-Connect"""
    space = base.DubinsStateSpace(2.0 * request.vehicle.min_turning_radius)
    bounds = base.RealVectorBounds(2)
    for axis in (0, 1):
        bounds.setLow(axis, float(request.waypoints[:, axis].min()) - margin)
        bounds.setHigh(axis, float(request.waypoints[:, axis].max()) + margin)
    space.setBounds(bounds)
    setup = geometric.SimpleSetup(space)

    def is_free(state):
        pose = [[state.getX(), state.getY(), state.getYaw()]]
        return bool(request.clearance(pose)[0] > safe_distance + DEVIATION)

    setup.setStateValidityChecker(is_free)
    start, goal = space.allocState(), space.allocState()
    ahead = request.waypoints[-1] - request.waypoints[-2]
    yaw = request.headings[-1] if request.headings else float(numpy.arctan2(ahead[1], ahead[0]))
    for state, pose in ((start, request.start), (goal, (*request.waypoints[-1], yaw))):
        state.setX(float(pose[0]))
        state.setY(float(pose[1]))
        state.setYaw(float(pose[2]))
    setup.setStartAndGoalStates(start, goal)
    setup.setPlanner(geometric.RRTConnect(setup.getSpaceInformation()))
    if not setup.solve(seconds) or not setup.haveExactSolutionPath():
        raise trackbed.NoPath(f"OMPL found no path within {seconds} s")
    setup.simplifySolution()
    path = setup.getSolutionPath()
    path.interpolate(max(2, int(path.length() / 0.25)))
    points = [[s.getX(), s.getY()] for s in path.getStates()]
    return trackbed.PlannedPath(points, max_deviation=DEVIATION)
