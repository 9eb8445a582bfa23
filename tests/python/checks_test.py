"""Assertions, and the pytest plugin."""

import shutil
import xml.etree.ElementTree

import pytest

import trackbed

pytest_plugins = "pytester"


@pytest.fixture(scope="module")
def run():
    return trackbed.run("three_turns", plants=["kinematic", "mujoco"])


def failure(check, *arguments, **bounds):
    with pytest.raises(AssertionError) as error:
        check(*arguments, **bounds)
    return str(error.value)


def test_pass_if_the_run_does(run):
    trackbed.tracks_within(run, 0.5)
    trackbed.stays_within(run, "mujoco", "kinematic", 0.5)
    trackbed.reaches_goal(run, 0.5)
    trackbed.steers_calmly(run)
    trackbed.satisfies(run, "always abs(cross_track_m) < 0.5")
    trackbed.meets_its_expectations(run)
    comparison = trackbed.compare(run, "kinematic", "mujoco")
    trackbed.differs_by_at_most(comparison, position=0.5, heading=0.5, yaw_rate=1, steering=1)


# The texts of the same failures in C++ are tested in tests/testing/scenario_testing_test.cpp.
def test_fail_with_the_texts_of_the_matchers(run):
    worst = run.metrics["mujoco"]["cross_track"]
    text = failure(trackbed.tracks_within, run, 1e-9)
    assert text.startswith("Expected: tracks its path within 1e-09 m\n  Actual: three_turns: ")
    assert "mujoco: cross-track error %.4g m at s = " % worst["max"] in text
    between = run.comparisons[0]["position"]
    text = failure(trackbed.stays_within, run, "kinematic", "mujoco", 1e-9)
    assert "Expected: keeps kinematic and mujoco within 1e-09 m of each other" in text
    assert "position difference %.4g m at s = " % between["max"] in text
    text = failure(trackbed.satisfies, run, "always speed_mps > 100")
    assert "Expected: satisfies always speed_mps > 100" in text
    text = failure(trackbed.keeps_clearance, run, 1.0)
    assert text.endswith("kinematic: there are no obstacles; mujoco: there are no obstacles")
    comparison = trackbed.compare(run, "kinematic", "mujoco")
    text = failure(trackbed.differs_by_at_most, comparison, position=1e-9, steering=9.0)
    assert text.startswith(
        "Expected: differ by at most 1e-09 m in position, 9 rad in steering\n"
        "  Actual: kinematic and mujoco from 0 m to "
    )


def test_compare_two_runs(run):
    other = trackbed.run("three_turns", plants="mujoco")
    comparison = trackbed.compare(run, other, "mujoco")
    assert comparison["position"]["max"] == 0.0
    with pytest.raises(trackbed.InputError, match="no plant kinematic"):
        trackbed.compare(run, other, "kinematic")


@pytest.mark.parametrize(
    "use, error, text",
    [
        (lambda run: trackbed.tracks_within(3, 0.1), TypeError, "run must be a trackbed.Run"),
        (lambda run: trackbed.tracks_within(run, "a"), TypeError, "limit must be a number"),
        (lambda run: trackbed.satisfies(run, 3), TypeError, "formula must be a str"),
        (
            lambda run: trackbed.satisfies(run, "alway speed_mps < 1"),
            trackbed.InputError,
            "formula is 'alway .*unknown signal 'alway'",
        ),
        (lambda run: trackbed.satisfies(run, "speed_mps <"), trackbed.InputError, "formula is 'sp"),
        (lambda run: trackbed.satisfies(run, ""), trackbed.InputError, "formula is ''"),
        (lambda run: trackbed.stays_within(run, 1, "a", 1), TypeError, "first must be a str"),
        (lambda run: trackbed.compare(run, "kinematic", 3), TypeError, "plant must be a str"),
        (lambda run: trackbed.differs_by_at_most(run, position=1), TypeError, "comparison must be"),
        (
            lambda run: trackbed.differs_by_at_most(
                trackbed.compare(run, "kinematic", "mujoco"), heading=float("nan")
            ),
            ValueError,
            "heading is nan",
        ),
    ],
)
def test_wrong_arguments_are_named(run, use, error, text):
    with pytest.raises(error, match=text):
        use(run)


