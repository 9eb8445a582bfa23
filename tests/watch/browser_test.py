"""Tests watched runs: starts the program, opens its page in a headless Chromium during the run, and
operates it.

browser_test.py PROGRAM PICTURES [I/N] [unittest's options]: writes pictures of the pages to the folder PICTURES.
"""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "report"))
from pages import PICTURES, PROGRAM, PageTest, run_tests  # noqa: E402

SCENARIO = """schema: 1
name: corner
mission: {speed: 3, waypoints: [[0, 0], [30, 0], [30, 30]]}
world:
  obstacles:
    - {box: {x: 5, y: 12, yaw: 0.3, length: 3, width: 1.5}, velocity: {x: 0.5, y: 0.25}}
plan: {method: fillet}
expect: {reach_goal: 0.5}
"""


class Watch(PageTest):
    @classmethod
    def make_inputs(cls):
        (cls.root / "corner.yaml").write_text(SCENARIO)

    def setUp(self):
        self.process = None

    def tearDown(self):
        if self.process:
            self.process.kill()
            self.process.communicate()
        for message in self.browser.console_errors():
            # The page tries to reconnect to a server that has ended.
            self.assertIn("ERR_CONNECTION_REFUSED", message)
            self.assertTrue(self.ended, message)

    ended = False

    def watch(self, *arguments):
        """Starts the program and returns its address."""
        self.ended = False
        self.process = subprocess.Popen(
            [PROGRAM, "watch", *arguments], cwd=self.root, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        line = self.process.stdout.readline()
        found = re.match(r"(http://127\.0\.0\.1:\d+/) ", line)
        if not found:
            self.fail(line + self.process.communicate()[1])
        return found.group(1)

    def end(self, number=signal.SIGINT):
        """Interrupts the program like Ctrl-C. Returns its exit code and its output since the start."""
        self.ended = True
        self.process.send_signal(number)
        output, errors = self.process.communicate()
        self.assertEqual(errors, "")
        return self.process.returncode, output

    def run_in_page(self, script, *arguments):
        return self.browser.run(script, *arguments)

    def eventually(self, script, *arguments):
        """Waits until the result of a script is true, even if the page reloads, and returns it."""
        last = time.monotonic() + 120
        while True:
            try:
                found = self.run_in_page(script, *arguments)
            except Exception:  # between two pages
                found = None
            if found:
                return found
            self.assertLess(time.monotonic(), last, script)
            self.browser.settle()

    def rows(self):
        return self.run_in_page("return tracks.map(track => track.log.t.length)")

    def place(self, plant="mujoco"):
        """The position of the car on the map."""
        text = self.run_in_page(
            "return document.querySelector(`.car[data-track='${arguments[0]}']`).getAttribute('transform')", plant
        )
        return [float(number) for number in re.findall(r"-?[\d.]+(?:e-?\d+)?", text)]

    def pixels(self):
        """A digest of the replay's picture."""
        return self.run_in_page(
            "const canvas = document.querySelector('.replay canvas'); replay.draw(now);"
            "const copy = document.createElement('canvas'); [copy.width, copy.height] = [64, 48];"
            "const context = copy.getContext('2d'); context.drawImage(canvas, 0, 0, 64, 48);"
            "return Array.from(context.getImageData(0, 0, 64, 48).data)"
        )

    def test_page_grows_pauses_steps_resumes_and_ends_as_the_report(self):
        url = self.watch("corner.yaml", "--paused")
        self.browser.open(url, width=1280, height=720)
        # The run waits at its start, with one row per plant.
        self.eventually("return live.state && live.state.paused && tracks.every(track => track.log.t.length === 1)")
        self.assertEqual(self.run_in_page("return document.getElementById('verdict').textContent"), "paused")
        self.assertEqual(self.place()[:2], [0, 0])
        before = self.pixels()
        # One step is one control period of both plants.
        self.run_in_page("document.getElementById('step').click()")
        self.eventually("return tracks.every(track => track.log.t.length === 2)")
        self.assertEqual(self.run_in_page("return tracks.map(track => track.log.t[1])"), [0.02, 0.02])
        # The car moves in the map, the charts and the replay.
        self.run_in_page("document.getElementById('pause').click()")
        self.eventually("return duration > 2 && now === duration && live.state && !live.state.paused")
        self.browser.picture(PICTURES / "watch.png")
        self.run_in_page("document.activeElement.blur()")
        self.key(" ")
        self.eventually("return live.state.paused")
        self.eventually("return tracks.every(track => track.log.t.length === tracks[0].log.t.length)")
        self.eventually("return now === duration && tracks[0].log.t[tracks[0].log.t.length - 1] === duration")
        x, y = self.place()[:2]
        log = self.run_in_page("const {log} = tracks[1]; const i = log.t.length - 1; return [log.x[i], log.y[i], log.t[i]]")
        self.assertAlmostEqual(x, log[0], delta=1e-6)
        self.assertAlmostEqual(y, log[1], delta=1e-6)
        self.assertGreater(x, 3)
        self.assertNotEqual(self.pixels(), before)
        # The charts' axes end at the last rows, and their readouts show the newest values.
        shown = self.run_in_page("return document.querySelector('[data-quantity=speed] [data-track=mujoco] span:last-child').textContent")
        self.assertGreater(float(shown), 1)
        self.assertAlmostEqual(self.run_in_page("return Number(document.querySelector('.tools input[type=range]').max)"), log[2])
        # A paused run stays at its time; the keyboard can step it.
        rows = self.rows()
        self.key(".")
        self.eventually("return tracks.every((track, i) => track.log.t.length === arguments[0][i] + 1)", rows)
        # A user who looks at an earlier time stays there, and can return to the newest one.
        self.run_in_page("setTime(1)")
        self.assertEqual(self.run_in_page("return document.getElementById('follow').getAttribute('aria-pressed')"), "false")
        self.key(".")
        self.eventually("return tracks.every((track, i) => track.log.t.length === arguments[0][i] + 2)", rows)
        self.assertEqual(self.run_in_page("return now"), 1)
        self.run_in_page("document.getElementById('follow').click()")
        self.assertEqual(self.run_in_page("return now === duration"), True)
        # A reloaded page shows everything.
        rows = self.rows()
        self.browser.open(url, width=390, height=844)
        self.eventually("return tracks.every((track, i) => track.log.t.length === arguments[0][i])", rows)
        wide, screen = self.run_in_page("return [document.documentElement.scrollWidth, window.innerWidth]")
        self.assertLessEqual(wide, screen)
        self.browser.picture(PICTURES / "watch_phone.png")
        # Runs to the end at full speed; then the report with its verdict appears.
        self.run_in_page(
            "const s = document.getElementById('speed'); s.value = 'max'; s.dispatchEvent(new Event('change'));"
            "document.getElementById('pause').click()"
        )
        self.eventually("return typeof live === 'undefined' && document.getElementById('verdict').textContent === 'passed'")
        self.assertEqual(self.run_in_page("return window.scrollY"), 0)
        self.browser.picture(PICTURES / "watch_end.png")
        report = json.loads((self.root / "out/corner/metrics.json").read_text())
        end = self.run_in_page("return tracks.map(track => track.end.t)")
        for shown, plant in zip(end, report["plants"].values()):
            self.assertAlmostEqual(shown, plant["time"], delta=1e-4)
        code, output = self.end()
        self.assertEqual(code, 0)
        self.assertIn("corner: passed, in out/corner", output)

    def key(self, key):
        for kind in ("keyDown", "keyUp"):
            self.browser.driver.execute_cdp_cmd(
                "Input.dispatchKeyEvent", {"type": kind, "key": key, "text": key if kind == "keyDown" else ""}
            )

    def test_page_tells_when_the_program_ends_and_loads_the_next_run(self):
        url = self.watch("corner.yaml", "--paused", "--speed", "5")
        port = url.split(":")[2].strip("/")
        self.browser.open(url)
        self.eventually("return live.state && document.getElementById('speed').value === '5'")
        code, output = self.end()
        self.assertEqual(code, 130)
        self.assertIn("corner: interrupted, in out/corner", output)
        self.assertIs(json.loads((self.root / "out/corner/metrics.json").read_text())["complete"], False)
        self.eventually("return document.getElementById('verdict').textContent === 'no connection'")
        self.assertTrue(self.run_in_page("return document.getElementById('pause').disabled"))
        first = self.run_in_page("return data.live.id")
        self.watch("corner.yaml", "--paused", "--port", port, "--seed", "7")
        self.eventually("return data.live.id !== arguments[0] && live.state && live.state.paused", first)
        self.assertIn("seed 7", self.run_in_page("return document.querySelector('header').textContent"))
        self.ended = True  # earlier refused connections are still in the console
        self.assertEqual(self.end(signal.SIGTERM)[0], 130)

    def test_finished_run_is_served_as_its_report(self):
        done = subprocess.run([PROGRAM, "run", "-q", "corner.yaml", "-o", "done"], cwd=self.root, check=False)
        self.assertEqual(done.returncode, 0)
        self.browser.open(self.watch("done"))
        self.assertEqual(self.run_in_page("return document.getElementById('verdict').textContent"), "passed")
        self.assertEqual(self.run_in_page("return typeof live"), "undefined")
        self.assertEqual(self.end(), (0, ""))

    def test_served_page_loads_nothing_from_elsewhere(self):
        self.browser.loaded()
        url = self.watch("corner.yaml", "--paused")
        self.browser.open(url)
        self.eventually("return live.state")
        for address in self.browser.loaded():
            self.assertRegex(address, rf"^({re.escape(url)}|data:|blob:|chrome:)", address[:100])
        # The policy prevents the page's scripts from connecting to other hosts.
        refused = self.browser.driver.execute_async_script(
            "const done = arguments[0];"
            "fetch('http://127.0.0.1:9/').then(() => done('sent'), (error) => done(String(error)));"
        )
        self.assertIn("Failed to fetch", refused)
        errors = self.browser.console_errors()
        self.assertTrue(any("Content Security Policy" in message for message in errors), errors)
        self.assertEqual(self.end()[0], 130)


if __name__ == "__main__":
    os.environ.pop("DISPLAY", None)
    run_tests(Watch)
