#!/usr/bin/env python3
"""Opens the page "mill" in Chromium without a screen, mills by a scripted pointer, and looks at what comes of it.

    web/tests/page_test.py SITE BURR [PICTURES]      SITE: build/web/site; BURR: the program; PICTURES: a folder to keep them

The server sends no special headers (no COOP, no COEP), as any static host does. How long things take is printed,
never judged: all waits end after minutes.
"""
import json
import math
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time
import tomllib

import scans
from chromium import Chromium, Site
from hand import PARK, POINTER

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE, BURR = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
PICTURES = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
if PICTURES:
    PICTURES.mkdir(parents=True, exist_ok=True)
WAIT = 300  # [s]
LEAST_TICKS = 20000
# Of the picture around the burr, in heights of the picture: the shade of a new edge reaches so far, and dust.
REACH = 0.22

bad = []


def policy():
    """The header that docs/use/browser.md names."""
    return re.search(r"Content-Security-Policy: (.+)", (ROOT / "docs/use/browser.md").read_text())[1]


def check(good, text):
    print(("good: " if good else "BAD:  ") + text)
    if not good:
        bad.append(text)


def at_rest(page):
    """Waits until the picture is complete, and no sentence stands over it."""
    page.run("document.getElementById('card_close').click(); document.getElementById('picture').focus()")
    page.run(PARK)
    time.sleep(2)
    page.wait("document.getElementById('say').textContent === ''", WAIT)
    page.wait("burr.refined()", WAIT)
    time.sleep(2)


def mill(page):
    page.wait("window.burr && burr.ready && burr.loaded", WAIT)
    print("times [ms]:", page.run("JSON.stringify(burr.times)"), "by", page.run("burr.gpu"))
    check(page.run("burr.times.first_picture > 0 && burr.pictures > 0"), "the first picture is there")
    check(page.run("!crossOriginIsolated"), "it works without COOP and COEP")
    loaded = len(page.requests)
    at_rest(page)
    before = page.picture(PICTURES and PICTURES / "before.png")
    high = page.run("document.getElementById('picture').clientHeight")
    done = page.run(POINTER + "(5000)")
    at_rest(page)
    after = page.picture(PICTURES and PICTURES / "after.png")
    figures = page.run("burr.figures")
    check(figures["removed"] > 1, f"removed {figures['removed']:.1f} mm3, more than 1")
    check(done["pressed"]["touching"] == 1 and 0 < done["pressed"]["force"] <= 3.31,
          f"the force while pressing is {done['pressed']['force']:.2f} N")
    x, y, radius = done["place"]
    far = radius + REACH * high
    parked = page.run("burr.place()")  # the burr there has turned
    changed = [at for at in before.different(after)
               if at[1] < high and math.dist(at, parked[:2]) > 3 * parked[2]]
    near = [at for at in changed if math.dist(at, (x, y)) <= far]
    outside = [at for at in changed if math.dist(at, (x, y)) > far]
    check(len(near) > 100, f"{len(near)} pixels differ around the burr")
    check(not outside, f"nothing differs elsewhere: {len(outside)} pixels, the first {outside[:3]}")
    return loaded


def undo_and_reset(page):
    before = page.run("burr.figures.removed")
    page.run("document.getElementById('undo').click()")
    page.wait(f"burr.figures.removed < {before} - 1", WAIT)
    check(True, f"undo brings back {before - page.run('burr.figures.removed'):.1f} mm3")
    page.run("document.getElementById('smaller').click(); document.getElementById('slower').click()")
    page.wait("burr.figures.size === 4.5 && Math.round(burr.figures.rpm) === 75000", WAIT)
    check(True, "another burr and another speed are in the hand")


def record(page, downloads):
    """A recording of at least LEAST_TICKS ticks, with undo, which the program replays to the bit."""
    page.run(POINTER + "(4000)")
    page.wait(f"burr.state.ticks >= {LEAST_TICKS}", WAIT)
    return recording(page, downloads, LEAST_TICKS)


