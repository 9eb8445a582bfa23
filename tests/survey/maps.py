"""Compares the cells of maps with the cells that the format's specification assigns to the image."""
import math
import re
import struct
import zlib

from result import Result

FREE, UNKNOWN, OCCUPIED = 0, 1, 2


def pgm(data):
    """Returns (width, height, value of white, rows of gray values) of a P2 or P5 image."""
    position, tokens = 0, []
    while len(tokens) < 4:
        found = re.compile(rb"\s*(?:#[^\n]*\n\s*)*([^\s#]+)").match(data, position)
        tokens.append(found.group(1))
        position = found.end()
    width, height, white = map(int, tokens[1:])
    if tokens[0] == b"P2":
        values = [int(v) for v in re.sub(rb"#[^\n]*", b"", data[position:]).split()]
    elif white > 255:
        values = [v[0] for v in struct.iter_unpack(">H", data[position + 1:position + 1 + 2 * width * height])]
    else:
        values = data[position + 1:position + 1 + width * height]
    return width, height, white, [values[i * width:(i + 1) * width] for i in range(height)]


def png(data):
    """Returns the same tuple as for P2, for a PNG image without interlacing; averages the colors."""
    position, parts, palette = 8, b"", b""
    while position < len(data):
        size, name = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + size]
        if name == b"IHDR":
            width, height, depth, color, _, _, interlaced = struct.unpack(">IIBBBBB", body)
        elif name == b"PLTE":
            palette = body
        elif name == b"IDAT":
            parts += body
        position += 12 + size
    if interlaced:
        raise ValueError("an interlaced PNG")
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[color]
    bits = depth * channels
    raw, stride, step = zlib.decompress(parts), (width * bits + 7) // 8, max(bits // 8, 1)
    rows, last = [], bytearray(stride)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        line = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        unfilter(kind, line, last, step)
        last = line
        rows.append(grays(line, width, depth, color, channels, palette))
    return width, height, 255 if color == 3 else (1 << depth) - 1, rows


def unfilter(kind, line, last, step):
    for i, value in enumerate(line):
        a = line[i - step] if i >= step else 0
        b, c = last[i], last[i - step] if i >= step else 0
        if kind == 1:
            value += a
        elif kind == 2:
            value += b
        elif kind == 3:
            value += (a + b) // 2
        elif kind == 4:
            p = a + b - c
            value += min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        line[i] = value & 255


def grays(line, width, depth, color, channels, palette):
    if depth == 16:
        samples = [v[0] for v in struct.iter_unpack(">H", bytes(line))]
    elif depth == 8:
        samples = line
    else:
        mask = (1 << depth) - 1
        samples = [line[i * depth // 8] >> (8 - depth - i * depth % 8) & mask for i in range(width)]
    if color == 3:
        return [sum(palette[3 * v:3 * v + 3]) / 3.0 for v in samples[:width]]
    used = 1 if channels < 3 else 3
    return [sum(samples[i * channels:i * channels + used]) / used for i in range(width)]


def ros(file):
    """Returns (resolution, rows of cells from the top) of a map_server map."""
    keys = dict(re.findall(r"(?m)^\s*(\w+)\s*:\s*([^#\n]*)", file.read_text(errors="replace")))
    image = file.parent / keys["image"].strip().strip("'\"")
    if not image.exists():  # the path on the machine that saved the map
        image = file.parent / image.name
    data = image.read_bytes()
    _, _, white, rows = png(data) if data.startswith(b"\x89PNG") else pgm(data)
    dark = keys["negate"].strip() in ("0", "false", "False")
    occupied, free = float(keys["occupied_thresh"]), float(keys["free_thresh"])

    def cell(v):
        d = 1.0 - v / white if dark else v / white
        return OCCUPIED if d > occupied else FREE if d < free else UNKNOWN
    known = {}
    return float(keys["resolution"]), [[known.setdefault(v, cell(v)) for v in row] for row in rows]


def moving_ai(file):
    lines = file.read_text().splitlines()
    return 1.0, [[FREE if c in ".G" else OCCUPIED for c in line] for line in lines[4:] if line]


def survey(program, file, _, __):
    """Runs a small car beside the map. The run folder contains the map as the program read it."""
    result = Result("map")
    octile = file.read_bytes()[:5] == b"type "
    out = program.scratch / "run"
    for name in ("map.yaml", "map.pgm"):
        (out / name).unlink(missing_ok=True)
    chart = {"file": str(file), "x": 0, "y": 0, "yaw": 0, **({"cell": 1.0} if octile else {})}
    keys = {"vehicle": {"model": "f1tenth"}, "world": {"map": chart}, "plan": {"method": "fillet"},
            "mission": {"speed": 1.0, "start": {"x": -20.0, "y": 0.0}, "waypoints": [[-20.0, 0.0], [-19.0, 0.0]]}}
    outcome = program.call("run", program.scenario(keys), "-o", out, "--plant", "kinematic", "-q", "--allow-assets",
                           file.parent)
    result.add(outcome)
    result.accepted = (out / "map.pgm").exists()
    if not result.accepted:
        return result
    try:
        resolution, cells = moving_ai(file) if octile else ros(file)
    except (OSError, ValueError, KeyError, AttributeError, zlib.error) as reason:
        result.detail = f"cells not compared: {reason}"
        return result
    found, read = ros(out / "map.yaml")
    different = sum(a != b for mine, its in zip(cells, read) for a, b in zip(mine, its))
    result.detail = f"{sum(map(len, cells))} cells of {resolution:g} m"
    if len(cells) != len(read) or len(cells[0]) != len(read[0]) or not math.isclose(found, resolution):
        result.wrong(f"{len(read)} rows of {len(read[0])} cells instead of {len(cells)} of {len(cells[0])}")
    elif different:
        result.wrong(f"{different} cells differ")
    return result
