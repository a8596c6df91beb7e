#!/usr/bin/env python3
"""The course of a session on the page "mill": steps, own marks, score, report, sound, in Chromium without a screen.

    web/tests/course_test.py SITE BURR [PICTURES [PART...]]    SITE: build/web/site; BURR: the program; PICTURES: a folder to keep
                                                           them; PART: learn, advice, practise, exam, sound; all without it

What the page finds is compared with what the program finds in the recording that the page saves. How long things take is
printed, never judged.
"""
import array
import base64
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import tomllib
import wave

from chromium import Chromium, Site
from hand import POINTER

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE, BURR = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
PICTURES = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
WAIT = 300  # [s]

bad = []


def check(good, text):
    print(("good: " if good else "BAD:  ") + text)
    if not good:
        bad.append(text)


def words_of(code):
    return (tomllib.loads((ROOT / f"words/{code}.toml").read_text()) |
            tomllib.loads((ROOT / f"web/words/{code}.toml").read_text()))


def keep(page, name):
    return page.picture(PICTURES and PICTURES / f"{name}.png")


def press(page, key, code=None, modifiers=0):
    for kind in ("keyDown", "keyUp"):
        page.send("Input.dispatchKeyEvent", {"type": kind, "key": key, "code": code or key, "modifiers": modifiers,
                                             "windowsVirtualKeyCode": {"Enter": 13, "Tab": 9, " ": 32}.get(key, 0),
                                             **({"text": "\r" if key == "Enter" else key} if kind == "keyDown" and key in ("Enter", " ") and not modifiers else {})})


def saved(page, downloads, name, button):
    """A file that the page hands over."""
    file = pathlib.Path(downloads) / name
    file.unlink(missing_ok=True)
    page.run(f"document.getElementById('{button}').click()")
    end, before = time.monotonic() + WAIT, -1
    while time.monotonic() < end:
        size = file.stat().st_size if file.exists() else -1
        if size > 0 and size == before:
            return file
        before = size
        time.sleep(0.5)
    check(False, f"{name} is saved")
    return None


def steps(page, code):
    """The panel says what the case says, in the language of the page."""
    case = tomllib.loads((ROOT / "cases/temporal_bone.toml").read_text())
    wanted, spoken = case["step"], words_of(code)
    rows = page.run("[...document.querySelectorAll('#course li button')].map((one) => one.textContent.slice(2))")
    check(rows == [one["title"][code] for one in wanted], f"{len(rows)} steps of the case, in {code}")
    check(page.run("document.querySelector('#course .title').textContent") == wanted[0]["title"][code],
          "the first step has begun")
    said = page.run("document.getElementById('course').textContent")
    check(wanted[0]["say"][code].strip() in said, "its text is the case's")
    check(spoken["steps_done"].replace("{}", "J") in said, f"its button: {spoken['steps_done']}")


def walk(page):
    """Step by step, by the key, by the button, and back."""
    current = "burr.course.steps.rows.findIndex((one) => one.current)"
    page.run("document.getElementById('picture').focus()")
    press(page, "j")
    page.wait(f"{current} === 1", WAIT)
    check(page.run("burr.course.steps.rows[0].done"), "key J: the step is done, and the next one begins")
    page.run("document.querySelectorAll('#course li button')[0].click()")
    page.wait(f"{current} === 0 && !burr.course.steps.rows[0].done", WAIT)
    check(True, "a step is opened again")
    page.run("document.getElementById('step_done').focus()")
    press(page, "Enter", "Enter")
    page.wait(f"{current} === 1", WAIT)
    check(True, "the button works by the keyboard")