def recording(page, downloads, least_ticks=1000):
    page.run("document.getElementById('save').click()")
    file = pathlib.Path(downloads) / "burr.mcap"
    end = time.monotonic() + WAIT
    while not (file.exists() and file.stat().st_size == (page.run("burr.saved") or -1)):
        if time.monotonic() > end:
            check(False, "the recording is saved as burr.mcap")
            return None
        time.sleep(0.2)
    replayed = subprocess.run([BURR, "replay", file, "--check"], capture_output=True, text=True)
    said = (replayed.stderr + replayed.stdout).strip().splitlines()[-1]
    same = re.search(r"the same to the bit: (\d+) ticks", said)
    check(replayed.returncode == 0 and same is not None and int(same[1]) >= least_ticks, f"burr replay --check: {said}")
    return file


def finer(page):
    """The same bone with finer voxels: the worker begins anew, after a question."""
    page.run("document.getElementById('finer').click()")
    page.run("document.getElementById('anew_yes').click()")
    page.wait("burr.voxel === 0.25 && burr.ready && burr.state.ticks > 100", WAIT)
    page.run("document.getElementById('larger').click()")
    page.wait("burr.figures.size === 5.5", WAIT)
    check(True, "the finer bone is there, with ticks")


def requests(page, site, loaded):
    """Of the page and of its worker."""
    elsewhere = [url for _, url in page.requests
                 if not url.startswith((site.url, "data:", f"blob:{site.url}"))]
    check(not elsewhere, f"no request to anywhere else {elsewhere}")
    check(any(url.endswith("/worker.js") for _, url in page.requests) and page.workers, "the worker was watched too")
    later = [url for _, url in page.requests[loaded:] if not url.startswith("blob:")]
    check(not later, f"no request after the page was loaded {later}")


def without_webgl(browser, site):
    """The sentence says so, and stays."""
    page = browser.open(site.url + "mill/?language=en", "HTMLCanvasElement.prototype.getContext = () => null;")
    page.wait("window.burr?.trouble", WAIT)
    time.sleep(8)  # the worker would have been ready by now
    said = page.run("document.getElementById('say').textContent")
    check(said == words_of("en")["no_webgl"], f"a browser without WebGL 2 says: {said}")
    page.close()


HIDDEN = """(() => { let hidden = true;
  Object.defineProperty(document, 'hidden', {get: () => hidden});
  window.show_page = (on) => { hidden = !on; document.dispatchEvent(new Event('visibilitychange')); };
})()"""
# Counts the timers of a worker that have not fired.
TIMERS = """(() => { const set = self.setTimeout, clear = self.clearTimeout; self.pending = new Set();
  self.setTimeout = (call, ms) => { const one = set(() => { pending.delete(one); call(); }, ms); pending.add(one); return one; };
  self.clearTimeout = (one) => { pending.delete(one); clear(one); };
})()"""


def in_the_background(browser, site):
    """A page that nobody sees does not tick, also when it was opened so. The host sends the policy for the worker."""
    page = browser.open(site.url + "mill/", HIDDEN)
    page.wait("window.burr && burr.ready", WAIT)
    page.run(TIMERS, page.workers[0])
    time.sleep(2)
    page.run("burr.hash()")
    page.wait("burr.hashes", WAIT)
    check(page.run("burr.hashes.ticks") == 0, f"no tick in the background: {page.run('burr.hashes.ticks')}")
    page.run("show_page(true)")
    page.wait("burr.state.ticks > 500", WAIT)
    page.run("for (let n = 0; n < 20; ++n) { show_page(false); show_page(true); }")
    page.wait(f"burr.state.ticks > {page.run('burr.state.ticks')} + 200", WAIT)
    pending = page.run("pending.size", page.workers[0])
    check(pending <= 1, f"one beat at a time waits: {pending}")
    memory = page.run("""(async () => { const {compile, start} = await import('../common/burr.js');
      const another = await start(await compile());
      try { another.with_bytes([{byteLength: 3e9}], () => 0); return 'nothing'; } catch (what) { return what.why; } })()""")
    check(memory == "no_memory", f"more than the memory holds: {memory}")
    check(not page.troubles, f"no errors on the console {page.troubles}")
    page.close()


