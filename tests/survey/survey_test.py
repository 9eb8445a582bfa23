"""Tests the survey: its evaluation of files against closed forms, and that it finds files that are read wrongly.

    survey_test.py PROGRAM
"""
import math
import pathlib
import stat
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
import zlib

import globe
import kinds
import maps
import open_drive

HERE = pathlib.Path(__file__).resolve().parent
DATA = HERE.parent / "data"
PROGRAM = "trackbed"


def geometry(shape, length):
    return open_drive.Geometry(ElementTree.fromstring(
        f'<geometry s="0" x="3" y="-2" hdg="0" length="{length}">{shape}</geometry>'))


class Evaluation(unittest.TestCase):
    def test_arc_is_a_circle(self):
        x, y, heading = geometry('<arc curvature="-0.05"/>', 30).at(30.0)
        # Closed form of a right turn of 1.5 rad with the radius 20 m; 1e-12: rounding.
        self.assertAlmostEqual(x, 3 + 20 * math.sin(1.5), delta=1e-12)
        self.assertAlmostEqual(y, -2 - 20 * (1 - math.cos(1.5)), delta=1e-12)
        self.assertAlmostEqual(heading, -1.5, delta=1e-12)

    def test_spiral_is_the_series_of_fresnels_integrals(self):
        x, y, _ = geometry('<spiral curvStart="0" curvEnd="0.04"/>', 40).at(40.0)
        # Heading c w^2 with c = 0.04/(2 40); the series' terms from n = 12 on are below 1e-15.
        c, length = 0.04 / 80, 40.0
        terms = range(12)
        u = sum((-1) ** n * c ** (2 * n) * length ** (4 * n + 1) / (math.factorial(2 * n) * (4 * n + 1)) for n in terms)
        v = sum((-1) ** n * c ** (2 * n + 1) * length ** (4 * n + 3) / (math.factorial(2 * n + 1) * (4 * n + 3))
                for n in terms)
        self.assertAlmostEqual(x, 3 + u, delta=1e-9)
        self.assertAlmostEqual(y, -2 + v, delta=1e-9)

    def test_polynomials_are_followed_by_arc_length(self):
        # v = u^2/40 from u = 0: the length up to u is (t sqrt(1 + t^2) + asinh t) 10 with t = u/20.
        t = 0.8
        length = 10 * (t * math.hypot(1, t) + math.asinh(t))
        x, y, heading = geometry('<poly3 a="0" b="0" c="0.025" d="0"/>', 30).at(length)
        # 1e-7: the rule of order 5 on 64 pieces of half a meter.
        self.assertAlmostEqual(x, 3 + 16, delta=1e-7)
        self.assertAlmostEqual(y, -2 + 6.4, delta=1e-7)
        self.assertAlmostEqual(heading, math.atan(0.8), delta=1e-7)

    def test_banked_lanes_are_nearer_to_the_reference_line(self):
        road = open_drive.Road(ElementTree.fromstring(
            '<road id="1" length="50"><planView><geometry s="0" x="0" y="0" hdg="0" length="50"><line/></geometry>'
            '</planView><elevationProfile><elevation s="0" a="0" b="0.75" c="0" d="0"/></elevationProfile>'
            '<lateralProfile><superelevation s="0" a="0.3" b="0" c="0" d="0"/></lateralProfile>'
            '<lanes><laneSection s="0"><left><lane id="1"><width sOffset="0" a="4" b="0" c="0" d="0"/></lane></left>'
            '<center><lane id="0"/></center></laneSection></lanes></road>'))
        x, y = road.center(0, 1, 10.0)
        # A rotation by 0.3 rad about the tangent (4, 0, 3)/5 takes (0, 2, 0) to 2 (-0.6 sin, cos, 0.8 sin).
        self.assertAlmostEqual(x, 10 - 1.2 * math.sin(0.3), delta=1e-12)
        self.assertAlmostEqual(y, 2 * math.cos(0.3), delta=1e-12)

    def test_meridian_arcs_have_their_length(self):
        _, north = globe.project(50.0, 8.0, 8.0)
        e2 = globe.E ** 2

        def radius(phi):
            return globe.A * (1 - e2) / (1 - e2 * math.sin(phi) ** 2) ** 1.5
        # 1e-5 m: terms of n^5 = 1e-14 of the earth's radius, and the quadrature.
        self.assertAlmostEqual(north, open_drive.integral(radius, 0.0, math.radians(50), 50), delta=1e-5)

    def test_every_filter_of_png_is_undone(self):
        pixels = [[(37 * x * y + 11 * x + 5 * y) % 256 for x in range(9)] for y in range(5)]
        raw = b""
        for kind, row in enumerate(pixels):
            raw += bytes([kind]) + bytes(filtered(kind, row, pixels[kind - 1] if kind else [0] * 9))

        def chunk(name, body):
            return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
        image = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 9, 5, 8, 0, 0, 0, 0)) +
                 chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))
        self.assertEqual(maps.png(image)[3], [[float(v) for v in row] for row in pixels])


