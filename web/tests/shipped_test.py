#!/usr/bin/env python3
"""burr's page as it is shipped, in Chromium: from the link to the first cut, its workers' doors, without a network, plain http.

    web/tests/shipped_test.py PAGE [PICTURES]      PAGE: what `burr web --out` wrote; PICTURES: a folder to keep them

web/tests/publish_test.py has the same for a small page, where a new version comes and other hosts serve it.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib

import hosts
import scans
import small_site
from chromium import Chromium
from hand import POINTER

PAGE = pathlib.Path(sys.argv[1]).resolve()
PICTURES = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
WAIT = 300  # [s]
MOST_KB = 600  # from the link to the first cut, packed
HIDES = "navigator.serviceWorker && (navigator.serviceWorker.register = async () => {});"

bad = []


def check(good, text):
    print(("good: " if good else "BAD:  ") + text, flush=True)
    if not good:
        bad.append(text)


def no_text_as_code():
    """In no script of the page is there a call that makes code of text, and one place alone starts workers."""
    found, starts = [], []
    for path in [*PAGE.rglob("*.js"), *PAGE.rglob("*.mjs")]:
        text = path.read_text()
        found += [f"{path.name}: {one}" for one in re.findall(r"(?<![\w.$])(?:eval|Function)\s*\(.{0,40}", text)]
        starts += [path.name] if "new Worker(" in text else []
    check(starts == ["bound_worker.js"], f"workers are started by bound_worker.js alone: {starts}")
    check(not found, f"no script makes code of text {found[:3]}")


def size(host, page):
    """What was asked for until the first cut was possible, as the host sends it packed.

    The page itself says when that was: what it fetches from then on (marks, sound) may have begun before a test can ask.
    """
    end = page.run("performance.timeOrigin + burr.times.ready") - 1  # what it needed was asked for longer before
    paths = sorted({url[len(host.url):].split("?")[0] for (_, url), at in zip(page.requests, page.asked_at)
                    if at <= end and url.startswith(host.url)})
    total = {"br": 0, "gz": 0}
    for path in paths:
        file = PAGE / (path + "index.html" if path == "" or path.endswith("/") else path)
        for end in total:
            packed = file.with_name(f"{file.name}.{end}")
            total[end] += (packed if packed.exists() else file).stat().st_size
    check(max(total.values()) <= 1000 * MOST_KB,
          f"to the first cut: {len(paths)} files, {total['gz'] / 1e3:.0f} kB by gzip, {total['br'] / 1e3:.0f} kB by brotli, at most {MOST_KB}")


def doors(page, elsewhere, who):
    """Each worker of the page, and the page, try what they may not."""
    for name, worker in (("the page", None), *((f"worker {n + 1}", one) for n, one in enumerate(page.workers))):
        try:
            tried = page.run(f"({small_site.TRY})('{elsewhere.url}')", worker)
        except RuntimeError as ended:
            print(f"      {who}, {name}: has ended ({ended})")
            continue
        worked = {one for one, came in tried.items() if came.startswith("worked")}
        check(worked == small_site.MAY, f"{who}, {name}: can do no more than WebAssembly: {tried}")
    check(not elsewhere.asked, f"{who}: nothing came to the other host {elsewhere.asked}")


def series(folder, kind, words):
    """The slices of a ball, as gdcmconv compresses them. None where it is not installed."""
    if not shutil.which("gdcmconv"):
        return None
    (folder / kind).mkdir(exist_ok=True)
    for k, one in enumerate(scans.dicom()):
        (folder / "plain.dcm").write_bytes(one)
        subprocess.run(["gdcmconv", *words, folder / "plain.dcm", folder / kind / f"{k}.dcm"], check=True)
    return sorted((folder / kind).iterdir())


def open_scans(page, folder, who):
    """Scans whose codecs have the most JavaScript of others, and one that JavaScript unpacks."""
    packed = folder / "ball.nrrd"
    packed.write_bytes(scans.nrrd())
    kinds = {"NRRD, gzip": [packed], "JPEG-LS": series(folder, "jpegls", ["--jpegls"]), "JPEG 2000": series(folder, "j2k", ["--j2k"])}
    page.run("document.getElementById('own').click()")
    page.wait("document.getElementById('own_files')", WAIT)
    for kind, files in kinds.items():
        if files is None:
            print(f"      left out: gdcmconv, which makes {kind}, is not installed")
            continue
        page.run("(delete burr.own.plan, delete burr.own.refused, 1)")
        page.choose("#own_files", *files)
        page.wait("burr.own.plan || burr.own.refused", WAIT)
        plan = page.run("burr.own.plan") or {}
        check(plan.get("scan") == [scans.EDGE] * 3, f"{who}: {kind} is read: {plan.get('scan')} {page.run('burr.own.refused')}")


def mill(page, seconds=3000):
    before = page.run("burr.figures.removed ?? 0")
    page.run("document.getElementById('picture').focus()")
    page.run(POINTER + f"({seconds})")
    removed = page.run("burr.figures.removed") - before
    check(removed > 1, f"bone is cut: {removed:.1f} mm3")


def ready(page):
    page.wait("window.burr && burr.ready", WAIT)


def on_hosts(browser, folder, elsewhere):
    for make in (hosts.plain, hosts.with_heads):
        with make(PAGE) as host:
            page = browser.open(host.url + "mill/", HIDES)
            ready(page)
            print(f"      {host.name}: ready {page.run('Math.round(performance.now())')} ms after the link")
            size(host, page)
            page.wait("burr.loaded", WAIT)
            mill(page)
            open_scans(page, folder, host.name)
            check(len(page.workers) >= 4, f"{host.name}: {len(page.workers)} workers: ticks, score, watch, the reader of scans")
            check(not page.troubles, f"{host.name}: no errors on the console {page.troubles}")
            outside = [url for _, url in page.requests if not url.startswith((host.url, "data:", "blob:" + host.url))]
            check(not outside, f"{host.name}: no request to anywhere else {outside}")
            doors(page, elsewhere, host.name)
            page.close()
            page = browser.open(host.url + "replay/", HIDES)
            page.wait("window.burr?.open", WAIT)
            time.sleep(2)
            check(not page.troubles, f"{host.name}: replay/ opens without errors {page.troubles}")
            check(len(page.workers) == 1, f"{host.name}, replay/: {len(page.workers)} worker")
            doors(page, elsewhere, f"{host.name}, replay/")
            page.close()


def offline(folder):
    """After one visit the page opens without its host, mills, marks, and reads a scan of its own."""
    with Chromium(960, 540) as browser:
        host = hosts.plain(PAGE)
        page = browser.open(host.url + "mill/")
        page.wait("window.burr && burr.ready && burr.loaded", WAIT)
        page.wait("navigator.serviceWorker.controller?.state === 'activated'", WAIT)
        came = host.asked[:]
        page.close()
        host.stop()
        check(any("burr_import.wasm" in path for path in came), "what was not needed yet is kept too")
        page = browser.open(host.url + "mill/?mode=learn")
        page.wait("window.burr && burr.ready && burr.loaded", WAIT)
        check(not host.asked[len(came):], "the host has ended, and was not asked")
        mill(page)
        open_scans(page, folder, "without a network")
        check(not page.troubles, f"without a network: no errors on the console {page.troubles}")
        page.close()
        page = browser.open(host.url + "replay/")
        page.wait("window.burr?.open", WAIT)
        check(not page.troubles, f"without a network: replay/ opens {page.troubles}")
        page.close()


def plain_http():
    """From a computer of the house by its name, without https: it mills, and says what the browser withholds."""
    with hosts.with_heads(PAGE) as host, Chromium(1366, 768, flags=["--host-resolver-rules=MAP burr.intranet 127.0.0.1"]) as browser:
        for code in ("en", "sv", "de"):
            words = tomllib.loads((small_site.ROOT / f"web/words/{code}.toml").read_text())
            page = browser.open(f"http://burr.intranet:{host.port}/mill/?language={code}")
            page.wait("window.burr && document.querySelector('#plain_http p')", WAIT)
            said = page.run("document.querySelector('#plain_http p').textContent")
            check(said.startswith(words["http_plain"].split("{}")[0]) and words["http_sound"] in said and words["http_offline"] in said,
                  f"plain http, {code}: {said}")
            check(not page.run("isSecureContext") and page.run("!navigator.serviceWorker && !('audioWorklet' in AudioContext.prototype)"),
                  "and it is so")
            if code == "en":
                page.wait("burr.ready && burr.loaded", WAIT)
                mill(page)
                if PICTURES:
                    page.picture(PICTURES / "plain_http.png")
                page.run("document.querySelector('#plain_http button').click()")
                check(page.run("document.getElementById('plain_http') === null"), "the sentence can be put away")
            page.close()
        page = browser.open(host.url + "mill/", HIDES)
        ready(page)
        check(page.run("document.getElementById('plain_http') === null"), "this computer itself counts as safe: no such sentence")
        page.close()


def main():
    if PICTURES:
        PICTURES.mkdir(parents=True, exist_ok=True)
    no_text_as_code()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "else").mkdir()
        (folder / "else/code.mjs").write_text("export const come = 1;\n")
        with hosts.plain(folder / "else") as elsewhere, Chromium(960, 540) as browser:
            on_hosts(browser, folder, elsewhere)
        offline(folder)
        plain_http()
    if bad:
        sys.exit("\n".join(bad))


main()