def bone_hash(page):
    page.run("delete burr.bone, burr.hash()")
    page.wait("burr.bone", WAIT)
    return page.run("burr.bone")


def seek(page, seconds):
    page.run(f"(() => {{ const time = document.getElementById('time'); time.value = {seconds};"
             "time.dispatchEvent(new Event('input')); })()")
    page.wait(f"Math.abs(burr.shown - {seconds}) < 0.02", WAIT)
    page.wait("burr.refined()", WAIT)


def show_the_saw(page, folder):
    """A tool of the rack is drawn as what it is, not as a round burr."""
    file = folder / "saw.mcap"
    subprocess.run([BURR, "--quiet", "mill", "phantom:block", "--voxel-mm", "0.5", "--motion", "pocket", "--tool", "sagittal-saw",
                    "--seconds", "1", "--record", file, "--embed"], capture_output=True, check=True)
    page.choose("#file", file)
    page.wait("burr.ready && burr.shown === 0", WAIT)
    seek(page, 0.9)
    saw = page.picture(PICTURES and PICTURES / "replay_saw.png")
    pictures = page.run("burr.pictures")
    page.run("burr.held(-1)")
    page.wait(f"burr.pictures > {pictures} && burr.refined()", WAIT)
    other = len(saw.different(page.picture(PICTURES and PICTURES / "replay_no_saw.png")))
    check(other > 500, f"a saw is no round burr: {other} pixels differ")


def two_bodies():
    """A scan of a block and, apart from it, a cube of 6 mm around (9, 0, 0) mm, as NRRD."""
    count, size = 64, 0.5
    first = -size * (count - 1) / 2
    places = [first + size * n for n in range(count)]
    values = bytearray()
    for z in places:
        for y in places:
            for x in places:
                deep = max(min(8 - abs(x + 4), 8 - abs(y), 5 - abs(z)), min(3 - abs(x - 9), 3 - abs(y), 3 - abs(z)))
                values += struct.pack("<h", int(max(-1000, min(1500, 250 + 1250 * deep)) + 7 * x))
    return (f"NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: {count} {count} {count}\n"
            f"space directions: ({size},0,0) (0,{size},0) (0,0,{size})\nspace origin: ({first},{first},{first})\n"
            "kinds: domain domain domain\nendian: little\nencoding: raw\n\n").encode() + values


def show_the_piece(page, folder):
    """A piece of bone that a hand carries is blue, and where the hand carried it: from (9, 0, 0) to (13, 0, 8) mm."""
    (folder / "two.nrrd").write_bytes(two_bodies())
    (folder / "approach.csv").write_text("t,x_mm,y_mm,z_mm,spindle\n0,9,0,12,0\n1,9,0,12,0\n")
    (folder / "carry.csv").write_text("t,x_mm,y_mm,z_mm,spindle\n0,9,0,12,0\n0.5,9,0,12,1\n2.5,13,0,20,1\n4,13,0,20,1\n")
    file = folder / "piece.mcap"
    subprocess.run([BURR, "--quiet", "mill", folder / "two.nrrd", "--iso", "250", "--voxel-mm", "0.5", "--path", folder / "approach.csv",
                    "--arm", "rigid", "--carry-piece", f"9,0,0:{folder / 'carry.csv'}", "--record", file, "--embed"],
                   capture_output=True, check=True)

    def blue(name):
        picture = page.picture(PICTURES and PICTURES / name)
        high = page.run("document.getElementById('picture').clientHeight")
        found = []
        for y in range(min(high, picture.height)):
            for x in range(picture.width):
                red, green, light = picture.pixel(x, y)
                if light > 90 and light > 1.2 * green and light > 1.8 * red:
                    found.append((x, y))
        return found

    page.choose("#file", file)
    page.wait("burr.ready && burr.shown === 0", WAIT)
    seek(page, 1)
    before = blue("replay_before_piece.png")
    seek(page, 14.5)
    at = blue("replay_piece.png")
    check(not before and len(at) > 100, f"{len(before)} blue pixels before the piece is lifted, {len(at)} while it is carried")
    corners = [page.run(f"burr.place({x}, {y}, {z})") for x in (0.010, 0.016) for y in (-0.003, 0.003) for z in (0.005, 0.011)]
    for n, side in enumerate(("across", "down")):
        found = [pick(one[n] for one in at) for pick in (min, max)] if at else [0, 0]
        wanted = [pick(one[n] for one in corners) for pick in (min, max)]
        check(all(abs(a - b) <= 3 for a, b in zip(found, wanted)),
              f"it is where the hand carried it: {side} from {found[0]} to {found[1]} pixels, its corners from {wanted[0]:.1f} to {wanted[1]:.1f}")


