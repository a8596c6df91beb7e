#!/usr/bin/env python3
"""The page "mill" in Firefox, on a screen of Xvfb: it opens, mills, keeps its work over a reload, is marked, and its recording replays.

    web/tests/firefox_test.py SITE BURR      SITE: build/web/site; BURR: the program

Firefox has no pipe as Chromium has, so a page of the same host drives the page in a frame, and posts what it found. With --headless it has no
WebGL where there is no graphics card, so it gets a screen.
"""
import http.server
import json
import os
import pathlib
import queue
import shutil
import subprocess
import sys
import tempfile
import threading

from common import WAIT, bad, check
from hand import POINTER

SITE, BURR = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()

# No first page, no news, no updates, nothing sent; a picture by the processor where there is no graphics card.
PREFERENCES = {
    "browser.shell.checkDefaultBrowser": False, "browser.startup.homepage_override.mstone": "ignore", "datareporting.policy.dataSubmissionEnabled": False,
    "toolkit.telemetry.enabled": False, "app.update.enabled": False, "browser.aboutwelcome.enabled": False, "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False, "extensions.update.enabled": False, "browser.safebrowsing.malware.enabled": False,
    "browser.safebrowsing.phishing.enabled": False, "webgl.force-enabled": True, "gfx.webrender.software": True, "dom.max_script_run_time": 0,
    "dom.disable_beforeunload": True, "browser.tabs.remote.autostart": True,
}

DRIVER = """<!doctype html><title>driver</title><body><iframe id="burr" width="960" height="540"></iframe><script type="module">
const frame = document.getElementById('burr'), inside = () => frame.contentWindow;
const tell = (what) => fetch('/told', {method: 'POST', body: JSON.stringify(what)});
const wait = async (what, good) => {
  const end = performance.now() + %d;
  for (;;) {
    let came = false;
    try { came = good(inside()); } catch { /* it is not there yet */ }
    if (came) return;
    if (performance.now() > end) throw new Error(`${what} did not come; ${inside().burr?.trouble ?? inside().document?.getElementById('say')?.textContent}`);
    await new Promise((go) => setTimeout(go, 200));
  }
};
const ready = (what) => wait(what, ({burr}) => burr.ready && burr.loaded);
const pointer = (ms) => inside().Function === undefined ? 0 : %s(ms);
try {
  frame.src = '/mill/?language=en&mode=learn&case=block';
  await ready('the page');
  const {burr} = inside();
  await tell({name: 'opened', gpu: burr.gpu, times: burr.times, kept: burr.kept.failed ?? ''});
  inside().document.getElementById('card_close').click();
  inside().document.getElementById('coolant').click();
  const {pressed} = await pointer(4000);
  await wait('the removed volume', ({burr: {figures}}) => figures.removed > 0.1);
  await tell({name: 'milled', pressed, figures: burr.figures, state: burr.state, pictures: burr.pictures});
  const removed = burr.figures.removed;
  frame.contentWindow.location.reload();
  await wait('the question after a reload', (w) => w.document.querySelector('dialog[open] button'));
  const offer = [...inside().document.querySelectorAll('dialog[open] button')].find((one) => one.textContent === 'Go on');
  offer.click();
  await ready('the session');
  await wait('the bone', ({burr: {figures}}) => Math.abs(figures.removed - removed) < 1);
  await tell({name: 'came back', before: removed, after: inside().burr.figures.removed});
  await wait('that it can be finished', ({burr: {course}}) => course.can_finish());
  inside().burr.course.ask_done();
  inside().document.getElementById('done_yes').click();
  await wait('the own marks', (w) => w.document.getElementById('self_skip'));
  inside().document.getElementById('self_skip').click();
  await wait('the marks', ({burr: {course}}) => course.page === 'found');
  const {course} = inside().burr;
  await tell({name: 'marked', trouble: course.trouble, score: course.found?.score});
  await fetch('/file', {method: 'POST', body: course.file});
} catch (what) {
  await tell({name: 'failed', why: `${what} ${what?.stack ?? ''}`});
}
</script></body>"""


