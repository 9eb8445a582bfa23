#!/usr/bin/env python3
"""Compares the speed of Trackbed in Python with other simulators of cars, in one process.

    PYTHONPATH=build/release/python python3 bench/python_peers.py [--seconds 2] [--processor-time]
        [--f1tenth PYTHON MAP]

Prints the simulated seconds per second of wall-clock time, of one car and of 64 cars together. Each
car turns at constant speed. Peers that are not installed are named and left out:

* mujoco: mj_step of the MuJoCo model that Trackbed composes for the same car, at its timestep, with
  MuJoCo's contacts instead of tyres, without sensors and log; 64 cars by mujoco.rollout on all
  processors.
* commonroad-vehicle-models: the single-track and the multi-body model of the BMW 320i, integrated
  by scipy's odeint over each control period, as its examples do; 64 cars one after another.
* f1tenth_gym: F110Env.step with its laser scan, without pictures, of one car on the map MAP, such as
  examples/example_map; 64 cars one after another. The Python PYTHON runs f1tenth_gym, because
  f1tenth_gym needs NumPy 1.22 or older, which has no wheel for the Python of Debian 12 or 13.

Trackbed's 64 cars are a VectorLoop on all processors. Each time is the least of three.
"""

import argparse
import importlib.util
import os
import pathlib
import subprocess
import tempfile
import time

import numpy

import trackbed

PERIOD = 0.02  # Control period of the scenario [s].
COUNT = 64


clock = time.perf_counter


def fastest(work, prepare=lambda: None):
    times = []
    for _ in range(3):
        prepare()
        start = clock()
        work()
        times.append(clock() - start)
    return min(times)


def of_trackbed(plant, seconds):
    periods = round(seconds / PERIOD)
    loop = trackbed.Loop("three_turns", plant, log=False)
    many = trackbed.VectorLoop("three_turns", plant=plant, count=COUNT, threads=os.cpu_count(),
                               log=False)
    angles = numpy.full(COUNT, 0.05)

    def one():
        for _ in range(periods):
            loop.step(0.05)

    def all_together():
        for _ in range(periods):
            many.step(angles)

    return fastest(one, loop.reset), fastest(all_together, many.reset)


def of_mujoco(seconds):
    import mujoco
    import mujoco.rollout

    run = trackbed.run("three_turns", plants=["kinematic"], set={"drive.time_limit": 0.1})
    with tempfile.TemporaryDirectory() as folder:
        run.write(folder)
        model = mujoco.MjModel.from_xml_path(str(pathlib.Path(folder) / "model.xml"))
    steps = round(seconds / model.opt.timestep)
    data = mujoco.MjData(model)

    def one():
        for _ in range(steps):
            mujoco.mj_step(model, data)

    full = mujoco.mjtState.mjSTATE_FULLPHYSICS
    start = numpy.zeros(mujoco.mj_stateSize(model, full))
    mujoco.mj_getState(model, mujoco.MjData(model), start, full)
    states = numpy.tile(start, (COUNT, 1))
    threads = [mujoco.MjData(model) for _ in range(os.cpu_count())]

    def all_together():
        mujoco.rollout.rollout(model, threads, initial_state=states, nstep=steps)

    return fastest(one, lambda: mujoco.mj_resetData(model, data)), fastest(all_together)


def of_commonroad(kind, seconds):
    from scipy.integrate import odeint
    from vehiclemodels.init_mb import init_mb
    from vehiclemodels.init_st import init_st
    from vehiclemodels.parameters_vehicle2 import parameters_vehicle2
    from vehiclemodels.vehicle_dynamics_mb import vehicle_dynamics_mb
    from vehiclemodels.vehicle_dynamics_st import vehicle_dynamics_st

    car = parameters_vehicle2()
    turning = [0.0, 0.0, 0.05, 3.0, 0.0, 0.0, 0.0]
    if kind == "mb":
        start, dynamics = init_mb(turning, car), vehicle_dynamics_mb
    else:
        start, dynamics = init_st(turning), vehicle_dynamics_st

    def rates(state, _time):
        return dynamics(state, [0.0, 0.0], car)

    def drive(count):
        for _ in range(count):
            state = start
            for _ in range(round(seconds / PERIOD)):
                state = odeint(rates, state, [0.0, PERIOD])[-1]

    one = fastest(lambda: drive(1))
    # One car after another: 64 times the work of one.
    return one, COUNT * one


OF_F1TENTH = """
import sys
import time
import numpy
from f110_gym.envs import F110Env

clock, steps = getattr(time, sys.argv[1]), int(sys.argv[2])
car = F110Env(map=sys.argv[3], map_ext=".png", num_agents=1)
start, command = numpy.array([[0.7, 0.0, 1.37]]), numpy.array([[0.05, 2.0]])
car.reset(start)
car.step(command)  # Compiles the functions.
times = []
for _ in range(3):
    car.reset(start)
    before = clock()
    for _ in range(steps):
        car.step(command)
    times.append(clock() - before)
print(min(times))
"""


def of_f1tenth(python, track, seconds):
    steps = round(seconds / 0.01)  # The timestep of F110Env [s].
    command = [python, "-W", "ignore", "-c", OF_F1TENTH, clock.__name__, str(steps), track]
    found = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    one = float(found.stdout)
    return one, COUNT * one


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=2.0, help="simulated time [s]")
    parser.add_argument("--processor-time", action="store_true",
                        help="measure the processor time of all threads, on a busy machine")
    parser.add_argument("--f1tenth", nargs=2, metavar=("PYTHON", "MAP"),
                        help="a Python that has f1tenth_gym, and a map without its extension")
    options = parser.parse_args()
    seconds = options.seconds
    if options.processor_time:
        global clock
        clock = time.process_time
    rows = [(f"trackbed {plant}", None, lambda plant=plant: of_trackbed(plant, seconds))
            for plant in ("kinematic", "single_track", "mujoco")]
    rows += [("mujoco, same model, own contacts", "mujoco", lambda: of_mujoco(seconds)),
             ("commonroad single-track", "vehiclemodels", lambda: of_commonroad("st", seconds)),
             ("commonroad multi-body", "vehiclemodels", lambda: of_commonroad("mb", seconds))]
    if options.f1tenth:
        rows.append(("f1tenth_gym", None, lambda: of_f1tenth(*options.f1tenth, seconds)))
    print(f"{'simulated seconds per second':34}{'one car':>12}{COUNT:>9} cars")
    for name, module, measure in rows:
        if module and importlib.util.find_spec(module) is None:
            print(f"{name:34}  left out: {module} is not installed")
            continue
        one, together = measure()
        print(f"{name:34}{seconds / one:12.0f}{COUNT * seconds / together:14.0f}")
    if not options.f1tenth:
        print(f"{'f1tenth_gym':34}  left out: --f1tenth is not given")


if __name__ == "__main__":
    main()
