"""Planners, controllers, plants, metrics and requirements that are written in Python."""

import functools
import gc
import math
import threading
import traceback
import weakref

import numpy
import pytest

import trackbed

@trackbed.planner("test_line", keys={"offset": trackbed.Key("m", "to the left", min=-5, max=5)})
def line(request, *, offset: float = 0.0, steps: int = 41, ends: str = "smooth"):
    """A line to the last waypoint, with a bend to the left"""
    (x, y), goal = request.waypoints[0], request.waypoints[-1]
    t = numpy.linspace(0.0, 1.0, steps)
    bend = offset * 0.5 * (1.0 - numpy.cos(2.0 * math.pi * t))
    return numpy.column_stack([x + t * (goal[0] - x), y + t * (goal[1] - y) + bend])


@trackbed.controller("test_gain", keys={"gain": trackbed.Key("rad/m", "feedback", above=0)})
class Gain:
    """Feedback of both errors."""

    columns = ("test_calls",)

    def __init__(self, *, gain: float = 0.1, heading: float = 0.8):
        self.gain, self.heading = gain, heading
        self.calls = 0
        self.values = [0]

    def step(self, seen):
        self.calls += 1
        self.values = [self.calls]
        ahead = seen.reference([seen.station_m + 1.0])["curvature_radpm"][0]
        feedback = -self.gain * seen.cross_track_m - self.heading * seen.heading_error_rad
        return math.atan(seen.vehicle.wheelbase * ahead) + feedback


@trackbed.controller("test_hold")
def hold(seen, *, angle: float = 0.05):
    return angle, (1.0 if seen.speed_mps < 2.0 else 0.0)


@trackbed.plant("test_bicycle")
class Bicycle:
    """The kinematic car without limits."""

    def __init__(self, setup):
        self.dt, self.wheelbase = setup.timestep, setup.vehicle.wheelbase
        self.x, self.y, self.yaw = setup.x_m, setup.y_m, setup.yaw_rad
        self.speed = setup.speed_mps

    def step(self, steering, acceleration):
        self.speed = max(0.0, self.speed + acceleration * self.dt)
        self.x += self.speed * math.cos(self.yaw) * self.dt
        self.y += self.speed * math.sin(self.yaw) * self.dt
        self.yaw += self.speed * math.tan(steering) / self.wheelbase * self.dt

    def state(self):
        return {"x_m": self.x, "y_m": self.y, "yaw_rad": self.yaw, "speed_mps": self.speed}


@trackbed.metric("test.left", unit="m", label="Farthest to the left", located=True)
def left(log, path):
    row = int(log["cross_track_m"].argmax())
    assert path is None or path["s_m"][0] == 0.0
    return log["cross_track_m"][row], log["s_m"][row], log["t_s"][row]


@trackbed.requirement("test_calm", unit="m/s^2")
def calm(log):
    return 3.0 - abs(log["lateral_acceleration_mps2"]).max()


ALONG = [[0, 0], [80, 0]]


def test_planner_plans_the_path_that_it_returns():
    change = {"plan": {"method": "test_line"}, "mission.waypoints": ALONG}
    run = trackbed.run("three_turns", plants="kinematic", set=change)
    assert run.plan["method"] == "test_line"
    # The points are on a line, and the fitted path stays within 1e-9 m of this line.
    assert run.path["x_m"][-1] == pytest.approx(80.0, abs=1e-9)
    assert abs(run.path["y_m"]).max() < 1e-9
    change["plan"]["offset"] = 4
    bent = trackbed.run("three_turns", plants=["kinematic", "mujoco"], set=change)
    assert bent.passed, bent.verdict
    # max_deviation of PlannedPath is 0.05 m; the bend is 4 m high in the middle.
    assert bent.path["y_m"].max() == pytest.approx(4.0, abs=0.05)
    assert "offset: 4" in bent.yaml and "ends: smooth" in bent.yaml


