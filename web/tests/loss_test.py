#!/usr/bin/env python3
"""Work on the page "mill" cannot be lost: each way to lose it, in Chromium without a screen.

    web/tests/loss_test.py SITE BURR [PICTURES [PART...]]    SITE: build/web/site; BURR: the program; PICTURES: a folder to keep them;
                                                         PART: one of PARTS; all without it

What was cut before is compared with what comes back: hashes of bone and tick, as the page had them and as the program finds them in the
recording. At most a second of work may be gone.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from chromium import Chromium, Site
from common import WAIT, bad, check, ready, text_of, words_of
from hand import POINTER

SITE, BURR = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
PICTURES = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
if PICTURES:
    PICTURES.mkdir(parents=True, exist_ok=True)
MOST_LOST = 1000  # ticks
SAID = words_of("en")


def opened(browser, site, more="", first=None):
    page = browser.open(f"{site.url}mill/?language=en{more}", first)
    ready(page)
    return page


def cut(page, ticks=2500):
    page.run(f"{POINTER}({ticks})")
    page.wait("burr.figures.removed > 0.5", WAIT)
    return state(page)


def state(page):
    """Tick, removed volume, hashes, of one moment."""
    page.run("(() => { delete burr.hashes; burr.hash(); })()")
    page.wait("burr.hashes", WAIT)
    for _ in range(2):  # a busy page writes later what the worker has told; the next state comes when the last one was written
        page.wait(f"burr.state.ticks > {page.run('Math.max(burr.hashes.ticks, burr.state.ticks)')}", WAIT)
    return page.run("({...burr.hashes, removed: burr.figures.removed})")


def offered(page, what):
    page.wait("document.querySelector('#ask[open] .kept_on')", WAIT)
    check(SAID["kept_offer"] in text_of(page, "ask"), f"{what}: the work is offered: {page.run('document.querySelector(`#ask li p`).textContent')}")


def comes_back(page, before, what):
    """The offer is taken; the bone is the same, unless the hand went on after `before`."""
    offered(page, what)
    page.run("document.querySelector('#ask .kept_on').click()")
    page.wait("burr.brought_back && burr.ready && burr.loaded || burr.not_brought", WAIT)
    check(page.run("burr.not_brought ?? ''") == "", f"{what}: brought back {page.run('burr.not_brought')}")
    page.wait(f"Math.abs(burr.figures.removed - {before['removed']}) < 1e-6", WAIT)
    now = page.run("burr.brought_back")
    check(before["ticks"] - now["ticks"] <= MOST_LOST, f"{what}: {before['ticks'] - now['ticks']} of {before['ticks']} ticks are gone")
    after = state(page)
    check(after["bone"] == before["bone"], f"{what}: the bone is the same to the bit: {after['bone']}")
    return after


def saved(page, folder, button="save"):
    file = pathlib.Path(folder) / "burr.mcap"
    file.unlink(missing_ok=True)
    page.run("(() => { delete burr.saved; })()")
    page.run(f"document.getElementById('{button}').click()")
    end = time.monotonic() + WAIT
    while not (file.exists() and file.stat().st_size == (page.run("burr.saved") or -1)):
        if time.monotonic() > end:
            check(False, "the recording is saved")
            return None
        time.sleep(0.2)
    return file


def replays(file, least, what):
    told = subprocess.run([BURR, "replay", file, "--check"], capture_output=True, text=True)
    said = (told.stderr + told.stdout).strip().splitlines()[-1]
    same = re.search(r"the same to the bit: (\d+) ticks", said)
    check(told.returncode == 0 and same is not None and int(same[1]) >= least, f"{what}: burr replay --check: {said}")


def reload(page):
    """By the browser's own way, which asks once where something was cut; yes."""
    asked = []
    page.browser.listeners.append(lambda message: message["method"] == "Page.javascriptDialogOpening" and asked.append(message["params"]["type"]))
    page.send("Page.bringToFront")
    x, y = page.run("(() => { const one = document.getElementById('removed').getBoundingClientRect(); return [one.left + 2, one.top + 2]; })()")
    for kind in ("mousePressed", "mouseReleased"):  # a browser asks only where somebody has clicked
        page.send("Input.dispatchMouseEvent", {"type": kind, "x": x, "y": y, "button": "left", "clickCount": 1})
    page.run("setTimeout(() => location.reload(), 50)")
    end = time.monotonic() + 20
    while not asked and time.monotonic() < end:
        time.sleep(0.1)
    return asked


