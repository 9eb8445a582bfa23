"""Tests reports of searches in a browser.

search_test.py PROGRAM PICTURES [I/N] [unittest's options]: writes pictures of the pages to the folder PICTURES.
"""

import csv
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from pages import PICTURES, PageTest, run_tests  # noqa: E402

SCENARIO = """schema: 1
name: corner
mission: {speed: 2, waypoints: [[0, 0], [30, 0], [30, 30]]}
plan: {method: fillet, infeasible: allow}
control: {method: preview, distance: 2.5}
"""

# Placeholders: the expectation, a key's distribution, and the number of runs.
SEARCH = """schema: 1
name: limit
scenario: corner.yaml
set: {drive.plants: [kinematic], expect.max_cross_track: %s}
vary:
  control.distance: {distribution: %s, from: 1, to: 6}
  mission.speed: {distribution: integer, from: 1, to: 4}
nominal: {control.distance: 1, mission.speed: 2}
search: {runs: %d, method: latin_hypercube, stop: false}
outputs: [metrics.kinematic.time]
"""

HOSTILE = "<b>&\"'</script><script>document.title = 'hacked'</script>"


class Searches(PageTest):
    webgl = False

    @classmethod
    def make_inputs(cls):
        (cls.root / "corner.yaml").write_text(SCENARIO)
        (cls.root / "printed").write_text(cls.search("broken", 0.2, "uniform", 40, code=3))
        cls.search("kept", 30, "log_uniform", 7, code=0)

    @classmethod
    def search(cls, name, most, distribution, runs, code):
        (cls.root / f"{name}.yaml").write_text(SEARCH % (most, distribution, runs))
        return cls.trackbed("falsify", f"{name}.yaml", "-o", name, "--report", code=code)

    def run_in_page(self, script, *arguments):
        return self.browser.run(script, *arguments)

    def text(self, selector):
        return self.run_in_page("return document.querySelector(arguments[0]).textContent", selector)

    def texts(self, selector):
        return self.run_in_page(
            "return Array.from(document.querySelectorAll(arguments[0])).map(e => e.textContent)", selector
        )

    def attributes(self, selector, name):
        return self.run_in_page(
            "return Array.from(document.querySelectorAll(arguments[0])).map(e => e.getAttribute(arguments[1]))",
            selector, name,
        )  # fmt: skip

    def rows(self, name):
        with open(self.root / name / "sweep.csv", newline="") as lines:
            return list(csv.DictReader(lines))

    def outcome(self, name):
        return json.loads((self.root / name / "falsify.json").read_text())

    def test_says_what_the_terminal_says(self):
        self.open("broken/report.html")
        printed = (self.root / "printed").read_text()
        found = self.outcome("broken")
        verdict = f"broken: {found['violations']} of {found['runs']} runs failed"
        self.assertIn(verdict, printed)
        self.assertEqual(self.text("#verdict"), verdict)
        self.assertIn("bad", self.attributes("#verdict", "class")[0])
        reason = found["counterexample"]["reason"]
        self.assertIn(reason, printed)
        self.assertEqual(self.text("#answer .reason"), reason)
        answer = self.text("#answer")
        self.assertIn(f"Runs to make it smaller{found['shrink_runs']}", answer)
        self.assertIn("broken/counterexample/counterexample.yaml", answer)
        self.assertIn(f"--row {found['counterexample']['row']} --video --report", answer)
        # For each key, the page shows the values of the key's line in the terminal output, and the
        # key's range.
        for key in ("control.distance", "mission.speed"):
            line = rf"^ *{re.escape(key)} +(\S+) +(\S+) +(\S+) +(\S+ to \S+|-) +(\S+)$"
            nominal, fails, holds, alone, sensitivity = re.search(line, printed, re.M).groups()
            cells = [text.replace("−", "-").replace("–", "-") for text in self.texts(f"#margins [data-key='{key}'] td")]
            self.assertEqual(cells[:4], [nominal, fails, holds, alone], key)
            if sensitivity == "-":
                self.assertEqual(cells[4], "-")
            else:  # three digits of five
                self.assertAlmostEqual(float(cells[4]), float(sensitivity), delta=0.005 * abs(float(sensitivity)) + 5e-5)
        self.assertEqual(self.texts("#margins tbody th"), ["control.distance [m]", "mission.speed [m/s]"])
        # The points of a search are not a sample.
        for section in ("#pass-rate", "#influence", "#distributions", "#correlations"):
            self.assertEqual(self.texts(section), [])
        self.assertEqual(self.run_in_page("return document.querySelector('#worst-order').selectedOptions[0].text"), "lowest")
        self.browser.picture(PICTURES / "search.png")

    def test_history(self):
        self.open("broken/report.html")
        rows = self.rows("broken")
        self.assertEqual(self.attributes("#history .runs .run", "data-phase"), [row["phase"] for row in rows])
        self.assertEqual({row["phase"] for row in rows}, {"nominal", "search", "shrink"})
        failed = [i for i, row in enumerate(rows) if row["status"] == "failed"]
        self.assertEqual([int(i) for i in self.attributes("#history .run.failed[data-row]", "data-row")], failed)
        places = [
            [float(number) for number in re.findall(r"-?[\d.]+", text)]
            for text in self.attributes("#history .runs .run", "transform")
        ]
        zero = float(re.match(r"M[\d.]+ ([\d.]+)H", self.attributes("#history figure .zero", "d")[0]).group(1))
        # Points go from left to right, with lower values lower, and failed ones below the line of
        # 0.
        self.assertEqual([x for x, _ in places], sorted(x for x, _ in places))
        values = [float(row["robustness"]) for row in rows]
        order = sorted(range(len(rows)), key=lambda i: values[i])
        heights = [places[i][1] for i in order]
        self.assertEqual(heights, sorted(heights, reverse=True))
        for (_, y), value in zip(places, values):
            self.assertEqual(y > zero, value < 0, value)
        # The line of the lowest value so far ends at the lowest run of the search.
        line = re.findall(r"[ML]([\d.]+),([\d.]+)", self.attributes("#history figure .best", "d")[0])
        searched = self.outcome("broken")["runs"]
        self.assertAlmostEqual(float(line[-1][1]), max(y for _, y in places[:searched]), delta=0.01)
        self.assertAlmostEqual(float(line[-1][0]), places[searched - 1][0], delta=0.01)
        ring = [float(self.attributes("#history figure .ring", name)[0]) for name in ("cx", "cy")]
        found = places[self.outcome("broken")["counterexample"]["row"]]
        self.assertAlmostEqual(ring[0], found[0], delta=0.01)
        self.assertAlmostEqual(ring[1], found[1], delta=0.01)

    def test_hovering_tells_of_a_run(self):
        self.open("broken/report.html")
        for mark in ("#history .runs .run[data-row='3']", "#coverage [data-output='control.distance'] .tick-of[data-row='3']"):
            box = self.run_in_page(
                "const e = document.querySelector(arguments[0]); e.scrollIntoView({block: 'center'});"
                "const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]", mark,
            )  # fmt: skip
            self.browser.driver.execute_cdp_cmd(
                "Input.dispatchMouseEvent", {"type": "mouseMoved", "x": box[0], "y": box[1]}
            )
            self.browser.settle()
            self.assertIn("row3phasesearchcontrol.distance [m]", self.text(".tooltip"))
            self.assertEqual(self.attributes("#table tr.chosen", "data-row"), ["3"])
            self.assertEqual(self.attributes("#history .run.chosen", "data-row"), ["3"])

    def test_coverage(self):
        self.open("broken/report.html")
        rows = self.rows("broken")
        tenths = {min(9, int((float(row["control.distance"]) - 1) / 5 * 10)) for row in rows}
        speeds = {int(row["mission.speed"]) for row in rows}
        self.assertEqual(
            self.text("#coverage .sentence"),
            f"Runs were in {len(tenths)} of 10 equal intervals of control.distance, {len(speeds)} of 4 of mission.speed.",
        )
        self.assertEqual(len(self.attributes("[data-output='control.distance'] .cell.tried", "x")), len(tenths))
        self.assertEqual(len(self.attributes("#coverage [data-output='mission.speed'] .cell", "x")), 4)
        self.assertEqual(len(self.attributes("#coverage [data-output='control.distance'] .tick-of", "d")), len(rows))
        # Each mark is above the axis tick of its run; the nominal point is row 0.
        for kind, row in (("point", 0), ("counterexample", self.outcome("broken")["counterexample"]["row"])):
            figure = "#coverage [data-output='control.distance']"
            mark = re.match(r"translate\(([\d.]+)", self.attributes(f"{figure} .sign-of.{kind}", "transform")[0]).group(1)
            tick = re.match(r"M([\d.]+)", self.attributes(f"{figure} .tick-of[data-row='{row}']", "d")[0]).group(1)
            self.assertAlmostEqual(float(mark), float(tick), delta=0.01)

    def test_map_is_of_the_robustness(self):
        self.open("broken/report.html")
        self.assertEqual(self.run_in_page("return document.querySelector('#map-of').selectedOptions[0].text"), "robustness")
        self.assertEqual(self.texts("#study-map figcaption"), ["Lowest robustness over control.distance [m] and mission.speed [m/s]"])
        self.assertEqual(len(self.attributes("#study-map .cell", "x")), 10 * 4)
        rows = self.rows("broken")
        cells = {(min(9, int((float(row["control.distance"]) - 1) / 5 * 10)), row["mission.speed"]) for row in rows}
        self.assertEqual(len(self.attributes("#study-map .cell:not(.none)", "x")), len(cells))
        self.assertEqual(
            self.attributes("#study-map figure .sign-of", "class"), ["sign-of point on-map", "sign-of counterexample on-map"]
        )

    def test_a_search_that_broke_nothing(self):
        for screen in ({}, {"width": 390, "height": 900}, {"dark": True}):
            self.open("kept/report.html", **screen)
            self.assertEqual(self.text("#verdict"), "not falsified in 8 runs")
            self.assertEqual(self.attributes("#verdict", "class"), ["badge plain"])
            least = self.outcome("kept")["least_robust"]
            self.assertIn(f"The nearest to it is row {least['row']}.", self.text("#answer"))
            self.assertIn("does not prove", self.text("#answer"))
            self.assertEqual(self.texts("#margins thead th"), ["Key", "Nominal", "Searched"])
            self.assertEqual(len(self.attributes("#coverage .sign-of.counterexample", "d")), 0)
            self.assertLessEqual(
                self.run_in_page("return document.documentElement.scrollWidth"), screen.get("width", 1440)
            )

    def test_sizes_far_apart(self):
        """From 0.5 to -86 the axis is logarithmic, and its label says so."""
        table = ["control.distance,mission.speed,status,robustness,limit,phase,reason"]
        for i, value in enumerate([0.5, 0.4, -0.5, 0.3, -86.3, 0.2, -0.4]):
            table.append(f"{1 + 0.1 * i},2,{'failed' if value < 0 else 'passed'},{value},car: y,{'search' if i else 'nominal'},")
        folder = self.root / "far"
        folder.mkdir()
        (folder / "sweep.csv").write_text("\n".join(table) + "\n")
        for name, changes in (("sweep.json", {}), ("falsify.json", {"runs": 7, "shrink_runs": 0})):
            content = json.loads((self.root / "broken" / name).read_text())
            content.update(changes)
            # The texts of the file are shown as text.
            if name == "falsify.json":
                content["counterexample"].update(row=2, reason=HOSTILE, limit=HOSTILE)
            (folder / name).write_text(json.dumps(content))
        self.trackbed("report", "far")
        self.open("far/report.html")
        self.assertEqual(self.text("#answer .reason"), HOSTILE)
        self.assertEqual(self.text("#history figure .axis-name"), "↑ robustness (logarithmic beyond ±0.1)")
        ticks = self.texts("#history figure .axis:nth-of-type(2) .tick text")
        self.assertEqual(ticks, ["−10", "−1", "−0.1", "0", "0.1"])
        y = [
            float(re.match(r"translate\([\d.]+ ([\d.]+)\)", text).group(1))
            for text in self.attributes("#history .runs .run", "transform")
        ]
        # On the logarithmic axis, ln(1 + 5) relates to ln(1 + 863) as 0.5 to 86.3.
        zero = float(re.match(r"M[\d.]+ ([\d.]+)H", self.attributes("#history figure .zero", "d")[0]).group(1))
        self.assertAlmostEqual((y[2] - zero) / (y[4] - zero), 1.7918 / 6.7616, delta=0.001)


if __name__ == "__main__":
    run_tests(Searches)
