"""Loops that Python steps."""

import copy
import gc
import math
import os
import pickle
import threading
import time

import numpy
import pytest

import trackbed


def same_logs(first, second):
    assert list(first) == list(second)
    for name in first:
        numpy.testing.assert_array_equal(first[name], second[name], name)


def finish(loop):
    while not loop.observation.ended:
        loop.step()
    return loop.log


@pytest.mark.parametrize("plant", ["kinematic", "single_track", "mujoco"])
def test_stepped_by_its_controller_is_the_run(plant):
    run = trackbed.run("three_turns", plants=plant)
    loop = trackbed.Loop("three_turns", plant)
    same_logs(finish(loop), run[plant])
    assert loop.observation.status == run.metrics[plant]["status"]


def test_goes_where_it_is_steered():
    loop = trackbed.Loop("three_turns", "kinematic", seed=1)
    seen = loop.reset()
    start = seen.speed_mps
    while seen.t_s < 2.0:
        seen = loop.step(steering=0.3, acceleration=1.0)
    # 1000 additions of 0.002 to numbers below 8 round by up to half an ulp, 8.9e-16, each.
    assert seen.speed_mps == pytest.approx(start + 2.0, abs=1000 * 4.5e-16)
    assert seen.steering_actuator_rad == 0.3
    assert seen.yaw_rad > loop.log["yaw_rad"][0]
    assert loop.log["steering_command_rad"][-1] == 0.3


def test_observation_has_the_values_of_the_log():
    loop = trackbed.Loop("three_turns", "mujoco")
    seen = []
    for _ in range(200):
        seen.append(loop.step())
    log = loop.log
    for name in trackbed.VectorLoop.columns:
        if name in log and name not in ("clearance_m",):
            numpy.testing.assert_array_equal(log[name][1:], [getattr(o, name) for o in seen[:-1]])
    reference = loop.reference([o.station_m for o in seen])
    numpy.testing.assert_array_equal(reference["curvature_radpm"], [o.curvature_radpm for o in seen])
    numpy.testing.assert_array_equal(reference["speed_mps"], [o.planned_speed_mps for o in seen])


def test_with_noise_sees_the_measured_pose():
    loop = trackbed.Loop("three_turns", "kinematic", set={"disturb.noise": {"position": 0.1}})
    seen = [loop.step() for _ in range(100)]
    log = loop.log
    numpy.testing.assert_array_equal(log["measured_x_m"][1:], [o.x_m for o in seen[:-1]])
    errors = numpy.array([o.cross_track_m for o in seen[:-1]]) - log["cross_track_m"][1:]
    # The noise across the path has a standard deviation of 0.1 m. With 99 samples, the measured
    # standard deviation errs by 0.1/sqrt(2*99) m = 7 mm. The tolerance is five times that.
    assert numpy.std(errors) == pytest.approx(0.1, abs=0.036)


@pytest.mark.parametrize("plant", ["kinematic", "mujoco"])
def test_returns_to_a_state_exactly(plant):
    whole = finish(trackbed.Loop("three_turns", plant))
    loop = trackbed.Loop("three_turns", plant)
    for _ in range(150):
        loop.step()
    state = loop.state
    for steering in (0.3, -0.3):
        for _ in range(20):
            loop.step(steering, 1.0)
        loop.state = state
    same_logs(finish(loop), whole)
    loop.state = state
    assert not loop.observation.ended
    same_logs(finish(loop), whole)


def test_states_outlive_their_loop():
    loop = trackbed.Loop("three_turns", "mujoco")
    loop.step()
    state, log, seen = loop.state, loop.log, loop.observation
    x = log["x_m"]
    before = x.copy()
    other = trackbed.Loop("three_turns", "mujoco")
    del loop, log
    gc.collect()
    numpy.testing.assert_array_equal(x, before)
    assert seen.t_s == pytest.approx(0.02)
    with pytest.raises(ValueError, match="state is the state of a loop with another scenario"):
        other.state = state


def test_reset_returns_to_the_start():
    loop = trackbed.Loop("three_turns", "kinematic")
    first = finish(loop)
    assert loop.reset().t_s == 0.0
    same_logs(finish(loop), first)
    seen = loop.reset(set={"mission.start.speed": 1.0})
    assert seen.speed_mps == 1.0
    assert loop.reset().speed_mps == 1.0
    assert loop.reset(options={"set": {"mission.start.speed": 2.0}}).speed_mps == 2.0
    with pytest.raises(ValueError, match="options has the unknown key 'mission.start.speed'"):
        loop.reset(options={"mission.start.speed": 2.0})
    with pytest.raises(ValueError, match=r"set and options\['set'\] are both given"):
        loop.reset(set={}, options={"set": {}})


