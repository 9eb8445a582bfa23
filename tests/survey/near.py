"""Distances of successive points from a polyline that runs in the same direction."""
import math


def to_segment(p, a, b):
    dx, dy = b[0] - a[0], b[1] - a[1]
    square = dx * dx + dy * dy
    w = 0.0 if square == 0.0 else min(1.0, max(0.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square))
    return math.hypot(p[0] - a[0] - w * dx, p[1] - a[1] - w * dy)


def distances(points, line, reach):
    """Returns each point's distance from the line; searches `reach` segments beyond the previous nearest one."""
    at, found = 0, []
    for p in points:
        best = math.inf
        for i in range(max(at - 2, 0), min(at + reach, len(line) - 1)):
            d = to_segment(p, line[i], line[i + 1])
            if d < best:
                best, at = d, i
        found.append(best)
    return found
