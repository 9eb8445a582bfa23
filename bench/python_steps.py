#!/usr/bin/env python3
"""Measures the cost of a control period from Python, and of many loops on threads.

    PYTHONPATH=build/release/python /usr/bin/python3 bench/python_steps.py [--loops 1000]

The C++ cost of a period is that of `run`, whose loop is the same but has no Python in it. The
overhead of a step is the difference of the medians of alternating measurements.
"""

import argparse
import statistics
import time

import numpy

import trackbed

PLANTS = ("kinematic", "single_track", "mujoco")


def fastest(work, repeat=7):
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        count = work()
        times.append((time.perf_counter() - start) / count)
    return min(times), statistics.median(times)


def one_loop(plant):
    loop = trackbed.Loop("three_turns", plant, log=False)
    seen = loop.reset()

    def stepped():
        nonlocal seen
        seen, count = loop.reset(), 0
        while not seen.ended and count < 1000:
            seen, count = loop.step(), count + 1
        return count

    vector = trackbed.VectorLoop("three_turns", plant=plant, count=1, threads=1, log=False)

    def observed():
        """Only converts an observation: the part of a step that is not simulation."""
        for _ in range(1000):
            loop.observation
        return 1000

    def together():
        vector.reset()
        for _ in range(1000):
            vector.step()
        return 1000

    return fastest(stepped), fastest(observed), fastest(together)


def many_loops(plant, count, periods=20):
    """Returns seconds per period and loop, of loops together and of a loop alone on one thread."""
    together = trackbed.VectorLoop("three_turns", plant=plant, count=count, threads=1, log=False)
    alone = trackbed.VectorLoop("three_turns", plant=plant, count=1, threads=1, log=False)
    angles = numpy.zeros(count)

    def many():
        for _ in range(periods):
            together.step(angles)
        return periods * count

    def single():
        for _ in range(periods * 20):
            alone.step(angles[:1])
        return periods * 20

    pairs = []
    for _ in range(5):
        together.reset(), alone.reset()
        pairs.append((fastest(many, 1)[0], fastest(single, 1)[0]))
    return min(p[0] for p in pairs), min(p[1] for p in pairs)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--loops", type=int, default=1000)
    options = parser.parse_args()
    print(f"trackbed {trackbed.__version__}; times in us per control period, the least of 7")
    print(f"{'plant':14}{'Loop.step':>12}{'observation':>13}{'VectorLoop':>12}", end="")
    print(f"{str(options.loops) + ' loops':>14}{'one of them':>13}")
    for plant in PLANTS:
        step, observation, vector = one_loop(plant)
        many, single = many_loops(plant, options.loops)
        row = [step[0], observation[0], vector[0], many, single]
        widths = (12, 13, 12, 14, 13)
        print(f"{plant:14}" + "".join(f"{1e6 * v:{w}.2f}" for v, w in zip(row, widths)))


if __name__ == "__main__":
    main()