def finish(page):
    """The question, the own marks, what burr found."""
    page.run("document.getElementById('picture').focus()")
    press(page, "Enter", "Enter", 2)
    page.wait("document.getElementById('ask').open", WAIT)
    keep(page, "ask")
    check(page.run("document.activeElement.id") == "done_yes", "the question has the keyboard")
    press(page, "Enter", "Enter")
    page.wait("burr.course.page === 'own' && burr.course.picture", WAIT)
    rubric = tomllib.loads((ROOT / "rubrics/temporal_bone.toml").read_text())
    asked = page.run("[...document.querySelectorAll('#review .choice[role=group]')].length")
    check(asked == len(rubric["item"]), f"it asks for {asked} own marks, as many as the rubric has items")
    mine = {rubric["item"][n]["id"]: ("met", "unmet", "unknown")[n % 3] for n in range(5)}
    for item, mark in mine.items():
        page.run(f"document.querySelector('[data-item=\"{item}\"][data-value={mark}]').click()")
    check(page.run("burr.course.marks.size") == 5, "five are given")
    keep(page, "own_marks")
    page.run("document.getElementById('self_finish').focus()")
    press(page, "Enter", "Enter")
    page.wait("burr.course.page === 'found'", WAIT)
    check(page.run("burr.course.trouble") == "", "burr has marked the work")
    took = page.run("burr.course.took")
    print(f"marked in {took['ms'] / 1000:.1f} s, memory of the module {took['memory'] / 1e6:.0f} MB")
    return mine


def same(a, b, where=""):
    """Where two JSON values differ; numbers to the last bits that other floating maths may change."""
    if isinstance(a, dict) and isinstance(b, dict):
        return [found for key in a.keys() | b.keys() for found in same(a.get(key), b.get(key), f"{where}.{key}")]
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        return [found for n, (x, y) in enumerate(zip(a, b)) for found in same(x, y, f"{where}[{n}]")]
    if isinstance(a, (int, float)) and isinstance(b, (int, float)) and not isinstance(a, bool):
        return [] if math.isclose(a, b, rel_tol=1e-12, abs_tol=1e-15) else [f"{where}: {a} and {b}"]
    return [] if a == b else [f"{where}: {a} and {b}"]


def score(page, recorded, mine):
    """`burr score` on the saved file gives the same figures, item by item."""
    told = subprocess.run([BURR, "--quiet", "score", recorded, "--json"], capture_output=True, text=True)
    check(told.returncode == 0, f"burr score reads the page's recording {told.stderr[-300:]}")
    if told.returncode != 0:
        return
    native = json.loads(told.stdout.strip().splitlines()[-1])
    found = page.run("burr.course.found.score")
    check(len(found["items"]) == len(native["items"]) > 30, f"{len(found['items'])} items")
    for one, other in zip(found["items"], native["items"]):
        differ = same(one, other, one["id"])
        if differ:
            check(False, "; ".join(differ))
    rest = {key: native[key] for key in found if key != "items"}
    differ = same({key: found[key] for key in rest}, rest)
    check(not differ, f"the totals are the same {differ}")
    exact = sum(one == other for one, other in zip(found["items"], native["items"]))
    valued = sum("value" in one for one in found["items"])
    print(f"the same to the bit: {exact} of {len(found['items'])} items, {valued} with a value")
    check(valued >= 10, f"{valued} items have a value")
    wet = next(one for one in native["items"] if one["id"] == "coolant.on")
    check(wet["outcome"] == "met" and wet["value"] > 0.9, f"coolant is marked: {wet}")
    check(not native["unfinished"] and native["ending"] == "declared done", "the recording says that the work is done")
    check(native["rubric_changed"] is False, "the recording names the rubric")
    checked = subprocess.run([BURR, "replay", recorded, "--check"], capture_output=True, text=True)
    check(checked.returncode == 0, f"it replays to the bit {checked.stderr[-200:]}")
    info = subprocess.run([BURR, "info", recorded], capture_output=True, text=True).stdout
    check("learn" in info, "burr info knows its mode")
    shown = page.run("[...document.querySelectorAll('#review tr[data-item]')].map((one) => one.dataset.item)")
    check(sorted(shown) == sorted(one["id"] for one in native["items"]), "the page shows every item")
    row = page.run("document.querySelector('#review tr[data-item]').textContent")
    check(words_of("en")["report_default"][:10] in page.run("document.getElementById('review').textContent"),
          "it says that the thresholds are defaults")
    own = page.run("burr.course.found.report.parts.flatMap((part) => part.items).filter((one) => one.self.word).map((one) => one.id)")
    check(set(own) == set(mine), f"the own marks are beside burr's: {row[:60]}")


