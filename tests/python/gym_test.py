"""The environment for Gymnasium; skipped where Gymnasium is not installed."""

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
        check_env(env.unwrapped, skip_render_check=True)


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
        assert reward == -2.0 * seen.cross_track_m**2
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


def test_vector_form():
    envs = gymnasium.make_vec(NAME, num_envs=3, plant="kinematic")
    observations, _ = envs.reset(seed=3)
    assert observations.shape == (3, envs.single_observation_space.shape[0])
    observations, rewards, *_ = envs.step(numpy.zeros((3, 1), numpy.float32))
    assert rewards.shape == (3,)


@pytest.mark.parametrize(
    "arguments, error, text",
    [
        (dict(observed=["speed"]), ValueError, "observed has the unknown column 'speed'; allowed: t_s"),
        (dict(observed=[3]), TypeError, "a name in observed must be a str"),
        (dict(costs=3), TypeError, "costs must be a dict"),
        (dict(costs={"cross_track_m": "a"}), TypeError, "must be a number"),
        (dict(ahead=["a"]), TypeError, "ahead must be a number"),
        (dict(max_cross_track=0), ValueError, "max_cross_track is 0; must be above 0"),
        (dict(max_acceleration=-1.0), ValueError, "max_acceleration is -1.0"),
        (dict(scenario="steering_circle"), ValueError, "scenario has no path to follow"),
    ],
)
def test_wrong_arguments_are_named(arguments, error, text):
    with pytest.raises(error, match=text):
        trackbed.gym.PathTracking(**{"scenario": "three_turns", "plant": "kinematic", **arguments})


def test_wrong_actions_are_named():
    env = trackbed.gym.PathTracking("three_turns", "kinematic")
    env.reset()
    with pytest.raises(ValueError, match=r"action has the shape \(2,\); must be \(1,\)"):
        env.step(numpy.zeros(2, numpy.float32))
    with pytest.raises(ValueError, match="options has the unknown key 'speed'"):
        env.reset(options={"speed": 3})