@pytest.mark.parametrize("yaw", [-0.06, -0.01, 0.02, 0.08])
def test_paths_begin_with_the_heading_of_the_car(yaw):
    trackbed.planner("test_turned", replace=True)(lambda request: line(request))
    change = {"plan": {"method": "test_turned"}, "mission.waypoints": ALONG}
    change["mission.start"] = {"yaw": yaw, "speed": 0.15}
    run = trackbed.run("three_turns", plants="kinematic", set=change)
    assert run.passed, (run.plan, run.verdict)
    path = run.path
    assert path["yaw_rad"][0] == pytest.approx(yaw, abs=1e-12)
    # The wheels of a rolling car are straight at the start.
    assert path["curvature_radpm"][0] == pytest.approx(0.0, abs=1e-12)
    # The points are on the x axis; max_deviation is 0.05 m.
    assert 0.049 < abs(path["y_m"]).max() < 0.05 + 1e-9
    assert path["x_m"][-1] == pytest.approx(80.0, abs=1e-6)


def test_paths_that_begin_across_the_car_are_infeasible():
    change = {"plan": {"method": "test_line"}}
    run = trackbed.run("three_turns", plants="kinematic", set=change)
    assert run.plan["status"] == "infeasible"
    assert "initial heading error" in run.plan["reason"]


def test_planner_may_find_no_path():
    @trackbed.planner("test_none", replace=True)
    def none(request):
        raise trackbed.NoPath("the gate is shut")

    run = trackbed.run("three_turns", set={"plan": {"method": "test_none"}})
    assert run.plan["status"] == "no_path"
    assert run.plan["reason"] == "the gate is shut"


def test_planner_sees_the_mission():
    seen = []

    @trackbed.planner("test_sees", replace=True)
    def sees(request):
        seen.append(request)
        return line(request)

    box = {"box": {"x": 40, "y": -9, "yaw": 0.2, "length": 3, "width": 2, "height": 1}}
    change = {"plan": {"method": "test_sees"}, "world.obstacles": [box], "seed": 7}
    trackbed.run("three_turns", plants="kinematic", set=change)
    request = seen[0]
    assert request.waypoints.shape == (5, 2)
    assert request.start == (0.0, 0.0, 0.0)
    assert request.seed == 7 and request.speed == 3.0
    numpy.testing.assert_array_equal(request.obstacles, [[40, -9, 0.2, 3, 2]])
    # The points are beside the box, 20 m before the box, and on the box.
    near = request.clearance([[38.0, -4.0, 0.0], [0.0, 0.0, 0.0], [39.0, -9.0, 0.0]])
    assert 0.0 < near[0] < 4.0 and near[1] >= near[0] and near[2] < 0.0
    with pytest.raises(ValueError, match=r"poses has the shape \(2,\)"):
        request.clearance([1.0, 2.0])


@pytest.mark.parametrize("plant", ["kinematic", "mujoco", "test_bicycle"])
def test_controller_steers(plant):
    run = trackbed.run("three_turns", plants=plant, set={"control": {"method": "test_gain"}})
    assert run.metrics[plant]["status"] == "arrived"
    assert abs(run[plant]["cross_track_m"]).max() < 0.5
    calls = run[plant]["test_calls"]
    # Each control period calls the controller once; the last row of the log begins no period.
    assert (numpy.diff(calls)[:-1] == 1).all()


def test_controller_may_set_the_speed():
    run = trackbed.run(
        "three_turns",
        plants="kinematic",
        set={"control": {"method": "test_hold"}, "drive.time_limit": 5, "mission.start": {"speed": 0}},
    )
    log = run["kinematic"]
    assert (log["steering_command_rad"][1:-1] == 0.05).all()
    # The speed may exceed 2 m/s by one period of 1 m/s^2.
    assert log["speed_mps"].max() <= 2.0 + (log["t_s"][1] - log["t_s"][0])


def test_plant_moves_as_its_model():
    run = trackbed.run("three_turns", plants=["kinematic", "test_bicycle"])
    both = trackbed.compare(run, "kinematic", "test_bicycle")
    # Euler's method errs by at most speed^2 curvature_max dt/2 T = 9/4*0.2*0.002/2*48 m = 0.02 m.
    # The plan does not use the actuator's full rate, which the plant does not limit.
    assert both["position"]["max"] < 0.1


