"""Tests reports as users see them: runs scenarios with the program, writes their reports, opens them in
a headless Chromium without a network, and operates them.

browser_test.py PROGRAM PICTURES [I/N] [unittest's options]: writes pictures of the pages to the folder PICTURES.
"""

import os
import csv
import json
import math
import pathlib
import re
import shutil
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from pages import PICTURES, PageTest, has_video, run_tests  # noqa: E402

SCENARIO = """schema: 1
name: corner
mission: {speed: %s, waypoints: [[0, 0], [30, 0], [30, 30]]}
world:
  obstacles:
    - {box: {x: 5, y: 12, yaw: 0.3, length: 3, width: 1.5}, velocity: {x: 0.5, y: 0.25}}
plan: {method: fillet}
control: {method: preview, distance: 2.5}
expect: {reach_goal: 0.5, max_cross_track: 2.5}
"""

STUDY = """schema: 1
name: fast
scenario: slow.yaml
set: {drive.plants: [kinematic]}
vary:
  control.distance: [2, 3]
  mission.speed: [2, 4, 3]
outputs: [metrics.kinematic.cross_track.max, metrics.kinematic.time, plan.status]
"""

JUDGED = "position=100,heading=1e-9"

EVIL = "<b>&\"'</script><script>alert(1)</script>"


def rows_of(file):
    with open(file, newline="") as lines:
        return list(csv.DictReader(lines))


def value_at(rows, column, moment):
    """Interpolates linearly between the rows; constant beyond the ends."""
    moments = [float(row["t_s"]) for row in rows]
    values = [float(row[column]) for row in rows]
    if moment >= moments[-1]:
        return values[-1]
    i = next(k for k, t in enumerate(moments) if t > moment)
    part = (moment - moments[i - 1]) / (moments[i] - moments[i - 1])
    return values[i - 1] + part * (values[i] - values[i - 1])


def copy_of_a_result(source, target):
    """Removes the manifest, which would detect edits of the run."""
    shutil.copytree(source, target)
    manifest = os.path.join(target, os.fsencode("manifest.json") if isinstance(target, bytes) else "manifest.json")
    if os.path.exists(manifest):
        os.remove(manifest)