def test_a_log_without_rows_has_columns():
    log = trackbed.Loop("three_turns", "kinematic").log
    assert log.rows == 0 and log["x_m"].shape == (0,)
    assert log["x_m"].flags.writeable is False
    assert pickle.loads(pickle.dumps(log))["x_m"].shape == (0,)


def test_seed_selects_the_noise():
    noise = {"disturb.noise": {"position": 0.1}}
    loop = trackbed.Loop("three_turns", "kinematic", set=noise, seed=1)
    first = loop.observation.x_m
    assert loop.reset(seed=2, set=noise).x_m != first
    assert loop.reset(seed=1, set=noise).x_m == first


def test_keeps_the_last_row_only_if_asked():
    loop = trackbed.Loop("three_turns", "kinematic", log=False)
    for _ in range(100):
        loop.step()
    assert loop.log.rows == 1


def test_ends_and_refuses_another_step():
    loop = trackbed.Loop("three_turns", "kinematic")
    finish(loop)
    assert loop.observation.status == "arrived"
    with pytest.raises(RuntimeError, match=r"ended \(arrived\); call reset"):
        loop.step(0.0, 0.0)


@pytest.mark.parametrize(
    "arguments, error, text",
    [
        (("a",), TypeError, "steering must be a number, not str"),
        ((0.0, "a"), TypeError, "acceleration must be a number, not str"),
        ((math.nan,), ValueError, "steering is nan; must be finite"),
        ((0.0, math.inf), ValueError, "acceleration is inf; must be finite"),
        (([0.0],), TypeError, "steering must be a number, not list"),
        ((None, 1.0), ValueError, "acceleration is given without steering"),
    ],
)
def test_wrong_commands_are_named(arguments, error, text):
    loop = trackbed.Loop("three_turns", "kinematic")
    with pytest.raises(error, match=text):
        loop.step(*arguments)
    assert loop.observation.t_s == 0.0


@pytest.mark.parametrize(
    "arguments, error, text",
    [
        (dict(plant=3), TypeError, "plant must be a str"),
        (dict(plant="recorded"), ValueError, "recorded"),
        (dict(plant="cinematic"), ValueError, "kinematic"),
        (dict(scenario=None), TypeError, "scenario must be"),
        (dict(seed="a"), TypeError, "seed must be a whole number"),
    ],
)
def test_wrong_arguments_are_named(arguments, error, text):
    with pytest.raises(error, match=text):
        trackbed.Loop(**{"scenario": "three_turns", **arguments})


def test_wrong_states_and_stations_are_named():
    loop = trackbed.Loop("three_turns", "kinematic")
    with pytest.raises(TypeError, match="state must be a trackbed.LoopState, not int"):
        loop.state = 3
    with pytest.raises(TypeError, match="stations must be an array of numbers"):
        loop.reference(["a"])
    with pytest.raises(ValueError, match="stations has the shape"):
        loop.reference([[1.0]])
    with pytest.raises(ValueError, match="stations has the shape"):
        loop.reference(1.0)
    with pytest.raises(ValueError, match="stations has a value that is not finite"):
        loop.reference([math.nan])


def test_a_scenario_without_a_plan_is_an_error():
    blocked = {"world.obstacles": [{"box": {"x": 0, "y": 0, "length": 1, "width": 1, "height": 1}}]}
    with pytest.raises(RuntimeError, match="no plan: "):
        trackbed.Loop("three_turns", "kinematic", set=blocked)


def test_vector_is_each_loop_alone():
    count = 12
    noise = {"disturb.noise": {"position": 0.05, "heading": 0.01}}
    vector = trackbed.VectorLoop(
        "three_turns", "mujoco", count, seeds=range(count), set=noise, threads=4, log=True
    )
    alone = [trackbed.Loop("three_turns", "mujoco", noise, seed=i) for i in range(count)]
    random = numpy.random.default_rng(1)
    for _ in range(60):
        steering = random.uniform(-0.3, 0.3, count)
        acceleration = random.uniform(0.0, 2.0, count)
        acceleration[::3] = math.nan
        seen = vector.step(steering, acceleration)
        for i, loop in enumerate(alone):
            own = loop.step(
                float(steering[i]), None if math.isnan(acceleration[i]) else float(acceleration[i])
            )
            numpy.testing.assert_array_equal(seen[i], [getattr(own, c) for c in vector.columns])
    for i in range(count):
        same_logs(vector.loops[i].log, alone[i].log)


