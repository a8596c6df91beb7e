#!/usr/bin/env python3
"""The page "mill" on any screen: layout, fingers, keys, links, and WCAG 2.2 AA by axe-core, in Chromium without a screen.

    web/tests/screens_test.py SITE AXE [PICTURES [PART...]]    SITE: build/web/site; AXE: a folder of the build that keeps axe-core;
                                                           PICTURES: a folder to keep screenshots; PART: one of PARTS; all without it
"""
import json
import math
import pathlib
import re
import shutil
import struct
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "codecs"))
import scans
import take
from chromium import Chromium, Site
from common import WAIT, bad, check, key, ready, size, text_of, touch, words_of
from hand import POINTER

SITE, AXE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
PICTURES = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
if PICTURES:
    PICTURES.mkdir(parents=True, exist_ok=True)
SAID = words_of("en")
# width, height, a touch screen; 1366 x 768 at 200 % is half of it
SIZES = {"phone": (390, 844, True), "tablet": (820, 1180, True), "laptop": (1366, 768, False), "laptop_200": (683, 384, False),
         "window": (960, 540, False)}
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]

CONTROLS = """[...document.querySelectorAll('button, select, input, summary')].filter((one) => one.getClientRects().length > 0).map((one) => {
  const box = one.getBoundingClientRect();
  return {id: one.id || one.className || one.textContent, width: box.width, height: box.height}; })"""
CANVAS = "(() => { const one = document.getElementById('picture').getBoundingClientRect(); return [one.left, one.top, one.width, one.height]; })()"


def picture(page, name):
    return page.picture(PICTURES and PICTURES / f"{name}.png")


def axe(page, source, what):
    if not page.run("typeof axe !== 'undefined'"):
        page.run(source + "; true")
    found = page.run(f"axe.run(document, {{runOnly: {json.dumps(RULES)}, resultTypes: ['violations']}}).then(({{violations}}) => "
                     "violations.map((one) => [one.id, one.nodes.map((node) => node.html.slice(0, 120) + ' ' + (node.any[0]?.message ?? ''))]))")
    check(not found, f"axe, {what}: {found}")


def layout(browser, site, source):
    """Every size: nothing sticks out, controls can be hit, and the state of the page follows the rules."""
    for name, (width, height, fingers) in SIZES.items():
        page = browser.open(f"{site.url}mill/?language=en&mode=learn", before=lambda one: size(one, width, height, fingers))
        ready(page)
        page.wait("document.getElementById('say').textContent === ''", WAIT)
        picture(page, f"{name}_card")
        axe(page, source, f"{name}, at the start")
        page.run("document.getElementById('card_close').click()")
        page.wait("burr.refined()", WAIT)
        picture(page, name)
        small = [one for one in page.run(CONTROLS) if one["height"] < 44 or one["width"] < 44]
        check(not small, f"{name}: controls are 44 pixels or more: {small}")
        check(page.run("document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight"), f"{name}: nothing sticks out")
        left, top, wide, high = page.run(CANVAS)
        check(wide >= width - 1 and high >= 0.5 * height, f"{name}: the picture has {wide:.0f} x {high:.0f} of {width} x {height}")
        steps(page, name, width, height, source)
        page.run("document.getElementById('menu_open').click()")
        picture(page, f"{name}_menu")
        axe(page, source, f"{name}, menu")
        box = page.run("(() => { const one = document.getElementById('menu').getBoundingClientRect(); return [one.left, one.top, one.right, one.bottom]; })()")
        check(box[0] >= 0 and box[1] >= 0 and box[2] <= width and box[3] <= height, f"{name}: the menu fits: {box}")
        page.run("document.getElementById('menu_close').click()")
        check("user-scalable=no" not in page.run("document.querySelector('meta[name=viewport]').content"), f"{name}: pinch zoom is allowed")
        check(not page.troubles, f"no errors on the console {page.troubles}")
        page.close()