def replay(browser, site, recorded):
    """The page "replay" shows recordings of the program and of the page; the bone at the end is the program's, to the bit."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "native.mcap"
        told = subprocess.run([BURR, "--quiet", "mill", "phantom:block", "--voxel-mm", "0.5", "--motion", "pocket", "--burr-mm",
                               "4", "--seconds", "3", "--record", file, "--embed", "--json"],
                              capture_output=True, text=True, check=True)
        milled = json.loads(told.stdout.strip().splitlines()[-1])
        page = browser.open(site.url + "replay/")
        page.wait("window.burr?.open", WAIT)
        loaded = len(page.requests)
        page.choose("#file", file)
        page.wait("burr.ready && burr.shown === 0", WAIT)
        start = bone_hash(page)
        page.run("(() => { const time = document.getElementById('time'); time.value = burr.seconds;"
                 "time.dispatchEvent(new Event('input')); })()")
        page.wait("burr.shown === burr.seconds", WAIT)
        check("0x" + bone_hash(page) == milled["bone_hash"] != "0x" + start,
              "the bone at the end is that of the program to the bit")
        removed = page.run("burr.figures.removed")
        check(abs(removed - milled["removed_mm3"]) < 1e-9, f"removed {removed:.3f} mm3, as the program says")
        page.wait("burr.refined()", WAIT)
        page.picture(PICTURES and PICTURES / "replay.png")
        slow = pathlib.Path(folder) / "slow.mcap"
        subprocess.run([BURR, "--quiet", "mill", "phantom:block", "--voxel-mm", "0.5", "--motion", "pocket", "--burr-mm",
                        "4", "--seconds", "1", "--rate", "500", "--record", slow, "--embed"], capture_output=True, check=True)
        page.choose("#file", slow)
        page.wait("burr.ready && burr.shown === 0", WAIT)
        page.run("(() => { const time = document.getElementById('time'); time.value = burr.seconds;"
                 "time.dispatchEvent(new Event('input')); })()")
        page.wait("burr.shown === burr.seconds", WAIT)
        shown, wanted = page.run("burr.figures.time"), page.run("burr.seconds")
        check(abs(shown - wanted) < 0.01, f"a recording of 500 ticks a second ends at {shown:.3f} s of {wanted:.3f} s")
        if recorded:
            page.choose("#file", recorded)
            page.wait("burr.ready && burr.shown === 0", WAIT)
            check(page.run(f"burr.seconds >= {LEAST_TICKS / 1000}"), "the page's own recording opens too")
        show_the_saw(page, pathlib.Path(folder))
        show_the_piece(page, pathlib.Path(folder))
        bad_file = pathlib.Path(folder) / "bad.mcap"
        bad_file.write_bytes(file.read_bytes()[:1000])
        page.choose("#file", bad_file)
        page.wait("burr.refused", WAIT)
        check("bad.mcap" in page.run("burr.refused"), f"a torn file is refused: {page.run('burr.refused')}")
        kept = page.run("""(() => { const data = new DataTransfer(); data.items.add(new File(['x'], 'dropped.mcap'));
          return document.querySelector('footer').dispatchEvent(
              new DragEvent('drop', {bubbles: true, cancelable: true, dataTransfer: data})) === false; })()""")
        check(kept, "a file that is dropped beside the picture does not take the page's place")
        if kept:
            page.wait("burr.refused?.includes('dropped.mcap')", WAIT)
            check(True, f"it is opened: {page.run('burr.refused')}")
        requests(page, site, loaded)
        sent = [one for one in page.sent if one != "GET"]
        check(not sent, f"nothing is uploaded {sent}")
        check(not page.troubles, f"no errors on the console {page.troubles}")
        page.close()


def own_scan(browser, site):
    """Scans of the user's: each format becomes bone and is milled; what is refused is one sentence, and the page lives on."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        page = browser.open(site.url + "mill/")
        page.wait("window.burr && burr.ready && burr.loaded", WAIT)
        browser.keep_downloads(name)
        loaded = len(page.requests)

        def opened(*files):
            page.run("document.getElementById('own_scan')?.open && document.getElementById('own_close').click()")
            page.run("document.getElementById('own').click()")
            page.wait("document.getElementById('own_scan')?.open", WAIT)
            page.choose("#own_files", *files)
            page.wait("burr.own.plan || burr.own.refused", WAIT)
            return page.run("burr.own.plan")

        def file(name, content):
            (folder / name).write_bytes(content)
            return folder / name

        def slices(name, *how):
            return [file(f"{name}{k}.dcm", one) for k, one in enumerate(scans.dicom(*how))]

        whole = [scans.EDGE] * 3
        kinds = {"NRRD, gzip": [file("ball.nrrd", scans.nrrd())], "NIfTI": [file("ball.nii.gz", scans.nifti())],
                 "MetaImage, zlib": [file("ball.mha", scans.meta())], "DICOM": slices("plain", scans.UNCOMPRESSED),
                 "DICOM, deflated": slices("deflated", scans.DEFLATED), "DICOM, run lengths": slices("runs", scans.RLE)}
        for kind, files in kinds.items():
            plan = opened(*files)
            check(plan and plan["scan"] == whole and abs(plan["voxel_mm"] - scans.SPACING) < 1e-6 and
                  plan["low"] == -1000 and plan["high"] == 1000,
                  f"{kind}: {plan and plan['format']}, {plan and plan['scan']} {page.run('burr.own.refused')}")
        real(page, opened)
        iso = opened(*kinds["NRRD, gzip"])["iso"]
        page.run("(() => { const set = (id, value) => { document.getElementById(id).value = value; };"
                 "set('own_level', 200); set('own_k1', 24); document.querySelector('#own_scan form').dispatchEvent(new Event('change')); })()")
        page.wait("burr.own.plan.iso === 200", WAIT)
        check(iso == 300 and page.run("burr.own.plan.size[2]") == 25, "level and region are the user's")
        page.run("document.querySelector('#own_scan form').requestSubmit()")
        page.wait("!burr.ready", WAIT)
        page.run("document.getElementById('card_close').click()")
        page.wait("burr.ready && burr.state.ticks > 200 && burr.refined()", WAIT)
        check(page.run("!document.getElementById('own_scan').open"), "bone is made of it, and the dialog closes")
        page.run(POINTER + "(3000)")
        removed = page.run("burr.figures.removed")
        check(1 < removed < scans.MM3, f"the own bone is milled: {removed:.1f} mm3")
        page.picture(PICTURES and PICTURES / "own.png")
        check(page.run("document.getElementById('finish').disabled && burr.course.steps === null"), "it has no steps and no score")
        saved = recording(page, name)
        check(saved is not None and b"temporal-bone" not in saved.read_bytes(), "its recording names no case")

        damaged = bytearray(scans.nrrd())
        damaged[-2000] ^= 255
        refused = {"cut off": ([file("cut.nrrd", scans.nrrd()[:len(scans.nrrd()) // 2])], "cut off"),
                   "a sum that is wrong": ([file("damaged.nrrd", bytes(damaged))], "damaged"),
                   "bzip2": ([file("ball_bz.nrrd", scans.nrrd("bzip2"))], "bzip2"),
                   "JPEG with loss": (slices("lossy", scans.LOSSY), scans.LOSSY),
                   "JPEG without its pixels": (slices("jpeg", scans.LOSSLESS), "cannot be decompressed"),
                   "no pixel data": (slices("empty", scans.UNCOMPRESSED, "1.2.3.0", False), "it holds no picture"),
                   "more than the memory": ([huge(folder)], words_of("en")["scan_memory"]),
                   "no scan": ([file("text.txt", b"hello")], "text.txt"), "an empty file": ([file("none.nrrd", b"")], "empty")}
        for kind, (files, part) in refused.items():
            plan = opened(*files)
            said = page.run("burr.own.refused") or ""
            check(plan is None and part in said, f"{kind} is refused: {said}")
        plan = opened(*slices("plain", scans.UNCOMPRESSED), *slices("other", scans.UNCOMPRESSED, "1.2.3.1"))
        check(plan and plan["scan"] == whole and "series" in " ".join(plan["notices"]), f"of two series one is read, and it says so: {plan and plan['notices']}")
        plan = opened(file("grey.nrrd", scans.nrrd("grey")))
        check(plan and not plan["hounsfield"] and plan["notices"], f"no Hounsfield units: {plan and plan['notices']}")
        odd(page, opened)
        page.run("document.getElementById('own_close').click()")
        pages_bone_again(page)
        ticks = page.run("burr.state.ticks")
        page.wait(f"burr.state.ticks > {ticks} + 200", WAIT)
        check(not page.run("burr.trouble"), "the page lives on")
        ours = ("common/import.js", "common/import.css", "common/import_worker.js", "burr_import.mjs", "burr_import.wasm", "common/codecs.mjs", "common/zstd.mjs",
                *(f"codecs/{one}" for one in ("pako.mjs", "charls.mjs", "charls.wasm", "openjpeg.mjs", "openjpeg.wasm", "zstd.wasm")))
        later = [url for _, url in page.requests[loaded:] if not url.startswith("blob:")]
        elsewhere = [url for url in later if not (url.startswith(site.url) and url.endswith(ours))]
        sent = [one for one in page.sent if one != "GET"]
        check(later and not elsewhere and not sent, f"after load only the reader itself is fetched, nothing is sent {elsewhere} {sent}")
        check(not page.troubles, f"no errors on the console {page.troubles}")
        page.close()


def huge(folder):
    """A file that is larger than a page may read; it takes no room on the disk."""
    with (folder / "huge.nrrd").open("wb") as out:
        out.truncate(1_100_000_000)
    return folder / "huge.nrrd"


REAL = {  # files below shared/data: how many of them in a row; size and least and greatest value, as `burr` on a desktop reads them
    "JPEG-LS": ("skull_phantom/bone_1mm_jpegls", 40), "JPEG lossless": ("skull_phantom/std_5mm_jpegll", 28),
    "JPEG 2000": ("skull_phantom/tilt_minus18.5_j2k", 54)}


def real(page, opened):
    """Scans of a scanner, compressed, where they lie beside the checkout."""
    for kind, (where, count) in REAL.items():
        folder = ROOT.parent / "shared/data" / where
        files = sorted((one for one in folder.rglob("*") if one.is_file()), key=lambda one: (len(one.name), one.name))[:count]
        if not files:
            continue
        begun = time.monotonic()
        plan = opened(*files)
        check(plan and plan["format"] == "DICOM" and plan["scan"][0] == 512 and plan["hounsfield"] and plan["high"] > 700,
              f"{kind}: {plan and (plan['scan'], plan['low'], plan['high'], plan['iso'])} in {time.monotonic() - begun:.1f} s "
              f"{page.run('burr.own.refused')}")


def pages_bone_again(page):
    """Another mode brings back the page's own bone, with its steps."""
    page.run("(() => { const mode = document.getElementById('mode'); mode.value = 'learn'; mode.dispatchEvent(new Event('change')); })()")
    page.run("document.getElementById('anew_yes').click()")
    page.wait("!burr.ready", WAIT)
    page.wait("burr.ready && burr.course.steps !== null && burr.state.ticks > 100", WAIT)
    check(page.run("burr.voxel === 0.5 && !document.getElementById('course').hidden"), "the page's own bone is back, with its steps")


def odd(page, opened):
    """Some of the files that other programs stumbled over, where they lie beside the checkout; BURR_ODD_SCANS=1: one in
    BURR_ODD_SCANS of them. Each is bone or one sentence."""
    folder = ROOT.parent / "shared/data/corpus"
    files = sorted(one for one in folder.rglob("*") if one.is_file() and one.stat().st_size < 20e6)
    files = files[::int(os.environ.get("BURR_ODD_SCANS", "20"))]
    if not files:
        return
    silent, broken, read = [], [], 0
    for one in files:
        plan = opened(one)
        said = page.run("burr.own.refused") or ""
        read += plan is not None
        if plan is None and len(said) < 10:
            silent.append(one.name)
        if said in (words_of("en")["scan_broken"], words_of("en")["scan_memory"]):
            broken.append(one.name)
    check(not silent, f"{len(files)} odd files: {read} are read, the others refused in a sentence; by the end of the reader: {broken}")


def words_of(code):
    return (tomllib.loads((ROOT / f"words/{code}.toml").read_text()) |
            tomllib.loads((ROOT / f"web/words/{code}.toml").read_text()))


def languages(browser, site):
    for code in ("sv", "de"):
        page = browser.open(f"{site.url}mill/?language={code}")
        page.wait("document.getElementById('undo')?.textContent", WAIT)
        wanted = words_of(code)
        check(page.run("document.getElementById('undo').textContent") == wanted["undo"] and
              page.run("document.querySelector('[data-word=force]').textContent") == wanted["force"] and
              page.run("document.getElementById('picture').getAttribute('aria-label')") == wanted["bone"] and
              page.run("document.documentElement.lang") == code, f"the words of the window in {code}")
        check(not page.troubles, f"no errors on the console {page.troubles}")
        page.close()


def main():
    only = os.environ.get("BURR_PAGE_TEST")  # one of the functions below, for whoever works on it
    if only:
        with Site(SITE) as site, Chromium(960, 540) as browser:
            browser.fresh = True
            {"replay": lambda *where: replay(*where, None), "own_scan": own_scan, "languages": languages}[only](browser, site)
        sys.exit("\n".join(bad))
    with tempfile.TemporaryDirectory() as downloads, Site(SITE) as site, Chromium(960, 540) as browser:
        browser.keep_downloads(downloads)
        browser.fresh = True
        page = browser.open(site.url + "mill/")
        loaded = mill(page)
        undo_and_reset(page)
        recorded = record(page, downloads)
        finer(page)
        requests(page, site, loaded)
        check(not page.troubles, f"no errors on the console {page.troubles}")
        print("ticks:", page.run("JSON.stringify(burr.state)"), "pictures:", page.run("burr.pictures"))
        page.close()
        replay(browser, site, recorded)
        own_scan(browser, site)
        without_webgl(browser, site)
        languages(browser, site)
        with Site(SITE, {"Content-Security-Policy": policy()}) as strict:
            in_the_background(browser, strict)
    if bad:
        sys.exit("\n".join(bad))


main()