# ---- the ways to lose work

def save_is_a_copy(browser, site, folder):
    """After saving, cuts are recorded on, and the marks come; both files replay."""
    page = opened(browser, site)
    cut(page)
    first = saved(page, folder)
    check(text_of(page, "say") == SAID["saved"], f"it says: {text_of(page, 'say')}")
    replays(first, 2000, "the copy")
    before = page.run("burr.state.ticks")
    page.run(POINTER + "(2000)")
    second = saved(page, folder)
    replays(second, before + 1500, "a second copy, with what came after the first")
    page.run("burr.course.ask_done(); document.getElementById('done_yes').click()")
    page.wait("burr.course.page === 'own' && burr.course.picture", WAIT)
    page.run("document.getElementById('self_skip').click()")
    page.wait("burr.course.page === 'found'", WAIT)
    check(page.run("burr.course.trouble") == "" and page.run("burr.course.found !== null"), "the marks come after saving")
    replays(saved(page, folder, "save_done"), before + 1500, "the recording at the end")
    check(not page.troubles, f"no errors on the console {page.troubles}")
    page.close()


def reset_is_undone(browser, site, _folder):
    page = opened(browser, site)
    page.run("document.getElementById('undo').click()")
    page.wait("burr.went_back?.what === 'undo'", WAIT)
    check(text_of(page, "say") == SAID["nothing_undone"], f"nothing was cut, and U says: {text_of(page, 'say')}")
    cut(page, 1500)
    time.sleep(1.5)
    before = cut(page, 1500)
    page.run("document.getElementById('reset').click()")
    page.wait("burr.went_back?.what === 'reset' && burr.figures.removed < 1e-6", WAIT)
    check(text_of(page, "say") == SAID["back_to_start"], f"reset says: {text_of(page, 'say')}")
    page.run("document.getElementById('undo').click()")
    page.wait(f"burr.went_back?.what === 'undo' && Math.abs(burr.figures.removed - {before['removed']}) < 1e-6", WAIT)
    check(text_of(page, "say") == SAID["reset_undone"] and state(page)["bone"] == before["bone"], f"undo takes the reset back, to the bit: {text_of(page, 'say')}")
    page.close()


def reloaded(browser, site, folder):
    page = opened(browser, site, "&mode=learn")
    page.run("document.getElementById('picture').focus(); burr.course.step_done()")
    page.wait("burr.course.steps.rows[0].done", WAIT)
    cut(page)
    cut(page)
    page.run("document.getElementById('undo').click()")
    page.wait("burr.went_back?.what === 'undo' && burr.went_back.did", WAIT)
    time.sleep(1)
    before = state(page)
    asked = reload(page)
    check(asked == ["beforeunload"], f"reload is asked once: {asked}")
    page.send("Page.handleJavaScriptDialog", {"accept": True})
    time.sleep(2)
    ready(page)
    comes_back(page, before, "reload")
    page.wait("burr.course.steps", WAIT)  # they come from another worker
    check(page.run("burr.mode") == "learn" and page.run("burr.course.steps.rows[0].done && burr.course.steps.rows[1].current"), "mode and steps are as they were")
    page.run("document.getElementById('redo').click()")
    page.wait("burr.went_back?.what === 'redo' && burr.went_back.did", WAIT)
    check(True, "what was undone before the reload can be redone after it")
    page.run(POINTER + "(1500)")
    replays(saved(page, folder), before["ticks"] + 1000, "one recording from before and after the reload")
    left = page.run("import('../common/store.js').then(async ({kept_sessions}) => (await kept_sessions()).length)")
    check(left == 1, f"the session is kept once: {left}")
    check(not page.troubles, f"no errors on the console {page.troubles}")
    page.close()


