#!/usr/bin/env python3
"""Writes the PNG files of this folder, from the PNG specification with zlib alone."""
import struct
import zlib
from pathlib import Path

FOLDER = Path(__file__).parent
ROWS = [[0, 64, 89, 90], [205, 206, 254, 255], [128, 10, 20, 30]]


def chunk(name, content):
    return (struct.pack(">I", len(content)) + name + content
            + struct.pack(">I", zlib.crc32(name + content)))


def write(name, depth, color, pixels, extra=b"", size=(4, 3)):
    """`pixels` are the bytes of each row."""
    header = struct.pack(">IIBBBBB", size[0], size[1], depth, color, 0, 0, 0)
    content = b"".join(b"\0" + row for row in pixels)
    (FOLDER / name).write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + extra
        + chunk(b"IDAT", zlib.compress(content, 9)) + chunk(b"IEND", b""))


write("gray8.png", 8, 0, [bytes(row) for row in ROWS])
write("gray16.png", 16, 0, [b"".join(struct.pack(">H", 257 * v) for v in row) for row in ROWS])
write("rgb.png", 8, 2, [b"".join(bytes((v, v, v)) for v in row) for row in ROWS])
grays = sorted({v for row in ROWS for v in row})
write("palette.png", 8, 3, [bytes(grays.index(v) for v in row) for row in ROWS],
      chunk(b"PLTE", b"".join(bytes((v, v, v)) for v in grays)))
# Of two pixels at the top left one is half transparent, the other all of it.
ALPHA = [[128, 0, 255, 255], [255] * 4, [255] * 4]
write("rgba.png", 8, 6, [b"".join(bytes((v, v, v, a)) for v, a in zip(row, alpha))
                         for row, alpha in zip(ROWS, ALPHA)])
# Its colors have the mean 100, their luminance is another.
write("colors.png", 8, 2, [bytes((0, 45, 255, 255, 45, 0))], size=(2, 1))
# A header that promises 4e9 x 4e9 pixels, and one of 5001 x 4000.
write("vast.png", 8, 0, [b""], size=(2**31 - 1, 2**31 - 1))
write("large.png", 8, 0, [b""], size=(5001, 4000))
