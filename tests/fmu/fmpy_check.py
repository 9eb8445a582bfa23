"""Checks an exported FMU with FMPy: validation, and a simulation equal to our own run.

  fmpy_check.py TRACKBED SCENARIO PLANT FMI

Runs in the Python of `scripts/setup fmpy`, or in another one that has FMPy. This Python loads the
FMU with its own libraries. Prints one line. Ends with 77 without FMPy.
"""
import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import fmpy
    import fmpy.validation
    import numpy as np
except ImportError:
    python = pathlib.Path(sys.argv[1]).parent / "fmpy/bin/python"
    if python.exists() and sys.executable != str(python):
        os.execv(python, [str(python), *sys.argv])
    print("skipped: FMPy is not installed; `scripts/setup fmpy` installs it")
    sys.exit(77)


def own_run(program, scenario, plant, folder, overrides):
    # The run ends early, so it may fail the expectations of the scenario (exit code 3).
    code = subprocess.run([program, "run", "-q", scenario, "--plant", plant, "-o", folder, "--set",
                           *overrides, "expect={}"], check=False).returncode
    assert code in (0, 3), code
    with open(folder / f"{plant.replace(':', '-')}.csv", newline="") as file:
        rows = list(csv.reader(file))
    return {name: np.array([float(row[i]) for row in rows[1:]]) for i, name in enumerate(rows[0])}


def same(log, result, columns, what):
    count = min(len(log["t_s"]), len(result["time"]))
    assert count > 100, f"{what}: only {count} rows"
    for name in columns:
        off = np.abs(result[name][:count] - log[name][:count]).max()
        assert off <= 1e-12, f"{what}: {name} differs by {off}"
    return count


def main(program, scenario, plant, fmi):
    folder = pathlib.Path(tempfile.mkdtemp())
    try:
        overrides = ["drive.time_limit=5"]
        fmu = str(folder / "car.fmu")
        subprocess.run([program, "fmu", "-q", scenario, "--plant", plant, "--fmi", fmi, "-o", fmu,
                        "--set", *overrides], check=True)
        problems = fmpy.validation.validate_fmu(fmu)
        assert not problems, problems
        description = fmpy.read_model_description(fmu)
        period = float(description.defaultExperiment.stepSize)
        log = own_run(program, scenario, plant, folder / "run", overrides)
        # The FMU outputs the command of the previous step, so this column lags the log by one row.
        states = [name for name in log if name != "steering_command_rad"]
        options = dict(output_interval=period, step_size=period, stop_time=5.0, output=states)
        driven = fmpy.simulate_fmu(fmu, start_values={"controller_steers": True}, **options)
        rows = same(log, driven, states, "driven by the controller")
        # The inputs are the commands of the log, each constant over its period.
        commands = np.array(list(zip(log["t_s"], log["steering_command_rad"])),
                            dtype=[("time", float), ("commanded_steering_rad", float)])
        steered = fmpy.simulate_fmu(fmu, start_values={"plan_sets_speed": True}, input=commands,
                                    **options)
        same(log, steered, states, "steered by the commands of the log")
        # A parameter of the FMU has the effect of an override of the scenario.
        slower = own_run(program, scenario, plant, folder / "slow",
                         [*overrides, "mission.speed=1.5"])
        slow = fmpy.simulate_fmu(fmu, start_values={"controller_steers": True,
                                                    "mission.speed": 1.5}, **options)
        same(slower, slow, states, "mission.speed=1.5")
        print(f"FMI {fmi}: {rows} rows of {len(states)} columns equal, three times")
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
