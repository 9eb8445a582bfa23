#!/usr/bin/env python3
"""Writes yard.map.scen: random pairs of free cells and the length of the shortest path between them, by Dijkstra's algorithm
with straight steps of 1 and diagonal ones of sqrt(2) where both adjacent cells are free."""
import heapq
import math
import random
from pathlib import Path

FOLDER = Path(__file__).parent
lines = (FOLDER / "yard.map").read_text().splitlines()
height, width = (int(lines[i].split()[1]) for i in (1, 2))
rows = lines[4:4 + height]
assert lines[0] == "type octile" and lines[3] == "map" and all(len(row) == width for row in rows)


def free(x, y):
    return 0 <= x < width and 0 <= y < height and rows[y][x] in ".G"


def lengths(start):
    """Straight and diagonal steps to every cell: whole numbers, so that no sum is rounded."""
    best = {start: (0, 0)}
    queue = [(0.0, start, (0, 0))]
    while queue:
        length, (x, y), steps = heapq.heappop(queue)
        if best[x, y] != steps:
            continue
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)):
            if not (free(x + dx, y + dy) and free(x + dx, y) and free(x, y + dy)):
                continue
            more = (steps[0] + (dx * dy == 0), steps[1] + (dx * dy != 0))
            next_length = more[0] + math.sqrt(2) * more[1]
            known = best.get((x + dx, y + dy))
            if known is None or next_length < known[0] + math.sqrt(2) * known[1]:
                best[x + dx, y + dy] = more
                heapq.heappush(queue, (next_length, (x + dx, y + dy), more))
    return best


generator = random.Random(26)
cells = [(x, y) for y in range(height) for x in range(width) if free(x, y)]
instances = []
while len(instances) < 60:
    start, goal = generator.sample(cells, 2)
    steps = lengths(start).get(goal)
    if steps:
        instances.append((steps[0] + math.sqrt(2) * steps[1], start, goal))
instances.sort()
with open(FOLDER / "yard.map.scen", "w") as file:
    file.write("version 1\n")
    for length, start, goal in instances:
        file.write(f"{int(length / 4)}\tyard.map\t{width}\t{height}\t{start[0]}\t{start[1]}\t{goal[0]}\t{goal[1]}\t{length:.8f}\n")
