"""Tests the accessibility of reports: contrast in both color schemes, names of drawn elements, tick labels at
their grid lines, reduced motion, and print.

access_test.py PROGRAM PICTURES [I/N] [unittest's options]: writes pictures of the pages to the folder PICTURES.
"""

import base64
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from pages import PICTURES, PageTest, run_tests  # noqa: E402

# A patch of ice that makes the car leave the road, an obstacle that becomes known late, and a
# failed expectation.
SCENARIO = """schema: 1
name: corner
vehicle: {tyre: magic_formula}
mission: {speed: %s, waypoints: [[0, 0], [30, 0], [30, 30]]}
world:
  friction_patches: [{x: 25, y: 4, yaw: 0.785, length: 6, width: 12, friction: 0.1}]
  obstacles: [{box: {x: 5, y: 12, length: 3, width: 1.5}, known_from: {time: 1}}]
plan: {method: fillet, infeasible: allow}
control: {method: preview, distance: 2.5}
expect: {max_cross_track: %s}
"""

STUDY = """schema: 1
name: fast
scenario: slow.yaml
set: {drive.plants: [kinematic], expect.max_cross_track: 0.1}
vary:
  control.distance: [2, 3]
  mission.speed: [2, 4, 3]
outputs: [metrics.kinematic.cross_track.max, metrics.kinematic.time]
"""

SEARCH = """schema: 1
name: limit
scenario: slow.yaml
set: {drive.plants: [kinematic], expect.max_cross_track: 0.1}
vary:
  control.distance: {distribution: uniform, from: 1, to: 6}
  mission.speed: {distribution: uniform, from: 1, to: 5}
nominal: {control.distance: 1, mission.speed: 1}
search: {runs: 20, method: latin_hypercube}
"""

# Contrast of every visible text with its background (WCAG 2.2, 1.4.3).
CONTRASTS = """
const parsed = (css) => {
  const [r, g, b, a = 1] = css.match(/[\\d.]+/g).map(Number);
  return {rgb: [r, g, b], a};
};
const over = (top, below) => top.rgb.map((c, i) => top.a * c + (1 - top.a) * below[i]);
const ground = (element) => {
  const chain = [];
  for (let e = element; e; e = e.parentElement) chain.push(parsed(getComputedStyle(e).backgroundColor));
  return chain.reverse().reduce((below, color) => over(color, below), [255, 255, 255]);
};
const luminance = (rgb) => {
  const [r, g, b] = rgb.map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const found = [];
const walker = document.createTreeWalker(document.querySelector('main'), NodeFilter.SHOW_TEXT);
while (walker.nextNode()) {
  const element = walker.currentNode.parentElement;
  const text = walker.currentNode.textContent.trim();
  if (!text || !element.getClientRects().length || ['OPTION', 'TITLE'].includes(element.tagName.toUpperCase())) continue;
  const style = getComputedStyle(element);
  if (style.visibility === 'hidden') continue;
  const below = ground(element);
  const color = parsed(element.namespaceURI.endsWith('svg') ? style.fill : style.color);
  const [a, b] = [over(color, below), below].map(luminance).sort((x, y) => y - x);
  found.push([(a + 0.05) / (b + 0.05), text.slice(0, 40), style.fontSize]);
}
return found;
"""


