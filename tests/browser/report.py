"""Looks at the reports of a run and of a study (see report.sh) with headless Chromium.

Numbers are compared with the run's own tables. How long it takes is printed, not tested; of any
report:  python3 report.py measure FILE.html"""

import csv
import json
import os
import pathlib
import sys
import tempfile

from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait

FLAGS = """--headless --no-sandbox --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader
--disable-quic --no-first-run --disable-background-networking --disable-component-update
--disable-sync --disable-default-apps""".split()

# How many pixels a canvas, the body's unless another is named, covers, and a number that depends
# on all of them.
PIXELS = """const c = document.createElement('canvas'), of = document.querySelector(arguments[0] || 'canvas');
c.width = of.width; c.height = of.height;
const d = c.getContext('2d'); d.drawImage(of, 0, 0);
const p = d.getImageData(0, 0, c.width, c.height).data;
let covered = 0, hash = 0;
for (let i = 0; i < p.length; i += 4) {
  if (p[i + 3]) covered++;
  hash = (hash * 31 + p[i] * 7 + p[i + 1] * 5 + p[i + 2]) % 2147483647;
}
return [covered / (c.width * c.height), hash];"""


class Page:
    """A browser of its own; anything the page complains of fails the test at its end."""

    def __init__(self, path, flags=()):
        options = webdriver.ChromeOptions()
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        for flag in [*FLAGS, *flags, "--user-data-dir=" + self.profile.name]:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.browser = webdriver.Chrome(options=options)
        self.url = pathlib.Path(path).absolute().as_uri()
        self.open(1200, False)

    def open(self, width, dark):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600})
        scheme = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": scheme})
        self.browser.get(self.url)
        # The charts are drawn again when their size is first seen, in the first frames painted.
        self.browser.execute_async_script("""const done = arguments[0];
            let left = 4;
            const frame = () => left-- ? requestAnimationFrame(frame) : done();
            frame();""")

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        log = [e for e in self.browser.get_log("browser") if e["level"] == "SEVERE"]
        self.browser.quit()
        assert kind or not log, log

    def js(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def all(self, selector):
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def texts(self, selector):
        """What elements say; at once, as a diagram may be drawn again at any time."""
        return self.js("return [...document.querySelectorAll(arguments[0])].map(e => e.textContent)", selector)

    def points(self, selector):
        """How many points each line of a diagram has."""
        return self.js("return [...document.querySelectorAll(arguments[0])].map(g => +g.dataset.points)",
                       selector + " .frame g.series")


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def drawn(run, name):
    """The table that the charts are of: with every step, if the run has left one."""
    fine = f"{run}/history.csv"
    return table(fine if name != "steps" and os.path.exists(fine) else f"{run}/{name}.csv")


def check_charts(page, run):
    rows = {name: drawn(run, name) for name in ("probes", "steps", "energy")}
    expected = {"probe-0": ("probes", 3), "probe-1": ("probes", 3), "step-size": ("steps", 1),
                "order": ("steps", 1), "error-estimate": ("steps", 1), "newton": ("steps", 1),
                "frame-angle": ("steps", 1), "energies": ("energy", 4), "balance": ("energy", 2)}
    charts = page.js("return Object.keys(corot.charts)")
    assert sorted(charts) == sorted(expected), charts
    for name, (source, nseries) in expected.items():
        points = page.points("#" + name)
        assert points == [len(rows[source])] * nseries, (name, points)
        for axis in ".tick.x", ".tick.y":
            labels = page.texts(f"#{name} {axis}")
            assert len(labels) >= 2 and all(labels), (name, axis, labels)
        titles = page.texts(f"#{name} text.label")
        assert all(titles), name
        label = titles[1]
        assert "[" in label or name in ("order", "newton", "error-estimate"), label  # has its unit
    # No point is left out of a line that is not crowded.
    path = page.find("#probe-0 g.series .line").get_attribute("d")
    if len(rows["probes"]) < 1000:
        assert path.count("L") + path.count("M") == len(rows["probes"])
    updates = sum(1 for r in rows["steps"] if "frames" in r["event"])
    assert updates > 10 and len(page.all("#frame-angle .frame .mark")) == updates


def check_pointer(page, run):
    rows = drawn(run, "probes")
    svg = page.find("#probe-0 .frame > svg")
    page.js("arguments[0].scrollIntoView({block: 'center'})", svg)
    at = lambda x: page.js("""const c = corot.charts['probe-0'], b = c.svg.getBoundingClientRect();
        return Math.round(c.across(arguments[0]) - b.width / 2)""", x)
    ActionChains(page.browser).move_to_element_with_offset(svg, at(0.5), 0).perform()
    tip = page.find("#probe-0 .tip").text
    shown = float(tip.split("t = ")[1].split("\n")[0])
    assert abs(shown - 0.5) < 0.01, tip
    row = min(rows, key=lambda r: abs(float(r["t"]) - shown))
    for c in "ux", "uy", "uz":
        shown = float(tip.split(c + ": ")[1].split("\n")[0])
        assert abs(shown - float(row["corner." + c])) <= 1e-4 * abs(shown), (tip, row)

    # Dragging zooms all charts over time, a double click shows all again.
    whole = page.js("return [corot.charts.energies.x.low, corot.charts.energies.x.high]")
    actions = ActionChains(page.browser).move_to_element_with_offset(svg, at(0.2), 0).click_and_hold()
    actions.move_to_element_with_offset(svg, at(0.6), 5).release().perform()
    low, high = page.js("return [corot.charts.energies.x.low, corot.charts.energies.x.high]")
    assert abs(low - 0.2) < 0.01 and abs(high - 0.6) < 0.01, (low, high)
    assert page.find("#step-size .reset").is_displayed()
    ActionChains(page.browser).double_click(svg).perform()
    assert page.js("return [corot.charts.energies.x.low, corot.charts.energies.x.high]") == whole

    button = page.find("#probe-0 .legend button")
    button.click()
    assert len(page.all("#probe-0 .frame g.series")) == 2
    button.click()
    assert len(page.all("#probe-0 .frame g.series")) == 3


def check_body(page, run):
    rows = table(f"{run}/probes.csv")
    assert page.js("return corot.body.t.length") == len(rows)
    # The surface has the probe's node: its displacement, to half a step of 65535.
    worst = page.js("""const b = corot.body, rows = arguments[0]; let worst = 0;
      for (let i = 0; i < b.nodes; i++) {
        const at = [0.1, 0.1, 0.4].every((x, c) => Math.abs(b.rest[3 * i + c] - x) < 1e-9);
        if (at) rows.forEach((u, k) => u.forEach((x, c) => {
          const m = b.moved[c];
          worst = Math.max(worst, Math.abs(m.low + m.step * m.q[k * b.nodes + i] - x) / m.step);
        }));
      }
      return worst;""", [[float(r["corner." + c]) for c in ("ux", "uy", "uz")] for r in rows])
    assert 0 < worst < 0.5001, worst

    slider, seen = page.find("#frame"), set()
    for frame in 0, len(rows) // 2, len(rows) - 1:
        page.js("""const s = arguments[0]; s.value = arguments[1]; s.dispatchEvent(new Event('input'))""", slider, frame)
        covered, picture = page.js(PIXELS)
        assert 0.02 < covered < 0.8, covered
        seen.add(picture)
        assert f"t = {float(rows[frame]['t']):g} s" in page.find(".player output").text
    assert len(seen) == 3
    canvas = page.find("canvas")
    page.js("arguments[0].scrollIntoView({block: 'center'})", canvas)
    ActionChains(page.browser).drag_and_drop_by_offset(canvas, 120, 30).perform()
    seen.add(page.js(PIXELS)[1])
    names = [o.text for o in Select(page.find("#field")).options]
    assert names == ["displacement", "speed", "von Mises stress", "rotation", "drift of the frame",
                     "volume over rest volume"], names
    for name in names:
        Select(page.find("#field")).select_by_visible_text(name)
        assert page.find(".scale").text.startswith(name)
        seen.add(page.js(PIXELS)[1])
    assert len(seen) >= 9, len(seen)  # of which one is chosen already

    # From the last frame it begins again at the first; then the body moves on by itself. How fast is
    # the machine's affair.
    page.js("""const b = corot.body, show = b.show; window.shown = [];
        b.show = function (frame) { shown.push(frame); return show.apply(this, arguments); };""")
    page.find("#play").click()
    WebDriverWait(page.browser, 60).until(lambda _: page.js("return shown.length") >= 2)
    shown = page.js("return shown")
    assert shown == sorted(shown) and shown[-1] > shown[0], shown
    assert page.js("return corot.timeline.moment") > 0  # shown in the charts, too


def check_opening(page, run):
    """The page opens at the largest displacement of all frames."""
    rows = table(f"{run}/probes.csv")
    frame, furthest = page.js("""const b = corot.body, { q, count } = b.fields[0];
        const most = b.t.reduce((list, _, k) => [...list, Math.max(...q.subarray(k * count, (k + 1) * count))], []);
        return [b.frame, most.indexOf(Math.max(...most))]""")
    assert frame == furthest and page.find("#frame").get_attribute("value") == str(frame), (frame, furthest)
    assert f"t = {float(rows[frame]['t']):g} s" in page.find(".player output").text
    assert page.js("return corot.timeline.moment === corot.body.t[corot.body.frame]")


def check_warnings(page, run):
    """Those of result.json, or that there are none; returns their texts."""
    with open(f"{run}/result.json") as file:
        warnings = [w if isinstance(w, str) else w["text"] for w in json.load(file)["warnings"]]
    shown = [li.text for li in page.all("#warnings li")]
    assert len(shown) == len(warnings) and all(s.startswith(w) for s, w in zip(shown, warnings)), shown
    assert warnings or page.find("#warnings").text == "No warnings."
    return warnings


def toggle(page):
    page.js("""for (const l of document.querySelectorAll('.controls label'))
        if (l.textContent.includes('supports and loads')) l.querySelector('input').click()""")


def check_marks(page, texts):
    """Supports and loads are drawn over the body, and said beneath it; they can be hidden."""
    items = [li.text for li in page.all("#conditions li")]
    assert len(items) == len(texts) and all(i.startswith(t) for i, t in zip(items, texts)), items
    covered, picture = page.js(PIXELS, ".overlay")
    assert 0.001 < covered < 0.2, covered
    body = page.js(PIXELS)
    toggle(page)
    assert not page.find(".overlay").is_displayed() and not page.find("#conditions").is_displayed()
    assert page.js(PIXELS) == body
    toggle(page)
    assert page.js(PIXELS, ".overlay") == [covered, picture]
    page.js("corot.body.camera.turn(0.5, 0.2); corot.body.draw()")  # they turn with it
    assert page.js(PIXELS, ".overlay")[1] != picture


def check_moving(run):
    with Page(f"{run}/report.html") as page:
        title = '</script><b id=bad onclick=alert(1)>A title & "others" </b>'
        assert page.browser.title.strip() == title and page.find("h1").text == title
        assert not page.all("#bad")
        assert any("nu = 0.495" in text for text in check_warnings(page, run))
        assert page.find("#warnings").rect["y"] < 400 < page.find("#body").rect["y"]
        check_marks(page, ["base: x, z held", "top: turned about (0, 0, 1) at 1 rad/s",
                           "traction on side: (300, 0, 0) Pa", "gravity: (0, 0, -9.81) m/s^2",
                           "pressure on side: 10 Pa"])
        # The traction turns round, and is gone half-way.
        page.js("corot.body.exaggeration = 0; corot.body.camera.reset()")
        seen = {}
        for frame, factor in (0, "1"), (5, "0"), (10, "-1"):
            page.js("corot.body.show(arguments[0])", frame)
            assert f"× {factor} now" in page.all("#conditions li")[2].text, page.all("#conditions li")[2].text
            seen[frame] = page.js(PIXELS, ".overlay")
        assert len({picture for _, picture in seen.values()}) == 3
        assert seen[5][0] < 0.95 * min(seen[0][0], seen[10][0]), seen  # dots have fewer pixels
        check_looks(page)


def check_static(run):
    with open(run + "/result.json") as file:
        result = json.load(file)
    rows, steps = table(f"{run}/probes.csv"), result["statics"]["steps"]
    with Page(f"{run}/report.html") as page:
        charts = page.js("return Object.keys(corot.charts)")
        assert charts == ["curve-0", "curve-1", "reaction-0", "residuals", "newton", "energies"], charts
        xs, ys = page.js("const s = corot.charts['curve-0'].series[0]; return [[...s.x], [...s.y]]")
        assert xs == [float(r["corner.ux"]) for r in rows]
        assert max(abs(y - f) for y, f in zip(ys, [0, 0.25, 0.5, 0.75, 1])) < 1e-12, ys
        # 200 and 50 Pa on 0.01 m^2, to the tolerance of the equilibrium.
        held = page.js("return corot.charts['reaction-0'].series.map((s) => s.y[s.y.length - 1])")
        assert abs(held[0] + 2) < 1e-6 and abs(held[1] + 0.5) < 1e-6, held
        expected = [r / s["force"] for s in steps for r in s["residual"]]
        shown = page.js("return [...corot.charts.residuals.series[0].y].filter((y) => !isNaN(y))")
        assert shown == expected and page.js("return corot.charts.residuals.data.yLog")
        assert not any(n.is_displayed() for n in page.all("#residuals .note"))
        for word in "t [s]", "balance", "kinetic", "dissipated":
            assert not any(word in e.text for e in page.all("h3, th, .facts, .legend, svg")), word
        check_warnings(page, run)
        # Load factors, which the slider goes through; nothing plays.
        assert page.find(".player output").text == "load factor = 1"
        assert page.find("#frame").is_displayed() and not page.find("#play").is_displayed()
        page.js("const s = document.querySelector('#frame'); s.value = 1; s.dispatchEvent(new Event('input'))")
        assert page.find(".player output").text == "load factor = 0.25"
        assert "× 0.25 now" in page.all("#conditions li")[1].text
        assert page.js("return corot.timeline.moment") == 0.25
        check_marks(page, ["base: x, y, z held", "traction on top: (200, 50, 0) Pa"])
        check_looks(page)


def check_small(one, bare, gone):
    with Page(f"{one}/report.html") as page:  # a single load step: there is nothing to slide through
        assert not page.find("#frame").is_displayed() and not page.find("#play").is_displayed()
        assert page.find(".player output").text == "load factor = 1"
        assert "in 1 load step and" in page.find(".lead").text
    with Page(f"{bare}/report.html") as page:  # no fields: no body, and all else
        check_warnings(page, bare)
        assert not page.all("#body") and page.all("#probe-0") and page.all("#energies")
        check_looks(page)
    with Page(f"{gone}/report.html") as page:  # failed at once: one row, one frame
        assert page.find(".outcome").text.startswith("failed at t = 0 s of 1 s: newmark")
        assert len(page.all("#probe-0 .mark")) == 3 and not page.find("#play").is_displayed()
        check_looks(page)


def check_long(run):
    """A page stays small however long the run was, and no peak is lost."""
    path = f"{run}/report.html"
    extremes = json.load(open(f"{run}/result.json"))["extremes"]
    with Page(path) as page:
        data = page.js("""const s = corot.charts['probe-0'].series[0];
            return [s.x.length, Math.min(...s.y), Math.max(...s.y), s.x[0], s.x[s.x.length - 1]]""")
        peak, dip = extremes["corner.ux"]["max"], extremes["corner.ux"]["min"]
        assert 2000 < data[0] <= 4000 and data[3:] == [0, 1], data
        assert abs(data[1] - dip["value"]) < 1e-6 and abs(data[2] - peak["value"]) < 1e-6, data
        # 12 curves of the history, and of the steps.
        assert os.path.getsize(path) < 3e6, os.path.getsize(path)
        assert page.find("#warnings h3").text == "2 warnings"
        assert [li.text for li in page.all("#warnings li")] == \
            ["One <b>thing</b> is off. one-thing", "Another is, too."]
        assert len(page.all("#extremes tbody tr")) == len(extremes)
        # A click on when it was shows the body there.
        row = page.all("#extremes tbody tr")[0]
        assert row.text.startswith("corner.ux [m]"), row.text
        button = row.find_elements(By.CSS_SELECTOR, "button")[1]
        assert button.text == f"{peak['t']:.6g}"
        button.click()
        at = page.js("return corot.body.t[corot.body.frame]")
        assert abs(at - peak["t"]) <= 0.0101, at
        check_looks(page)
        measure(page, path)


def check_goal(folder):
    """The values on the meshes lie in the diagram where they should, and so does the interval."""
    solved = json.load(open(f"{folder}/solve.json"))
    with Page(f"{folder}/report.html") as page:
        assert page.js("return Object.keys(corot.charts)") == ["meshes"]
        points = page.points("#meshes")
        assert len(points) == 2 + (solved["limit"] is not None)
        assert points[0] == len(solved["levels"]) >= 2
        band = page.js("""const c = corot.charts.meshes, r = c.svg.querySelector('rect.interval');
            return [+r.getAttribute('y'), +r.getAttribute('height'), c.down(arguments[1]),
                    c.down(arguments[0]) - c.down(arguments[1]), c.height]""", solved["low"], solved["high"])
        assert abs(band[0] - band[2]) < 0.01 and abs(band[1] - band[3]) < 0.01 and 0 < band[1] < band[4], band
        assert page.js("return corot.charts.meshes.note.textContent") == ""
        check_looks(page)


def check_looks(page):
    for width, dark in (390, False), (390, True), (1200, True), (1200, False):
        page.open(width, dark)
        wide = page.js("return document.documentElement.scrollWidth")
        assert wide <= width, (width, wide)
        paper, ink = (page.js("""const c = getComputedStyle(document.body)[arguments[0]]
            .match(/\\d+/g).map(Number); return (c[0] + c[1] + c[2]) / 765""", of)
                      for of in ("backgroundColor", "color"))
        assert (paper < 0.2 and ink > 0.8) if dark else (paper > 0.9 and ink < 0.2), (paper, ink)


def check_ticks(page):
    """The page's axes choose as those of the SVG files, of which test_chart.c knows."""
    cases = [([0, 40, False], 5, ["0", "10", "20", "30", "40"]),
             ([-0.21, 0.42, False], 7, ["-0.2", "-0.1", "0", "0.1", "0.2", "0.3", "0.4"]),
             ([0, 4.1e-6, False], 5, ["0", "1e-6", "2e-6", "3e-6", "4e-6"]),
             ([0.5e-2, 2e1, True], 8, ["10^-2", "10^-1", "1", "10"]),
             ([0.15, 0.9, True], 7, ["0.2", "0.5"])]
    for axis, most, expected in cases:
        labels = page.js("""return new corot.Axis(...arguments[0]).ticks(arguments[1])
            .map((t) => t.label).filter((l) => l)""", axis, most)
        assert labels == expected, (axis, labels)


def measure(page, path):
    """Prints what is not tested: it depends on the machine."""
    load = page.js("const t = performance.timing; return t.loadEventEnd - t.navigationStart")
    rate = page.browser.execute_async_script("""const done = arguments[0], body = corot.body;
      if (!body) return done(null);
      let n = 0; const began = performance.now();
      const step = () => {
        body.show(n++ % body.t.length);
        const passed = performance.now() - began;
        if (passed < 2000) requestAnimationFrame(step);
        else done(1000 * n / passed);
      };
      requestAnimationFrame(step);""")
    frames = f", {rate:.0f} frames/s painted in software" if rate else ""
    print(f"{path}: {os.path.getsize(path) / 1e6:.2f} MB, loaded in {load} ms{frames}")


def check_run(run):
    path = f"{run}/report.html"
    with Page(path) as page:
        assert page.browser.title == "A bar <that> bends & swings"
        assert page.js("return performance.getEntriesByType('resource').length") == 0
        check_opening(page, run)
        check_ticks(page)
        check_charts(page, run)
        check_pointer(page, run)
        check_body(page, run)
        page.open(1200, False)
        check_marks(page, ["base: x, y, z held", "traction on top: (200, 50, 0) Pa"])
        check_looks(page)
        measure(page, path)
    with Page(path, flags=["--disable-3d-apis"]) as page:  # painted without WebGL
        assert page.js("return corot.body.paint.constructor.name") == "Paint2d"
        covered, picture = page.js(PIXELS)
        assert 0.02 < covered < 0.8, covered
        page.js("corot.body.show(0)")
        assert page.js(PIXELS)[1] != picture
        assert page.js(PIXELS, ".overlay")[0] > 0.001  # marks need no WebGL either


def check_study(folder):
    path = folder + ".html"
    with open(folder + "/table.json") as file:
        cells = json.load(file)["cells"]
    with Page(path) as page:
        for name in "displacement", "velocity_end":
            rated = [c for c in cells if c["status"] == "done" and name not in c["unrated"]]
            label = page.js("return corot.charts['work-precision'].data.yLabel")
            assert name.split("_")[0] in label, label
            marks = len(page.all("#work-precision .frame .mark"))
            assert rated and marks == len(rated), (name, marks, len(rated))
            for axis in ".tick.x", ".tick.y":
                assert len(page.all("#work-precision " + axis)) >= 2
            Select(page.find("#error")).select_by_visible_text("relative error of velocity, at the end")
        Select(page.find("#cost")).select_by_visible_text("steps")
        assert page.find("#work-precision text.label").text == "steps"
        assert "1 %" in page.find(".answer").text
        assert len(page.all("#runs tbody tr")) == len(cells)
        check_looks(page)
        measure(page, path)


if __name__ == "__main__":
    if sys.argv[1] == "measure":
        with Page(sys.argv[2]) as measured:
            measure(measured, sys.argv[2])
    else:
        check_run(sys.argv[1])
        check_moving("moving")
        check_static("still")
        check_small("one", "bare", "gone")
        check_long("long")
        check_goal("goal")
        check_study(sys.argv[2])