def steps(page, name, width, height, source):
    """Where there is room the panel stands beside the work; otherwise it is a sheet that does not cover the picture while it is folded."""
    panel = page.run("(() => { const one = document.getElementById('course').getBoundingClientRect(); return [one.left, one.top, one.width, one.height]; })()")
    left, top, wide, high = page.run(CANVAS)
    if width <= 760 or height <= 520:
        check(panel[1] >= top + high - 1 and panel[3] <= 50, f"{name}: the steps are one line below the picture: {panel}")
        page.run("document.getElementById('course_fold').click()")
        opened = page.run("document.getElementById('course').getBoundingClientRect().height")
        check(opened > 0.3 * height and page.run("document.getElementById('course_fold').getAttribute('aria-expanded')") == "true", f"{name}: open, they are {opened:.0f} pixels high")
        picture(page, f"{name}_steps")
        axe(page, source, f"{name}, steps")
        page.run("document.getElementById('course_fold').click()")
    else:
        check(panel[3] > 150, f"{name}: the panel of the steps is {panel[3]:.0f} pixels high")
        check(panel[0] + panel[2] < left + 0.5 * wide, f"{name}: it leaves the middle of the picture free")


# The longest figures; then those that do not fit, before the page can write others.
LONGEST = """((code, left_out) => {
  const number = (value, digits) => value.toLocaleString(code, {minimumFractionDigits: digits, maximumFractionDigits: digits});
  const texts = {force: number(33.3, 1), removed: number(12345.6, 1), loop_title: left_out, loop: number(1234567, 0), near_mm: number(-12.3, 1), near_sign: '!!',
    near_title: 'Abstand zum horizontalen Bogengang', rpm: number(80000, 0)};
  for (const [id, text] of Object.entries(texts)) document.getElementById(id).textContent = text;
  document.getElementById('near').hidden = false;
  return [...document.querySelectorAll('#stage ~ footer dd, #loop_title')].filter((one) => one.scrollWidth > one.clientWidth)
    .map((one) => `${one.textContent}: ${one.scrollWidth} of ${one.clientWidth} pixels`);
})"""


def figures_do_not_move_the_picture(browser, site, _source):
    for name, (width, height, fingers) in (SIZES | {"small phone": (320, 568, True)}).items():
        page = browser.open(f"{site.url}mill/?language=de&mode=learn", before=lambda one: size(one, width, height, fingers))
        ready(page)
        page.run("document.getElementById('card_close').click()")
        before = page.run(CANVAS)
        for code in ("en", "sv", "de"):
            cut = page.run(LONGEST + f"({json.dumps(code)}, {json.dumps(words_of(code)['left_out'])})")
            check(not cut, f"{name}, {code}: no figure is cut off at its edge: {cut}")
        page.run("document.getElementById('say').textContent = 'Ein langer Satz. '.repeat(12)")
        check(page.run(CANVAS) == before, f"{name}: the longest figures and sentences leave the picture where it is")
        page.close()


def rounds(page, count=4):
    """The worker has said how it is, and got the hand, so many times."""
    for _ in range(count):
        page.wait(f"burr.state.ticks > {page.run('burr.state.ticks')}", WAIT)
    time.sleep(1)