ARGUMENTS = ("-p", "trackbed.pytest_plugin", "-p", "no:cacheprovider")


def test_fixture_runs_a_scenario_once(pytester):
    pytester.makepyfile(
        """
        import trackbed

        def test_first(trackbed_run):
            run = trackbed_run("three_turns", plants=["kinematic"])
            assert trackbed_run("three_turns", plants=["kinematic"]) is run
            assert trackbed_run("three_turns", plants=["mujoco"]) is not run
            trackbed.tracks_within(run, 0.5)

        def test_second(trackbed_run):
            trackbed.tracks_within(trackbed_run("three_turns", plants=["kinematic"]), 1e-9)
        """
    )
    result = pytester.runpytest_subprocess(*ARGUMENTS)
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["*Expected: tracks its path within 1e-09 m*"])
    # The traceback ends at the line of the test.
    assert "_checks.py" not in result.stdout.str()


def test_fixture_notices_changed_scenarios_and_plugins(pytester):
    pytester.makepyfile(
        """
        import trackbed

        TEXT = (
            "schema: 1\\nname: x\\nmission: {speed: %d, duration: 1}\\n"
            "control: {method: %s}\\ndrive: {plants: [kinematic]}\\n"
        )

        def test_file(trackbed_run, tmp_path, monkeypatch):
            for folder, speed in (("a", 2), ("b", 3), ("b", 4)):
                (tmp_path / folder).mkdir(exist_ok=True)
                monkeypatch.chdir(tmp_path / folder)
                with open("x.yaml", "w") as file:
                    file.write(TEXT % (speed, "constant_steering, steering: 0"))
                run = trackbed_run("x.yaml")
                assert run["kinematic"]["speed_mps"][0] == speed
                assert trackbed_run("x.yaml") is run

        def test_plugin(trackbed_run, tmp_path, monkeypatch):
            monkeypatch.chdir(tmp_path)
            with open("x.yaml", "w") as file:
                file.write(TEXT % (2, "own"))
            for angle in (0.1, 0.2):
                trackbed.controller("own", needs_plan=False, replace=True)(lambda seen: angle)
                run = trackbed_run("x.yaml")
                assert run["kinematic"]["steering_command_rad"][0] == angle
        """
    )
    pytester.runpytest_subprocess(*ARGUMENTS).assert_outcomes(passed=2)


def test_collects_scenarios_with_expectations(pytester, scenarios):
    folder = pytester.mkdir("scenarios")
    shutil.copy(scenarios / "three_turns.yaml", folder / "good.yaml")
    text = (scenarios / "three_turns.yaml").read_text()
    assert "expect:" in text
    bad = text[: text.index("expect:")] + "expect:\n  max_cross_track: 1.0e-9\n"
    (folder / "bad.yaml").write_text(bad)
    (folder / "wrong.yaml").write_text(text.replace("mission:", "misson:", 1))
    (folder / "map.yaml").write_text("image: a.pgm\nresolution: 0.1\norigin: [0, 0, 0]\n")
    result = pytester.runpytest_subprocess(*ARGUMENTS, "scenarios", "--junitxml=out.xml")
    result.assert_outcomes(passed=1, failed=2)
    result.stdout.fnmatch_lines(["*cross-track error*", "*misson*"])
    assert "pytest_plugin.py" not in result.stdout.str()
    suite = xml.etree.ElementTree.parse(pytester.path / "out.xml").getroot().find("testsuite")
    assert suite.get("tests") == "3"


def test_collects_only_scenarios_below_the_given_folder(pytester, scenarios):
    shutil.copy(scenarios / "three_turns.yaml", pytester.path / "other.yaml")
    result = pytester.runpytest_subprocess(*ARGUMENTS, "-p", "no:terminalreporter", "--co")
    assert "other.yaml" not in result.stdout.str()