def test_metric_and_requirement_are_measured_and_judged(tmp_path):
    bounds = [{"metric": "test_calm", "min": 0}, {"metric": "test.left", "max": 1}]
    run = trackbed.run("three_turns", plants="kinematic", set={"expect.metrics": bounds})
    log = run["kinematic"]
    metrics = run.metrics["kinematic"]
    assert metrics["test_calm"] == 3.0 - abs(log["lateral_acceleration_mps2"]).max()
    assert metrics["test"]["left"] == log["cross_track_m"].max()
    assert metrics["test"]["left_t"] == log["t_s"][log["cross_track_m"].argmax()]
    assert run.passed
    bounds[0]["min"] = 10
    run = trackbed.run("three_turns", plants="kinematic", set={"expect.metrics": bounds})
    assert not run.passed
    assert "Calm" in run.report() and "Farthest to the left" in run.report()


def test_loop_state_copies_a_controller_and_a_plant():
    loop = trackbed.Loop("three_turns", "test_bicycle", set={"control": {"method": "test_gain"}})
    for _ in range(50):
        loop.step()
    state = loop.state
    first = [loop.step().x_m for _ in range(50)]
    loop.state = state
    second = [loop.step().x_m for _ in range(50)]
    assert first == second


def test_loop_state_copies_what_a_plugin_has_kept():
    trackbed.controller("test_keeps", replace=True)(Keeps)
    trackbed.plant("test_keeps", replace=True)(KeepsSetup)
    loop = trackbed.Loop("three_turns", "test_keeps", set={"control": {"method": "test_keeps"}})
    loop.step()
    state, there = loop.state, loop.observation.x_m
    loop.step()
    assert loop.observation.x_m > there
    loop.state = state
    assert loop.observation.x_m == there


class KeepsLock(Bicycle):
    def __init__(self, setup):
        super().__init__(setup)
        self.lock = threading.Lock()


def test_an_object_without_a_copy_names_a_remedy():
    trackbed.plant("test_locks", replace=True)(KeepsLock)
    loop = trackbed.Loop("three_turns", "test_locks")
    with pytest.raises(trackbed.PluginError, match="Loop.state copies KeepsLock .*__deepcopy__"):
        loop.state
    loop.step()


class Keeps:
    def step(self, seen):
        self.seen, self.vehicle = seen, seen.vehicle
        return 0.1 / self.vehicle.wheelbase


class KeepsSetup:
    def __init__(self, setup):
        self.setup, self.x = setup, setup.x_m

    @staticmethod
    def speed():
        return 3.0

    def step(self, steering, acceleration, *, gear):
        self.x += gear * self.speed() * self.setup.timestep

    def state(self):
        return {"x_m": self.x, "y_m": 0.0, "yaw_rad": 0.0, "speed_mps": self.speed()}


def test_methods_may_be_static():
    class Static:
        columns = ["test_unset"]

        @staticmethod
        def step(seen):
            return numpy.array(0.0)

    trackbed.controller("test_static", replace=True)(Static)
    with pytest.raises(trackbed.PluginError, match=r"step must set values, .* of \['test_unset'\]"):
        trackbed.run("three_turns", "kinematic", {"control": {"method": "test_static"}})


def test_vector_loops_are_single_loops():
    change = {"control": {"method": "test_gain"}}
    cars = trackbed.VectorLoop("three_turns", plant="test_bicycle", count=8, set=change, threads=4)
    one = trackbed.Loop("three_turns", "test_bicycle", set=change)
    for _ in range(30):
        rows, seen = cars.step(), one.step()
    assert (rows[:, cars.columns.index("x_m")] == seen.x_m).all()


class Broken(Exception):
    pass


def broken_step(seen):
    raise Broken("no steering today")


def raised(method, set):
    with pytest.raises(trackbed.PluginError) as error:
        trackbed.run("three_turns", plants="kinematic", set=set)
    assert method in str(error.value)
    return error.value


