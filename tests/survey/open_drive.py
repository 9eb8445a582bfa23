"""Lane centers and random routes of OpenDRIVE files, from the text of the standard (ASAM OpenDRIVE 1.7).

Nothing here uses the program's sources: reference lines (10.3 of the standard), lane offsets, widths and borders
(11.4 to 11.6), superelevation (10.5.2), and the links of lanes, roads and junctions (11.5, 10.2, 12).
"""
import bisect
import math
import xml.etree.ElementTree as ElementTree

DRIVABLE = ("driving", "entry", "exit", "onRamp", "offRamp", "connectingRamp", "slipLane")
INSET = 1e-6  # [m]: at the very end of a section, the records of the next one begin

# Points and weights of the Gauss-Legendre rule of order 5 on [-1, 1].
GAUSS = ((0.0, 128 / 225), (0.5384693101056831, 0.47862867049936647), (-0.5384693101056831, 0.47862867049936647),
         (0.9061798459386640, 0.23692688505618908), (-0.9061798459386640, 0.23692688505618908))


class Unclear(Exception):
    """Raised if the standard does not define the position of the lane."""


def real(element, name, default=None):
    text = element.get(name)
    if text is None:
        if default is None:
            raise Unclear(f"<{element.tag}> without {name}")
        return default
    return float(text)


def integral(function, a, b, pieces):
    total = 0.0
    for i in range(pieces):
        low, high = a + (b - a) * i / pieces, a + (b - a) * (i + 1) / pieces
        total += 0.5 * (high - low) * sum(w * function(0.5 * (low + high + (high - low) * x)) for x, w in GAUSS)
    return total


class Cubics:
    """Piecewise cubic polynomials over a station; 0 before the first record."""

    def __init__(self, elements, start):
        rows = [(real(e, start), *(real(e, name, 0.0) for name in "abcd")) for e in elements]
        self.rows = sorted(rows, key=lambda row: row[0])
        self.starts = [row[0] for row in self.rows]

    def value(self, s):
        i = bisect.bisect_right(self.starts, s) - 1
        if i < 0:
            return 0.0
        start, a, b, c, d = self.rows[i]
        u = s - start
        return a + u * (b + u * (c + u * d))

    def slope(self, s):
        i = bisect.bisect_right(self.starts, s) - 1
        if i < 0:
            return 0.0
        start, _, b, c, d = self.rows[i]
        u = s - start
        return b + u * (2.0 * c + u * 3.0 * d)


class Geometry:
    """One element of the plan view, which gives (x, y, heading) at a distance along the element."""

    def __init__(self, element):
        self.s, self.length = real(element, "s"), real(element, "length")
        self.x, self.y, self.heading = real(element, "x"), real(element, "y"), real(element, "hdg")
        shapes = [child for child in element if child.tag != "userData"]
        if len(shapes) != 1:
            raise Unclear("a geometry without a shape")
        self.kind = shapes[0].tag
        shape = shapes[0]
        if self.kind == "line":
            self.curvatures = (0.0, 0.0)
        elif self.kind == "arc":
            self.curvatures = (real(shape, "curvature"),) * 2
        elif self.kind == "spiral":
            self.curvatures = (real(shape, "curvStart"), real(shape, "curvEnd"))
        elif self.kind == "poly3":
            self.set_polynomials((0.0, 1.0, 0.0, 0.0), tuple(real(shape, n) for n in "abcd"), None)
        elif self.kind == "paramPoly3":
            u, v = (tuple(real(shape, n + axis) for n in "abcd") for axis in "UV")
            self.set_polynomials(u, v, 1.0 if shape.get("pRange") != "arcLength" else self.length)
        else:
            raise Unclear(f"<{self.kind}>")

    def set_polynomials(self, u, v, end):
        """Tabulates the arc length over the parameter p."""
        self.u, self.v = u, v
        self.table = [(0.0, 0.0)]
        last = end if end is not None else self.length  # A cubic is never shorter than its u axis.
        for i in range(64):
            a, b = last * i / 64, last * (i + 1) / 64
            self.table.append((self.table[-1][0] + integral(self.arc_rate, a, b, 1), b))
        self.scale = 1.0 if end is None else self.table[-1][0] / self.length

    def derivatives(self, p):
        return tuple(b + p * (2.0 * c + p * 3.0 * d) for _, b, c, d in (self.u, self.v))

    def arc_rate(self, p):
        return math.hypot(*self.derivatives(p))

    def parameter(self, distance):
        """Newton's method from the nearest entry of the table of arc lengths."""
        wanted = distance * self.scale
        i = min(max(bisect.bisect_right(self.table, (wanted, math.inf)) - 1, 0), len(self.table) - 2)
        base, p = self.table[i]
        start = p
        for _ in range(8):
            rate = self.arc_rate(p)
            if rate < 1e-12:
                break
            p -= (base + integral(self.arc_rate, start, p, 1) - wanted) / rate
        return p

    def at(self, distance):
        if self.kind in ("poly3", "paramPoly3"):
            p = self.parameter(distance)
            du, dv = self.derivatives(p)
            u, v = (a + p * (b + p * (c + p * d)) for a, b, c, d in (self.u, self.v))
            turned = math.atan2(dv, du)
        else:
            first, last = self.curvatures
            rate = (last - first) / self.length if self.length > 0.0 else 0.0

            def angle(w):
                return w * (first + 0.5 * rate * w)
            turned = angle(distance)
            if first == last:
                half = 0.5 * turned
                chord = distance * (math.sin(half) / half if half else 1.0)
                u, v = chord * math.cos(half), chord * math.sin(half)
            else:
                pieces = 1 + int(2.0 * max(abs(first), abs(last)) * distance)
                u = integral(lambda w: math.cos(angle(w)), 0.0, distance, pieces)
                v = integral(lambda w: math.sin(angle(w)), 0.0, distance, pieces)
        c, s = math.cos(self.heading), math.sin(self.heading)
        return self.x + c * u - s * v, self.y + s * u + c * v, self.heading + turned


