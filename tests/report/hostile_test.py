"""Tests reports of maliciously written files: markup, scripts, marks of writing direction, emoji,
control characters, invalid UTF-8 and very long words in every text that a page shows. The pages are
opened in a headless Chromium.

hostile_test.py PROGRAM PICTURES [I/N] [unittest's options]
"""

import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from pages import PICTURES, PROGRAM, PageTest, has_video, run_tests  # noqa: E402

SCENARIO = """schema: 1
name: corner
mission: {speed: 3, waypoints: [[0, 0], [30, 0], [30, 30]]}
plan: {method: fillet}
control: {method: preview, distance: 2.5}
expect: {reach_goal: 0.5, max_cross_track: 2.5, between: [{plants: [kinematic, mujoco], position_max: 2}]}
"""

STUDY = """schema: 1
name: fast
scenario: corner.yaml
set: {drive.plants: [kinematic], drive.time_limit: 2, expect: {}}
vary: {control.distance: [2, 3], mission.speed: [2, 4]}
outputs: [metrics.kinematic.distance, plan.status]
"""

# Each script sets `hacked` if it runs. No script contains a slash, so that each script can be a
# file name.
SCRIPTS = {
    "script": "<script>hacked=1",
    "image": '"><img src=x onerror="hacked=2">',
    "handler": "' onmouseover='hacked=3' autofocus onfocus='hacked=3",
    "vector": "<svg onload=hacked=4><animate onbegin=hacked=4>",
    "link": "<a href=javascript:hacked=5>javascript:hacked=5<iframe src=javascript:hacked=5>",
    "template": "${hacked=6}{{hacked=6}}`+hacked+`\\u003cscript\\u003e &lt;b&gt; &amp;",
    "refresh": "<meta http-equiv=refresh content='0;url=data:text,x'><base href=x><style>*{display:none}",
}
ENDINGS = "</script></title></style></pre><!--<script>hacked=7</script><script>hacked=8</script>"
UNSEEN = {
    "\u202e": "<U+202E>", "\u2066": "<U+2066>", "\u200f": "<U+200F>", "\u061c": "<U+061C>",
    "\u200b": "<U+200B>", "\u2028": "<U+2028>", "\ufeff": "<U+FEFF>", "\x00": "<U+0000>",
    "\x1b": "<U+001B>", "\x07": "<U+0007>", "\r": "<U+000D>", "\x7f": "<U+007F>",
}  # fmt: skip
SEEN = "\u05e9\u05dc\u05d5\u05dd \u0633\u0644\u0627\u0645 \U0001f469\u200d\U0001f680 \u2764\ufe0f e\u0301 \u4f60\u597d"
WORD = "w" * 4000


def hostile(number, slash=True):
    """A hostile text, different for each number."""
    middle = (ENDINGS if slash else "") + "".join(SCRIPTS.values())
    return f"{number}:{middle}{''.join(UNSEEN)}{SEEN}"


def file_name(number):
    """A hostile file name, of at most 255 bytes and without a slash."""
    return f"{number}'\"><img src=x onerror=hacked=9><svg onload=hacked=9>\u202e\u2066\u200f\x1b\x07\n{SEEN}#?%41&amp;"


def visible(text):
    for mark, name in UNSEEN.items():
        text = text.replace(mark, name)
    return text


def copy_of_a_result(source, target):
    """Removes the manifest, which would detect edits of the run."""
    shutil.copytree(source, target)
    manifest = os.path.join(target, os.fsencode("manifest.json") if isinstance(target, bytes) else "manifest.json")
    if os.path.exists(manifest):
        os.remove(manifest)