def report(page, downloads, recorded):
    """The page's report is the program's, but for the picture."""
    file = saved(page, downloads, "burr.html", "save_report")
    if not file:
        return
    html = file.read_text()
    made = pathlib.Path(downloads) / "native.html"
    subprocess.run([BURR, "--quiet", "report", recorded, "--pictures", "0", "--out", made], check=True, capture_output=True)
    native = made.read_text()
    begin, end = html.index('<div class="whole">'), html.index("<h2>" + words_of("en")["report_line"])
    check("data:image/png;base64," in html[begin:end], "the report holds a picture of the bone")
    mine, native = (re.sub(r"(clang|g)\+\+ [0-9. ]+,", "compiler,", one) for one in (html[:begin] + html[end:], native))
    first = next((n for n, (a, b) in enumerate(zip(mine, native)) if a != b), min(len(mine), len(native)))
    check(mine == native, f"all else is what burr report writes, byte for byte but for the compiler's name {mine[first:first + 80] + ' / ' + native[first:first + 80] if mine != native else ''}")


def elsewhere(page, site, loaded):
    later = [url for _, url in page.requests[loaded:] if not url.startswith("blob:")]
    check(not later, f"no request after the page was loaded {later}")
    out = [url for _, url in page.requests if not url.startswith((site.url, "data:", f"blob:{site.url}"))]
    check(not out, f"no request to anywhere else {out}")
    check(len(page.workers) == 4, "all workers were watched: one that ticks, one that waits to take its place, two of the case")
    check(not page.troubles, f"no errors on the console {page.troubles}")


# Asks the page's watch about a burr of 1 mm at a place, as if it were there, while the true rows wait.
ASK = """window.ask = (x, y, z) => new Promise((go) => {
  const listen = ({data}) => {
    if (data.kind !== 'asked') return;
    burr.watch.worker.removeEventListener('message', listen);
    go(data.found);
  };
  burr.watch.worker.addEventListener('message', listen);
  burr.watch.post({kind: 'at', place: [x, y, z, 5e-4]});
})"""
# A place in what must not be cut, [m].
FIND = """(async () => {
  for (let z = -12e-3; z < 14e-3; z += 2e-3) for (let y = -12e-3; y < 14e-3; y += 2e-3) for (let x = -4e-3; x < 22e-3; x += 2e-3) {
    const {to_spare} = await ask(x, y, z);
    if (to_spare !== null && to_spare < -6e-4) return [x, y, z];
  }
})()"""


def coolant(page):
    """Coolant by its key: the button, the sentence, and the ticks say that it runs."""
    pressed = "document.getElementById('coolant').getAttribute('aria-pressed')"
    check(page.run(pressed) == "false" and page.run("burr.figures.wet") == 0, "a session begins dry")
    page.run("document.getElementById('picture').focus()")
    press(page, "i")
    page.wait("burr.figures.wet === 1", WAIT)
    check(page.run(pressed) == "true" and page.run("document.getElementById('say').textContent") == words_of("en")["coolant_on"], "key I: coolant runs")


# The burr waits where it has cut.
HOVER = """(() => {
  const canvas = document.getElementById('picture'), box = canvas.getBoundingClientRect();
  canvas.dispatchEvent(new PointerEvent('pointermove', {clientX: box.left + 0.5 * box.width, clientY: box.top + 0.5 * box.height,
      button: -1, pointerId: 1, pointerType: 'mouse', bubbles: true}));
})()"""


def changed_pixels(one, other):
    """In the middle of the picture, by more than noise."""
    step = one.step
    return sum(max(abs(one.rows[y][step * x + n] - other.rows[y][step * x + n]) for n in range(3)) > 12
               for y in range(100, one.height - 140) for x in range(300, one.width - 300))