class Access(PageTest):
    @classmethod
    def make_inputs(cls):
        # Failed and passed runs have different colors.
        for name, speed, most, code in (("slow", 4, 0.01, 3), ("quick", 4.5, 0.01, 3), ("good", 2, 5, 0)):
            (cls.root / f"{name}.yaml").write_text(SCENARIO % (speed, most))
            cls.trackbed("run", "-q", f"{name}.yaml", "-o", name, code=code)
        (cls.root / "study.yaml").write_text(STUDY)
        cls.trackbed("sweep", "-q", "study.yaml", "-o", "study", code=None)
        (cls.root / "search.yaml").write_text(SEARCH)
        cls.trackbed("falsify", "-q", "search.yaml", "-o", "search", code=3)
        cls.trackbed("report", "search", "-o", "search.html")
        cls.trackbed("report", "slow", "-o", "run.html")
        cls.trackbed("report", "slow", "quick", "-o", "runs.html")
        cls.trackbed("report", "study", "-o", "study.html")
        cls.trackbed("report", "good", "-o", "good.html")

    def check_contrast(self, *pages):
        for page in pages:
            for dark in (False, True):
                with self.subTest(page=page, dark=dark):
                    self.open(page, dark=dark)
                    found = self.browser.run(CONTRASTS)
                    self.assertGreater(len(found), 40)
                    self.assertEqual([f for f in found if f[0] < 4.5], [])
                    self.browser.picture(PICTURES / f"access_{page[:-5]}_{'dark' if dark else 'light'}.png")

    def test_contrast_of_runs(self):
        self.check_contrast("run.html", "good.html")

    def test_contrast_of_several_runs(self):
        self.check_contrast("runs.html")

    def test_contrast_of_studies(self):
        self.check_contrast("study.html", "search.html")

    def test_what_is_drawn_has_a_name(self):
        for page in ("run.html", "runs.html", "study.html", "search.html"):
            self.open(page)
            unnamed = self.browser.run(
                """
                const named = (e) => e.closest('[aria-hidden=true], [role=img][aria-label], [role=group][aria-label]')
                  || e.closest('.sign, .readout, .pair-sign, th');
                return Array.from(document.querySelectorAll('main svg, main canvas, main video'))
                  .filter((e) => !named(e)).map((e) => e.outerHTML.slice(0, 200));
                """
            )
            self.assertEqual(unnamed, [], page)
            nameless = self.browser.run(
                """
                return Array.from(document.querySelectorAll('button, input, select, [role=button]'))
                  .filter((e) => e.getClientRects().length && !(e.getAttribute('aria-label') || e.textContent.trim() || e.closest('label')))
                  .map((e) => e.outerHTML.slice(0, 200));
                """
            )
            self.assertEqual(nameless, [], page)
            self.assertEqual(self.browser.run("return document.querySelectorAll('main').length"), 1)
            self.assertEqual(self.browser.run("return document.querySelectorAll('h1').length"), 1)
            self.assertTrue(self.browser.run("return document.documentElement.lang"))

    def test_events_are_reached_by_keys(self):
        self.open("run.html")
        moment = self.browser.run(
            """
            const mark = document.querySelector('.event-track .event.known');
            mark.focus();
            mark.dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter', bubbles: true}));
            return now;
            """
        )
        self.assertEqual(moment, 1.0)

    def test_tick_labels_stand_at_their_grid_lines(self):
        for width in (1280, 390):
            self.open("run.html", width=width, height=900)
            off = self.browser.run(
                """
                const off = [];
                const check = (plot, graph) => {
                  const at = plot.getBoundingClientRect();
                  for (const label of plot.querySelectorAll('.dygraph-axis-label-x, .dygraph-axis-label-y')) {
                    const isX = label.classList.contains('dygraph-axis-label-x');
                    const value = parseFloat(label.textContent.replace('\\u2212', '-'));
                    const range = document.createRange();
                    range.selectNodeContents(label);
                    const box = range.getBoundingClientRect();
                    const away = isX ? (box.left + box.right) / 2 - at.left - graph.toDomXCoord(value)
                      : (box.top + box.bottom) / 2 - at.top - graph.toDomYCoord(value);
                    // A label is set to whole pixels, and its letters do not fill its line evenly.
                    if (Math.abs(away) > 3) off.push([label.textContent, away, isX]);
                  }
                };
                for (const plot of document.querySelectorAll('.chart .plot')) check(plot, graphs.get(plot));
                // Moves the grid lines of one chart over its whole height, so that some pass close to both edges.
                const plot = document.querySelector('.chart .plot');
                const graph = graphs.get(plot);
                const [low, high] = graph.yAxisRange();
                for (let step = 1; step <= 60; ++step) {
                  const shift = step / 60 * (high - low);
                  graph.updateOptions({drawCallback: null, valueRange: [low + shift, high + shift]});
                  check(plot, graph);
                }
                return off;
                """
            )
            self.assertEqual(off, [])
            inside = self.browser.run(
                """
                return Array.from(document.querySelectorAll('.plots svg, .map svg')).flatMap((svg) => {
                  const frame = svg.getBoundingClientRect();
                  return Array.from(svg.querySelectorAll('text')).map((text) => [text.textContent, text.getBoundingClientRect()])
                    .filter(([, box]) => box.width > 0 && (box.left < frame.left - 0.5 || box.right > frame.right + 0.5
                      || box.top < frame.top - 0.5 || box.bottom > frame.bottom + 0.5)).map(([text]) => text);
                });
                """
            )
            self.assertEqual(inside, [])

    def test_less_motion(self):
        self.open("run.html")
        self.browser.driver.execute_cdp_cmd(
            "Emulation.setEmulatedMedia", {"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]}
        )
        moving = self.browser.run(
            """
            const scale = () => Number(document.querySelector('.map svg').getAttribute('data-scale'));
            const before = scale();
            document.querySelector('.map .zoom button[aria-label="Zoom in"]').click();
            return Array.from(document.querySelectorAll('main *')).filter((e) => {
              const { transitionDuration, animationName } = getComputedStyle(e);
              return parseFloat(transitionDuration) > 0 || animationName !== 'none';
            }).length;
            """
        )
        self.assertEqual(moving, 0)
        self.browser.settle()
        # Nothing plays automatically.
        self.assertEqual(self.browser.run("return playback.timer"), None)

    def test_paper(self):
        self.open("run.html", width=1280, height=900)
        printed = self.browser.driver.execute_cdp_cmd(
            "Page.printToPDF", {"printBackground": True, "paperWidth": 8.27, "paperHeight": 11.69}
        )
        pdf = PICTURES / "access_run.pdf"
        pdf.write_bytes(base64.b64decode(printed["data"]))
        self.assertGreater(pdf.stat().st_size, 20_000)
        still = self.browser.run("return document.querySelector('.replay .still').src.length")
        self.assertGreater(still, 10_000)


if __name__ == "__main__":
    run_tests(Access)
