"""Recognizes the kind of a file by its content, independent of its name and extension."""
import json
import re

import tables

HEAD = 1 << 16


def xml_kind(text):
    found = re.search(r"<([A-Za-z_][\w.:-]*)[\s/>]", re.sub(r"<!--.*?-->|<\?.*?\?>|<![A-Z][^>]*>", "", text, flags=re.S))
    root = found.group(1).split(":")[-1] if found else ""
    if root == "robot":
        return None if "xmlns:xacro" in text and "<xacro:" in text else "vehicle model"
    if root == "mujoco":
        return "vehicle model" if "<worldbody" in text or "<include" in text else None
    if root == "osm":
        return "Lanelet2" if "lanelet" in text else None
    return {"OpenDRIVE": "road network", "commonRoad": "CommonRoad scenario", "CommonRoadSolution": "path",
            "gpx": "positions", "kml": "positions"}.get(root)


def json_kind(text):
    try:
        value = json.loads(text)
    except ValueError:
        return None
    if isinstance(value, dict) and value.get("type") in ("FeatureCollection", "Feature", "LineString"):
        return "positions"
    return "path" if isinstance(value, dict) and "poses" in value else None


def kind(file):
    """Returns the kind of a file, or None if the survey knows no such kind."""
    data = file.read_bytes() if file.stat().st_size < HEAD else None
    with open(file, "rb") as stream:
        head = stream.read(HEAD) if data is None else data
    if head.startswith(b"\x89MCAP0\r\n"):
        return "bag"
    if head.startswith(b"SQLite format 3\0"):
        return "bag" if b"messages" in head else None
    if b"\0" in head[:1024]:
        return None
    text = head.decode("utf-8", "replace").lstrip("\ufeff \t\r\n")
    if text.startswith("<"):
        whole = text if data is not None else text + file.read_text(errors="replace")
        return xml_kind(whole)
    if text.startswith(("{", "[")) and file.suffix.lower() in (".json", ".geojson"):
        return json_kind(file.read_text(errors="replace"))
    if text.startswith("type ") and re.match(r"type \w+\s+height \d+\s+width \d+", text):
        return "map"
    if re.search(r"(?m)^\s*image\s*:", text) and re.search(r"(?m)^\s*resolution\s*:", text):
        return "map"
    if re.search(r"(?m)^poses\s*:", text):
        return "path"
    if re.search(r"(?mi)^\s*\[(MDI_HEADER|MODEL|SCALING_COEFFICIENTS|DIMENSION)\]", text):
        return "tyre"
    return tables.kind(text)
