#!/usr/bin/python3
"""view.html and report.html in a real browser: page_in_browser.py TYNDALL SCENE FOLDER

Solves a small scene, and opens its pages in headless Chromium: the GPU's picture (here a software
one) against the walk in double precision, pixel by pixel; then keys, clicks and sliders, and the report. Exits with
77, skipped, where Chromium, its driver or Selenium are missing (./bootstrap test installs them),
unless TYNDALL_REQUIRE_BROWSER is set.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from verdicts import check, skip  # noqa: E402

# Of the larger of a pixel's radiance (its brightest channel's) and a thousandth of the mean. Single
# precision places a ray on a leaf's face to 1e-7 of the room, and J changes by its own size across the
# smallest leaves, a hundredth of the room: 1e-5, and some more where a ray crosses many. The few rays that
# graze a face at which functions jump are told by rays beside them (self_test.js).
WORST = 5e-5
GRAZING = 0.005  # of all values
FLAGS = ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--disable-dev-shm-usage", "--disable-background-networking",
         "--force-device-scale-factor=0.5"]  # few pixels: they are drawn without a GPU


def self_test(chromium, page, profile):
    """Worst relative error of the GPU's picture of every camera."""
    done = subprocess.run([chromium, *FLAGS, f"--user-data-dir={profile}", "--enable-logging=stderr",
                           "--virtual-time-budget=20000", "--dump-dom", f"{page.as_uri()}#selftest"],
                          capture_output=True, text=True, timeout=300)
    # What a driver remarks on its own speed, which it does where it likes, is not the page's.
    console = [line for line in done.stderr.splitlines()
               if ":CONSOLE" in line and "GL Driver Message (OpenGL, Performance" not in line]
    check(not console, f"no message on the console {console}")
    found = re.search(r'<pre id="selftest">(.*?)</pre>', done.stdout)
    check(found, "the page tested itself")
    return json.loads(found.group(1).replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"))


class Browser:
    """The page as a visitor has it."""

    def __init__(self, webdriver, chromium, driver, page, profile):
        options = webdriver.ChromeOptions()
        options.binary_location = chromium
        for flag in [*FLAGS, f"--user-data-dir={profile}", "--window-size=560,420"]:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        service = webdriver.chrome.service.Service(driver)
        self.driver = webdriver.Chrome(service=service, options=options)
        self.page = page

    def open(self, link="#smooth=0"):
        self.driver.get("about:blank")
        self.driver.get(self.page.as_uri() + link)
        self.wait("return document.getElementById('canvas').dataset.state === 'done'")

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, script, seconds=120):
        from selenium.webdriver.support.ui import WebDriverWait
        WebDriverWait(self.driver, seconds, 0.1).until(lambda d: d.execute_script(script))

    def set(self, name, value):
        """As a visitor does: the value, and the event that follows."""
        self.run("""const input = document.getElementById(arguments[0]);
                    if (input.type === 'checkbox') input.checked = arguments[1];
                    else input.value = arguments[1];
                    input.dispatchEvent(new Event('input', { bubbles: true }));
                    input.dispatchEvent(new Event('change', { bubbles: true }));""", name, value)

    def settle(self):
        self.wait("return document.getElementById('canvas').dataset.state === 'done'")

    def pixels(self):
        """Mean of the screen's red, green and blue."""
        self.settle()
        return self.run("""
            const canvas = document.getElementById('canvas'), gl = canvas.getContext('webgl2');
            gl.bindFramebuffer(gl.FRAMEBUFFER, null);
            const bytes = new Uint8Array(4 * canvas.width * canvas.height), sum = [0, 0, 0];
            gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
            bytes.forEach((v, i) => { if (i % 4 < 3) sum[i % 4] += v; });
            return sum.map((v) => v / (canvas.width * canvas.height));""")

    def keys(self, *names):
        self.driver.find_element("id", "canvas").send_keys(*names)

    def errors(self):
        return [entry for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]


def look_around(browser):
    eye = "return window.tyndall.view.eye"
    forward = "return window.tyndall.view.forward"
    before = browser.run(eye)
    browser.keys("w")
    ahead = [b - a for a, b in zip(before, browser.run(eye))]
    toward = browser.run(forward)
    check(sum(a * b for a, b in zip(ahead, toward)) > 0.01, "W walks ahead")
    browser.keys("\ue014")  # arrow right
    turned = browser.run(forward)
    check(turned != toward, "the arrow turns")
    cross = toward[0] * turned[1] - toward[1] * turned[0]
    check(cross < 0, "to the right")
    browser.keys("2")
    check(browser.run("return document.getElementById('camera').value") == "1", "2 goes to the second camera")
    browser.keys("1")
    check(max(abs(a - b) for a, b in zip(browser.run(eye), before)) < 1e-9, "and 1 back to the first")
    from selenium.webdriver import ActionChains
    canvas = browser.driver.find_element("id", "canvas")
    ActionChains(browser.driver).click_and_hold(canvas).move_by_offset(40, 0).release().perform()
    check(browser.run(forward) != toward, "dragging turns")
    browser.keys("1")