def suction(page):
    """It takes water and dust out of the picture, and nothing out of the bone."""
    page.run(HOVER)
    page.run("document.getElementById('picture').focus()")

    def look(name):
        time.sleep(6)  # by itself, what was wet dries meanwhile
        page.run("burr.picture.snapshot()")
        return keep(page, name)
    before = look("suction_before")
    for _ in range(12):  # until the burr is there and the picture is as fine as it gets
        now = look("suction_without")
        alone, before = changed_pixels(before, now), now
        if alone < 20:
            break
    press(page, "6")
    page.wait("document.getElementById('suction').getAttribute('aria-pressed') === 'true'", WAIT)
    cleared = changed_pixels(before, look("suction_with"))
    check(cleared > 40 and cleared > 2 * alone, f"suction clears the picture: pixels that change without it, with it: {alone}, {cleared}")
    press(page, "6")


def guidance(page):
    """The target of the step is lit; a burr that is in a structure is lifted, and the page says in which."""
    spoken = words_of("en")
    page.run("document.getElementById('picture').focus()")
    press(page, "a")
    page.wait("burr.course.lit !== null", WAIT)
    lit = page.run("burr.course.lit")
    check(lit["step"] == page.run("burr.course.steps.now.id") and (lit["marks"] or lit["lines"]),
          f"key A lights the target: {len(lit['marks'])} marks, tissues {lit['tissues']}")
    page.wait("burr.refined()", WAIT)
    shown = page.run("[...document.querySelectorAll('#light path')].map((one) => { const {x, y, width, height} = one.getBoundingClientRect(); return [x + width / 2, y + height / 2, Math.max(width, height) / 2, one.getAttribute('class')]; })")
    check(len(shown) == len(lit["marks"]) and all(0 < x < 960 and 0 < y < 540 and r >= 6 for x, y, r, _ in shown), f"the marks are in the picture: {shown}")
    check("target" in {kind for *_, kind in shown}, "and a target is among them")
    check(page.run("document.getElementById('step_light').textContent") == spoken["steps_unlight"].replace("{}", "A"), "the button puts it out")
    keep(page, "lit")
    page.run("document.getElementById('step_light').click()")
    check(page.run("burr.course.lit === null && document.querySelectorAll('#light path').length === 0"), "and it is out")
    page.wait("burr.watch.found", WAIT)
    check(page.run("!document.getElementById('near').hidden && document.getElementById('near_title').textContent !== ''"),
          f"the figure: {page.run('document.getElementById(`near`).textContent')}")
    page.run(ASK)
    page.run("document.getElementById('picture').dispatchEvent(new PointerEvent('pointerdown', {clientX: 480, clientY: 200, button: 0, buttons: 1, pointerId: 1}))")
    check(page.run("burr.pressing()"), "the burr is pressed")
    place = page.run(FIND)
    found = page.run("burr.watch.found")
    check(place and found["injured"] and found["stop"].startswith(spoken["injury_stop"].split("{}")[0]) and
          page.run("document.getElementById('say').textContent") == found["stop"], f"in a structure at {place}: {found['stop']}")
    check(not page.run("burr.pressing()"), "the burr is lifted")
    check(page.run("document.getElementById('near').className") == "bad" and "!!" in page.run("document.getElementById('near').textContent"),
          "the figure is marked")
    check(page.run(f"ask({place[0]}, {place[1]}, {place[2]})")["stop"] == "", "it is said once")
    keep(page, "stopped")
    page.run("document.getElementById('picture').dispatchEvent(new PointerEvent('pointerup', {pointerId: 1, button: 0})); burr.watch.post({kind: 'go_on'})")


def advised(page):
    """Two seconds with a burr that does not suit the step: one sentence."""
    page.run("document.querySelectorAll('#course li button')[5].click()")
    suits = page.run("burr.course.steps.now.tool")
    for _ in range(12):
        page.run("document.getElementById('smaller').click()")
    page.run(f"void {POINTER}(8000)")
    page.wait("document.getElementById('advice').textContent !== ''", WAIT)
    check(True, f"advice: {page.run('document.getElementById(`advice`).textContent')} (step: {suits})")
    keep(page, "advice")