def fingers(browser, site, _source):
    """A finger in the middle cuts; two turn the view and cut nothing, whoever comes first."""
    page = browser.open(f"{site.url}mill/?language=en&mode=learn", before=lambda one: size(one, 390, 844, True))
    ready(page)
    page.run("document.getElementById('card_close').click()")
    left, top, wide, high = page.run(CANVAS)
    x, y = left + 0.5 * wide, top + 0.5 * high
    eye = "[...burr.picture.view.numbers(burr.picture.view.view_place(0, 0, 0, 0.001), 3)]"
    page.run("(() => { window.downs = []; addEventListener('pointerdown', (one) => downs.push(one.timeStamp), true); })()")
    wanted, tries = [0, 0.06, 0.3, 0.5], 0  # of the second finger [s]
    while wanted and tries < 20:
        late, tries = wanted[0], tries + 1
        before, seen = page.run("burr.figures.removed"), page.run(eye)
        first = time.time()
        touch(page, "touchStart", (x, y), at=first)
        time.sleep(late)
        touch(page, "touchStart", (x, y), (x + 80, y + 40), at=first + late)
        for n in range(1, 12):
            touch(page, "touchMove", (x + 6 * n, y + 4 * n), (x + 80 + 6 * n, y + 40 + 4 * n))
            time.sleep(0.03)
        touch(page, "touchEnd", (x + 66, y + 44))
        time.sleep(0.6)
        touch(page, "touchEnd")
        time.sleep(2)
        rounds(page)
        after = page.run("burr.figures.removed")
        apart = page.run("(downs.at(-1) - downs.at(-2)) / 1000")
        if apart > 0.7:  # this machine was too busy to bring them as they were meant
            print(f"      once more: the fingers came {apart:.2f} s apart")
            continue
        wanted.pop(0)
        check(abs(after - before) < 1e-6, f"two fingers, the second {apart:.2f} s later: {after - before:.4f} mm3 are cut")
        check(math.dist(page.run(eye)[:2], seen[:2]) > 5, "and the view is turned")
    check(not wanted, f"all fingers came: {wanted} did not")
    page.run("document.getElementById('home').click()")
    time.sleep(1)
    before = page.run("burr.figures.removed")
    touch(page, "touchStart", (x, y))
    page.wait(f"burr.figures.removed > {before} + 0.3", WAIT)
    touch(page, "touchEnd")
    check(True, f"one finger in the middle cuts {page.run('burr.figures.removed') - before:.1f} mm3")
    check(not page.run("burr.pressing()"), "and the burr is lifted with it")
    page.close()


def keys(browser, site, _source):
    """Milling by the keyboard alone."""
    page = browser.open(f"{site.url}mill/?language=en")
    ready(page)
    page.run("document.getElementById('picture').focus()")
    key(page, "rawKeyDown", "ArrowRight", shift=True)
    at = page.run("[burr.hand.pointer.x, burr.hand.pointer.y]")
    key(page, "rawKeyDown", "ArrowLeft", shift=True)
    check(page.run("burr.hand.pointer.x") < at[0], "Shift and arrows move the burr")
    time.sleep(1)
    key(page, "rawKeyDown", " ", "Space")
    for n in range(6):
        key(page, "rawKeyDown", "ArrowRight" if n % 2 else "ArrowLeft", shift=True)
        time.sleep(0.3)
    page.wait("burr.figures.removed > 0.3", WAIT)
    key(page, "keyUp", " ", "Space")
    rounds(page)
    removed = page.run("burr.figures.removed")
    rounds(page)
    check(not page.run("burr.pressing()") and page.run("burr.figures.removed") - removed < 1e-6, f"Space mills while it is held: {removed:.1f} mm3")
    page.run("document.getElementById('undo').focus()")
    key(page, "rawKeyDown", " ", "Space")
    check(not page.run("burr.pressing()"), "on a button it is the button's")
    key(page, "keyUp", " ", "Space")
    page.close()


