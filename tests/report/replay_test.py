"""Tests the 3D replay in a headless Chromium with software WebGL.

replay_test.py PROGRAM PICTURES [I/N] [unittest's options]: writes pictures of the pages to the folder PICTURES.
"""

import csv
import json
import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser  # noqa: E402
from pages import PICTURES, PageTest, run_tests  # noqa: E402

SCENARIO = """schema: 1
name: minute
vehicle: {tyre: magic_formula}
mission: {speed: 3, waypoints: [[0, 0], [70, 0], [70, 70], [140, 70]]}
plan: {method: fillet}
control: {method: preview, distance: 2.5}
"""

# Five minutes in circles.
LONG = """schema: 1
name: circles
mission: {speed: 5, duration: 300}
control: {method: constant_steering, steering: 0.1}
drive: {plants: [kinematic], time_limit: 400}
"""


def log_of(file):
    with open(file, newline="") as lines:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(lines)]


def at(rows, column, moment):
    """Interpolates linearly between the rows; constant beyond the ends."""
    if moment >= rows[-1]["t_s"]:
        return rows[-1][column]
    i = next(k for k, row in enumerate(rows) if row["t_s"] > moment)
    part = (moment - rows[i - 1]["t_s"]) / (rows[i]["t_s"] - rows[i - 1]["t_s"])
    return rows[i - 1][column] + part * (rows[i][column] - rows[i - 1][column])


def rotated(quaternion, point):
    w, x, y, z = quaternion
    px, py, pz = point
    tx, ty, tz = 2 * (y * pz - z * py), 2 * (z * px - x * pz), 2 * (x * py - y * px)
    return [px + w * tx + y * tz - z * ty, py + w * ty + z * tx - x * tz, pz + w * tz + x * ty - y * tx]


def corners_of(geom, meshes):
    """Returns points whose convex hull contains the geom."""
    a, b, c = geom["size"]
    kind = geom["type"]
    if kind == "mesh":
        flat = meshes[geom["mesh"]]["vertices"]
        return [flat[i : i + 3] for i in range(0, len(flat), 3)]
    half = {"sphere": [a, a, a], "cylinder": [a, a, b], "capsule": [a, a, a + b]}.get(kind, [a, b, c])
    return [[sx * half[0], sy * half[1], sz * half[2]] for sx in (-1, 1) for sy in (-1, 1) for sz in (-1, 1)]


def car_points(vehicle):
    """Returns the points of all geoms of a vehicle with its joints at zero, in the frame of its first body."""
    places = []
    for i, body in enumerate(vehicle["bodies"]):
        chain = []
        while i > 0:
            chain.append(vehicle["bodies"][i])
            i = vehicle["bodies"][i]["parent"]
        places.append(chain)
    points = []
    for geom in vehicle["geoms"]:
        for corner in corners_of(geom, vehicle["meshes"]):
            point = [p + q for p, q in zip(geom["pos"], rotated(geom["quat"], corner))]
            for body in places[geom["body"]]:
                point = [p + q for p, q in zip(body["pos"], rotated(body["quat"], point))]
            points.append(point)
    return points


def hull_of(points):
    """Convex hull, counterclockwise (Andrew's monotone chain)."""
    points = sorted(set(map(tuple, points)))

    def half(order):
        chain = []
        for p in order:
            while len(chain) > 1 and (
                (chain[-1][0] - chain[-2][0]) * (p[1] - chain[-2][1])
                <= (chain[-1][1] - chain[-2][1]) * (p[0] - chain[-2][0])
            ):
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(points) + half(reversed(points))


def depth_in(hull, point):
    """Distance of a point from the nearest edge, positive inside, negative outside."""
    deep = math.inf
    for (x0, y0), (x1, y1) in zip(hull, hull[1:] + hull[:1]):
        length = math.hypot(x1 - x0, y1 - y0)
        deep = min(deep, ((x1 - x0) * (point[1] - y0) - (y1 - y0) * (point[0] - x0)) / length)
    return deep


def area_of(hull):
    return 0.5 * sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(hull, hull[1:] + hull[:1]))