class Lane:
    def __init__(self, element):
        self.id = int(element.get("id"))
        self.type = element.get("type", "none")
        self.width = Cubics(element.findall("width"), "sOffset")
        self.border = Cubics(element.findall("border"), "sOffset") if not self.width.rows else None
        link = element.find("link")
        self.links = {}
        for end in ("predecessor", "successor"):
            found = link.findall(end) if link is not None else []
            if found:
                self.links[end] = int(found[0].get("id"))


class Section:
    def __init__(self, element):
        self.s = real(element, "s")
        self.lanes = {}
        for side in element:
            for lane in side.findall("lane"):
                self.lanes[int(lane.get("id"))] = Lane(lane)


class Road:
    def __init__(self, element):
        self.id = element.get("id")
        self.length = real(element, "length")
        self.left_hand = element.get("rule") == "LHT"
        self.geometries = sorted((Geometry(g) for g in element.findall("planView/geometry")), key=lambda g: g.s)
        self.starts = [g.s for g in self.geometries]
        self.elevation = Cubics(element.findall("elevationProfile/elevation"), "s")
        self.roll = Cubics(element.findall("lateralProfile/superelevation"), "s")
        self.offset = Cubics(element.findall("lanes/laneOffset"), "s")
        self.sections = sorted((Section(x) for x in element.findall("lanes/laneSection")), key=lambda x: x.s)
        self.links = {}
        for end in ("predecessor", "successor"):
            link = element.find(f"link/{end}")
            if link is not None:
                self.links[end] = (link.get("elementType"), link.get("elementId"), link.get("contactPoint"))
        if not self.geometries or not self.sections:
            raise Unclear("a road without a plan view or lanes")

    def section_end(self, index):
        return self.sections[index + 1].s if index + 1 < len(self.sections) else self.length

    def edges(self, index, lane_id, s):
        """Returns the lateral offsets of the inner and the outer edge of a lane from the reference line."""
        section = self.sections[index]
        side = 1 if lane_id > 0 else -1
        t = self.offset.value(s)
        for i in range(1, abs(lane_id) + 1):
            lane = section.lanes[side * i]
            inner = t
            if lane.border is not None and lane.border.rows:
                if self.offset.rows and any(any(row[1:]) for row in self.offset.rows):
                    raise Unclear("borders of lanes beside a lane offset")
                t = lane.border.value(s - section.s)
            else:
                t += side * lane.width.value(s - section.s)
        return inner, t

    def center(self, index, lane_id, s):
        """Returns (x, y) of the middle of a lane, whose surface is rolled about the tangent in space."""
        inner, outer = self.edges(index, lane_id, s)
        t = 0.5 * (inner + outer)
        g = self.geometries[max(bisect.bisect_right(self.starts, s) - 1, 0)]
        x, y, heading = g.at(s - g.s)
        roll, pitch = self.roll.value(s), math.atan(self.elevation.slope(s))
        ahead, left = -t * math.sin(roll) * math.sin(pitch), t * math.cos(roll)
        c, sine = math.cos(heading), math.sin(heading)
        return x + c * ahead - sine * left, y + sine * ahead + c * left