@pytest.mark.parametrize(
    "step, text",
    [
        (lambda seen: float("nan"), r"step returned the steering angle \[rad\] nan; must be finite"),
        (lambda seen: (0.0, float("inf")), r"the acceleration \[m/s\^2\] inf; must be finite"),
        (lambda seen: "left", "the steering angle .* must be a number, not str"),
        (lambda seen: None, r"step returned None; must return the steering angle \[rad\]"),
        (lambda seen: (1.0, 2.0, 3.0), "step returned 3 values"),
        (lambda seen: numpy.zeros(1), "step returned 1 values"),
        (lambda seen: 10**400, "the steering angle .* too large; must be finite"),
        (lambda seen: numpy.float32("nan"), r"the steering angle \[rad\] .*; must be finite"),
        (lambda seen: seen.nothing, "AttributeError.*nothing"),
        (lambda seen: seen.reference("a"), "stations must be an array of numbers, not str"),
        (lambda seen: seen.reference([math.nan]), "stations has a value that is not finite"),
        (lambda seen: seen.reference(1.0), r"stations has the shape \(\); must be \(n,\)"),
    ],
)
def test_wrong_commands_are_named(step, text):
    trackbed.controller("test_wrong", replace=True)(step)
    with pytest.raises(trackbed.PluginError, match=text):
        trackbed.run("three_turns", plants="kinematic", set={"control": {"method": "test_wrong"}})


def test_a_path_that_turns_back_names_a_remedy_for_its_points():
    zigzag = [[0, 0], [5, 0], [0, 1], [20, 1]]
    trackbed.planner("test_zigzag", replace=True)(lambda request: zigzag)
    plan = trackbed.run("three_turns", "kinematic", {"plan": {"method": "test_zigzag"}}).plan
    assert plan["status"] == "u_turn"
    assert "turns back on itself by 2.94 rad at (5, 0); if the car reverses" in plan["reason"]
    assert "return points of shape (n, 3)" in plan["reason"]


TEXTS = ["\U0001f697 \u00e4", "\x7f\x85\u2028\ufeff", 'a"\\: # {', " a ", "yes", "\\ud83d"]


@pytest.mark.parametrize("text", TEXTS)
def test_texts_reach_a_plugin_unchanged(text):
    seen = []

    @trackbed.planner("test_text", replace=True)
    def plan(request, *, name: str = "x"):
        seen.append(name)
        return [[0, 0], [20, 0]]

    trackbed.run("three_turns", "kinematic", {"plan": {"method": "test_text", "name": text}})
    assert seen == [text]


def test_a_note_of_the_plan_is_shown_once():
    remark = "drives straight on"
    trackbed.planner("test_note", replace=True)(
        lambda request: trackbed.PlannedPath([[0, 0], [40, 0]], notes=[remark])
    )
    set = {"plan": {"method": "test_note"}, "drive.time_limit": 1}
    notes = trackbed.run("three_turns", "kinematic", set).notes
    assert [note for note in notes if remark in note] == [remark]


def test_an_array_is_a_command():
    commands = {"array": lambda seen: numpy.array([0.1, 1.0]), "tuple": lambda seen: (0.1, 1.0)}
    driven = {}
    for name, step in commands.items():
        trackbed.controller("test_command", replace=True)(step)
        control = {"control": {"method": "test_command"}, "drive.time_limit": 2}
        driven[name] = trackbed.run("three_turns", "kinematic", control)["kinematic"]["x_m"]
    numpy.testing.assert_array_equal(driven["array"], driven["tuple"])


@pytest.mark.parametrize(
    "answer, text",
    [
        (None, "returned None; return points"),
        ([[0, 0]], "points has 1 rows"),
        ([0, 1, 2], r"points has the shape \(3,\); must be \(n, 2\) or \(n, 3\)"),
        ([[0, 0], [float("nan"), 1]], r"points\[1\] is \[nan, 1.0\]; must be finite"),
        ("a path", "points must be an array of numbers, not str"),
        ([[5, 5], [50, 50]], r"begins at \(5, 5\), 7.071 m from the start"),
        ([[0, 0, 0], [5, 0, 0], [2, 0.0, 0]], "drives in reverse|turns back"),
    ],
)
def test_wrong_paths_are_named(answer, text):
    trackbed.planner("test_wrong", replace=True)(lambda request: answer)
    with pytest.raises(trackbed.PluginError, match=text) as error:
        trackbed.run("three_turns", plants="kinematic", set={"plan": {"method": "test_wrong"}})
    assert "planner 'test_wrong'" in str(error.value)