class HostileReports(PageTest):
    @classmethod
    def make_inputs(cls):
        (cls.root / "corner.yaml").write_text(SCENARIO)
        cls.trackbed("run", "-q", "corner.yaml", "-o", "plain")
        cls.trackbed("compare", "-q", "plain", "plain", "-o", "compared", "--tolerance", "position=1")
        (cls.root / "study.yaml").write_text(STUDY)
        cls.trackbed("sweep", "-q", "study.yaml", "-o", "study")

    def change(self, file, **entries):
        content = json.loads(file.read_text())
        content.update(entries)
        file.write_text(json.dumps(content))
        return content

    def hostile_run(self, folder):
        """Makes a run in which every text is hostile. Returns the texts as a page should show them."""
        run = self.root / folder
        copy_of_a_result(self.root / "plain", run)
        texts = {}

        def text(place, slash=True):
            texts[place] = hostile(len(texts), slash)
            return texts[place]

        metrics = json.loads((run / "metrics.json").read_text())
        entry = metrics["plants"]["mujoco"]
        entry[text("metric")] = text("value of a metric")
        for check in metrics["verdict"]["checks"][:1]:
            check.update(
                plant=text("plant of a check"), metric=text("metric of a check"),
                bound=text("bound"), value=text("found"),
            )  # fmt: skip
        metrics["verdict"].update(failures=[text("failure")], notes=[text("note"), WORD])
        metrics["versions"] = {key: text(key) for key in metrics["versions"]}
        metrics["between"][0]["plants"] = ["kinematic", text("plant of a pair")]
        metrics["between"][0][text("metric of a pair")] = 1.5
        metrics["scenario"] = text("scenario")
        (run / "metrics.json").write_text(json.dumps(metrics))
        self.change(run / "plan.json", method=text("method"))
        model = run / "model.xml"
        named = model.read_text().replace('model="prius"', 'model="&lt;img src=x onerror=hacked=1&gt;&#x202E;"', 1)
        self.assertIn("hacked", named)
        texts["car"] = "<img src=x onerror=hacked=1>\u202e"
        model.write_text(named)
        resolved = run / "scenario.resolved.yaml"
        # YAML allows no control characters.
        texts["comment"] = "# " + ENDINGS + "".join(SCRIPTS.values()) + "\u202e\u2066" + SEEN
        resolved.write_text(resolved.read_text() + texts["comment"] + "\n")
        texts["folder"] = pathlib.Path(folder).name
        return run, {place: visible(text) for place, text in texts.items()}

    def shown(self):
        return self.browser.run("return document.body.textContent")

    def assert_harmless(self):
        """Checks that no script ran, nothing was requested, the page has only its own elements, and the
        console is empty."""
        run = self.browser.run
        self.assertIsNone(run("return typeof hacked === 'undefined' ? null : hacked"))
        self.assertEqual(
            run(
                "return Array.from(document.querySelectorAll('body img:not(#replay .still), iframe, base, a, form,"
                " object, embed, animate, #report script, #report style, #report meta,"
                " [onerror], [onload], [onfocus], [onmouseover]')).map(e => e.outerHTML)"
            ),
            [],
        )
        # Three scripts with code, one with data and one with licenses, and three more for a replay.
        scripts = run("return typeof THREE === 'undefined' ? 5 : 8")
        self.assertEqual(run("return document.scripts.length"), scripts)
        self.assertEqual(self.browser.console_errors(), [])
        for url in self.browser.loaded():
            self.assertRegex(url, r"^(file://.*\.(html|mp4)$|data:|blob:|chrome:)", url[:100])
        wide, screen = run("return [document.documentElement.scrollWidth, window.innerWidth]")
        self.assertLessEqual(wide, screen)

    def hover_everything(self):
        """Unfolds everything and points at every element, to trigger handlers in attributes."""
        self.browser.run(
            "for (const e of document.querySelectorAll('details')) e.open = true;"
            "for (const e of document.querySelectorAll('#report *'))"
            "  for (const kind of ['mouseenter', 'mouseover', 'focus'])"
            "    e.dispatchEvent(new MouseEvent(kind));"
        )
        self.browser.settle()

    def check(self, page, texts, picture):
        self.browser.open(self.root / page)
        self.hover_everything()
        everything = self.shown() + " ".join(
            self.browser.run(
                "return Array.from(document.querySelectorAll('[title], [aria-label]'))"
                ".flatMap(e => [e.title || '', e.getAttribute('aria-label') || ''])"
            )
        )
        for place, text in texts.items():
            self.assertIn(text, everything, place)
        self.assert_harmless()
        self.browser.picture(PICTURES / f"hostile-{picture}.png")
        self.browser.open(self.root / page, width=390, height=844)
        self.assert_harmless()

    def test_run(self):
        run, texts = self.hostile_run(file_name(1))
        self.trackbed("report", run.name, "-o", "run.html")
        self.check("run.html", texts, "run")
        self.assertEqual(self.browser.run("return document.title"), texts["folder"].replace("\n", " "))
        self.assertEqual(self.browser.run("return document.querySelector('h1').textContent"), texts["scenario"])

    def test_runs_side_by_side(self):
        first, texts = self.hostile_run("a/" + file_name(2))
        second, _ = self.hostile_run("b/" + file_name(2))
        del texts["scenario"], texts["car"], texts["folder"]
        texts["folders"] = f"a/{visible(first.name)}"
        self.trackbed("report", str(first), str(second), "-o", "side.html")
        self.check("side.html", texts, "side")

    def test_comparison(self):
        first, _ = self.hostile_run("first " + file_name(3))
        second, _ = self.hostile_run("second " + file_name(3))
        compared = self.root / file_name(4)
        copy_of_a_result(self.root / "compared", compared)
        texts = {"failure": hostile(1), "note": hostile(2), "first": first.name, "second": second.name}
        content = json.loads((compared / "compare.json").read_text())
        content["runs"] = [f"../{first.name}", f"../{second.name}"]
        content["verdict"].update(failures=[texts["failure"]], notes=[texts["note"]])
        (compared / "compare.json").write_text(json.dumps(content))
        self.trackbed("report", compared.name, "-o", "compared.html")
        self.check("compared.html", {place: visible(text) for place, text in texts.items()}, "comparison")

    def test_study(self):
        study = self.root / file_name(5)
        copy_of_a_result(self.root / "study", study)
        texts = {name: hostile(i) for i, name in enumerate(("study", "scenario", "trackbed", "physics"))}
        self.change(
            study / "sweep.json", study=texts["study"], scenario=texts["scenario"],
            versions={"trackbed": texts["trackbed"], "physics": texts["physics"]},
        )  # fmt: skip
        with open(study / "sweep.csv", newline="") as lines:
            rows = list(csv.reader(lines))
        # Names and values of a parameter, of the status and of an output; the text also occurs as a
        # value.
        column = rows[0].index("mission.speed")
        printable = {place: "".join(c for c in text if c not in "\x00\r") for place, text in texts.items()}
        texts["parameter"], texts["value"], texts["state"], texts["output"] = (
            f"{i} {printable['study']}" for i in range(4)
        )
        rows[0][column] = texts["parameter"]
        for i, row in enumerate(rows[1:]):
            row[column] = texts["value"] if i % 2 else WORD
        rows[1][rows[0].index("status")] = texts["state"]
        rows[0][rows[0].index("metrics.kinematic.distance")] = texts["output"]
        with open(study / "sweep.csv", "w", newline="") as lines:
            csv.writer(lines, lineterminator="\n").writerows(rows)
        self.trackbed("report", study.name, "-o", "study.html")
        self.check("study.html", {place: visible(text) for place, text in texts.items()}, "study")
        # The tooltip of a dot names its row.
        self.browser.open(self.root / "study.html")
        self.browser.run("document.querySelector('.dots circle').dispatchEvent(new MouseEvent('mouseenter'))")
        tip = self.browser.run("return document.querySelector('.tooltip').textContent")
        self.assertIn(visible(texts["parameter"]), tip)
        self.assert_harmless()
        # A table alone is named after its file.
        alone = self.root / (file_name(6) + ".csv")
        shutil.copy(study / "sweep.csv", alone)
        self.trackbed("report", alone.name, "-o", "table.html")
        self.check("table.html", {"name": visible(alone.stem)}, "table")

    def test_bytes_that_are_no_text(self):
        run = os.path.join(os.fsencode(self.root), b"latin \xe9 \xff\xc0\xaf<b>")
        copy_of_a_result(os.fsencode(self.root / "plain"), run)
        with open(os.path.join(run, b"metrics.json"), "rb") as file:
            text = file.read()
        # JSON with invalid UTF-8 is rejected with a message.
        with open(os.path.join(run, b"metrics.json"), "wb") as file:
            file.write(text.replace(b'"corner"', b'"c\xf6rner"', 1))
        refused = subprocess.run(
            [PROGRAM, "report", run, "-o", "bytes.html"], cwd=self.root, capture_output=True, check=False
        )
        self.assertEqual(refused.returncode, 2)
        self.assertIn(b"ill-formed UTF-8 byte", refused.stderr)
        with open(os.path.join(run, b"metrics.json"), "wb") as file:
            file.write(text)
        subprocess.run([PROGRAM, "report", run, "-o", "bytes.html"], cwd=self.root, check=True)
        self.check("bytes.html", {"folder": "latin \ufffd \ufffd\ufffd<b>"}, "bytes")

    def test_film_beside_a_hostile_name(self):
        if not has_video():
            self.skipTest("built without video")
        run, _ = self.hostile_run(file_name(8))
        shutil.rmtree(run)
        copy_of_a_result(self.root / "plain", run)
        self.trackbed("render", "-q", run.name, "--size", "64x64", "--fps", "5")
        self.trackbed("report", run.name, "--film", "beside", "-o", "beside.html")
        self.browser.open(self.root / "beside.html")
        self.browser.driver.execute_async_script(
            "const done = arguments[0]; const video = document.querySelector('video');"
            "if (video.readyState > 0) done(); else video.addEventListener('loadedmetadata', () => done());"
        )
        self.assertGreater(self.browser.run("return document.querySelector('video').duration"), 1)
        self.assert_harmless()

    def test_every_text_of_the_data(self):
        """All texts in the data of a page, including those that the program would reject, such as
        names of unknown plants."""
        for name in ("first", "second"):
            copy_of_a_result(self.root / "plain", self.root / "every" / name)
        judged = self.root / "every/judged"
        copy_of_a_result(self.root / "compared", judged)
        self.change(judged / "compare.json", runs=["../first", "../second"])
        for path in ("plain", "every/judged", "study"):
            self.trackbed("report", path, "-o", "every.html")
            page = (self.root / "every.html").read_text()
            begin = page.index('id="data">') + len('id="data">')
            end = page.index("</script>", begin)
            texts = {}
            drawn = set()  # appears only in the 3D scene, not as text

            def changed(value, place, texts=texts, drawn=drawn):
                if isinstance(value, dict):
                    return {key: changed(entry, f"{place}.{key}") for key, entry in value.items()}
                if isinstance(value, list):
                    return [changed(entry, f"{place}[{i}]") for i, entry in enumerate(value)]
                if not isinstance(value, str) or place.endswith((".plan.status", ".kind")):
                    return value
                # Equal texts must stay equal, because the page matches runs by the names of their
                # plants.
                texts.setdefault(value, f"{len(texts)}:{ENDINGS}{''.join(SCRIPTS.values())}{SEEN}")
                if re.search(r"\.(motion|vehicle|ground)\b", place):
                    drawn.add(texts[value])
                return texts[value]

            data = changed(json.loads(page[begin:end]), "")
            self.assertGreater(len(texts), 15)
            script = json.dumps(data).replace("<", "\\u003c")
            (self.root / "every.html").write_text(page[:begin] + script + page[end:])
            self.browser.open(self.root / "every.html")
            self.hover_everything()
            self.assert_harmless()
            shown = self.shown()
            said = set(texts.values()) - drawn
            self.assertGreater(sum(text in shown for text in said), 0.5 * len(said))
            self.browser.picture(PICTURES / f"hostile-every-{path.split('/')[0]}.png")

    # The Content-Security-Policy is a second protection against scripts in inputs.

    def test_policy_refuses_what_the_page_does_not_have(self):
        self.trackbed("report", "plain", "-o", "policy.html")
        page = (self.root / "policy.html").read_text()
        attacks = {
            "script-src-elem": ["<script>hacked=1</script>", "<script src=https://a.invalid/x.js></script>"],
            "script-src-attr": ["<img src=data:, onerror=hacked=2>", "<svg onload=hacked=2></svg>"],
            "img-src": ["<img src=https://a.invalid/x.png>", "<img src=x.png>"],
            "style-src-elem": ["<style>*{display:none}</style>", "<link rel=stylesheet href=https://a.invalid/x.css>"],
            "style-src-attr": ["<p style='background:url(https://a.invalid/x)'></p>"],
            "frame-src": ["<iframe src=https://a.invalid></iframe>", "<iframe src=data:text/html,x></iframe>"],
            "object-src": ["<object data=https://a.invalid/x></object>", "<embed src=https://a.invalid/x>"],
            "base-uri": ["<base href=https://a.invalid>"],
            "media-src": ["<video src=https://a.invalid/x></video>"],
        }
        markup = "".join(text for texts in attacks.values() for text in texts)
        (self.root / "attacked.html").write_text(page.replace("<body>", "<body>" + markup, 1))
        # Scripts of the browser's driver are not subject to the policy.
        listener = self.browser.driver.execute_cdp_cmd(
            "Page.addScriptToEvaluateOnNewDocument",
            {
                "source": "window.refused = []; document.addEventListener('securitypolicyviolation',"
                " (e) => refused.push(e.effectiveDirective));"
            },
        )
        self.browser.open(self.root / "attacked.html")
        self.browser.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", listener)
        refused = self.browser.run("return refused")
        self.assertEqual(
            {directive: refused.count(directive) for directive in set(refused)},
            {directive: len(texts) for directive, texts in attacks.items()},
        )
        self.assertIsNone(self.browser.run("return typeof hacked === 'undefined' ? null : hacked"))
        for url in self.browser.loaded():
            self.assertRegex(url, r"^(file://.*/attacked\.html$|data:|chrome:)", url[:100])
        # The page's own script could not load anything either, even if it were tricked into trying.
        violated = self.browser.driver.execute_async_script(
            "const done = arguments[0]; refused.length = 0;"
            "fetch('https://a.invalid/x').catch(() => {});"
            "try { new WebSocket('wss://a.invalid'); } catch (e) {}"
            "navigator.sendBeacon('https://a.invalid/x');"
            "try { new Worker('data:,'); } catch (e) {}"
            "const link = document.createElement('a'); link.href = 'javascript:hacked=1';"
            "document.body.append(link); link.click();"
            "const form = document.createElement('form'); form.action = 'https://a.invalid';"
            "document.body.append(form); form.submit();"
            "setTimeout(() => done(refused), 500);"
        )
        self.assertEqual(violated.count("connect-src"), 3, violated)
        for directive in ("worker-src", "script-src-elem", "form-action"):
            self.assertIn(directive, violated)
        self.assertIsNone(self.browser.run("return typeof hacked === 'undefined' ? null : hacked"))
        for url in self.browser.loaded():
            self.assertRegex(url, r"^(file|data|chrome):", url[:100])
        self.browser.console_errors()


if __name__ == "__main__":
    run_tests(HostileReports)