def links(browser, site, _source):
    """?case=, ?mode=, ?bone=: all five cases, each with its steps and marks; a scan beside the page."""
    first = browser.open(f"{site.url}mill/?language=en")
    ready(first)
    names = first.run("[...document.querySelectorAll('#case option')].map((one) => [one.value, one.textContent])")
    check(len(names) == 5 and all(text for _, text in names), f"the menu has five cases: {names}")
    first.close()
    for name, title in names[1:]:
        page = browser.open(f"{site.url}mill/?language=en&mode=learn&case={name}")
        ready(page)
        check(page.run("document.getElementById('case').value") == name and page.run("burr.mode") == "learn", f"?case={name}&mode=learn")
        page.run("document.getElementById('card_close').click()")
        page.run(POINTER + "(2500)")
        rounds(page)  # a busy worker tells later what it has cut
        check(page.run("burr.figures.removed") > 0.02, f"{title}: the first view shows where to cut: {page.run('burr.figures.removed'):.2f} mm3")
        picture(page, f"case_{name}")
        page.run("burr.course.ask_done(); document.getElementById('done_yes').click()")
        page.wait("burr.course.page === 'own' && burr.course.picture", WAIT)
        page.run("document.getElementById('self_skip').click()")
        page.wait("burr.course.page === 'found'", WAIT)
        check(page.run("burr.course.trouble") == "", f"{title}: burr has marked it {page.run('burr.course.trouble')}")
        check(not page.troubles, f"no errors on the console {page.troubles}")
        page.close()
    page = browser.open(f"{site.url}mill/?language=en&case=none")
    ready(page)
    check(page.run("burr.state !== null && document.getElementById('case').value") == "temporal-bone", "a case that there is not: the page's own")
    page.close()
    page = browser.open(f"{site.url}mill/?language=en&bone=scans/ball.nrrd")
    page.wait("window.burr?.own?.plan", WAIT)
    check(page.run("burr.own.plan.scan[0]") == scans.EDGE, "?bone= opens a scan that lies beside the page")
    page.close()


def dropped(browser, site, _source):
    """A scan that is dropped on the picture is read."""
    page = browser.open(f"{site.url}mill/?language=en")
    ready(page)
    page.run("""fetch('scans/ball.nrrd').then((one) => one.blob()).then((blob) => { const data = new DataTransfer();
      data.items.add(new File([blob], 'ball.nrrd'));
      document.getElementById('picture').dispatchEvent(new DragEvent('drop', {bubbles: true, cancelable: true, dataTransfer: data})); })""")
    page.wait("burr.own?.plan", WAIT)
    check(page.run("document.getElementById('own_scan').open && burr.own.plan.scan[0]") == scans.EDGE, "a scan dropped on the picture is read")
    page.close()


def volume_of(stl):
    """Of a closed surface: the sum over its triangles."""
    count = struct.unpack_from("<I", stl, 80)[0]
    total = 0
    for n in range(count):
        ax, ay, az, bx, by, bz, cx, cy, cz = struct.unpack_from("<9f", stl, 84 + 50 * n + 12)
        total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return count, total / 6


def shape(browser, site, _source):
    """The STL file holds the bone that the page removed from: its volume changes by what was cut."""
    with tempfile.TemporaryDirectory() as folder:
        browser.keep_downloads(folder)
        page = browser.open(f"{site.url}mill/?language=en&case=block")
        ready(page)
        volumes = []
        for _ in range(2):
            file = pathlib.Path(folder) / "burr.stl"
            file.unlink(missing_ok=True)
            page.run("document.getElementById('shape').click()")
            end = time.monotonic() + WAIT
            while not (file.exists() and file.stat().st_size > 84 and (file.stat().st_size - 84) % 50 == 0) and time.monotonic() < end:
                time.sleep(0.5)
            time.sleep(1)
            count, volume = volume_of(file.read_bytes())
            volumes.append(volume)
            if len(volumes) == 1:
                check(abs(volume - 48000) < 200, f"the block is 40 x 40 x 30 mm, its STL {volume:.0f} mm3 in {count} triangles")
                page.run(POINTER + "(3000)")
        removed = page.run("burr.figures.removed")
        check(removed > 1 and abs(volumes[0] - volumes[1] - removed) < 0.1 * removed + 0.5, f"{removed:.1f} mm3 are cut, and the STL is {volumes[0] - volumes[1]:.1f} mm3 smaller")
        page.close()


