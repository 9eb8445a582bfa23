#!/usr/bin/env python3
"""Draws the maps of this folder: a hall for ROS (hall.yaml, hall.pgm) and the old town for Moving AI (old_town.map)."""
from pathlib import Path

FOLDER = Path(__file__).parent


def hall():
    """48 x 28 m in cells of 0.2 m. y counts up here, the image's rows count down."""
    width, height, cell = 240, 140, 0.2
    rows = [[254] * width for _ in range(height)]

    def fill(x, y, length, depth, value):
        """Of a rectangle, its lower left corner first [m]."""
        for row in range(round(y / cell), round((y + depth) / cell)):
            for column in range(round(x / cell), round((x + length) / cell)):
                rows[row][column] = value

    # Outside nothing is known; the hall has walls of 0.4 m and two gates of 5 m on its left.
    fill(0, 0, 48, 28, 205)
    fill(2, 2, 44, 24, 0)
    fill(2.4, 2.4, 43.2, 23.2, 254)
    for y in (4, 19):
        fill(0, y, 3, 5, 254)
    # Racks with aisles of 5.4 m, and columns.
    for x in (14, 21.4, 28.8):
        fill(x, 6, 2, 7, 0)
        fill(x, 17, 2, 8.6, 0)
    for x in (9, 37):
        for y in (9.6, 18):
            fill(x, y, 0.6, 0.6, 0)
    # The office, and pallets.
    fill(38, 20, 7.6, 5.6, 0)
    fill(40, 2.4, 1.2, 2.4, 0)
    fill(8, 24.4, 2.4, 1.2, 0)
    pgm = f"P5\n{width} {height}\n255\n".encode() + b"".join(bytes(row) for row in reversed(rows))
    (FOLDER / "hall.pgm").write_bytes(pgm)
    (FOLDER / "hall.yaml").write_text(
        "image: hall.pgm\nmode: trinary\nresolution: 0.2\norigin: [-10, -8, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n")


def old_town():
    """64 x 48 cells: blocks of houses with crooked lanes, a square with a fountain, and trees."""
    width, height = 64, 48
    rows = [["."] * width for _ in range(height)]

    def fill(x, y, columns, count, terrain):
        """y counts from the top, as in the file."""
        for row in range(y, y + count):
            for column in range(x, x + columns):
                rows[row][column] = terrain

    for x, y, columns, count in (
            (0, 0, 12, 9), (0, 14, 9, 12), (0, 31, 14, 17), (17, 0, 15, 8), (14, 13, 8, 7), (14, 24, 10, 5),
            (19, 34, 12, 14), (37, 0, 11, 6), (53, 0, 11, 11), (42, 11, 6, 9), (54, 16, 10, 14), (41, 25, 8, 6),
            (36, 36, 13, 12), (54, 35, 10, 13)):
        fill(x, y, columns, count, "@")
    for x, y in ((12, 5), (22, 13), (48, 3), (49, 40)):  # oriels
        fill(x, y, 1, 2, "@")
    fill(31, 19, 3, 3, "W")  # the fountain
    for x, y in ((27, 15), (37, 15), (27, 26), (37, 26), (50, 22), (11, 29)):
        fill(x, y, 1, 1, "T")
    text = "".join("".join(row) + "\n" for row in rows)
    (FOLDER / "old_town.map").write_text(f"type octile\nheight {height}\nwidth {width}\nmap\n{text}")


hall()
old_town()