class Reports(PageTest):
    # replay_test.py tests the 3D replay. Without the 3D replay, pages open three times as fast.
    webgl = False

    @classmethod
    def make_inputs(cls):
        for name, speed in (("slow", 3), ("quick", 3.3)):
            (cls.root / f"{name}.yaml").write_text(SCENARIO % speed)
            cls.trackbed("run", "-q", f"{name}.yaml", "-o", name)
        (cls.root / "study.yaml").write_text(STUDY)
        cls.trackbed("sweep", "-q", "study.yaml", "-o", "study")
        if has_video():
            cls.trackbed("render", "-q", "slow", "--size", "160x120", "--fps", "10")
        cls.trackbed("report", "slow")
        cls.trackbed("report", "slow", "--film", "beside", "-o", "beside.html")
        cls.trackbed("report", "slow", "quick", "--film", "none", "-o", "both.html")
        # The runs differ only in speed, by 0.3 m/s in the turn.
        cls.trackbed("compare", "-q", "slow", "quick", "-o", "judged", "--tolerance", JUDGED, code=3)
        cls.trackbed("report", "judged", "--film", "none")
        cls.trackbed("report", "study")
        evil = cls.root / "evil"
        copy_of_a_result(cls.root / "slow", evil)
        metrics = json.loads((evil / "metrics.json").read_text())
        metrics["scenario"] = EVIL
        metrics["verdict"]["failures"] = [EVIL]
        (evil / "metrics.json").write_text(json.dumps(metrics))
        cls.trackbed("report", "evil", "--film", "none", "-o", "evil.html")

    def tearDown(self):
        self.assertEqual(self.browser.console_errors(), [])
        for url in self.browser.loaded():
            self.assertRegex(url, r"^(file|data|blob|chrome):", url[:100])

    # Queries of a page.

    def run_in_page(self, script, *arguments):
        return self.browser.run(script, *arguments)

    def text(self, selector):
        return self.run_in_page(
            "return document.querySelector(arguments[0]).textContent", selector
        )

    def count(self, selector):
        return self.run_in_page("return document.querySelectorAll(arguments[0]).length", selector)

    def choose(self, selector, option):
        """Chooses the option of a select element whose text begins so."""
        self.run_in_page(
            "const s = document.querySelector(arguments[0]);"
            "s.value = Array.from(s.options).find(o => o.text.startsWith(arguments[1])).value;"
            "s.dispatchEvent(new Event('change'))",
            selector,
            option,
        )
        self.browser.settle()

    def box(self, selector):
        return self.run_in_page(
            "const e = document.querySelector(arguments[0]); e.scrollIntoView({block: 'center'});"
            "const b = e.getBoundingClientRect();"
            "return {x: b.x, y: b.y, width: b.width, height: b.height}",
            selector,
        )

    def mouse(self, kind, x, y, **more):
        self.browser.driver.execute_cdp_cmd(
            "Input.dispatchMouseEvent", {"type": kind, "x": x, "y": y, **more}
        )

    def drag(self, x, y, to_x, to_y):
        self.mouse("mousePressed", x, y, button="left", clickCount=1)
        for share in (0.3, 0.7, 1):
            self.mouse("mouseMoved", x + share * (to_x - x), y + share * (to_y - y), button="left", buttons=1)
        self.mouse("mouseReleased", to_x, to_y, button="left", clickCount=1)
        self.browser.settle()

    def double_click(self, x, y):
        for count in (1, 2):
            self.mouse("mousePressed", x, y, button="left", clickCount=count)
            self.mouse("mouseReleased", x, y, button="left", clickCount=count)
        self.browser.settle()

    def click(self, selector):
        self.run_in_page("document.querySelector(arguments[0]).click()", selector)
        self.browser.settle()

    def numbers(self, selector, attribute="transform"):
        text = self.run_in_page(
            "return document.querySelector(arguments[0]).getAttribute(arguments[1])",
            selector,
            attribute,
        )
        return [float(n) for n in re.findall(r"-?[\d.]+(?:e-?\d+)?", text)]

    def moment(self):
        return float(re.fullmatch(r"t = ([\d.]+) s", self.text("#time")).group(1))

    def eventually(self, check):
        """Repeats a check until it passes, because animations take time."""
        last = time.monotonic() + 60
        while True:
            try:
                check()
                return
            except AssertionError:
                if time.monotonic() > last:
                    raise
            self.browser.settle()

    def point_at(self, quantity, share):
        """Moves the pointer to a chart, at this fraction of its width from the left."""
        plot = self.box(f"[data-quantity={quantity}] .plot")
        self.mouse("mouseMoved", plot["x"] + 60 + share * (plot["width"] - 60), plot["y"] + 60)
        self.browser.settle()

    def width_is_kept(self):
        wide, screen = self.run_in_page(
            "return [document.documentElement.scrollWidth, window.innerWidth]"
        )
        self.assertLessEqual(wide, screen)

    # One run.

    def test_run_says_first_how_it_went(self):
        self.open("slow/report.html")
        self.assertEqual(self.text("h1"), "corner")
        self.assertEqual(self.text("#verdict"), "passed")
        metrics = json.loads((self.root / "slow/metrics.json").read_text())
        shown = self.run_in_page(
            "return Array.from(document.querySelectorAll("
            "'[data-path=\"cross_track.max\"] .number')).map(e => parseFloat(e.textContent.replace('−', '-')))"
        )
        exact = [plant["cross_track"]["max"] for plant in metrics["plants"].values()]
        exact.append(exact[1] - exact[0])
        self.assertEqual(len(shown), 3)  # the last one is their difference
        for one, other in zip(shown, exact):
            self.assertAlmostEqual(one, other, delta=max(5e-5, 5e-3 * abs(other)))  # three digits, four decimals
        self.assertIn("resolved", self.text("#scenario h2").lower())
        self.assertIn("waypoints: [[0, 0], [30, 0], [30, 30]]", self.text("#scenario pre"))
        self.width_is_kept()
        self.browser.picture(PICTURES / "run.png")

    def test_first_screen_says_who_left_the_path_where_and_by_how_much(self):
        self.open("slow/report.html", width=1280, height=900)
        metrics = json.loads((self.root / "slow/metrics.json").read_text())
        rows = self.run_in_page(
            "return Array.from(document.querySelectorAll('#answer .rows li')).map(e =>"
            " ['.name', '.what', '.size', '.place'].map(s => e.querySelector(s).textContent)"
            " .concat(e.getBoundingClientRect().bottom))"
        )
        [between] = metrics["between"]
        # The plants, in descending order of cross-track error, followed by their difference.
        plants = sorted(metrics["plants"], key=lambda name: -metrics["plants"][name]["cross_track"]["max"])
        self.assertEqual([row[0] for row in rows], [*plants, "kinematic – mujoco"])
        exact = [metrics["plants"][name]["cross_track"] for name in plants] + [between["position"]]

        def rounded(value):  # to centimeters, to millimeters below 10 cm
            return f"{value:.{3 if value < 0.0995 else 2}f} m"

        for (name, what, size, place, bottom), own in zip(rows, exact):
            number, _, side = size.rpartition(" ")
            self.assertEqual(number, rounded(own["max"]))
            s, t = re.fullmatch(r"at ([\d.]+) m, ([\d.]+) s", place).groups()
            # Stations and times are shown with one decimal.
            self.assertAlmostEqual(float(s), own["max_s"], delta=0.051)
            self.assertAlmostEqual(float(t), own["max_t"], delta=0.051)
            self.assertLess(bottom, 900)
            if name in plants:
                self.assertIn(f"arrived after {metrics['plants'][name]['time']:.3g} s", what)
                log = rows_of(self.root / "slow" / f"{name}.csv")
                left = value_at(log, "cross_track_m", own["max_t"]) > 0
                self.assertEqual(side, "left" if left else "right")
        # The sentence describes the plant with the largest error.
        sentence = self.text("#answer .sentence")
        side = rows[0][2].rpartition(" ")[2]
        self.assertIn(f"{rounded(exact[0]['max'])} to the {side}", sentence)
        self.assertLess(sentence.index(plants[0]), sentence.index(plants[1]))
        self.assertIn(f"stays within {rounded(exact[1]['max'])} of it", sentence)
        # The page opens at the time of the largest difference between the plants, and every place
        # is a link.
        self.assertAlmostEqual(self.moment(), between["position"]["max_t"], delta=0.006)
        self.run_in_page("document.querySelector('#answer .rows li .place').click()")
        self.assertAlmostEqual(self.moment(), exact[0]["max_t"], delta=0.006)

    def test_expectations_nearest_to_their_limits_come_first(self):
        self.open("slow/report.html")
        checks = json.loads((self.root / "slow/metrics.json").read_text())["verdict"]["checks"]
        bars = self.run_in_page(
            "return Array.from(document.querySelectorAll('.limits li')).map(e => {"
            " const bar = e.querySelector('.bar');"
            " return [e.querySelector('.mark').textContent, bar && ['.fill', '.limit'].map(s =>"
            "  { const b = bar.querySelector(s).getBoundingClientRect();"
            "    return (s === '.fill' ? b.right : b.left + b.width / 2) - bar.getBoundingClientRect().left; })]; })"
        )
        shares = sorted(
            (c["value"] / c["bound"] if c["relation"] == "at_most" else c["bound"] / c["value"]
             for c in checks if c["relation"] != "equals" and c["bound"] > 0 and c["value"] > 0),
            reverse=True,
        )
        drawn = [fill / limit for _, bar in bars if bar for fill, limit in [bar]]
        self.assertGreaterEqual(len(drawn), 3)
        self.assertEqual({mark for mark, _ in bars}, {"✓"})
        for one, other in zip(drawn, shares):
            one = one if one <= 1.001 else 1 / one  # beyond a lower bound the ratio is inverted
            self.assertAlmostEqual(one, other, delta=0.02)  # some pixels of 400

    def test_enlarged_distances_from_the_path(self):
        self.open("slow/report.html")
        rows = rows_of(self.root / "slow/mujoco.csv")
        self.point_at("cross_track", 0.45)
        moment = self.moment()
        self.click("#enlarge")
        x, y, _ = self.numbers(".car[data-track=mujoco]")
        heading = value_at(rows, "yaw_rad", moment) - value_at(rows, "heading_error_rad", moment)
        by = 9 * value_at(rows, "cross_track_m", moment)
        self.assertGreater(abs(by), 0.01)
        # The page draws the car's distance from its path ten times enlarged. The time is shown with
        # two decimals, so the car may be up to 15 mm farther along the path.
        self.assertAlmostEqual(x, value_at(rows, "x_m", moment) - by * math.sin(heading), delta=0.03)
        self.assertAlmostEqual(y, value_at(rows, "y_m", moment) + by * math.cos(heading), delta=0.03)
        self.click("#enlarge")
        x, _, _ = self.numbers(".car[data-track=mujoco]")
        self.assertAlmostEqual(x, value_at(rows, "x_m", moment), delta=0.02)

    def test_phase_planes_follow_the_moment(self):
        self.open("slow/report.html")
        self.assertEqual(self.count("[data-plane]"), 3)
        rows = rows_of(self.root / "slow/mujoco.csv")

        def place():
            return self.run_in_page(
                "const dots = document.querySelectorAll('[data-plane=steering_yaw_rate] circle.now');"
                "return [+dots[1].getAttribute('cx'), +dots[1].getAttribute('cy')]"
            )

        places = []
        for share in (0.3, 0.5, 0.7):
            self.point_at("speed", share)
            moment = self.moment()
            places.append((place(), [value_at(rows, c, moment) for c in ("steering_rad", "yaw_rate_radps")]))
        for axis in (0, 1):
            values = [(p[axis], v[axis]) for p, v in places]
            (low, at_low), (high, at_high) = min(values, key=lambda e: e[1])[::1], max(values, key=lambda e: e[1])
            scale = (high - low) / (at_high - at_low)
            self.assertEqual(scale > 0, axis == 0)
            for pixel, value in values:
                # Within half a unit of the time's last digit, the steering changes by 0.75 mrad.
                self.assertAlmostEqual(pixel, low + scale * (value - at_low), delta=abs(scale) * 3e-3 + 0.5)

    def test_pointing_at_a_chart_moves_cars_and_obstacle(self):
        self.open("slow/report.html")
        moments = []
        for quantity, share in (("cross_track", 0.25), ("speed", 0.5), ("lateral_acceleration", 0.7)):
            self.point_at(quantity, share)
            moment = self.moment()
            moments.append(moment)
            for plant in ("kinematic", "mujoco"):
                rows = rows_of(self.root / "slow" / f"{plant}.csv")
                x, y, degrees = self.numbers(f".car[data-track={plant}]")
                # The time has two decimals, so the position errs by up to 15 mm at 3 m/s.
                self.assertAlmostEqual(x, value_at(rows, "x_m", moment), delta=0.02)
                self.assertAlmostEqual(y, value_at(rows, "y_m", moment), delta=0.02)
                yaw = math.degrees(value_at(rows, "yaw_rad", moment))
                self.assertAlmostEqual(degrees, yaw, delta=0.3)
                speed = self.text(f"[data-quantity=speed] .readout[data-track={plant}]")
                self.assertAlmostEqual(float(speed), value_at(rows, "speed_mps", moment), delta=0.02)
            x, y, degrees = self.numbers(".obstacle.moving")
            self.assertAlmostEqual(x, 5 + 0.5 * moment, delta=0.01)
            self.assertAlmostEqual(y, 12 + 0.25 * moment, delta=0.01)
            self.assertAlmostEqual(degrees, math.degrees(0.3), delta=1e-3)
            cursors = self.run_in_page(
                "return Array.from(document.querySelectorAll('.chart:not([data-quantity^=difference]) .cursor'))"
                ".map(e => e.getBoundingClientRect().x)"
            )
            self.assertEqual(len(cursors), 7)
            self.assertLess(max(cursors) - min(cursors), 0.6)
        self.assertLess(moments[0] + 1, moments[1])
        self.assertLess(moments[1] + 1, moments[2])
        self.browser.picture(PICTURES / "drive.png")

    def test_steering_shows_what_was_asked_and_done(self):
        self.open("slow/report.html")
        self.point_at("steering", 0.4)  # the wheels do not follow the command
        rows = rows_of(self.root / "slow/mujoco.csv")
        text = self.text("[data-quantity=steering] .readout[data-track=mujoco]").replace("−", "-")
        done, asked = (float(n) for n in re.fullmatch(r"(-?[\d.]+) \((-?[\d.]+)\)", text).groups())
        # The tolerance is the change of the steering at its rate limit of 0.15 rad/s within half a
        # unit of the time's last digit, plus rounding to four decimals.
        delta = 0.15 * 0.005 + 5e-5
        self.assertAlmostEqual(done, value_at(rows, "steering_rad", self.moment()), delta=delta)
        self.assertAlmostEqual(
            asked, value_at(rows, "steering_command_rad", self.moment()), delta=0.01
        )
        self.assertGreater(abs(asked - done), 0.05)

    def test_map_zooms_and_moves(self):
        self.open("slow/report.html")
        area = self.box(".map svg")
        x, y = area["x"] + area["width"] / 2, area["y"] + area["height"] / 2

        def view():
            a, b, c, d, e, f = self.numbers(".map .world")
            self.assertEqual([b, c], [0, 0])
            self.assertAlmostEqual(a, -d)  # the same scale along x and y
            return a, e, f

        whole = view()
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=-300)
        self.browser.settle()
        self.assertEqual(view(), whole)  # the page scrolls, not the map
        area = self.box(".map svg")
        x, y = area["x"] + area["width"] / 2, area["y"] + area["height"] / 2
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=-300, modifiers=2)
        self.browser.settle()
        near = view()
        self.assertGreater(near[0], 1.3 * whole[0])
        # The point under the pointer stays there.
        inside = (x - area["x"], y - area["y"])
        for place, before, after in ((inside[0], whole[1], near[1]), (inside[1], whole[2], near[2])):
            self.assertAlmostEqual((place - before) / whole[0], (place - after) / near[0], delta=0.1)
        self.drag(x, y, x + 80, y - 50)
        moved = view()
        self.assertAlmostEqual(moved[0], near[0])
        self.assertAlmostEqual(moved[1] - near[1], 80, delta=1)
        self.assertAlmostEqual(moved[2] - near[2], -50, delta=1)
        self.double_click(x, y)

        def assert_whole():
            for one, other in zip(view(), whole):
                self.assertAlmostEqual(one, other, delta=1e-6 * abs(other) + 1e-6)

        self.eventually(assert_whole)
        self.click(".map .zoom button[aria-label='Zoom in']")
        self.eventually(
            lambda: self.assertAlmostEqual(view()[0], 1.6 * whole[0], delta=1e-6 * whole[0])
        )
        self.browser.picture(PICTURES / "zoomed.png")

    def test_a_plant_can_be_hidden(self):
        self.open("slow/report.html")

        def shown():
            return self.run_in_page(
                "const shown = e => getComputedStyle(e).display !== 'none';"
                "return [Array.from(document.querySelectorAll('.car')).filter(shown).length,"
                "  Array.from(document.querySelectorAll('.track')).filter(shown).length,"
                "  Array.from(document.querySelectorAll('[data-quantity=speed] .readout')).filter(shown).length]"
            )

        def colors():
            """The number of pixels of the chart in each plant's color."""
            return self.run_in_page(
                "const canvas = document.querySelectorAll('[data-quantity=speed] canvas')[0];"
                "const copy = new OffscreenCanvas(canvas.width, canvas.height)"
                ".getContext('2d', {willReadFrequently: true});"
                "copy.drawImage(canvas, 0, 0);"
                "const d = copy.getImageData(0, 0, canvas.width, canvas.height).data;"
                "let blue = 0, orange = 0;"
                "for (let i = 0; i < d.length; i += 4) if (d[i + 3] > 100) {"
                "  if (d[i + 2] > d[i] + 60) ++blue; else if (d[i] > d[i + 2] + 60) ++orange; }"
                "return [blue, orange]"
            )

        self.assertEqual(shown(), [2, 2, 2])
        blue, orange = colors()
        self.assertGreater(orange, 300)
        self.click(".legend [data-track=mujoco]")
        self.assertEqual(shown(), [1, 1, 1])
        alone = colors()
        self.assertEqual(alone[1], 0)
        self.assertGreater(alone[0], blue)  # traces that lay below
        self.click(".legend [data-track=mujoco]")
        self.assertEqual(shown(), [2, 2, 2])
        self.assertEqual(colors(), [blue, orange])

    def test_charts_zoom_together(self):
        self.open("slow/report.html")

        def ticks():
            return self.run_in_page(
                "return Array.from(document.querySelectorAll('.chart:not([data-quantity^=difference])')).map(c => Array.from("
                "c.querySelectorAll('.dygraph-axis-label-x')).map(e => e.textContent).join())"
            )

        whole = ticks()
        self.assertEqual(len(set(whole)), 1)
        plot = self.box("[data-quantity=speed] .plot")
        y = plot["y"] + 60
        self.drag(plot["x"] + 0.4 * plot["width"], y, plot["x"] + 0.6 * plot["width"], y + 2)
        part = ticks()
        self.assertEqual(len(set(part)), 1)
        self.assertNotEqual(part, whole)
        moments = [float(n) for n in re.findall(r"[\d.]+", part[0])]
        self.assertGreater(moments[0], 2)
        self.browser.picture(PICTURES / "part.png")
        self.double_click(plot["x"] + 0.5 * plot["width"], y)
        self.assertEqual(ticks(), whole)

    def test_play_moves_on(self):
        self.open("slow/report.html")
        self.click("#play")
        self.assertEqual(self.text("#play"), "Pause")
        before = self.moment()
        self.eventually(lambda: self.assertGreater(self.moment(), before))
        self.click("#play")
        still = self.moment()
        self.browser.settle()
        self.assertEqual(self.moment(), still)

    def test_film_follows_and_leads(self):
        if not has_video():
            self.skipTest("built without video")
        end = float(rows_of(self.root / "slow/mujoco.csv")[-1]["t_s"])
        for page in ("slow/report.html", "beside.html"):
            self.open(page)
            self.eventually(
                lambda: self.assertAlmostEqual(
                    self.run_in_page("return document.querySelector('video').duration || 0"),
                    end,
                    delta=0.3,  # frames every 0.1 s
                )
            )
            self.point_at("speed", 0.5)
            self.eventually(
                lambda: self.assertAlmostEqual(
                    self.run_in_page("return document.querySelector('video').currentTime"),
                    self.moment(),
                    delta=0.011,
                )
            )
            self.browser.driver.execute_async_script(
                "const done = arguments[0]; document.querySelector('video').play().then(() => done());"
            )
            before = self.moment()
            self.eventually(lambda: self.assertGreater(self.moment(), before + 0.1))
            self.run_in_page("document.querySelector('video').pause()")

    def test_dark(self):
        self.open("slow/report.html", dark=True)
        self.point_at("speed", 0.5)
        light = self.run_in_page(
            "const of = e => getComputedStyle(e);"
            "const sum = c => c.match(/\\d+/g).slice(0, 3).reduce((a, b) => a + Number(b), 0);"
            "return [sum(of(document.body).backgroundColor), sum(of(document.body).color)]"
        )
        self.assertLess(light[0], 120)
        self.assertGreater(light[1], 600)
        self.browser.picture(PICTURES / "dark.png")

    def test_phone(self):
        for page in ("slow/report.html", "both.html", "study/report.html"):
            self.open(page, width=390, height=844)
            self.width_is_kept()
            self.browser.picture(PICTURES / f"phone-{page.split('/')[0].split('.')[0]}.png")
        self.open("slow/report.html", width=390, height=844)
        # Drags a finger along the chart; the browser must not emulate a mouse for it.
        plot = self.box("[data-quantity=speed] .plot")
        touches = [
            {"x": plot["x"] + share * plot["width"], "y": plot["y"] + 60}
            for share in (0.3, 0.4, 0.5, 0.6)
        ]
        steps = [("touchStart", [touches[0]])]
        steps += [("touchMove", [touch]) for touch in touches[1:]]
        for kind, points in [*steps, ("touchEnd", [])]:
            self.browser.driver.execute_cdp_cmd(
                "Input.dispatchTouchEvent", {"type": kind, "touchPoints": points}
            )
        self.browser.settle()
        end = float(rows_of(self.root / "slow/mujoco.csv")[-1]["t_s"])
        self.assertAlmostEqual(self.moment() / end, 0.55, delta=0.15)
        self.browser.picture(PICTURES / "phone-drive.png")

    def test_tables_on_a_phone(self):
        places = (
            "const box = document.querySelector(arguments[0] + ' .scroll');"
            "box.scrollLeft = arguments[1];"
            "const place = e => { const b = e.getBoundingClientRect(); return [b.left, b.right]; };"
            "return [place(box), Array.from(box.querySelectorAll('tr')).map(row => Array.from(row.children).map(place))]"
        )
        # With two plants, the whole table fits. Otherwise the row headings and some of the values
        # fit.
        for page, tables in (
            ("slow/report.html", {"#numbers": 2, "#between": 1}),
            ("both.html", {"#numbers": 1, "#between": 2, "#headline": 1, "#differences": 1}),
            ("study/report.html", {"#table": 1}),
        ):
            self.open(page, width=375, height=812)
            for table, count in tables.items():
                for scrolled in (0, 10000):
                    (left, right), rows = self.run_in_page(places, table, scrolled)
                    for row in rows:
                        self.assertAlmostEqual(row[0][0], left, delta=1.5, msg=f"{page} {table}")
                        self.assertLess(row[0][1], left + 0.55 * (right - left))
                        inside = [cell for cell in row[1:] if cell[0] >= row[0][1] - 1 and cell[1] <= right + 1]
                        self.assertGreaterEqual(len(inside), count, f"{page} {table}")
            self.width_is_kept()
            self.run_in_page("document.querySelector(arguments[0]).scrollIntoView()", next(iter(tables)))
            self.browser.settle()
            self.browser.picture(PICTURES / f"phone-tables-{page.split('/')[0].split('.')[0]}.png")

    def test_nothing_lies_upon_the_film(self):
        if not has_video():
            self.skipTest("built without video")
        self.open("slow/report.html")
        has_controls = "return document.querySelector('video').controls"
        self.assertFalse(self.run_in_page(has_controls))
        film = self.box("video")
        self.mouse("mouseMoved", film["x"] + 20, film["y"] + 20)
        self.assertTrue(self.run_in_page(has_controls))
        self.mouse("mouseMoved", 2, 2)
        self.assertFalse(self.run_in_page(has_controls))
        # The controls also appear with the keyboard.
        self.run_in_page("document.querySelector('video').focus()")
        self.assertTrue(self.run_in_page(has_controls))
        self.run_in_page("document.querySelector('video').blur()")
        self.assertFalse(self.run_in_page(has_controls))
        # Controls appear on touch and stay until something else is touched.
        self.open("slow/report.html", width=390, height=844)
        for selector, controls in (("video", True), ("#play", False)):
            place = self.box(selector)
            point = [{"x": place["x"] + place["width"] / 2, "y": place["y"] + place["height"] / 2}]
            for kind, points in (("touchStart", point), ("touchEnd", [])):
                self.browser.driver.execute_cdp_cmd(
                    "Input.dispatchTouchEvent", {"type": kind, "touchPoints": points}
                )
            self.eventually(lambda: self.assertEqual(self.run_in_page(has_controls), controls))

    # Several runs.

    def test_comparison(self):
        self.open("both.html")
        names = self.run_in_page(
            "return Array.from(document.querySelectorAll('#headline tbody th')).map(e => e.textContent)"
        )
        self.assertEqual(
            names, ["slow · kinematic", "slow · mujoco", "quick · kinematic", "quick · mujoco"]
        )
        shown = self.run_in_page(
            "const i = Array.from(document.querySelectorAll('#headline thead th'))"
            ".findIndex(e => e.textContent.startsWith('Maximum cross-track'));"
            "return Array.from(document.querySelectorAll('#headline tbody tr'))"
            ".map(row => parseFloat(row.children[i].textContent))"
        )
        for one, (run, plant) in zip(shown, (name.split(" · ") for name in names)):
            metrics = json.loads((self.root / run / "metrics.json").read_text())
            exact = metrics["plants"][plant]["cross_track"]["max"]
            self.assertAlmostEqual(one, exact, delta=max(5e-5, 5e-3 * exact))
        # One color per run, the same in the legend, on the map and beside the readings.
        colors = self.run_in_page(
            "const of = s => Array.from(document.querySelectorAll(s)).map(e => getComputedStyle(e).color);"
            "return [of('.legend button .dot'), of('.car'), of('.track'),"
            " of('[data-quantity=speed] .readout .dot'), of('#numbers thead .dot')]"
        )
        self.assertEqual(len(set(colors[0])), 4)
        for other in colors[1:]:
            self.assertEqual(other, colors[0])
        self.point_at("speed", 0.5)
        for run, plant in (("slow", "mujoco"), ("quick", "kinematic")):
            rows = rows_of(self.root / run / f"{plant}.csv")
            x, y, _ = self.numbers(f".car[data-track='{run} · {plant}']")
            self.assertAlmostEqual(x, value_at(rows, "x_m", self.moment()), delta=0.03)
            self.assertAlmostEqual(y, value_at(rows, "y_m", self.moment()), delta=0.03)
        # Both runs have the same obstacle; differences between the scenarios are marked.
        self.assertEqual(
            self.run_in_page("return document.querySelectorAll('.map .obstacle').length"), 1
        )
        marked = self.run_in_page(
            "return Array.from(document.querySelectorAll('pre .differs')).map(e => e.textContent.trim())"
        )
        self.assertEqual(sorted(set(marked)), ["speed: 3", "speed: 3.3"])
        self.browser.picture(PICTURES / "comparison.png")

    def test_differences(self):
        for page in ("both.html", "judged/report.html"):
            self.open(page)
            judged = page != "both.html"
            pairs = json.loads((self.root / "judged/compare.json").read_text())["pairs"]
            self.assertEqual(len(pairs), 2)
            table = self.run_in_page(
                "return Array.from(document.querySelectorAll('#differences tbody tr')).map(row =>"
                "[row.querySelector('th').textContent,"
                " Array.from(row.querySelectorAll('td')).map(e =>"
                "  Array.from(e.children).map(e => e.textContent))])"
            )
            self.assertEqual([row[0] for row in table], [f"{p}: slow – quick" for p in ("kinematic", "mujoco")])
            for (_, cells), pair in zip(table, pairs):
                for cell, name in zip(cells, ("position", "heading", "yaw_rate", "steering")):
                    exact = pair[name]
                    self.assertAlmostEqual(float(cell[0]), exact["max"], delta=1e-3 * exact["max"])
                    place = re.fullmatch(r"at ([\d.]+) m, ([\d.]+) s", cell[-2])
                    self.assertAlmostEqual(float(place.group(1)), exact["max_s"], delta=0.05)
                    self.assertAlmostEqual(float(place.group(2)), exact["max_t"], delta=0.05)
                    rms = float(cell[-1].removeprefix("rms "))
                    self.assertAlmostEqual(rms, exact["rms"], delta=1e-3 * exact["rms"])
                self.assertEqual([cell[1] for cell in cells if len(cell) > 3],
                                 ["✓ at most 100", "✗ at most 1e−9"] if judged else [])
            self.assertEqual(
                self.run_in_page(
                    "return Array.from(document.querySelectorAll('.comparison .badge, .comparison li'))"
                    ".map(e => e.textContent.replace(/ difference .*|, [\\d.]+ m and .*/, ''))"
                ),
                ["failed", *[f"slow/{p} and quick/{p}: heading" for p in ("kinematic", "mujoco")],
                 "the runs follow different paths"]
                if judged else [],
            )
            # Compares the difference curve at the pointer's station with the table, and the first
            # car at its time at this station.
            rows = [row for row in rows_of(self.root / "judged/compare.csv") if row["pair"] == "0"]
            self.point_at("difference_yaw_rate", 0.45)
            moment = self.moment()
            self.assertGreater(moment, 3)
            station = value_at([{**row, "t_s": row["first_t_s"]} for row in rows], "s_m", moment)
            at = [{**row, "t_s": row["s_m"]} for row in rows]
            for quantity, column, slack in (
                ("position", "position_m", 0.01),
                ("heading", "yaw_rad", 0.004),
                ("yaw_rate", "yaw_rate_radps", 0.01),
                ("steering", "steering_rad", 0.01),
            ):
                told = self.text(f"[data-quantity=difference_{quantity}] .readout").replace("−", "-")
                # The time has two decimals, so the station errs by up to 15 mm. `slack` is the
                # change of the difference over this distance; it is largest for steering angles and
                # yaw rates.
                self.assertAlmostEqual(float(told), value_at(at, column, station), delta=slack)
            x, _, _ = self.numbers(".car[data-track='slow · kinematic']")
            log = rows_of(self.root / "slow/kinematic.csv")
            self.assertAlmostEqual(x, value_at(log, "x_m", moment), delta=0.03)
            cursors = self.run_in_page(
                "return Array.from(document.querySelectorAll('[data-quantity^=difference] .cursor'))"
                ".map(e => e.getBoundingClientRect().x)"
            )
            self.assertEqual(len(cursors), 4)
            self.assertLess(max(cursors) - min(cursors), 0.6)
            # A hidden plant is in no pair.
            self.click(".legend [data-track='quick · mujoco']")
            readouts = self.run_in_page(
                "return Array.from(document.querySelectorAll("
                "'[data-quantity=difference_position] .readout')).map(e => getComputedStyle(e).display)"
            )
            self.assertNotEqual(readouts[0], "none")
            self.assertEqual(readouts[1], "none")
            self.width_is_kept()
            self.browser.picture(PICTURES / ("judged.png" if judged else "differences.png"))

    # A study.

    def test_study(self):
        self.open("study/report.html")
        self.assertEqual(self.text("h1"), "fast")
        rows = rows_of(self.root / "study/sweep.csv")
        column = "metrics.kinematic.cross_track.max"
        exact = [float(row[column]) for row in rows]
        self.assertEqual(len(rows), 6)

        def cells():
            return self.run_in_page(
                "const i = Array.from(document.querySelectorAll('#table thead th'))"
                ".findIndex(e => e.dataset.column === arguments[0]);"
                "return Array.from(document.querySelectorAll('#table tbody tr'))"
                ".map(row => parseFloat(row.children[i].textContent))",
                column,
            )

        def assert_shown(expected):
            for one, other in zip(cells(), expected):
                self.assertAlmostEqual(one, other, delta=1e-3 * other)  # four digits

        assert_shown(exact)
        button = f"#table th[data-column='{column}'] button"
        self.click(button)
        assert_shown(sorted(exact))
        self.click(button)
        assert_shown(sorted(exact, reverse=True))

        def places(output):
            return self.run_in_page(
                "return Array.from(document.querySelectorAll(arguments[0])).map(e =>"
                "[Number(e.getAttribute('cx')), Number(e.getAttribute('cy')), Number(e.dataset.row)])",
                f"[data-output='{output}'] circle",
            )

        def assert_linear(pixels, values):
            """Asserts that pixels are a linear function of the values."""
            low, high = values.index(min(values)), values.index(max(values))
            slope = (pixels[high] - pixels[low]) / (values[high] - values[low])
            self.assertGreater(abs(slope), 0)
            for pixel, value in zip(pixels, values):
                self.assertAlmostEqual(
                    pixel, pixels[low] + slope * (value - values[low]), delta=0.05
                )

        for over in ("control.distance", "mission.speed"):
            self.choose("#over", over)
            points = places(column)
            self.assertEqual([row for _, _, row in points], [0, 1, 2, 3, 4, 5])
            assert_linear([x for x, _, _ in points], [float(row[over]) for row in rows])
            assert_linear([y for _, y, _ in points], exact)
            self.assertLess(points[exact.index(max(exact))][1], points[exact.index(min(exact))][1])
        # Only numbers are plotted.
        self.assertEqual(places("plan.status"), [])
        point = self.box(f"[data-output='{column}'] circle[data-row='4']")
        self.mouse("mouseMoved", point["x"] + 4, point["y"] + 4)
        self.browser.settle()
        self.assertEqual(
            self.run_in_page("return document.querySelector('#table .chosen').dataset.row"), "4"
        )
        tip = self.text(".tooltip")
        self.assertIn("mission.speed [m/s]4", tip)
        self.browser.picture(PICTURES / "study.png")
        self.width_is_kept()

    def test_study_statistics(self):
        rows = ["method,x,status,error,margin,reason"]
        for i in range(600):
            x = (i // 2 + 0.5) / 300
            error = x if i % 2 == 0 else 2 * x
            rows.append(f"{'lqr' if i % 2 == 0 else 'mpc'},{x},{'passed' if error < 1 else 'failed'},{error},{1 - error},")
        folder = self.root / "sampled"
        folder.mkdir()
        (folder / "sweep.csv").write_text("\n".join(rows) + "\n")
        (folder / "sweep.json").write_text(
            '{"study": "sampled", "scenario": "a.yaml", "complete": true, "rows_expected": 600, "versions": {}}'
        )
        self.trackbed("report", "sampled")
        self.open("sampled/report.html")
        self.assertIn("Pass rate 75.0 %, 95 % interval 71.4 % to 78.3 %", self.text("#pass-rate"))
        def shares():
            return self.run_in_page(
                "return Array.from(document.querySelectorAll('#influence [data-bar]'))"
                ".map(e => [e.dataset.bar, Number(e.querySelector('rect').getAttribute('width'))])"
            )

        # The pass rate is shown first.
        self.assertEqual(sorted(name for name, _ in shares()), ["method", "x"])
        self.assertEqual(self.count("#influence figure"), 3)
        self.assertEqual(self.count("#study-map .cell:not(.none)"), 2 * 7)
        self.assertEqual(self.count("#distributions figure"), 2)
        # The two outputs are perfectly anticorrelated.
        self.assertEqual(self.text("#correlations [data-bar='error'] .bar-name:last-child"), "−1.00")
        worst = self.run_in_page(
            "return Array.from(document.querySelectorAll('#worst tbody tr')).map(e => e.dataset.number)"
        )
        self.assertEqual(worst, [str(599 - 2 * i) for i in range(10)])
        self.assertIn("--row 599 --video --report", self.text("#worst tbody tr code"))
        self.choose("#worst-order", "lowest")
        self.assertEqual(
            self.run_in_page("return document.querySelector('#worst tbody tr').dataset.number"), "0"
        )
        self.choose("#influence-of", "error")
        # The shares of the variance are 9/13 and 3/13.
        (first, wide), (second, narrow) = shares()
        self.assertEqual([first, second], ["x", "method"])
        self.assertAlmostEqual(wide / narrow, 3, delta=0.3)
        self.assertIn("Mean of error over x", self.run_in_page("return document.querySelector('#influence').textContent"))
        self.choose("#map-of", "error")
        self.browser.picture(PICTURES / "sampled.png")
        self.width_is_kept()

    # Texts of files are shown as text.

    def test_text_is_no_markup(self):
        self.open("evil.html")
        self.assertEqual(self.text("h1"), EVIL)
        self.assertEqual(self.text(".verdict li"), EVIL)
        self.assertEqual(self.run_in_page("return document.querySelectorAll('#report b').length"), 0)


if __name__ == "__main__":
    run_tests(Reports)