def test_vector_leaves_ended_loops_and_resets():
    vector = trackbed.VectorLoop("three_turns", "kinematic", 3)
    first = vector.reset()
    assert first.shape == (3, len(vector.columns))
    while not vector.loops[0].observation.ended:
        vector.loops[0].step()
    assert list(vector.ended) == [True, False, False]
    before = vector.observations
    after = vector.step([0.1, 0.1, 0.1])
    numpy.testing.assert_array_equal(before[0], after[0])
    assert (after[1] != before[1]).any()
    numpy.testing.assert_array_equal(vector.reset(), first)
    assert not vector.ended.any()


@pytest.mark.parametrize(
    "use, error, text",
    [
        (lambda v: v.step([0.1]), ValueError, r"steering has the shape \(1,\); must be \(3,\)"),
        (lambda v: v.step([0.1, 0.1, math.nan]), ValueError, "steering has a value that is not"),
        (lambda v: v.step(["a", "b", "c"]), TypeError, "steering must be an array of numbers"),
        (
            lambda v: v.step(numpy.ma.masked_array([0.1] * 3, mask=[0, 1, 0])),
            ValueError,
            "steering has a value that is not finite",
        ),
        (lambda v: v.step([0.0] * 3, [[1.0]]), ValueError, "acceleration has the shape"),
        (lambda v: v.step([0.0] * 3, [1, 1, math.inf]), ValueError, "acceleration has an infinite"),
        (lambda v: v.step(None, [1.0] * 3), ValueError, "acceleration is given without steering"),
        (lambda v: v.reset([1, 2]), ValueError, "seeds has 2 values; must have 3"),
        (lambda v: v.reset([[1, 2], 3, 4]), TypeError, r"seeds\[0\] must be"),
        (lambda v: v.reset("123"), TypeError, "seeds must be a list of whole numbers, not str"),
        (lambda v: trackbed.VectorLoop("three_turns", "kinematic", 0), ValueError, "count is 0"),
        (lambda v: trackbed.VectorLoop("three_turns", "kinematic", 2, seeds=[1]), ValueError, "seeds"),
        (lambda v: trackbed.VectorLoop("three_turns", count=1, threads=0), ValueError, "threads is 0"),
    ],
)
def test_vector_names_wrong_arguments(use, error, text):
    with pytest.raises(error, match=text):
        use(trackbed.VectorLoop("three_turns", "kinematic", 3))


def test_vector_resets_with_other_seeds_and_values():
    noise = {"disturb.noise": {"position": 0.1}}
    vector = trackbed.VectorLoop("three_turns", "kinematic", 2, seeds=[1, 2], set=noise)
    alone = [trackbed.Loop("three_turns", "kinematic", noise, seed=i) for i in (7, 8)]
    seen = vector.reset(seeds=[7, 8], set=noise)
    assert [row[vector.columns.index("x_m")] for row in seen] == [
        loop.observation.x_m for loop in alone
    ]


def test_observations_are_copied_but_not_pickled():
    seen = trackbed.Loop("three_turns", "kinematic").observation
    assert copy.copy(seen) is seen
    assert copy.deepcopy([seen])[0] is seen
    with pytest.raises(TypeError, match=r"cannot be pickled; use seen.asdict\(\)"):
        pickle.dumps(seen)
    assert pickle.loads(pickle.dumps(seen.asdict()))["speed_mps"] == seen.speed_mps


def test_one_loop_may_be_stepped_by_several_threads():
    loop = trackbed.Loop("three_turns", "mujoco")

    def work():
        for _ in range(50):
            loop.step(0.1, 1.0)
            loop.state
            loop.log["x_m"]

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert loop.observation.t_s == pytest.approx(200 * loop.period)


def test_steps_in_a_forked_process():
    vector = trackbed.VectorLoop("three_turns", "kinematic", 8, threads=2)
    vector.step()
    child = os.fork()
    if child == 0:
        try:
            vector.step()
            os._exit(0)
        finally:
            os._exit(1)
    assert os.waitpid(child, 0)[1] == 0


