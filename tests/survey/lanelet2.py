"""Plans random routes on Lanelet2 maps and compares them with the middles of their bounds."""
import math
import xml.etree.ElementTree as ElementTree

import globe
import paths
from result import Result

ROUTES = 3
LONGEST = 300.0  # [m]
FOR_CARS = ("", "road", "highway", "play_street", "exit", "road_shoulder")


def tags(element):
    return {tag.get("k"): tag.get("v") for tag in element.findall("tag")}


def at(line, share):
    """Returns the point of a line at this fraction of the line's length."""
    lengths = [math.dist(a, b) for a, b in zip(line, line[1:])]
    rest = share * sum(lengths)
    for a, b, length in zip(line, line[1:], lengths):
        if rest <= length and length > 0.0:
            return a[0] + rest / length * (b[0] - a[0]), a[1] + rest / length * (b[1] - a[1])
        rest -= length
    return line[-1]


def side(line, point):
    """Returns a positive number if the point is to the left of the line's nearest edge."""
    best = (math.inf, 0.0)
    for a, b in zip(line, line[1:]):
        dx, dy = b[0] - a[0], b[1] - a[1]
        w = min(1.0, max(0.0, ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / max(dx * dx + dy * dy, 1e-12)))
        x, y = point[0] - a[0] - w * dx, point[1] - a[1] - w * dy
        best = min(best, (math.hypot(x, y), dx * y - dy * x))
    return best[1]


class Map:
    def __init__(self, file):
        root = ElementTree.parse(file).getroot()
        nodes = {node.get("id"): node for node in root.findall("node")}
        self.ways = {way.get("id"): [nd.get("ref") for nd in way.findall("nd")] for way in root.findall("way")}
        self.bounds = {}
        for relation in root.findall("relation"):
            own = tags(relation)
            cars = own.get("participant:vehicle")
            if own.get("type") != "lanelet" or (cars != "yes" if cars else own.get("subtype", "") not in FOR_CARS):
                continue
            ways = [[self.ways.get(m.get("ref"), []) for m in relation.findall("member") if m.get("role") == role]
                    for role in ("left", "right")]
            if all(len(w) == 1 and len(w[0]) > 1 and all(n in nodes for n in w[0]) for w in ways):
                self.bounds[relation.get("id")] = [ways[0][0], ways[1][0]]
        used = [nodes[n] for bound in self.bounds.values() for way in bound for n in way]
        self.origin = None
        if not used:
            return
        if all({"local_x", "local_y"} <= tags(n).keys() for n in used):
            self.places = {n.get("id"): (float(tags(n)["local_x"]), float(tags(n)["local_y"])) for n in used}
        else:
            self.origin = float(used[0].get("lat")), float(used[0].get("lon"))
            line = globe.local([self.origin] + [(float(n.get("lat")), float(n.get("lon"))) for n in used])
            self.places = {n.get("id"): p for n, p in zip(used, line[1:])}
        for bound in self.bounds.values():
            self.orient(bound)

    def line(self, way):
        return [self.places[n] for n in way]

    def orient(self, bound):
        left, right = self.line(bound[0]), self.line(bound[1])
        if side(left, right[len(right) // 2]) > 0.0:
            bound[0] = bound[0][::-1]
        if side(right, left[len(left) // 2]) < 0.0:
            bound[1] = bound[1][::-1]

    def center(self, key):
        left, right = map(self.line, self.bounds[key])
        count = max(len(left), len(right))
        if len(left) == len(right):
            pairs = zip(left, right)
        else:
            pairs = [(at(left, i / (count - 1)), at(right, i / (count - 1))) for i in range(count)]
        return [(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])) for a, b in pairs]

    def random_route(self, random):
        starts = {}
        for key, (left, right) in self.bounds.items():
            starts.setdefault((left[0], right[0]), []).append(key)
        route = [random.choice(sorted(self.bounds))]
        length = 0.0
        while length < LONGEST:
            center = self.center(route[-1])
            length += sum(math.dist(a, b) for a, b in zip(center, center[1:]))
            left, right = self.bounds[route[-1]]
            nexts = [key for key in starts.get((left[-1], right[-1]), []) if key not in route]
            if not nexts:
                break
            route.append(random.choice(sorted(nexts)))
        return route


def survey(program, file, random, drive):
    result = Result("Lanelet2")
    try:
        chart = Map(file)
    except (ElementTree.ParseError, ValueError, TypeError) as reason:
        result.detail = f"not read by the survey: {reason}"
        paths.attempt(program, result, file, paths.keys_of(file, 9.0, 0.05, lanelets=["1"]), False)
        return result
    if not chart.bounds:
        result.detail = "no lanelet for cars"
        paths.attempt(program, result, file, paths.keys_of(file, 9.0, 0.05, lanelets=["1"]), False)
        return result
    planned, worst = 0, 0.0
    for _ in range(ROUTES):
        route = chart.random_route(random)
        points = [p for key in route for p in chart.center(key)]
        extra = {"lanelets": route, "fit": "spline"}
        if chart.origin:
            extra["origin_latitude"], extra["origin_longitude"] = chart.origin
        rows, _ = paths.attempt(program, result, file, paths.keys_of(file, 9.0, 0.05, **extra), drive)
        if rows:
            planned += 1
            off = paths.offset(points, rows)
            worst = max(worst, off)
            if off > 0.05 + 0.001:
                result.wrong(f"{off:.3f} m off the centers of the lanelets {' '.join(route)}")
    result.detail = f"{planned} of {ROUTES} routes, {worst:.3f} m"
    return result