def went_back(browser, site, _folder):
    """Another address, and Back."""
    page = opened(browser, site)
    before = cut(page)
    page.send("Page.navigate", {"url": "about:blank"})
    time.sleep(2)
    page.run("history.back()")
    time.sleep(2)
    ready(page)
    page.wait("document.querySelector('#ask[open] .kept_on') || burr.figures.removed > 0", WAIT)
    if page.run("burr.figures.removed > 0"):  # the browser has kept the whole page
        ticks = page.run("burr.state.ticks")
        page.wait(f"burr.state.ticks > {ticks} + 300", WAIT)
        check(state(page)["bone"] == before["bone"], "Back: the page is as it was left, and goes on")
    else:
        comes_back(page, before, "Back")
    page.close()


def worker_crashes(browser, site, folder):
    """The worker that ticks ends: another one goes on by itself, without a request."""
    page = opened(browser, site)
    before = cut(page)
    requests = len(page.requests)
    page.run("setTimeout(() => { throw new Error('broken on purpose'); })", page.workers[0])
    page.wait("burr.brought_back && burr.ready", WAIT)
    page.wait(f"Math.abs(burr.figures.removed - {before['removed']}) < 1e-6", WAIT)
    after = state(page)
    check(after["bone"] == before["bone"], f"a crash of the worker: the bone is the same to the bit, {before['ticks'] - page.run('burr.brought_back.ticks')} ticks are gone")
    later = [url for _, url in page.requests[requests:] if not url.startswith("blob:") and not url.endswith((".js", ".mjs"))]
    check(not later, f"nothing but the next spare worker is asked for: {later}")
    page.wait("burr.loaded", WAIT)
    page.run(POINTER + "(1500)")
    replays(saved(page, folder), before["ticks"], "its recording")
    page.close()


def context_lost(browser, site, _folder):
    page = opened(browser, site)
    before = cut(page)
    page.run("burr.picture.canvas.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext()")
    page.wait("!burr.picture.alive", WAIT)
    check(text_of(page, "say") == SAID["picture_lost"], f"it says: {text_of(page, 'say')}")
    ticks = page.run("burr.state.ticks")
    page.wait("burr.picture.alive && burr.refined()", WAIT)
    check(page.run("burr.picture.made") == 2 and not page.run("burr.trouble"), "a lost WebGL context: the picture is made anew")
    page.wait(f"burr.state.ticks > {ticks} + 300", WAIT)
    time.sleep(1)
    page.run("document.getElementById('card_close').click()")
    picture = page.picture(PICTURES and PICTURES / "after_lost_context.png")
    middle = [picture.pixel(x, 200) for x in range(300, 660, 20)]
    check(len(set(middle)) > 5, f"there is bone in it: {len(set(middle))} colours of {len(middle)} pixels")
    check(state(page)["bone"] == before["bone"], "the bone is as it was")
    after = cut(page, 2500)
    check(after["removed"] > before["removed"] + 0.3, f"and it is milled on: {before['removed']:.1f}, then {after['removed']:.1f} mm3")
    page.close()