def advice(browser, site, _downloads):
    page = browser.open(site.url + "mill/?language=de&mode=learn")
    page.wait("window.burr && burr.ready && burr.loaded", WAIT)
    advised(page)
    check(page.run("document.getElementById('near_title').textContent") in (words_of("de")["nearest_far"],) or
          page.run("document.getElementById('near_title').textContent").startswith(words_of("de")["nearest"].split("{}")[0]), "the figure's title is German")
    check(not page.troubles, f"no errors on the console {page.troubles}")
    page.close()


def learn(browser, site, downloads):
    page = browser.open(site.url + "mill/?language=en&mode=learn")
    page.wait("window.burr && burr.ready && burr.loaded", WAIT)
    print("times [ms]:", page.run("JSON.stringify(burr.times)"))
    loaded = len(page.requests)
    steps(page, "en")
    keep(page, "steps")
    walk(page)
    coolant(page)
    guidance(page)
    page.run(POINTER + "(9000)")
    page.wait("burr.figures.removed > 1", WAIT)
    suction(page)
    page.run("(() => { const one = document.getElementById('language'); one.value = 'sv'; one.dispatchEvent(new Event('change')); })()")
    page.wait("document.querySelector('#course .title')?.textContent === burr.course.steps.rows.find((one) => one.current).title && "
              f"burr.course.texts.done_yes === {json.dumps(words_of('sv')['done_yes'])}", WAIT)
    page.run("(() => { const one = document.getElementById('language'); one.value = 'en'; one.dispatchEvent(new Event('change')); })()")
    page.wait(f"burr.course.texts.done_yes === {json.dumps(words_of('en')['done_yes'])}", WAIT)
    mine = finish(page)
    keep(page, "found")
    recorded = saved(page, downloads, "burr.mcap", "save_done")
    if recorded:
        told = recorded.read_bytes()
        check(b"injury" in told and b"sigmoid sinus" in told and b"help_shown" in told, "the recording says what was lit and where the burr was stopped")
        score(page, recorded, mine)
        report(page, downloads, recorded)
    elsewhere(page, site, loaded)
    page.close()


def measured(page):
    """A step that says how it is measured is ticked off by itself. The bone of the steps gets bricks that are cut away."""
    current = "burr.course.steps.rows.findIndex((one) => one.current)"
    page.run("document.querySelectorAll('#course li button')[1].click()")
    page.wait(f"{current} === 1 && burr.course.steps.now.measured", WAIT)
    time.sleep(4)  # what was cut until now is measured, and is too little
    check(page.run(current) == 1, "the antrum is not open yet")
    page.run("""(() => { const kBrick = 1028, bytes = new Uint8Array(4000 * kBrick), all = new DataView(bytes.buffer);
      for (let n = 0; n < 4000; ++n) all.setInt32(n * kBrick, n, true);
      burr.course.look(bytes); })()""")
    page.wait(f"{current} === 2", WAIT)
    title = page.run("burr.course.steps.rows[1].title")
    check(page.run("document.getElementById('say').textContent") == words_of("en")["steps_ticked"].replace("{}", title),
          f"without bone it is, and burr says so: {title}")


def practise(browser, site, _downloads):
    page = browser.open(site.url + "mill/?language=en&mode=practise")
    page.wait("window.burr && burr.ready && burr.loaded", WAIT)
    check(page.run("document.getElementById('course').hidden"), "practise: steps come when they are asked for")
    page.run("document.getElementById('show_steps').click()")
    page.wait("!document.getElementById('course').hidden", WAIT)
    measured(page)
    page.run(ASK)
    place = page.run(FIND)
    found = place and page.run(f"ask({place[0]}, {place[1]}, {place[2]})")
    check(found and found["injured"] and found["stop"] == "" and page.run("document.getElementById('near').hidden"),
          "practise: a tone, no stop and no distance")
    page.close()