class Host(http.server.ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self):
        self.told = queue.Queue()
        driven = POINTER.replace("document.", "inside().document.").replace("new PointerEvent", "new (inside().PointerEvent)").replace("burr.", "inside().burr.")
        self.driver = (DRIVER % (1000 * WAIT, driven)).replace("inside().Function === undefined ? 0 : ", "").encode()
        super().__init__(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Handler(http.server.SimpleHTTPRequestHandler):
    extensions_map = http.server.SimpleHTTPRequestHandler.extensions_map | {".mjs": "text/javascript", ".js": "text/javascript", ".wasm": "application/wasm"}

    def __init__(self, *words):
        super().__init__(*words, directory=str(SITE))

    def do_GET(self):
        if self.path != "/driver.html":
            return super().do_GET()
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(self.server.driver)))
        self.end_headers()
        self.wfile.write(self.server.driver)

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.server.told.put(body if self.path == "/file" else json.loads(body))
        self.send_response(204)
        self.end_headers()

    def log_message(self, *_):
        pass


def main():
    program = shutil.which("firefox-esr") or shutil.which("firefox")
    if program is None or shutil.which("xvfb-run") is None:
        print("left out: firefox-esr or xvfb is missing (section [tools] of scripts/packages.txt)")
        sys.exit(1 if os.environ.get("BURR_REQUIRE_TOOLS") == "1" else 77)
    host = Host()
    with tempfile.TemporaryDirectory(prefix="burr_firefox_") as profile:
        lines = (f"user_pref({json.dumps(name)}, {json.dumps(value)});" for name, value in PREFERENCES.items())
        pathlib.Path(profile, "user.js").write_text("\n".join(lines))
        browser = subprocess.Popen(["xvfb-run", "-a", program, "--no-remote", "--profile", profile, f"http://127.0.0.1:{host.server_address[1]}/driver.html"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "HOME": profile, "MOZ_DISABLE_CONTENT_SANDBOX": "1"},
                                   start_new_session=True)
        try:
            def next_one(name):
                try:
                    one = host.told.get(timeout=2 * WAIT)
                except queue.Empty:
                    sys.exit(f"Firefox says nothing of: {name}")
                if isinstance(one, dict) and one.get("name") == "failed":
                    sys.exit(f"BAD:  {one['why']}")
                return one
            opened = next_one("opened")
            check(opened["kept"] == "", f"Firefox opens the page: {opened['gpu']}, times {opened['times']}, {opened['kept']}")
            milled = next_one("milled")
            check(milled["pressed"]["force"] > 0 and milled["figures"]["removed"] > 0.1 and milled["figures"]["wet"] == 1,
                  f"it mills: {milled['figures']['removed']:.1f} mm3, {milled['pressed']['force']:.1f} N, {milled['pictures']} pictures, {milled['state']}")
            back = next_one("came back")
            check(abs(back["after"] - back["before"]) < 1, f"after a reload the work is there: {back['before']:.2f} and {back['after']:.2f} mm3")
            marked = next_one("marked")
            check(marked["trouble"] == "" and marked["score"], "it is marked")
            file = pathlib.Path(profile, "burr.mcap")
            file.write_bytes(next_one("file"))
            checked = subprocess.run([BURR, "--quiet", "replay", file, "--check"], capture_output=True, text=True)
            check(checked.returncode == 0, f"its recording replays to the bit {checked.stderr[-300:]}")
            told = subprocess.run([BURR, "--quiet", "score", file, "--json"], capture_output=True, text=True)
            native = json.loads(told.stdout.strip().splitlines()[-1])
            check([one["outcome"] for one in native["items"]] == [one["outcome"] for one in marked["score"]["items"]], f"{len(native['items'])} marks are those of burr score")
        finally:
            os.killpg(browser.pid, 9)
            browser.wait()
    if bad:
        sys.exit("\n".join(bad))


main()