@pytest.mark.parametrize(
    "state, text",
    [
        ({"x_m": 1, "y_m": 1, "yaw_rad": 0}, "state returned no 'speed_mps'"),
        ({"x_m": float("nan"), "y_m": 1, "yaw_rad": 0, "speed_mps": 1}, "x_m nan; must be finite"),
        ({"x_m": 1, "y_m": 1, "yaw_rad": 0, "speed_mps": 1, "z": 1}, "state returned 'z'"),
        ({"x_m": "a", "y_m": 1, "yaw_rad": 0, "speed_mps": 1}, "x_m, which must be a number"),
        ([1, 2], "state must return a dict of columns, not list"),
    ],
)
def test_wrong_states_are_named(state, text):
    class Wrong:
        def __init__(self, setup):
            pass

        def step(self, steering, acceleration):
            pass

        def state(self):
            return state

    trackbed.plant("test_wrong", replace=True)(Wrong)
    with pytest.raises(trackbed.PluginError, match=f"plant 'test_wrong' .*{text}"):
        trackbed.run("three_turns", plants="test_wrong")


def test_a_plant_that_runs_away_has_diverged():
    class Rocket(Bicycle):
        def step(self, steering, acceleration):
            self.x = 10.0 * self.x + 1.0

    trackbed.plant("test_wrong", replace=True)(Rocket)
    run = trackbed.run("three_turns", plants="test_wrong")
    assert run.metrics["test_wrong"]["status"] == "diverged"


def test_vector_loops_raise_the_exception_of_a_thread():
    def step(seen):
        if seen.t_s > 0.1:
            raise Broken("on a thread")
        return 0.0

    trackbed.controller("test_broken", replace=True)(step)
    change = {"control": {"method": "test_broken"}}
    cars = trackbed.VectorLoop("three_turns", plant="kinematic", count=16, set=change, threads=8)
    with pytest.raises(trackbed.PluginError, match="on a thread") as error:
        for _ in range(100):
            cars.step()
    assert isinstance(error.value.__cause__, Broken)
    cars.reset()
    assert not cars.ended.any()


@pytest.mark.parametrize("value", [float("nan"), "a", [1, 2]])
def test_wrong_metrics_are_named(value):
    wanted = []
    trackbed.metric("test_wrong", replace=True)(lambda log: wanted[0] if wanted else None)
    wanted.append(value)
    with pytest.raises(trackbed.PluginError, match="metric 'test_wrong' .*the value"):
        trackbed.run("three_turns", plants="kinematic")
    wanted.clear()
    trackbed.run("three_turns", plants="kinematic")


def test_exceptions_keep_their_traceback():
    trackbed.controller("test_broken", replace=True)(broken_step)
    error = raised("controller 'test_broken'", {"control": {"method": "test_broken"}})
    assert isinstance(error.__cause__, Broken)
    assert "broken_step" in "".join(traceback.format_tb(error.__cause__.__traceback__))
    assert "no steering today" in str(error)
    loop = trackbed.Loop("three_turns", "kinematic", set={"control": {"method": "test_broken"}})
    with pytest.raises(trackbed.PluginError, match="no steering today"):
        loop.step()
    loop.step(steering=0.1)


def test_interrupts_are_raised_unchanged():
    def interrupt(seen):
        raise KeyboardInterrupt

    trackbed.controller("test_broken", replace=True)(interrupt)
    with pytest.raises(KeyboardInterrupt):
        trackbed.run("three_turns", plants="kinematic", set={"control": {"method": "test_broken"}})


async def plans_later(request):
    return [(0.0, 0.0), (1.0, 0.0)]


class steps_later:
    async def step(self, seen):
        return 0.0


def yields(seen):
    yield 0.0


def test_a_generator_is_a_planner():
    @trackbed.planner("test_yields", replace=True)
    def planner(request):
        for x in range(30):
            yield request.start[0] + x, request.start[1]

    run = trackbed.run("three_turns", plants="kinematic", set={"plan": {"method": "test_yields"}})
    assert run.path["x_m"][-1] == pytest.approx(29.0, abs=0.05)  # At most max_deviation.


