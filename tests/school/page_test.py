#!/usr/bin/env python3
"""Opens the instructor's page in Chromium without a screen: every view in three languages, and what must not happen.

    tests/school/page_test.py BURR [PICTURES]      BURR: the program; PICTURES: a folder to keep screenshots in

With BURR_AXE=axe.min.js (npm's axe-core) each view is also checked for accessibility. How long a view takes is printed, never
judged.
"""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "web/tests"))
from chromium import Chromium  # noqa: E402

BURR = pathlib.Path(sys.argv[1]).resolve()
PICTURES = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
AXE = os.environ.get("BURR_AXE")
MARKUP = '<img src=x onerror="document.title=1"><script>document.title=2</script>'
WAIT = 60  # [s]


def run(*command):
    done = subprocess.run([BURR, *map(str, command)], capture_output=True, text=True)
    assert done.returncode == 0, f"burr {command}: {done.stderr}"
    return done.stdout


def same(found, wanted, what):
    assert found == wanted, f"{what}: {found!r}, not {wanted!r}"


def store_in(folder):
    store = folder / "school.sqlite"
    learners = [f"heron-{1000 + n}" for n in range(6)]
    for learner in learners:
        run("learner", "add", "--store", store, "--id", learner, "--level", "PGY2", "--name", "Nora Nyberg")
    run("learner", "cohort", "add", "--store", store, MARKUP, *learners)
    for n in (1, 2):
        recording = folder / f"{n}.mcap"
        run("surgeon", "tooth", "--level", "average", "--seed", n, "--learner", learners[0], "--attempt", n,
            "--record", recording)
        run("learner", "enter", "--store", store, learners[0], recording)
    return store, learners


class Serving:
    def __init__(self, store):
        self.process = subprocess.Popen([BURR, "serve", "--store", store, "--port", "0"], stdout=subprocess.PIPE, text=True)
        said = ""
        while "Ctrl-C" not in said:
            line = self.process.stdout.readline()
            assert line, "burr serve ended: " + said
            said += line
        self.url = re.search(r"http://\S+", said).group(0)
        self.base, self.token = self.url.split("#token=")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(20)
        same(code, 0, "exit code of burr serve after SIGTERM")


def go(page, path):
    page.run("delete document.body.dataset.shown")
    page.run(f"(location.hash === '#' + {json.dumps(path)}) ? dispatchEvent(new Event('hashchange')) : (location.hash = {json.dumps(path)})")
    state = "document.getElementById('state')"
    page.wait(f"(document.body.dataset.shown && {state}.textContent === '') || {state}.className === 'wrong'", WAIT)
    same(page.run("document.getElementById('state').textContent"), "", "the line of state at " + path)


def look(page, name):
    text = page.run("document.body.innerText")
    for word in ("undefined", "NaN", "[object", "null", "{n}", "Nora"):
        assert word not in text, f"{name}: the page says {word}: {text}"
    if PICTURES:
        page.picture(PICTURES / f"school_{name}.png")
    if not AXE:
        return
    page.run(pathlib.Path(AXE).read_text() + "; 1")
    found = page.run("axe.run(document).then(all => all.violations.map(one => [one.impact, one.id, one.nodes.length, one.nodes[0].html]))")
    serious = [one for one in found if one[0] in ("serious", "critical")]
    print(f"axe, {name}: {found}")
    same(serious, [], "serious faults of accessibility at " + name)


def check_views(page, views):
    for language in ("en", "sv", "de"):
        page.run(f"(() => {{ const one = document.getElementById('language'); one.value = '{language}'; one.dispatchEvent(new Event('change')); }})()")
        for name, path in views.items():
            go(page, path)
            assert page.run("document.querySelector('h1').textContent.length") > 2, name
            same(page.run("document.documentElement.lang"), language, "the language")
            look(page, f"{name}_{language}")
            if language == "en":
                print(f"{name}: {page.run('document.body.dataset.shown')} ms")