def filtered(kind, row, above):
    """Filters a row of bytes as the specification of PNG defines."""
    left, corner = [0] + row[:-1], [0] + above[:-1]

    def paeth(a, b, c):
        return min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
    guess = {0: lambda a, b, c: 0, 1: lambda a, b, c: a, 2: lambda a, b, c: b, 3: lambda a, b, c: (a + b) // 2, 4: paeth}
    return [(v - guess[kind](a, b, c)) % 256 for v, a, b, c in zip(row, left, above, corner)]


def survey(program, *folders):
    done = subprocess.run([sys.executable, str(HERE / "survey.py"), "--program", str(program), *map(str, folders)],
                          capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


class Survey(unittest.TestCase):
    def test_reads_the_files_of_the_tests_rightly(self):
        code, text = survey(PROGRAM, DATA / "paths", DATA / "models" / "foreign_car.xml", DATA / "maps" / "yard.map",
                            DATA / "road_network" / "features.xodr", DATA / "tyres", DATA / "bags" / "odometry.mcap")
        self.assertEqual(code, 0, text)
        self.assertNotIn("refused |", text.split("\n\n", maxsplit=1)[0].replace("| refused | driven", ""))
        self.assertIn("4 of 4 routes, 0.", text)
        self.assertIn("adapted, 3.5 kg", text)
        self.assertIn("1536 cells of 1 m", text)
        self.assertIn("3 of 3 routes", text)
        self.assertRegex(text, r"\| positions \| 4 \| 4 \| 0 ")

    def test_finds_paths_beside_their_lanes_and_points(self):
        """The survey reports a program whose plans are shifted by 6 cm to the north."""
        with tempfile.TemporaryDirectory() as folder:
            shifted = pathlib.Path(folder) / "shifted"
            shifted.write_text(f"""#!{sys.executable}
import csv, pathlib, subprocess, sys
code = subprocess.run(["{PROGRAM}", *sys.argv[1:]]).returncode
if "-o" in sys.argv:
    file = pathlib.Path(sys.argv[sys.argv.index("-o") + 1]) / "plan.csv"
    if file.exists():
        rows = list(csv.reader(file.open()))
        for row in rows[1:]:
            row[2] = str(float(row[2]) + 0.06)
        csv.writer(file.open("w")).writerows(rows)
sys.exit(code)
""")
            shifted.chmod(shifted.stat().st_mode | stat.S_IXUSR)
            code, text = survey(shifted, DATA / "road_network" / "features.xodr", DATA / "paths" / "nav_path.yaml")
        self.assertEqual(code, 1, text)
        self.assertIn("m off the lane centers", text)
        self.assertIn("m off the plan", text)

    def test_finds_crashes(self):
        with tempfile.TemporaryDirectory() as folder:
            crashing = pathlib.Path(folder) / "crashing"
            crashing.write_text("#!/bin/sh\nkill -SEGV $$\n")
            crashing.chmod(crashing.stat().st_mode | stat.S_IXUSR)
            code, text = survey(crashing, DATA / "paths" / "nav_path.yaml")
        self.assertEqual(code, 1, text)
        self.assertIn("exit -11", text)

    def test_tells_kinds_by_content(self):
        expected = {"tyres/mf52.tir": "tyre", "bags/sqlite/sqlite.db3": "bag", "paths/gps.csv": "positions",
                    "paths/raceline.csv": "path", "bad/track_ring.csv": "track", "recordings/autoware.csv": "recording",
                    "paths/commonroad.xml": "path", "models/small_car.xml": "vehicle model", "maps/rgb.png": None}
        for name, kind in expected.items():
            self.assertEqual(kinds.kind(DATA / name), kind, name)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
