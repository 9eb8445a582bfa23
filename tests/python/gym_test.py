"""The environment for Gymnasium; skipped where Gymnasium is not installed."""

import importlib
import inspect
import sys
import warnings

import numpy
import pytest

import trackbed

gymnasium = pytest.importorskip("gymnasium")
import trackbed.gym  # noqa: E402
from gymnasium.utils.env_checker import check_env  # noqa: E402

NAME = "trackbed/PathTracking-v0"


@pytest.mark.parametrize("plant", ["kinematic", "mujoco"])
@pytest.mark.parametrize("max_acceleration", [None, 2.0])
def test_passes_the_check_of_gymnasium(plant, max_acceleration):
    env = gymnasium.make(NAME, scenario="three_turns", plant=plant, max_acceleration=max_acceleration)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # The bounds of the observations are infinite on purpose, because observations are in SI
        # units.
        warnings.filterwarnings("ignore", message=".*Box observation space m.*")
        check_env(env.unwrapped)


def test_drives_the_path_of_the_loop():
    env = gymnasium.make(NAME, plant="kinematic", costs={"cross_track_m": 2.0})
    loop = trackbed.Loop("three_turns", "kinematic")
    seen = loop.reset()
    observation, info = env.reset()
    columns = list(trackbed.gym.OBSERVED)
    while True:
        angle = numpy.float32(-0.3 * seen.cross_track_m + 1.5 * seen.curvature_radpm)
        observation, reward, terminated, truncated, info = env.step(numpy.array([angle]))
        seen = loop.step(float(angle) * loop.steering_limit)
        expected = numpy.array([getattr(seen, name) for name in columns], dtype=numpy.float32)
        numpy.testing.assert_array_equal(observation[: len(columns)], expected)
        assert reward == -2.0 * (seen.cross_track_m * seen.cross_track_m)
        assert info == {"status": seen.status, "t_s": seen.t_s}
        if terminated or truncated:
            break
    assert terminated == (seen.ended or abs(seen.cross_track_m) > 5.0)


def test_is_truncated_by_the_time_limit():
    env = gymnasium.make(NAME, plant="kinematic", set={"drive.time_limit": 0.1})
    env.reset()
    steps = 0
    while True:
        steps += 1
        _, _, terminated, truncated, info = env.step(numpy.zeros(1, numpy.float32))
        if terminated or truncated:
            break
    assert (terminated, truncated, info["status"], steps) == (False, True, "time_limit", 5)


def test_is_terminated_off_the_path():
    env = gymnasium.make(NAME, plant="kinematic", max_cross_track=0.5)
    env.reset()
    while True:
        _, _, terminated, truncated, info = env.step(numpy.ones(1, numpy.float32))
        if terminated or truncated:
            break
    assert terminated and info["status"] is None


def test_seeds_repeat_and_options_change_the_scenario():
    env = gymnasium.make(NAME, plant="kinematic", set={"disturb.noise": {"position": 0.1}})
    first, _ = env.reset(seed=1)
    second, _ = env.reset(seed=2)
    assert (first != second).any()
    numpy.testing.assert_array_equal(env.reset(seed=1)[0], first)
    changed, _ = env.reset(options={"set": {"mission.start.speed": 1.0}})
    assert changed[0] == 1.0


class OneByOne:
    """The vector environment's oracle: PathTracking, reset in the step after an episode's end."""

    def __init__(self, count, **arguments):
        self.envs = [gymnasium.make(NAME, **arguments) for _ in range(count)]
        self.done = [False] * count

    def reset(self, seed):
        self.done = [False] * len(self.envs)
        return [env.reset(seed=seed + i)[0] for i, env in enumerate(self.envs)]

    def step(self, actions):
        rows = []
        for env, action, done in zip(self.envs, actions, self.done):
            row = (env.reset()[0], 0.0, False, False) if done else env.step(action)[:4]
            rows.append(row)
        self.done = [row[2] or row[3] for row in rows]
        return [numpy.array(column) for column in zip(*rows)]


@pytest.mark.parametrize("max_acceleration", [None, 2.0])
def test_vector_form_is_many_single_ones(max_acceleration):
    # Short episodes: noise moves some cars off the path, others reach the time limit.
    arguments = dict(
        plant="kinematic",
        max_cross_track=0.12,
        max_acceleration=max_acceleration,
        rewards={"cross_track.max": -3.0},
        set={"drive.time_limit": 1.0, "disturb.noise": {"position": 0.05}, "mission.start.speed": 3},
    )
    envs = gymnasium.make_vec(NAME, num_envs=5, **arguments)
    assert isinstance(envs.unwrapped, trackbed.gym.VectorPathTracking)
    single = OneByOne(5, **arguments)
    observations, infos = envs.reset(seed=3)
    numpy.testing.assert_array_equal(observations, single.reset(3))
    assert observations in envs.observation_space
    random = numpy.random.default_rng(7)
    ends = {"terminated": 0, "truncated": 0}
    for _ in range(110):
        actions = random.uniform(-1.0, 1.0, envs.action_space.shape).astype(numpy.float32)
        actions[:3] *= 0.1
        *found, infos = envs.step(actions)
        for own, expected in zip(found, single.step(actions)):
            numpy.testing.assert_array_equal(own, expected)
        ends["terminated"] += found[2].sum()
        ends["truncated"] += found[3].sum()
        assert infos["t_s"].shape == infos["status"].shape == (5,)
    assert min(ends.values()) > 0, ends