class Replay(PageTest):
    @classmethod
    def make_inputs(cls):
        for name, text in (("minute", SCENARIO), ("long", LONG)):
            (cls.root / f"{name}.yaml").write_text(text)
            cls.trackbed("run", "-q", f"{name}.yaml", "-o", name)
            cls.trackbed("report", name, "--film", "none")

    def open(self, page, **screen):
        self.browser.open(self.root / page, **screen)
        self.browser.run("document.querySelector('.replay').scrollIntoView()")
        self.browser.settle()

    def data(self, page):
        text = (self.root / page).read_text()
        return json.loads(re.search(r'id="data">(.*?)</script>', text, re.S).group(1))

    def test_pixels_of_the_car_are_where_the_log_says(self):
        self.open("minute/report.html", width=1280, height=900)
        [run] = self.data("minute/report.html")["runs"]
        points = car_points(run["vehicle"])
        log = log_of(self.root / "minute/mujoco.csv")
        states = log_of(self.root / "minute/mujoco.state.csv")
        # Hides the shadows and the lines on the ground, which the car covers, so that only the car
        # differs between the pictures.
        self.browser.run(
            "for (const car of replay.cars) { car.trail.mesh.material.visible = false;"
            " car.ghost.group.traverse(o => { if (o.material) o.material.visible = false; });"
            " car.solid.group.traverse(o => { o.castShadow = false; }); }"
        )
        for moment in (8.0, 25.3, 41.0):
            shown = self.browser.run(
                """
                const moment = arguments[0];
                setTime(moment);
                const gl = replay.renderer.getContext();
                const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
                const picture = (seen) => {
                  replay.lead.solid.group.traverse(o => { if (o.material) o.material.visible = seen; });
                  replay.draw(moment);
                  const pixels = new Uint8Array(4 * width * height);
                  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
                  return pixels;
                };
                const [without, with_] = [picture(false), picture(true)];
                const differs = [];
                for (let y = 0; y < height; y += 2) for (let x = 0; x < width; x += 2) {
                  const i = 4 * (y * width + x);
                  const by = [0, 1, 2].reduce((most, c) => Math.max(most, Math.abs(with_[i + c] - without[i + c])), 0);
                  if (by > 12) differs.push([x + 0.5, y + 0.5]);
                }
                const [{ camera }] = replay.views();
                const matrix = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse);
                return [width, height, differs, matrix.elements];
                """,
                moment,
            )
            width, height, differs, matrix = shown
            yaw = at(log, "yaw_rad", moment)
            x, y = at(log, "x_m", moment), at(log, "y_m", moment)
            z = at(states, "z_m", moment)
            outline = []
            for px, py, pz in points:
                place = [x + px * math.cos(yaw) - py * math.sin(yaw), y + px * math.sin(yaw) + py * math.cos(yaw), z + pz, 1.0]
                clip = [sum(matrix[4 * k + i] * place[k] for k in range(4)) for i in range(4)]
                outline.append(((0.5 + 0.5 * clip[0] / clip[3]) * width, (0.5 + 0.5 * clip[1] / clip[3]) * height))
            hull = hull_of(outline)
            self.assertGreater(len(differs), 1000)
            # The car rolls and pitches by up to a degree, which moves its roof, 1.5 m high, by 26
            # mm. The rows of the log are 33 ms apart. At the car, a pixel is about 10 mm wide.
            outside = [p for p in differs if depth_in(hull, p) < -4]
            self.assertLess(len(outside), 0.002 * len(differs), moment)
            # Only every second pixel is checked. A car fills its convex outline except for the gaps
            # between the wheels, above the hood and behind the rear window, and except for glass
            # and tyres that are as dark as the road.
            self.assertGreater(4 * len(differs), 0.75 * area_of(hull), moment)
        self.browser.picture(PICTURES / "replay.png")

    def test_wheels_steer_and_spin_as_logged(self):
        self.open("minute/report.html")
        states = log_of(self.root / "minute/mujoco.state.csv")
        most = max(states, key=lambda row: abs(row["steer_fl_rad"]))["t_s"]
        for moment in (5.0, most, 50.0):
            angles = self.browser.run(
                """
                const car = replay.lead;
                car.solid.pose(car.motion, arguments[0]);
                const model = runs[0].vehicle;
                const body = (channel) => model.bodies.findIndex((b) => b.joints.some((j) => j.channel === channel));
                const nodes = car.solid.group.children;
                const turn = (channel) => {
                  const i = body(channel);
                  const local = new THREE.Matrix4().getInverse(nodes[model.bodies[i].parent].matrix).multiply(nodes[i].matrix);
                  const e = local.elements;
                  return [Math.atan2(e[1], e[0]), Math.atan2(e[8], e[10])];
                };
                return [turn('steer_fl_rad')[0], turn('spin_fl_rad')[1]];
                """,
                moment,
            )
            self.assertAlmostEqual(angles[0], at(states, "steer_fl_rad", moment), delta=2e-3)
            # The wheel spins at 10 rad/s and accelerates little between rows 33 ms apart.
            off = angles[1] - at(states, "spin_fl_rad", moment)
            self.assertAlmostEqual(math.remainder(off, 2 * math.pi), 0.0, delta=0.02)

    def test_cameras_and_views(self):
        self.open("minute/report.html", width=1280, height=900)
        self.browser.run("setTime(30)")
        places = {}
        for kind in ("follow", "driver", "orbit"):
            self.browser.run("document.querySelector(`.replay button[value=${arguments[0]}]`).click()", kind)
            self.browser.settle()
            places[kind] = self.browser.run("return replay.views()[0].camera.position.toArray()")
            self.browser.picture(PICTURES / f"replay_{kind}.png")
        log = log_of(self.root / "minute/mujoco.csv")
        x, y, yaw = (at(log, c, 30.0) for c in ("x_m", "y_m", "yaw_rad"))

        def in_car(place):
            dx, dy = place[0] - x, place[1] - y
            return dx * math.cos(yaw) + dy * math.sin(yaw), -dx * math.sin(yaw) + dy * math.cos(yaw), place[2]

        along, across, up = in_car(places["follow"])
        self.assertLess(along, -4)
        along, across, up = in_car(places["driver"])
        self.assertTrue(0 < along < 3 and 0 < across < 0.8 and 1 < up < 1.4, (along, across, up))
        self.browser.run("document.querySelector('#side-by-side').click()")
        self.browser.settle()
        views = self.browser.run("return replay.views().map(v => [v.car.track.plant, v.viewport.x, v.viewport.width])")
        self.assertEqual([v[0] for v in views], ["kinematic", "mujoco"])
        self.assertGreaterEqual(views[1][1], views[0][1] + views[0][2])
        self.browser.picture(PICTURES / "replay_side_by_side.png")

    def test_first_picture_comes_soon(self):
        self.open("minute/report.html", width=1280, height=900)
        # Printed for information, not checked: machines differ.
        print(f"first picture after {self.browser.run('return replay.firstPicture()'):.0f} ms", file=sys.stderr)

    def test_scene_is_small(self):
        [run] = self.data("minute/report.html")["runs"]
        for plant in run["plants"]:
            minutes = plant["log"]["t"][-1] / 60
            self.assertGreater(minutes, 0.9)
            self.assertLess(len(json.dumps(plant["motion"])) / minutes, 500_000)

    def test_memory_is_bounded_over_five_minutes(self):
        self.open("long/report.html", width=640, height=480)
        self.assertGreaterEqual(self.browser.run("return duration"), 299)
        used = []
        for _ in range(3):
            used.append(
                self.browser.run(
                    """
                    for (let time = 0; time < duration; time += 10) { setTime(time, 'test'); replay.draw(time); }
                    const { geometries, textures } = replay.renderer.info.memory;
                    return [geometries, textures, replay.renderer.info.programs.length];
                    """
                )
            )
        self.assertEqual(used[0], used[1])
        self.assertEqual(used[0], used[2])

    def test_without_webgl_the_map_stays(self):
        page = self.root / "minute/report.html"
        plain = self.root / "plain.html"
        plain.write_text(page.read_text())
        browser = Browser(webgl=False)
        try:
            browser.open(plain)
            self.assertIn("no WebGL", browser.run("return document.querySelector('#replay').textContent"))
            self.assertEqual(browser.run("return document.querySelectorAll('.map .car').length"), 2)
            self.assertEqual(browser.console_errors(), [])
        finally:
            browser.close()

    def test_phone(self):
        self.open("minute/report.html", width=390, height=844)
        wide, screen = self.browser.run("return [document.documentElement.scrollWidth, window.innerWidth]")
        self.assertLessEqual(wide, screen)
        self.browser.picture(PICTURES / "replay_phone.png")


if __name__ == "__main__":
    run_tests(Replay)