def exam(browser, site, downloads):
    """No steps, no way back, no marks; the recording is kept, and says that it was an exam."""
    page = browser.open(site.url + "mill/?language=de&mode=exam")
    page.wait("window.burr && burr.ready && burr.loaded", WAIT)
    said = words_of("de")
    check(page.run("document.getElementById('say').textContent") == said["exam_begins"], f"exam: {said['exam_begins']}")
    check(page.run("document.getElementById('course').hidden && document.getElementById('show_steps').hidden && "
                   "['undo', 'redo', 'reset'].every((id) => document.getElementById(id).disabled)"), "no steps and no way back")
    check(page.run("burr.watch.worker === null && document.getElementById('near').hidden"), "no distance, and nobody watches")
    press(page, "a")
    check(page.run("burr.course.lit === null"), "no target")
    page.run(POINTER + "(3000)")
    before = page.run("burr.figures.removed")
    page.run("document.getElementById('picture').focus()")
    press(page, "u")
    time.sleep(2)
    check(page.run("burr.figures.removed") >= before > 0, "key U brings nothing back")
    page.run("burr.course.ask_done(); document.getElementById('done_yes').click()")
    page.wait("burr.course.page === 'own' && burr.course.picture", WAIT)
    page.run("document.getElementById('self_skip').click()")
    page.wait("burr.course.page === 'exam' && burr.course.file", WAIT)
    check(said["review_exam"] in page.run("document.getElementById('review').textContent") and page.run("burr.course.found") is None,
          "the marks are not shown")
    keep(page, "exam")
    recorded = saved(page, downloads, "burr.mcap", "save_done")
    told = subprocess.run([BURR, "--quiet", "score", recorded, "--json"], capture_output=True, text=True)
    check(told.returncode == 0 and not json.loads(told.stdout.strip().splitlines()[-1])["unfinished"], "the examiner can score it")
    check(not page.troubles, f"no errors on the console {page.troubles}")
    page.close()


# The samples of a recording, made by the page's module from the rows of its ticks, as floats in base64.
SAMPLES = """(async (recording, ticks) => {
  const {compile, start} = await import('../common/burr.js');
  const {default: make} = await import('../burr_replay.mjs');
  const {load_codecs} = await import('../common/codecs.mjs');
  const burr = await start(await compile('burr_replay.wasm'), make, await load_codecs('zstd'));
  burr.module.FS.writeFile('/burr.mcap', Uint8Array.from(atob(recording), (one) => one.charCodeAt(0)));
  const path = new TextEncoder().encode('/burr.mcap\\0');
  if (burr.with_bytes([path], (at) => burr.core_open(at)) === 0) return burr.text(burr.core_why());
  const none = new Proxy({}, {get: () => () => 0});
  const {exports} = await WebAssembly.instantiate(await compile('burr_sound.wasm'), {env: none, wasi_snapshot_preview1: none});
  exports._initialize?.();
  exports.sound_open(48000, burr.core_rate());
  exports.sound_loudness(1);
  const all = new Float32Array(48 * ticks);
  for (let n = 0; n < ticks; ++n) {
    burr.core_seek((n + 0.1) / burr.core_rate());
    const size = burr.core_row_size();
    new Uint8Array(exports.memory.buffer, exports.sound_row(), size).set(burr.bytes(burr.core_row(), size));
    exports.sound_update();
    all.set(new Float32Array(exports.memory.buffer, exports.sound_make(48), 48), 48 * n);
  }
  let text = '';
  for (const one of new Uint8Array(all.buffer)) text += String.fromCharCode(one);
  return btoa(text);
})"""