def test_vector_form_takes_the_seeds_of_a_list():
    envs = gymnasium.make_vec(
        NAME, num_envs=3, plant="kinematic", set={"disturb.noise": {"position": 0.1}}
    )
    observations, _ = envs.reset(seed=[4, 5, 4])
    numpy.testing.assert_array_equal(observations[0], observations[2])
    assert (observations[0] != observations[1]).any()
    with pytest.raises(ValueError, match=r"seed has 2 values; must have 3"):
        envs.reset(seed=[1, 2])
    with pytest.raises(ValueError, match=r"seed has the shape \(\); must be \(3,\)"):
        envs.reset(seed=numpy.array(1.5))
    with pytest.raises(ValueError, match=r"actions has the shape \(2, 1\); must be \(3, 1\)"):
        envs.step(numpy.zeros((2, 1)))


def test_rewards_are_metrics_of_the_run():
    weights = {"cross_track.rms": -10.0, "steering_rate_max": -1.0}
    env = gymnasium.make(NAME, plant="kinematic", costs={}, rewards=weights)
    env.reset()
    total = 0.0
    while True:
        loop = env.unwrapped.loop
        angle = -0.3 * loop.observation.cross_track_m + 1.5 * loop.observation.curvature_radpm
        _, reward, terminated, truncated, _ = env.step(numpy.array([angle], numpy.float32))
        total += reward
        if terminated or truncated:
            break
        assert reward == 0.0
    run = loop.result()
    values = run.metric_values("kinematic")
    assert total == sum(weight * values[name] for name, weight in weights.items())
    rms = numpy.sqrt(numpy.mean(run["kinematic"]["cross_track_m"] ** 2))
    assert values["cross_track.rms"] == pytest.approx(rms, rel=0.05)  # The metric weights by time.


def test_renders_the_moment():
    env = gymnasium.make(NAME, plant="kinematic", render_mode="rgb_array", size=(96, 64))
    env.reset()
    first = env.render()
    assert first.shape == (64, 96, 3) and first.dtype == numpy.uint8
    env.step(numpy.zeros(1, numpy.float32))
    env.render()  # 0.02 s is no multiple of the 1/60 s between the configurations in a run folder.
    for _ in range(99):
        env.step(numpy.zeros(1, numpy.float32))
    later = env.render()
    assert (first != later).any()
    loop = env.unwrapped.loop
    again = trackbed.frame(loop.result(), loop.observation.t_s, (96, 64))
    numpy.testing.assert_array_equal(later, again)
    envs = gymnasium.make_vec(
        NAME, num_envs=2, plant="kinematic", render_mode="rgb_array", size=(96, 64)
    )
    envs.reset()
    numpy.testing.assert_array_equal(envs.render()[1], first)


@pytest.mark.parametrize(
    "arguments, error, text",
    [
        (dict(observed=["speed"]), ValueError, "observed has the unknown column 'speed'; did you mean '"),
        (dict(observed=[3]), TypeError, "a name in observed must be a str"),
        (dict(costs=3), TypeError, "costs must be a dict"),
        (dict(costs={"cross_track_m": "a"}), TypeError, "must be a number"),
        (dict(ahead=["a"]), TypeError, "ahead must be a number"),
        (dict(rewards={"cross_track": 1.0}), ValueError, "rewards has the unknown metric 'cross_track'; did"),
        (dict(rewards=["cross_track.max"]), TypeError, "rewards must be a dict of metrics and weights"),
        (dict(render_mode="human"), ValueError, "render_mode is 'human'; must be None or 'rgb_array'"),
        (dict(size=(96,)), TypeError, r"size must be \(width, height\) in pixels"),
        (dict(max_cross_track=0), ValueError, "max_cross_track is 0; must be above 0"),
        (dict(max_acceleration=-1.0), ValueError, "max_acceleration is -1.0"),
        (dict(scenario="steering_circle"), ValueError, "scenario has no path to follow"),
    ],
)
def test_wrong_arguments_are_named(arguments, error, text):
    with pytest.raises(error, match=text):
        trackbed.gym.PathTracking(**{"scenario": "three_turns", "plant": "kinematic", **arguments})


def test_both_environments_have_the_same_arguments():
    single = inspect.signature(trackbed.gym.PathTracking).parameters
    envs = trackbed.gym.VectorPathTracking(2, "three_turns", "kinematic", threads=1, ahead=[1.0])
    assert envs.single_observation_space.shape == (len(trackbed.gym.OBSERVED) + 1,)
    assert single["ahead"].default == (2.0, 5.0, 10.0)
    for made in (trackbed.gym.PathTracking, trackbed.gym.VectorPathTracking):
        with pytest.raises(TypeError, match="unexpected keyword argument 'reward'"):
            made(reward={})


def test_an_old_gymnasium_is_named(monkeypatch):
    monkeypatch.setattr(gymnasium, "__version__", "0.29.1")
    monkeypatch.delitem(sys.modules, "trackbed.gym")
    with pytest.raises(ImportError, match=r"Gymnasium 1\.0 or newer, not 0\.29\.1: pip install"):
        importlib.import_module("trackbed.gym")


def test_wrong_actions_are_named():
    env = trackbed.gym.PathTracking("three_turns", "kinematic")
    env.reset()
    with pytest.raises(ValueError, match=r"action has the shape \(2,\); must be \(1,\)"):
        env.step(numpy.zeros(2, numpy.float32))
    with pytest.raises(ValueError, match="options has the unknown key 'speed'"):
        env.reset(options={"speed": 3})
    with pytest.raises(ValueError, match="render_mode is array"):
        trackbed.gym.PathTracking("three_turns", "kinematic", render_mode=numpy.zeros(2))