def settings(browser):
    plain = browser.pixels()
    browser.set("exposure", "1")
    check(browser.pixels()[0] > plain[0] + 3, "exposure brightens")
    browser.set("exposure", "0")
    check(abs(browser.pixels()[0] - plain[0]) < 0.01, "and back")
    browser.keys("m")
    check(abs(browser.pixels()[0] - plain[0]) > 0.5, "M takes the medium away")
    browser.keys("m")
    layers = browser.driver.find_elements("css selector", "#layers input")
    for box in layers[:3]:
        browser.run("arguments[0].scrollIntoView(); arguments[0].click();", box)
    medium_alone = browser.pixels()
    check(0 < medium_alone[0] < plain[0], "without surfaces the medium alone is left")
    for box in layers[:3]:
        browser.run("arguments[0].click();", box)
    browser.set("edges", True)
    edges = browser.pixels()
    check(edges[0] - edges[2] > plain[0] - plain[2] + 1, "edges of elements are drawn in orange")
    browser.set("edges", False)


def cut_and_pick(browser):
    browser.set("cut", "x")
    browser.set("cut_at", "0.5")
    seen = {}
    for colours in ["1", "2", "3"]:
        browser.set("colours", colours)
        seen[colours] = browser.pixels()
    check(seen["1"] != seen["2"] != seen["3"], "zones on the cut are coloured by level, error, J")
    check("W/m" in browser.driver.find_element("id", "scale").text, "with a scale")
    browser.run("document.getElementById('pick').click()")
    picked = browser.driver.find_element("id", "picked").text
    check("zone" in picked and "extinction" in picked, f"a zone on the cut is picked: {picked!r}")
    browser.set("cut", "")
    browser.settle()
    from selenium.webdriver import ActionChains
    canvas = browser.driver.find_element("id", "canvas")
    browser.run("arguments[0].scrollIntoView()", canvas)
    ActionChains(browser.driver).move_to_element_with_offset(canvas, 20, 20).click().perform()
    picked = browser.driver.find_element("id", "picked").text
    check("patch" in picked and ("room" in picked or "partition" in picked), f"a click picks a patch: {picked!r}")
    radiance = browser.run("return window.tyndall.picked.rows.find((r) => r[0] === 'radiance')[1]")
    check(float(re.split("[ ,]", radiance)[0]) > 0, "with its radiance")


def link(browser):
    browser.keys("w")
    browser.set("exposure", "1.5")
    browser.set("cut", "z")
    browser.set("colours", "3")
    seen, address = browser.pixels(), browser.run("return window.tyndall.link()")
    browser.open(address)
    again = browser.pixels()
    check(max(abs(a - b) for a, b in zip(seen, again)) < 0.5, f"the link restores the view {seen} {again}")
    check(browser.run("return window.tyndall.link()") == address, "and is the same again")


def passes(browser):
    """The slider through the meshes of the passes."""
    meshes = browser.run("return window.tyndall.meta.meshes")
    check(len(meshes) > 1, f"the meshes of earlier passes are there {meshes}")
    check(meshes[-1]["zones"] == browser.run("return window.tyndall.meta.report.zones"), "the last is the report's")
    browser.set("cut", "x")
    browser.set("cut_at", "0.4")
    browser.set("colours", "1")
    last = browser.pixels()
    browser.set("pass", "0")
    first = browser.pixels()
    check(max(abs(a - b) for a, b in zip(first, last)) > 0.05, f"an earlier mesh has other levels {first} {last}")
    said = browser.driver.find_element("id", "pass_value").text
    check(meshes[0]["passes"] in said and str(meshes[0]["zones"]) in said, f"the slider says which {said!r}")
    check("pass=0" in browser.run("return window.tyndall.link()"), "the link knows it")
    shown = browser.run("""
        const t = window.tyndall.tables, seen = new Set();
        for (let z = 0; z < t.zoneCount; ++z)
          if (t.zones[4 * t.zoneStride * z + 20] >= 0) seen.add(t.zones[4 * t.zoneStride * z + 21]);
        return seen.size;""")
    check(shown == meshes[0]["zones"], f"it shows as many zones as that pass had: {shown}")
    browser.keys("]")
    check(browser.run("return document.getElementById('pass').value") == "1", "] goes to the next")
    browser.set("pass", str(len(meshes) - 1))
    again = browser.pixels()
    check(max(abs(a - b) for a, b in zip(again, last)) < 0.01, "and back")
    browser.set("cut", "")
    browser.settle()