def two_tabs(browser, site, _folder):
    """Two pages at once: each keeps its own work, and neither offers that of the other."""
    one, other = opened(browser, site), opened(browser, site)
    one.send("Page.bringToFront")
    first = cut(one)
    other.send("Page.bringToFront")
    second = cut(other, 3500)
    third = opened(browser, site)
    check(third.run("!document.getElementById('ask').open"), "what others are working at is not offered")
    third.close()
    one.close()
    other.close()
    time.sleep(1)
    page = opened(browser, site)
    offered(page, "two tabs")
    page.run("document.getElementById('kept_later').click(); document.getElementById('kept').click()")
    page.wait("document.querySelectorAll('#ask[open] .kept_on').length === 2", WAIT)
    volumes = page.run("import('../common/store.js').then(async ({kept_sessions}) => (await kept_sessions()).map((one) => one.about.removed).filter((one) => one > 0))")
    check(sorted(round(one, 3) for one in volumes) == sorted(round(one["removed"], 3) for one in (first, second)), f"both are kept: {volumes}")
    page.close()


def storage_full(browser, site, folder):
    page = opened(browser, site)
    cut(page)
    page.send("Storage.overrideQuotaForOrigin", {"origin": site.url.rstrip("/"), "quotaSize": 1000})
    page.run("(() => { window.filled = 0; })()")
    page.run(POINTER + "(3000)")
    page.wait("burr.kept.failed !== ''", WAIT)
    check(text_of(page, "say").startswith(SAID["not_kept"].split("{}")[0]), f"storage full: it says so: {text_of(page, 'say')}")
    ticks = page.run("burr.state.ticks")
    page.run(POINTER + "(1500)")
    replays(saved(page, folder), ticks, "the session goes on, and is saved whole")
    page.send("Storage.overrideQuotaForOrigin", {"origin": site.url.rstrip("/")})
    page.close()


def offline(browser, site, folder):
    """The network goes after loading."""
    page = opened(browser, site)
    page.send("Network.emulateNetworkConditions", {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0})
    before = cut(page)
    replays(saved(page, folder), before["ticks"] - MOST_LOST, "offline: a copy")
    page.run("burr.course.ask_done(); document.getElementById('done_yes').click()")
    page.wait("burr.course.page === 'own' && burr.course.picture", WAIT)
    page.run("document.getElementById('self_skip').click()")
    page.wait("burr.course.page === 'found'", WAIT)
    check(page.run("burr.course.found !== null"), "offline: marks")
    page.close()


def long_pause(browser, site, folder):
    """A lid that is closed: the browser stands still, and goes on."""
    page = opened(browser, site)
    before = cut(page)
    browser.sleep(20)
    page.wait(f"burr.state.ticks > {before['ticks']} + 300", WAIT)
    check(state(page)["bone"] == before["bone"], "a long pause: the bone is as it was")
    page.run(POINTER + "(1500)")
    replays(saved(page, folder), before["ticks"] + 1000, "its recording")
    page.close()


def browser_killed(site, folder):
    """Chromium is killed in the middle of a stroke, and started again with the same profile."""
    with Chromium(960, 540) as browser:
        page = opened(browser, site)
        page.run("void " + POINTER + "(60000)")
        page.wait("burr.state.ticks > 5000 && burr.figures.removed > 1", WAIT)
        ticks, removed = page.run("[burr.state.ticks, burr.figures.removed]")
        browser.kill()
        with Chromium(960, 540, folder=browser.folder) as again:
            again.keep_downloads(folder)
            page = opened(again, site)
            offered(page, "killed browser")
            page.run("document.querySelector('#ask .kept_on').click()")
            page.wait("burr.brought_back && burr.ready && burr.loaded", WAIT)
            back = page.run("burr.brought_back")
            check(ticks - back["ticks"] <= MOST_LOST and back["removed"] > 0.5 * removed, f"killed browser: {ticks - back['ticks']} of {ticks} ticks are gone, {back['removed']:.1f} of {removed:.1f} mm3 are back")
            page.run(POINTER + "(1500)")
            replays(saved(page, folder), ticks - MOST_LOST, "its recording")