@pytest.mark.parametrize(
    "register, error, text",
    [
        (lambda: trackbed.planner("preview"), None, ""),
        (lambda: trackbed.planner("straight")(line), ValueError, "already registered"),
        (lambda: trackbed.planner("test_line")(lambda r: 1), ValueError, "already registered, by .*line"),
        (lambda: trackbed.planner("Ärger")(line), ValueError, "name is 'Ärger'"),
        (lambda: trackbed.planner(3)(line), TypeError, "name must be a str"),
        (lambda: trackbed.planner(line), TypeError, "planner needs a name"),
        (lambda: trackbed.planner("test_x")(3), TypeError, "must be a function"),
        (lambda: trackbed.planner("test_x")(lambda: 1), TypeError, r"parameters \(request, \*, keys\)"),
        (lambda: trackbed.planner("test_x")(lambda r, *a: 1), TypeError, r"\*args"),
        (lambda: trackbed.planner("test_x")(lambda r, *, method=1: 1), ValueError, "every plan sec"),
        (lambda: trackbed.planner("test_x")(lambda r, *, a={}: 1), TypeError, "a of .* the default"),
        (lambda: trackbed.planner("test_x")(lambda r, *, a: 1), TypeError, "a of .* needs a default"),
        (
            lambda: trackbed.planner("test_x", keys={"b": trackbed.Key()})(lambda r, *, a=1: 1),
            ValueError,
            r"keys\['b'\] is no keyword parameter",
        ),
        (lambda: trackbed.controller("test_x")(type("A", (), {})), TypeError, r"step\(self, seen\)"),
        (lambda: trackbed.controller("test_x", station="x"), ValueError, "station is 'x'"),
        (lambda: trackbed.plant("test_x")(lambda s: 1), TypeError, "must be a class"),
        (lambda: trackbed.plant("kinematic")(Bicycle), ValueError, "already registered"),
        (lambda: trackbed.metric("test_x")(lambda: 1), TypeError, r"\(log\) or \(log, path\)"),
        (lambda: trackbed.metric("cross_track")(calm), ValueError, "is a section of metrics.json"),
        (lambda: trackbed.Key(min="a"), TypeError, "min must be a number"),
        (lambda: trackbed.Key(min=2, max=1), ValueError, "min is 2, which exceeds max, 1"),
        (lambda: trackbed.Key(above=1, max=1), ValueError, "above is 1, but max is 1"),
        (
            lambda: trackbed.planner("test_x", keys={"a": trackbed.Key(max=1)})(lambda r, *, a=2: 1),
            ValueError,
            "a of .* has the default 2; must be at most 1",
        ),
        (
            lambda: trackbed.planner("test_x", keys={"a": trackbed.Key(above=0)})(
                lambda r, *, a=[1, 0]: 1
            ),
            ValueError,
            r"a of .* has the default \[1, 0\]; must be above 0",
        ),
        (
            lambda: trackbed.planner("test_x", keys={"a": trackbed.Key(allowed=["b"])})(
                lambda r, *, a="c": 1
            ),
            ValueError,
            "a of .* has the default 'c'; allowed are b",
        ),
        (lambda: trackbed.planner("test_x")(plans_later), TypeError, "not an async one"),
        (lambda: trackbed.controller("test_x")(steps_later), TypeError, "step of .* an async one"),
        (lambda: trackbed.controller("test_x")(yields), TypeError, "its result, not yield it"),
        (lambda: trackbed.metric("test_x")(yields), TypeError, "its result, not yield it"),
        (lambda: trackbed.controller("test_x")(lambda seen, gain: 1), TypeError, "come after '\\*'"),
        (
            lambda: trackbed.plant("test_x")(type("A", (), {})),
            TypeError,
            r"parameters \(setup\); its positional parameters are: none$",
        ),
    ],
)
def test_wrong_registrations_are_named(register, error, text):
    if error is None:
        register()
    else:
        with pytest.raises(error, match=text):
            register()


def test_a_replaced_plugin_is_used_by_later_runs():
    loops = []
    for angle in (0.1, 0.2):
        trackbed.controller("test_replaced", replace=True)(lambda seen, *, own=angle: own)
        loops.append(trackbed.Loop("three_turns", set={"control": {"method": "test_replaced"}}))
    for loop in loops:
        loop.step()
    assert [loop.log["steering_command_rad"][0] for loop in loops] == [0.1, 0.2]
    with pytest.raises(ValueError, match="replace=True cannot change"):
        trackbed.controller("test_replaced", replace=True, needs_plan=False)(lambda seen: 0.0)