def main():
    if PICTURES:
        PICTURES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as place, Chromium(1100, 900) as browser:
        store, learners = store_in(pathlib.Path(place))
        with Serving(store) as server:
            page = browser.open(server.url)
            page.wait("document.body && document.body.dataset.shown", WAIT)
            same(page.run("location.hash"), "#/", "the address after the token was taken")
            overview = json.loads(page.run("fetch('/api/overview', {headers: {Authorization: 'Bearer ' + sessionStorage.getItem('burr-token')}}).then(a => a.text())"))
            first = page.run("fetch('/api/learner?id=heron-1000', {headers: {Authorization: 'Bearer ' + sessionStorage.getItem('burr-token')}}).then(a => a.json())")
            sessions = [one["id"] for one in first["sessions"]]
            same(len(sessions), 2, "sessions")
            cohort = overview["cohorts"][0]["id"]
            check_views(page, {"overview": "/", "cohort": f"/cohort/{cohort}/tooth", "learner": "/learner/heron-1000",
                               "learner_without": "/learner/heron-1003", "session": "/session/" + sessions[0],
                               "compare": "/compare/" + "/".join(sessions), "audit": "/audit"})
            # markup stays text
            go(page, f"/cohort/{cohort}/tooth")
            assert MARKUP in page.run("document.querySelector('h1').textContent")
            same(page.run("document.querySelectorAll('main img, main script').length"), 0, "elements out of a title")
            # the items that were met, as the store has them
            cells = page.run("[...document.querySelectorAll('.heat tbody tr:first-child td')].map(cell => cell.textContent)")
            assert any(re.fullmatch(r"\d/2", cell) for cell in cells), cells
            # unknown things
            for path in ("/learner/nobody-1", "/session/x", "/cohort/x/tooth"):
                page.run("document.getElementById('state').className = ''")
                page.run(f"location.hash = {json.dumps(path)}")
                page.wait("document.getElementById('state').className === 'wrong'", WAIT)
            # on a phone nothing is wider than the screen
            page.send("Emulation.setDeviceMetricsOverride", {"width": 390, "height": 800, "deviceScaleFactor": 2, "mobile": True})
            for path in ("/", f"/cohort/{cohort}/tooth", "/session/" + sessions[0]):
                go(page, path)
                wide = page.run("document.documentElement.scrollWidth")
                assert wide <= 390, f"{path} is {wide} pixels wide on a phone"
            if PICTURES:
                page.picture(PICTURES / "school_phone.png")
            troubles = [one for one in page.troubles if "404" not in one]
            same(troubles, [], "the console")
            others = [url for _, url in page.requests if not url.startswith((server.base, "blob:", "data:"))]
            same(others, [], "requests to other places")
            same([url for _, url in page.requests if server.token in url.split("#")[0]], [], "addresses that carry the token")
            page.close()
            # every language has every word
            page = browser.open(server.base)
            page.wait("document.getElementById('state') && document.getElementById('state').className === 'wrong'", WAIT)
            keys = page.run("import('/words.mjs').then(m => Object.values(m.words).map(one => Object.keys(one).sort().join()))")
            same(len(set(keys)), 1, "sets of keys of the languages")
            # by keyboard: the first stop leads to the content
            for kind in ("keyDown", "keyUp"):
                page.send("Input.dispatchKeyEvent", {"type": kind, "key": "Tab", "code": "Tab", "windowsVirtualKeyCode": 9})
            same(page.run("document.activeElement.id"), "skip", "the first stop of the Tab key")
            # another tab has no token
            same(page.run("document.querySelector('main').children.length"), 0, "what is shown without a token")
            wanted = page.run("import('/words.mjs').then(m => m.words[document.documentElement.lang].token)")
            same(page.run("document.getElementById('state').textContent"), wanted, "the sentence that a page without its token shows")
    print("the instructor's page: all as it should be")


main()