def folds(browser):
    """What is folded on the screen opens by its heading, and is printed."""
    shown = "return [...document.querySelectorAll('.folded')].map((f) => f.offsetHeight > 0)"
    count = len(browser.run(shown))
    check(count >= 2 and not any(browser.run(shown)), f"{count} folded parts")
    browser.run("document.querySelector('.fold summary').click()")
    check(browser.run(shown).count(True) == 1, "one opens at a click")
    browser.run("document.querySelector('.fold summary').click()")
    check(not any(browser.run(shown)), "and closes")
    browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    check(all(browser.run(shown)), "all are printed")
    check(browser.run("return [...document.querySelectorAll('.fold')].every((f) => f.offsetHeight === 0)"),
          "without the headings that fold them")
    browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


def report(browser):
    """report.html, which has no script of its own."""
    link = browser.driver.find_element("css selector", "header a[href='report.html']")
    browser.run("arguments[0].click()", link)
    browser.wait("return document.title.startsWith('Report:') && document.readyState === 'complete'")
    charts = browser.run("return [...document.querySelectorAll('svg')].map((s) => "
                         "[s.querySelector('title').textContent, s.querySelector('desc').textContent])")
    check(len(charts) >= 8 and all(t and d for t, d in charts), f"its charts have titles {[t for t, d in charts]}")
    check(browser.run("return [...document.querySelectorAll('table')].every((t) => t.caption.textContent)"),
          "its tables have captions")
    check(browser.run("return [...document.querySelectorAll('h1, h2')].map((h) => h.tagName)")[0] == "H1", "headings")
    check(browser.run("return document.querySelector('img').naturalWidth") == 40, "the picture is in it")
    check("NaN" not in browser.run("return document.body.innerText"), "no NaN")
    ids = browser.run("return [...document.querySelectorAll('nav a')].map((a) => a.getAttribute('href').slice(1))"
                      ".filter((id) => !document.getElementById(id))")
    check(not ids, f"its contents lead somewhere {ids}")
    zones = json.loads((browser.page.parent / "report.json").read_text())["zones"]
    check(browser.run("return [...document.querySelectorAll('#solution ~ * tbody tr')].map((r) => "
                      "[r.cells[0].textContent, r.cells[1].textContent])").count(["zones", str(zones)]) == 1,
          "its figures are those of report.json")
    wide = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
    check(wide <= 0, f"nothing is wider than the window: {wide}")
    folds(browser)
    back = browser.driver.find_element("css selector", "header a")
    browser.run("arguments[0].click()", back)
    browser.wait("return document.getElementById('canvas') !== null")


def for_everybody(browser):
    """What a screen reader and a keyboard need."""
    unnamed = browser.run("""
        return [...document.querySelectorAll('input, select, button')]
            .filter((e) => !(e.labels && e.labels.length) && !e.textContent.trim()).map((e) => e.outerHTML);""")
    check(not unnamed, f"every control has a name {unnamed}")
    charts = browser.run("return [...document.querySelectorAll('svg')].map((s) => "
                         "[s.querySelector('title').textContent, s.querySelector('desc').textContent,"
                         " s.closest('section').querySelectorAll('tbody tr').length])")
    check(charts and all(t and d and rows > 0 for t, d, rows in charts),
          f"charts have titles, descriptions and tables {charts}")
    check(browser.run("document.getElementById('canvas').focus();"
                      "return document.activeElement.id") == "canvas", "the picture takes the focus")


def without_webgl(browser):
    browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument",
                                   {"source": "HTMLCanvasElement.prototype.getContext = () => null;"})
    browser.driver.get("about:blank")
    browser.driver.get(browser.page.as_uri())
    browser.wait("return !document.getElementById('notice').hidden")
    check("WebGL2" in browser.driver.find_element("id", "notice").text, "without WebGL2 the page says so")
    check(browser.run("return document.querySelectorAll('#report table').length") > 0, "and shows the report")


def main():
    tyndall, scene, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if not chromium or not driver:
        skip("chromium and chromium-driver are not installed", "TYNDALL_REQUIRE_BROWSER")
    try:
        from selenium import webdriver
        import selenium.webdriver.chrome.service
    except ImportError:
        skip("python3-selenium is not installed", "TYNDALL_REQUIRE_BROWSER")
    shutil.rmtree(folder, ignore_errors=True)
    page = folder / "view.html"
    if scene.endswith(".html"):
        page = pathlib.Path(scene).resolve()
        folder.mkdir(parents=True)
    else:
        subprocess.run([tyndall, "run", scene, "-o", folder, "--quiet"], check=True)
    for camera in self_test(chromium, page, folder / "profile"):
        check(camera["worst"] < WORST, f"GPU and CPU agree: {camera}")
        check(camera["grazing"] < GRAZING * 3 * camera["pixels"], "few rays graze faces")
    browser = Browser(webdriver, chromium, driver, page, folder / "profile")
    try:
        browser.open()
        look_around(browser)
        settings(browser)
        cut_and_pick(browser)
        passes(browser)
        link(browser)
        for_everybody(browser)
        if (folder / "report.html").exists():  # not where one page alone was given
            report(browser)
        check(not browser.errors(), "no error on the console")
        without_webgl(browser)
    finally:
        browser.driver.quit()
        shutil.rmtree(folder / "profile", ignore_errors=True)


main()