def test_keys_are_checked_as_all_keys():
    for change, text in [
        ({"gain": 0}, "gain.*above 0"),
        ({"gain": "a"}, "gain"),
        ({"gian": 1}, "gain"),
    ]:
        with pytest.raises(trackbed.InputError, match=text):
            trackbed.run("three_turns", set={"control": {"method": "test_gain", **change}})
    with pytest.raises(trackbed.InputError, match="test_gain"):
        trackbed.run("three_turns", set={"control": {"method": "test_gian"}})


def test_registers_nothing_while_a_run_is_going_on():
    errors = []

    def register(seen):
        try:
            trackbed.planner("test_late")(lambda request: None)
        except RuntimeError as error:
            errors.append(str(error))
        return 0.0

    trackbed.controller("test_broken", replace=True)(register)
    loop = trackbed.Loop("three_turns", set={"control": {"method": "test_broken"}})
    loop.step()
    assert "planner 'test_late' cannot be registered while trackbed runs a plug-in" in errors[0]


def test_a_loop_cannot_be_stepped_by_its_own_controller():
    loops = []

    def step(seen):
        loops[0].step()
        return 0.0

    trackbed.controller("test_broken", replace=True)(step)
    loops.append(trackbed.Loop("three_turns", set={"control": {"method": "test_broken"}}))
    with pytest.raises(trackbed.PluginError, match="a plug-in uses the loop that calls it"):
        loops[0].step()


def test_input_cannot_be_used_after_its_period():
    kept = []

    def step(seen):
        kept.append(seen)
        return 0.0

    trackbed.controller("test_broken", replace=True)(step)
    loop = trackbed.Loop("three_turns", set={"control": {"method": "test_broken"}})
    loop.step()
    del loop
    gc.collect()
    assert kept[0].t_s == 0.0 and kept[0].vehicle.wheelbase > 2.0
    with pytest.raises(RuntimeError, match="until step returns"):
        kept[0].reference([1.0])


def test_objects_of_plugins_are_freed():
    made = []

    class Counted:
        def __init__(self):
            made.append(weakref.ref(self))

        def step(self, seen):
            return 0.0

    trackbed.controller("test_broken", replace=True)(Counted)
    loop = trackbed.Loop("three_turns", set={"control": {"method": "test_broken"}})
    states = [loop.state for _ in range(5)]
    del loop, states
    gc.collect()
    assert made and all(reference() is None for reference in made)


def test_plugins_run_on_threads():
    runs = [None] * 4
    change = {"control": {"method": "test_gain"}}

    def work(i):
        runs[i] = trackbed.run("three_turns", plants="test_bicycle", set=change)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for run in runs[1:]:
        numpy.testing.assert_array_equal(run["test_bicycle"]["x_m"], runs[0]["test_bicycle"]["x_m"])


def again(request):
    return [[0.0, 0.0], [20.0, 0.0]]


def test_the_same_definition_replaces_itself():
    for _ in range(2):  # As a reloaded module, or a notebook's cell that is run again.
        trackbed.planner("test_again")(again)
    with pytest.raises(ValueError, match="already registered, by .*again"):
        trackbed.planner("test_again")(lambda request: again(request))


class Straight:
    def __call__(self, request):
        x, y, _ = request.start
        return ((x + i, y) for i in range(40))


@pytest.mark.parametrize(
    "name, planner",
    [
        ("test_object", Straight()),
        ("test_partial", functools.partial(lambda request, own: own(request), own=Straight())),
    ],
)
def test_any_callable_is_a_planner(name, planner):
    trackbed.planner(name)(planner)
    run = trackbed.run("three_turns", plants="kinematic", set={"plan": {"method": name}})
    assert run.path["x_m"][-1] == pytest.approx(39.0, abs=0.1)


def test_a_metric_may_have_parameters_of_its_own():
    trackbed.metric("test_bound")(functools.partial(lambda log, *, least: least, least=2.0))
    run = trackbed.run("three_turns", plants="kinematic", set={"drive.time_limit": 1, "expect": {}})
    assert run.metric_values("kinematic")["test_bound"] == 2.0


def test_a_class_is_no_planner_and_no_metric():
    with pytest.raises(TypeError, match="planner 'test_x' must be a function, not the class Straight"):
        trackbed.planner("test_x")(Straight)
    with pytest.raises(TypeError, match="metric 'test_x' must be a function"):
        trackbed.metric("test_x")(Straight)