def evidence(browser, site, source):
    """From the marks to the place: the view turns there, and a ring marks it."""
    page = browser.open(f"{site.url}mill/?language=en&mode=learn")
    ready(page)
    page.run(POINTER + "(3000)")
    page.run("burr.course.ask_done()")
    axe(page, source, "the question")
    page.run("document.getElementById('done_yes').click()")
    page.wait("burr.course.page === 'own' && burr.course.picture", WAIT)
    axe(page, source, "own marks")
    page.run("document.getElementById('self_skip').click()")
    page.wait("burr.course.page === 'found'", WAIT)
    axe(page, source, "what burr found")
    places = page.run("burr.course.found.report.parts.flatMap((part) => part.items).filter((one) => one.place).map((one) => one.place)")
    shown = page.run("document.querySelectorAll('.show_place').length")
    check(shown == len(places) > 0, f"{shown} items have a place")
    for n, (x, y, z) in enumerate(places[:4]):
        page.run(f"document.querySelectorAll('.show_place')[{n}].click()")
        page.wait("burr.refined() && document.querySelector('#light path.evidence')", WAIT)
        time.sleep(1)
        left, top, wide, high = page.run(CANVAS)
        ring = page.run("(() => { const [a, b] = ['#light path.evidence', '#light'].map((one) => document.querySelector(one).getBoundingClientRect()); "
                        "return [a.left + a.width / 2 - b.left, a.top + a.height / 2 - b.top, a.width / 2]; })()")
        true = page.run(f"[...burr.picture.view.numbers(burr.picture.view.view_place({x}, {y}, {z}, 0), 2)]")
        check(math.dist(ring[:2], true) < 2 and math.dist(ring[:2], (0.5 * wide, 0.5 * high)) < 3, f"the place stands in the middle of the picture, in the ring: {ring}")
        picture(page, f"evidence_{n}")
        page.run("document.getElementById('to_marks').click()")
        check(page.run("!document.getElementById('review').hidden && !document.querySelector('#light path.evidence')"), "and back to the marks")
    moments(page, browser)
    check(not page.troubles, f"no errors on the console {page.troubles}")
    page.close()


def moments(page, browser):
    """From an item to its moment, in the page that shows recordings: the time and the view both go there."""
    links = page.run("[...document.querySelectorAll('a.watch_moment')].map((one) => one.href)")
    placed = next((one for one in links if "place=" in one), None)
    check(placed is not None, f"{len(links)} items have a moment")
    if placed is None:
        return
    browser.fresh = False
    other = browser.open(placed)
    browser.fresh = True
    other.wait("window.burr?.ready && burr.shown > 0 && burr.refined()", WAIT)
    time.sleep(1)
    wanted = float(re.search(r"at=([0-9.]+)", placed)[1])
    check(abs(other.run("burr.shown") - wanted) < 0.02 or other.run("burr.shown >= burr.seconds - 0.02"), f"it shows {other.run('burr.shown'):.2f} s of the wanted {wanted:.2f} s")
    left, top, wide, high = other.run(CANVAS)
    ring = other.run("(() => { const one = document.querySelector('#light circle.evidence'); return [one.getAttribute('visibility'), +one.getAttribute('cx'), +one.getAttribute('cy')]; })()")
    check(ring[0] == "visible" and math.dist(ring[1:], (0.5 * wide, 0.5 * high)) < 3, f"the ring stands in the middle: {ring}")
    picture(other, "moment")
    check(not other.troubles, f"no errors on the console {other.troubles}")
    other.close()


PARTS = {one.__name__: one for one in (layout, figures_do_not_move_the_picture, fingers, keys, links, dropped, shape, evidence)}


def main():
    packages = take.fetch(AXE, pathlib.Path(__file__).resolve().parent / "npm")
    source = (packages / "axe-core/axe.min.js").read_text()
    with tempfile.TemporaryDirectory() as folder:
        site_folder = pathlib.Path(folder) / "site"
        shutil.copytree(SITE, site_folder)
        (site_folder / "mill/scans").mkdir()
        (site_folder / "mill/scans/ball.nrrd").write_bytes(scans.nrrd())
        with Site(site_folder) as site, Chromium(960, 540) as browser:
            browser.fresh = True
            for name in sys.argv[4:] or PARTS:
                print(f"-- {name}", flush=True)
                PARTS[name](browser, site, source)
    if bad:
        sys.exit("\n".join(bad))


main()