def old_recording(browser, site, folder):
    """What another version of the page has kept cannot be computed again: as far as it goes, and the file stays."""
    page = opened(browser, site)
    cut(page)
    page.send("Page.navigate", {"url": site.url + "replay/"})
    page.wait("document.readyState === 'complete' && location.pathname.endsWith('replay/')", WAIT)
    page.run("""(async () => { const where = await (await navigator.storage.getDirectory()).getDirectoryHandle('burr-sessions');
      for await (const [name, one] of where.entries()) if (name.endsWith('.mcap')) {
        const bytes = new Uint8Array(await (await one.getFile()).arrayBuffer());
        const out = await one.createWritable();
        await out.write(bytes.subarray(0, Math.floor(0.6 * bytes.length)));  // and it ends in the middle of a chunk
        await out.close();
      } })()""")
    page.send("Page.navigate", {"url": site.url + "mill/?language=en"})
    time.sleep(1)
    ready(page)
    offered(page, "an old recording, cut off")
    page.run("document.querySelector('#ask .kept_on').click()")
    page.wait("burr.brought_back && burr.ready", WAIT)
    page.wait("burr.figures.removed >= 0 && burr.state.ticks > 0", WAIT)
    check(page.run("burr.state.ticks") > 500, f"what there is of it comes back: {page.run('burr.state.ticks')} ticks")
    page.close()


def begin_anew_asks(browser, site, _folder):
    """Another mode, a finer bone: asked once, and the work stays in the browser."""
    page = opened(browser, site)
    cut(page, 1500)
    choose = "(() => { const one = document.getElementById('mode'); one.value = 'practise'; one.dispatchEvent(new Event('change')); })()"
    page.run(choose)
    check(page.run("document.getElementById('ask').open && burr.ready"), f"another mode is asked: {text_of(page, 'ask')}")
    page.run("document.getElementById('anew_no').click()")
    check(page.run("burr.mode === 'free' && document.getElementById('mode').value === 'free' && burr.figures.removed > 0"), "no: all is as it was")
    page.run("document.getElementById('finer').click()")
    check(page.run("document.getElementById('ask').open"), "a finer bone is asked")
    page.run("document.getElementById('anew_no').click()")
    page.run(choose)
    page.run("document.getElementById('anew_yes').click()")
    page.wait("!burr.ready", WAIT)
    ready(page)
    page.run("document.getElementById('kept').click()")
    page.wait("document.querySelector('#ask[open] .kept_on')", WAIT)
    check(True, "yes: it begins anew, and the menu has the work that was left")
    page.run("document.getElementById('kept_later').click()")
    page.run(choose.replace("practise", "free"))
    check(page.run("!document.getElementById('ask').open"), "where nothing was cut nothing is asked")
    page.close()


def database(browser, _site, _folder):
    """Where the browser has no files for pages (OPFS), the work is kept in its database."""
    store = (SITE / "common/store.js").read_text()
    other = store.replace("navigator.storage.getDirectory()", "Promise.reject(new Error('no files'))")
    check(other != store, "a browser without OPFS")
    with Site(SITE, instead={"/common/store.js": other.encode()}) as site:
        page = opened(browser, site)
        before = cut(page)
        time.sleep(2)
        page.send("Page.navigate", {"url": site.url + "mill/?language=en"})
        time.sleep(2)
        ready(page)
        comes_back(page, before, "without OPFS")
        page.close()


PARTS = {one.__name__: one for one in (save_is_a_copy, reset_is_undone, reloaded, went_back, worker_crashes, context_lost, two_tabs, storage_full, offline,
                                       long_pause, browser_killed, old_recording, begin_anew_asks, database)}


def main():
    with tempfile.TemporaryDirectory() as folder, Site(SITE) as site:
        for name in sys.argv[4:] or PARTS:
            print(f"-- {name}", flush=True)
            if name == "browser_killed":
                PARTS[name](site, folder)
                continue
            with Chromium(960, 540) as browser:  # each with an empty storage
                browser.keep_downloads(folder)
                PARTS[name](browser, site, folder)
    if bad:
        sys.exit("\n".join(bad))


main()