class Network:
    def __init__(self, path):
        root = ElementTree.parse(path).getroot()
        for element in root.iter():
            if isinstance(element.tag, str):
                element.tag = element.tag.split("}")[-1]  # some programs declare a namespace
        self.unclear = []
        self.roads = {}
        for element in root.iter("road"):
            if element.find("planView") is None:
                continue
            try:
                road = Road(element)
                self.roads[road.id] = road
            except (Unclear, ValueError, TypeError, KeyError) as reason:
                self.unclear.append(f"road {element.get('id')}: {reason}")
        self.junctions = {j.get("id"): j for j in root.iter("junction")}

    def forward(self, road, lane_id):
        return (lane_id < 0) != road.left_hand

    def lanes(self):
        """Yields (road, section, lane) of every drivable lane that is at least a meter wide halfway along."""
        for road in self.roads.values():
            for index, section in enumerate(road.sections):
                s = 0.5 * (section.s + road.section_end(index))
                for lane_id, lane in section.lanes.items():
                    if lane_id != 0 and lane.type in DRIVABLE:
                        try:
                            inner, outer = road.edges(index, lane_id, s)
                        except (KeyError, Unclear):
                            continue
                        if abs(outer - inner) > 1.0:
                            yield road, index, lane_id

    def nexts(self, road, index, lane_id):
        """Returns the lanes that follow a lane in the direction of travel."""
        ahead = self.forward(road, lane_id)
        end = "successor" if ahead else "predecessor"
        lane = road.sections[index].lanes[lane_id]
        following = index + 1 if ahead else index - 1
        if 0 <= following < len(road.sections):
            to = lane.links.get(end)
            return [(road, following, to)] if to in road.sections[following].lanes else []
        kind, other, contact = road.links.get(end, (None, None, None))
        if kind == "road" and other in self.roads and end in lane.links:
            return self.entries(road, self.roads[other], contact, lane.links[end])
        found = []
        if kind == "junction" and other in self.junctions:
            for connection in self.junctions[other].findall("connection"):
                to_road = connection.get("connectingRoad") or connection.get("linkedRoad")
                if connection.get("incomingRoad") != road.id or to_road not in self.roads:
                    continue
                for link in connection.findall("laneLink"):
                    if int(link.get("from")) == lane_id:
                        found += self.entries(road, self.roads[to_road], connection.get("contactPoint"),
                                              int(link.get("to")))
        return found

    def entries(self, road, other, contact, lane_id):
        """Returns the lane that begins at this end of its road, if its traffic drives away from this end."""
        index = 0 if contact == "start" else len(other.sections) - 1
        section = other.sections[index]
        if other is road or lane_id not in section.lanes or section.lanes[lane_id].type not in DRIVABLE:
            return []
        return [(other, index, lane_id)] if self.forward(other, lane_id) == (contact == "start") else []

    def random_route(self, random, lanes, longest):
        """Returns a random chain of successive lanes of up to about `longest` meters; no road appears twice."""
        route = [random.choice(lanes)]
        seen = {route[0][0].id}
        length = 0.0
        while length < longest:
            road, index, lane_id = route[-1]
            length += road.section_end(index) - road.sections[index].s
            choices = [n for n in self.nexts(road, index, lane_id)
                       if n[0] is road or n[0].id not in seen]
            if not choices:
                break
            route.append(random.choice(choices))
            seen.add(route[-1][0].id)
        return route


def stations(network, route):
    """Returns [(road, section, lane, from, to)] of a route that begins and ends in the middle of a lane."""
    legs = []
    for road, index, lane_id in route:
        a, b = road.sections[index].s, road.section_end(index)
        legs.append([road, index, lane_id, a, b] if network.forward(road, lane_id) else [road, index, lane_id, b, a])
    share = 0.1
    if len(legs) == 1:
        a, b = legs[0][3:]
        legs[0][3:] = [a + share * (b - a), b - share * (b - a)]
    else:
        a, b = legs[0][3:]
        legs[0][3] = a + 0.5 * (b - a)
        a, b = legs[-1][3:]
        legs[-1][4] = a + 0.5 * (b - a)
    return legs


def joints_of(road, index):
    """Returns the stations at which the center of a lane may kink."""
    stations_ = [g.s for g in road.geometries]
    for name in ("offset", "roll", "elevation"):
        stations_ += getattr(road, name).starts
    section = road.sections[index]
    for lane in section.lanes.values():
        stations_ += [section.s + start for start in lane.width.starts]
    return stations_


def sampled(legs, step):
    """Returns points of the lane centers as (x, y, is_near_joint, gap).

    A point is near a joint if it is within a meter of it; centers may kink at joints. The gap is the distance [m]
    between the end of a lane's center and the beginning of the next one."""
    parts = []
    for road, index, lane_id, a, b in legs:
        inset = math.copysign(min(INSET, 0.25 * abs(b - a)), b - a)
        a, b = a + inset, b - inset
        count = max(2, int(abs(b - a) / step) + 1)
        joints = [a, b] + joints_of(road, index)
        stations_ = [a + (b - a) * i / count for i in range(count + 1)]
        parts.append([(*road.center(index, lane_id, s), any(abs(s - joint) < 1.0 for joint in joints))
                      for s in stations_])
    gaps = [0.0] + [math.dist(p[-1][:2], q[0][:2]) for p, q in zip(parts, parts[1:])] + [0.0]
    return [(*point, max(gaps[i], gaps[i + 1])) for i, part in enumerate(parts) for point in part]
