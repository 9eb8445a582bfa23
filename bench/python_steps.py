#!/usr/bin/env python3
"""Measures what Python adds to a control period, of one loop and of many loops.

    PYTHONPATH=build/release/python /usr/bin/python3 bench/python_steps.py [--loops 1000]

VectorLoop.step simulates a period of each loop in C++, and then writes its observation. The same
call without simulation (VectorLoop.observations) is what Python adds. Loop.observation is the
call of Loop.step without simulation. Times are processor times, the least of many measurements on
one thread.
"""

import argparse
import time

import numpy

import trackbed

PLANTS = ("kinematic", "single_track", "mujoco")


def least(work, count, prepare=lambda: None, repeat=20):
    times = []
    for _ in range(repeat):
        prepare()
        start = time.process_time()
        work()
        times.append((time.process_time() - start) / count)
    return min(times)


def measure(plant, count):
    """Returns seconds per loop and period: together, without simulation, alone, its observation."""
    many = trackbed.VectorLoop("three_turns", plant=plant, count=count, threads=1, log=False)
    angles = numpy.zeros(count)
    repeat = 20 if plant != "mujoco" else 5

    def steps():
        for _ in range(10):
            many.step(angles)

    def observations():
        for _ in range(10):
            many.observations

    together = least(steps, 10 * count, many.reset, repeat)
    observed = least(observations, 10 * count)
    loop = trackbed.Loop("three_turns", plant, log=False)

    def single():
        for _ in range(500):
            loop.step(0.0)

    def seen():
        for _ in range(500):
            loop.observation

    return together, observed, least(single, 500, loop.reset), least(seen, 500)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--loops", type=int, default=1000)
    options = parser.parse_args()
    print(f"trackbed {trackbed.__version__}, {options.loops} loops, us per control period and loop")
    titles = ("simulation", "observation", "share", "Loop.step", "Loop.observation")
    print(f"{'plant':14}" + "".join(f"{title:>18}" for title in titles))
    for plant in PLANTS:
        together, observed, single, seen = measure(plant, options.loops)
        simulated = together - observed
        cells = [1e6 * simulated, 1e6 * observed, 100.0 * observed / simulated, 1e6 * single, 1e6 * seen]
        units = ("", "", " %", "", "")
        cells = [f"{cell:.2f}{unit}".rjust(18) for cell, unit in zip(cells, units)]
        print(f"{plant:14}" + "".join(cells))


if __name__ == "__main__":
    main()
