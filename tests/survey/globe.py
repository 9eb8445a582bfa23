"""Positions on the globe and their transverse Mercator projection (Krueger's series to n^4, as in Karney 2011)."""
import json
import math
import re
import xml.etree.ElementTree as ElementTree

import tables

A, F = 6378137.0, 1.0 / 298.257223563  # WGS 84
N = F / (2.0 - F)
RADIUS = A / (1.0 + N) * (1.0 + N ** 2 / 4.0 + N ** 4 / 64.0)
ALPHA = (N / 2 - 2 * N ** 2 / 3 + 5 * N ** 3 / 16 + 41 * N ** 4 / 180, 13 * N ** 2 / 48 - 3 * N ** 3 / 5 + 557 * N ** 4 / 1440,
         61 * N ** 3 / 240 - 103 * N ** 4 / 140, 49561 * N ** 4 / 161280)
E = math.sqrt(F * (2.0 - F))


def project(lat, lon, meridian):
    """Projects a position [degrees] to easting and northing [m]; the scale is 1 on the meridian."""
    phi, lam = math.radians(lat), math.radians((lon - meridian + 180.0) % 360.0 - 180.0)
    t = math.sinh(math.atanh(math.sin(phi)) - E * math.atanh(E * math.sin(phi)))
    xi, eta = math.atan2(t, math.cos(lam)), math.asinh(math.sin(lam) / math.hypot(t, math.cos(lam)))
    x, y = eta, xi
    for j, alpha in enumerate(ALPHA, 1):
        x += alpha * math.cos(2 * j * xi) * math.sinh(2 * j * eta)
        y += alpha * math.sin(2 * j * xi) * math.cosh(2 * j * eta)
    return RADIUS * x, RADIUS * y


def local(line):
    """Converts a line of (lat, lon) to meters east and north of its first position."""
    meridian = line[0][1]
    _, north = project(line[0][0], meridian, meridian)
    points = [project(lat, lon, meridian) for lat, lon in line]
    return [(x, y - north) for x, y in points]


def tag(element):
    return element.tag.split("}")[-1]


def xml_lines(file):
    root = ElementTree.parse(file).getroot()
    lines = []
    for element in root.iter():
        if tag(element) in ("trk", "rte"):
            lines.append([(float(p.get("lat")), float(p.get("lon"))) for p in element.iter()
                          if tag(p) in ("trkpt", "rtept")])
        elif tag(element) in ("LineString", "LinearRing"):
            text = " ".join(c.text or "" for c in element if tag(c) == "coordinates")
            lines.append([tuple(float(v) for v in word.split(",")[1::-1]) for word in text.split()])
        elif tag(element) == "Track":
            lines.append([tuple(float(v) for v in c.text.split()[1::-1]) for c in element
                          if tag(c) == "coord" and c.text])
    return lines


def json_lines(value):
    if isinstance(value, dict):
        if value.get("type") == "LineString":
            return [[(p[1], p[0]) for p in value["coordinates"]]]
        if value.get("type") in ("MultiLineString", "Polygon"):
            return [[(p[1], p[0]) for p in part] for part in value["coordinates"]]
        return [line for part in value.values() for line in json_lines(part)]
    return [line for part in value for line in json_lines(part)] if isinstance(value, list) else []


def lines(file):
    """The lines of (lat, lon) in a file."""
    text = file.read_text(errors="replace").lstrip("\ufeff \t\r\n")
    if text.startswith("<"):
        found = xml_lines(file)
    elif re.match(r"[{\[]", text):
        found = json_lines(json.loads(text))
    else:
        table = tables.read(file)
        found = [list(zip(table["lat"], table["lon"]))]
    return [[p for p in line if p != (0.0, 0.0)] for line in found if len(line) > 1]