def test_the_result_of_a_loop_is_the_run():
    set = {"mission.waypoints": [[0, 0], [20, 0]], "expect": {"max_cross_track": 0.2}}
    run = trackbed.run("three_turns", plants=["kinematic"], set=set)
    loop = trackbed.Loop("three_turns", "kinematic", set)
    assert loop.result().metrics["kinematic"]["status"] == "interrupted"
    while not loop.observation.ended:
        loop.step()
    result = loop.result()
    assert result.metrics == run.metrics and result.verdict == run.verdict and result.passed
    for column in run["kinematic"]:
        numpy.testing.assert_array_equal(result["kinematic"][column], run["kinematic"][column])


def test_a_result_ends_with_the_present_moment():
    loop = trackbed.Loop("three_turns", "kinematic")
    for steps in range(3):
        log = loop.result()["kinematic"]
        seen = loop.observation
        assert (log.rows, log["t_s"][-1], log["x_m"][-1]) == (steps + 1, seen.t_s, seen.x_m)
        trackbed.frame(loop.result(), seen.t_s, (64, 64))
        loop.step(0.1)
    last = trackbed.Loop("three_turns", "kinematic", log=False)
    last.step()
    last.step()
    assert last.result()["kinematic"]["t_s"].tolist()[-1] == last.observation.t_s


def test_a_copy_goes_its_own_way():
    loop = trackbed.Loop("three_turns", "kinematic")
    loop.step(0.1)
    other = copy.deepcopy(loop)
    assert repr(other.observation) == repr(loop.observation)
    other.step(0.3)
    assert loop.observation.t_s == loop.period and other.observation.t_s == 2 * loop.period
    loop.step(0.3)
    assert repr(other.observation) == repr(loop.observation)
    with pytest.raises(TypeError, match="a Loop cannot be pickled; make a loop in each process"):
        pickle.dumps(loop)
    with pytest.raises(TypeError, match="a LoopState cannot be pickled"):
        pickle.dumps(loop.state)


def test_copies_of_vectors_and_of_subclasses_go_their_own_way():
    class Own(trackbed.Loop):
        gain = 2

    assert type(copy.copy(Own("three_turns", "kinematic"))) is Own
    cars = trackbed.VectorLoop("three_turns", "kinematic", 3)
    cars.step([0.1, 0.2, 0.3])
    other = copy.deepcopy(cars)
    numpy.testing.assert_array_equal(other.observations, cars.observations)
    other.step([0.3, 0.3, 0.3])
    assert (cars.observations[:, 0] == cars.loops[0].period).all()
    assert other.loops[2].observation.t_s == 2 * cars.loops[2].observation.t_s
    with pytest.raises(TypeError, match="a VectorLoop cannot be pickled"):
        pickle.dumps(cars)


def test_a_name_is_found_without_reading_other_scenarios():
    def seconds(name):
        start = time.process_time()
        try:
            trackbed.Loop(name, "kinematic")
        except trackbed.InputError:
            pass
        return time.process_time() - start

    # An unknown name needs the names of all scenarios, and so reads all files: about 150 ms of
    # processor time. Reading and planning one scenario takes about 5 ms.
    seconds("three_turns")
    assert seconds("three_turns") < 0.5 * seconds("three_tunrs")


def test_texts_say_where_the_car_is():
    cars = trackbed.VectorLoop("three_turns", "kinematic", 2)
    cars.step()
    assert repr(cars.loops[0]) == "<Loop three_turns on kinematic: driving at 0.02 s>"
    assert repr(cars) == "<VectorLoop three_turns on kinematic: 0 of 2 ended>"
    assert repr(cars.loops[0].observation).startswith("<Observation {'t_s': 0.02, 'x_m': ")
    assert len(cars) == 2 and cars.statuses == [None, None]


def test_curvature_ahead_is_that_of_the_references():
    cars = trackbed.VectorLoop("three_turns", "kinematic", 2, seeds=[1, 2])
    for angle in numpy.linspace(0, 0.2, 50):
        cars.step([angle, -angle])
    ahead = numpy.array([0.0, 5.0, 35.0])
    found = cars.curvature_ahead(ahead)
    for row, loop in zip(found, cars.loops):
        points = loop.reference(loop.observation.station_m + ahead)
        numpy.testing.assert_array_equal(row, points["curvature_radpm"])
    assert (found != 0.0).any()
    with pytest.raises(ValueError, match=r"distances has the shape \(\); must be \(n,\)"):
        cars.curvature_ahead(2.0)