def sound(browser, site, downloads):
    """Silent until somebody asks; then it sounds; its samples are the program's."""
    file, made = pathlib.Path(downloads) / "block.mcap", pathlib.Path(downloads) / "block.wav"
    subprocess.run([BURR, "--quiet", "mill", "phantom:block", "--voxel-mm", "0.5", "--motion", "pocket", "--burr-mm", "4",
                    "--seconds", "1.5", "--record", file, "--embed"], check=True, capture_output=True)
    subprocess.run([BURR, "--quiet", "replay", file, "--sound", made], check=True, capture_output=True)
    with wave.open(str(made)) as read:
        native = array.array("h", read.readframes(read.getnframes()))
    page = browser.open(site.url + "mill/?language=en")
    page.wait("window.burr && burr.ready && burr.loaded", WAIT)
    loaded = len(page.requests)
    check(page.run("burr.sound.trouble") == "" and page.run("burr.sound.context.state") == "suspended" and
          page.run("burr.sound.node === null"), "no sound before somebody asks for it")
    spoken = words_of("en")
    check(page.run("document.getElementById('sound').textContent") == spoken["sound_on"], "the button offers it")
    page.run("document.getElementById('sound').focus()")
    press(page, "Enter", "Enter")
    page.wait("burr.sound.context.state === 'running'", WAIT)
    check(page.run("document.getElementById('sound').textContent") == spoken["mute"], "the keyboard switches it on; the button mutes it")
    check(page.run("burr.sound.loudness") == 0.25, "it begins quiet")
    page.run("""(() => { const {context, node} = burr.sound; window.ear = context.createAnalyser(); ear.fftSize = 8192; node.connect(ear);
      window.heard = () => { const some = new Float32Array(ear.fftSize); ear.getFloatTimeDomainData(some);
        return Math.sqrt(some.reduce((sum, one) => sum + one * one, 0) / some.length); }; })()""")
    check(page.run("heard()") == 0, "a burr that stands is silent")
    page.run(ASK)
    page.run(FIND)
    page.wait("heard() > 0.005", WAIT)
    check(True, f"near a structure a tone warns, {page.run('heard()'):.3f} of full scale")
    page.run("ask(0.2, 0.2, 0.2)")
    page.wait("heard() === 0", WAIT)
    page.run("burr.watch.post({kind: 'go_on'})")
    page.run(f"void {POINTER}(20000)")  # it turns while it is pressed
    page.wait("heard() > 0.005", WAIT)
    level = page.run("heard()")
    page.run("(() => { const one = document.getElementById('volume'); one.value = 1; one.dispatchEvent(new Event('input')); })()")
    page.wait(f"heard() > 2 * {level}", WAIT)
    check(True, f"it sounds, {level:.3f} of full scale, and louder when it is asked to")
    page.run("document.getElementById('sound').click()")
    page.wait("burr.sound.context.state === 'suspended' && !burr.sound.on", WAIT)
    check(True, "muted, it stops")
    check(not [url for _, url in page.requests[loaded:] if not url.startswith("blob:")], "no request for the sound")
    check(not page.troubles, f"no errors on the console {page.troubles}")
    ticks = len(native) // 48
    coded = page.run(f"{SAMPLES}({json.dumps(base64.b64encode(file.read_bytes()).decode())}, {ticks})")
    try:
        mine = array.array("f", base64.b64decode(coded, validate=True))
    except Exception:
        check(False, f"samples: {coded[:200]}")
        return
    loud = max(abs(one) for one in native)
    off = [abs(32767 * a - b) for a, b in zip(mine, native)]
    check(len(mine) == len(native) and loud > 2000, f"{len(mine)} samples of a recording, the loudest {loud} of 32767")
    check(max(off) <= 0.51, f"they are the program's but for its rounding to 16 bits: {max(off):.3f} of a step")
    page.close()


def main():
    with tempfile.TemporaryDirectory() as downloads, Site(SITE) as site, Chromium(960, 540) as browser:
        browser.keep_downloads(downloads)
        browser.fresh = True
        for part in (learn, advice, practise, exam, sound):
            if part.__name__ in (sys.argv[4:] or [part.__name__]):
                part(browser, site, downloads)
    if bad:
        sys.exit("\n".join(bad))


main()
