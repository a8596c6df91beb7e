#!/usr/bin/env python3
"""What becomes of a published page on a host: who binds its workers, what is left without a network, how a new version comes.

    web/tests/publish_test.py [PART...]       PART: files, bound, framed, hosts, offline, update

With a small page of its own (small_site.py), so it needs no build; web/tests/shipped_test.py looks at burr's. BURR_HOSTS: folders in which
nginx, apache2 and caddy lie besides PATH; where they are missing, hosts is left out, unless BURR_REQUIRE_TOOLS=1.
"""
import gzip
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

import hosts
import small_site
from chromium import Chromium

WAIT = 60  # [s]
bad = []


def check(good, text):
    print(f"good: {text[:200]}" if good else f"BAD:  {text}", flush=True)
    if not good:
        bad.append(text)


def files(folder):
    """The folder holds what it says, twice the same to the byte, and what is packed unpacks to it."""
    one, two = small_site.make(folder / "one", "1"), small_site.make(folder / "two", "1")
    same = subprocess.run(["diff", "-r", one, two], capture_output=True, text=True)
    check(same.returncode == 0, f"the same page is published the same to the byte {same.stdout}")
    other = json.loads((small_site.make(folder / "two", "2") / "version.json").read_text())
    about = json.loads((one / "version.json").read_text())
    check(about["parts"] != other["parts"], f"another page has another folder: {about['parts']}, {other['parts']}")
    there = {path.relative_to(one).as_posix() for path in one.rglob("*") if path.is_file()} - {"version.json"}
    check(there == set(about["files"]), f"version.json names every file {there ^ set(about['files'])}")
    wrong = [path for path, said in about["files"].items() if hashlib.sha256((one / path).read_bytes()).hexdigest() != said]
    check(not wrong, f"and its hash {wrong}")
    unpacked = "process.stdout.write(require('zlib').brotliDecompressSync(require('fs').readFileSync(process.argv[1])))"
    for path in sorted(one.rglob("*.gz")):
        whole = path.with_suffix("").read_bytes()
        brotli = subprocess.run(["node", "-e", unpacked, path.with_suffix(".br")], capture_output=True).stdout
        if gzip.decompress(path.read_bytes()) != whole or brotli != whole:
            check(False, f"{path.name} unpacks to what it was packed from")
    page = (one / "mill/index.html").read_text()
    check(f'src="../{about["parts"]}/mill/mill.js"' in page, "the page names the folder of its version")
    stable = sorted(path for path in about["files"] if not path.startswith(about["parts"]) and not path.endswith((".gz", ".br")))
    check(stable == [".htaccess", "_headers", "hosting/apache.conf", "hosting/caddy.conf", "hosting/nginx.conf", "index.html",
                     "mill/index.html", "sw.js"], f"outside of it: {stable}")


def attempts(page, how, elsewhere):
    return page.run(f"burr.{how}('{elsewhere.url}')")


def judge(tried, elsewhere, who):
    worked = {name for name, came in tried.items() if came.startswith("worked")}
    check(worked == small_site.MAY, f"{who} can do no more than WebAssembly: {tried}")
    check(not elsewhere.asked, f"nothing came to the other host {elsewhere.asked}")
    elsewhere.asked.clear()


def bound(folder):
    """A worker asks another host and runs text as code, or tries to."""
    site = small_site.make(folder / "bound", "1")
    (folder / "else").mkdir()
    (folder / "else/code.mjs").write_text("export const come = 1;\n")
    with hosts.plain(folder / "else") as elsewhere, Chromium(600, 400) as browser:
        with hosts.plain(site) as host:
            page = browser.open(host.url + "mill/", "navigator.serviceWorker.register = async () => {};")
            page.wait("window.burr?.loaded", WAIT)
            tried = attempts(page, "loose", elsewhere)
            loose = {name for name, came in tried.items() if came.startswith("worked")}
            check({"fetch", "eval", "Function", "timer"} <= loose and elsewhere.asked,
                  f"the test sees it: a worker from an address of a plain host can: {sorted(loose)}")
            elsewhere.asked.clear()
            judge(attempts(page, "bound", elsewhere), elsewhere, f"{host.name}: a bound worker")
            judge(page.run(f"burr.page('{elsewhere.url}')"), elsewhere, f"{host.name}: the page")
            page.close()
        with hosts.with_heads(site) as host:
            page = browser.open(host.url + "mill/", "navigator.serviceWorker.register = async () => {};")
            page.wait("window.burr?.loaded", WAIT)
            judge(attempts(page, "loose", elsewhere), elsewhere, f"{host.name}: a worker from an address")
            judge(attempts(page, "bound", elsewhere), elsewhere, f"{host.name}: a bound worker")
            page.close()
        with hosts.plain(site) as host:  # kept by the browser, the page has its heads from sw.js
            page = browser.open(host.url + "mill/")
            kept(page)
            page.send("Page.reload")
            time.sleep(1)
            page.wait("window.burr?.loaded", WAIT)
            judge(attempts(page, "loose", elsewhere), elsewhere, f"{host.name}, second visit: a worker from an address")
            page.close()


def framed(folder):
    """A page of another host shows ours inside of it, or tries to."""
    site = small_site.make(folder / "framed", "1")
    (folder / "around").mkdir()
    with Chromium(600, 400) as browser:
        for make, comes in ((hosts.plain, True), (hosts.with_heads, False)):
            with make(site) as host, hosts.plain(folder / "around") as around:
                (folder / "around/index.html").write_text(f'<iframe src="{host.url}mill/"></iframe>')
                page = browser.open(around.url.replace("127.0.0.1", "localhost"))
                end = time.monotonic() + WAIT
                while "/mill/" not in host.asked and time.monotonic() < end:
                    time.sleep(0.2)
                time.sleep(4)  # for its parts
                came = any("mill.js" in path for path in host.asked)
                check("/mill/" in host.asked and came is comes,
                      f"{host.name}: {'shows' if came else 'does not show'} its page inside of another host's")
                page.close()


def asked(url, packing=""):
    request = urllib.request.Request(url, headers={"Accept-Encoding": packing} if packing else {})
    try:
        with urllib.request.urlopen(request, timeout=WAIT) as answer:
            return answer.status, dict((name.lower(), value) for name, value in answer.headers.items()), answer.read()
    except urllib.error.HTTPError as refused:
        return refused.code, dict((name.lower(), value) for name, value in refused.headers.items()), b""


def looks(host, site):
    """Each file of the site comes whole, with its type, the policy and how long it may be kept; packed where that is asked for."""
    about = json.loads((site / "version.json").read_text())
    wanted = small_site.policy() + "; frame-ancestors 'self'"
    wrong = []
    for path in about["files"]:
        if path.startswith((".", "_", "hosting/")) or path.endswith((".gz", ".br")):
            continue
        data = (site / path).read_bytes()
        forever = "immutable" in "".join(asked(host.url + path)[1].get("cache-control", ""))
        for packing in ("", "gzip", "br"):
            status, head, body = asked(host.url + path, packing)
            came = head.get("content-encoding", "")
            if came == "gzip":
                body = gzip.decompress(body)
            if came == "br":
                good = body == (site / (path + ".br")).read_bytes()
            else:
                good = body == data
            kind = {"html": "text/html", "css": "text/css", "json": "application/json", "wasm": "application/wasm",
                    "txt": "text/plain"}.get(path.rsplit(".", 1)[1], "text/javascript")
            if status != 200 or not good or head["content-type"].split(";")[0] != kind or head.get("content-security-policy") != wanted \
                    or head.get("x-content-type-options") != "nosniff" or forever != path.startswith("v-") \
                    or (packing == "gzip" and (site / (path + ".gz")).exists() and not path.endswith(".txt") and came != "gzip"):
                wrong.append((path, packing, status, came, head))
    check(not wrong, f"{host.name}: types, policy, packing and keeping of each file {wrong[:2]}")
    for path in ("_headers", "hosting/nginx.conf", ".htaccess"):
        status = asked(host.url + path)[0]
        check(status in (403, 404), f"{host.name}: {path} is not shown: {status}")


def host_programs(folder):
    """The real programs take the shipped files, and bind the workers."""
    site = small_site.make(folder / "hosted", "1")
    found, missing = hosts.real(site)
    if missing:
        check(os.environ.get("BURR_REQUIRE_TOOLS") != "1", f"left out, not installed: {' '.join(missing)}")
    (folder / "else_too").mkdir()
    (folder / "else_too/code.mjs").write_text("export const come = 1;\n")
    with hosts.plain(folder / "else_too") as elsewhere, Chromium(600, 400) as browser:
        for host in found:
            with host:
                looks(host, site)
                page = browser.open(host.url + "mill/", "navigator.serviceWorker.register = async () => {};")
                page.wait("window.burr?.loaded", WAIT)
                for how in ("loose", "bound"):
                    judge(attempts(page, how, elsewhere), elsewhere, f"{host.name}: a worker ({how})")
                check(not page.troubles or all("Content Security" in one or "violates" in one for one in page.troubles),
                      f"{host.name}: no other errors on the console {page.troubles}")
                page.close()


def kept(page):
    """Waits until the browser keeps the whole page."""
    page.wait("window.burr?.loaded", WAIT)
    page.wait("navigator.serviceWorker.controller?.state === 'activated'", WAIT)


VERSIONS = "caches.keys().then((all) => all.map((one) => one.split(' ').pop()))"
LOCKS = "navigator.locks.query().then((all) => all.held.map((one) => one.name))"
# Asks for a new version until one came to this end ("activated", or "redundant" where it was refused). A browser looks by itself too, after a
# page was opened: what it found before it is asked counts, and so does what it found in files that have been mended since.
INSTALLED = """(async (wanted, name, wait_ms) => {
  const registration = await navigator.serviceWorker.getRegistration();
  const late = performance.now() + wait_ms;
  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  let worker = registration.installing;
  registration.addEventListener('updatefound', () => { worker = registration.installing ?? worker; });
  while (performance.now() < late) {
    await registration.update().catch(() => {});
    worker ??= registration.installing;
    while (worker && !['activated', 'redundant'].includes(worker.state) && performance.now() < late) await pause(50);
    if (worker?.state === wanted) return wanted;
    worker = null;
    const kept = (await caches.keys()).some((one) => one.endsWith(name));
    if (kept && !registration.installing && !registration.waiting) return 'activated';
    await pause(200);
  }
  return 'nothing came in time';
})"""


def installed(page, wanted, name):
    """What became of the version of this name."""
    return page.run(f"{INSTALLED}({json.dumps(wanted)}, {json.dumps(name)}, {WAIT * 1000})")


def offline(folder):
    """After one visit the page opens without its host, also the part that was never asked for."""
    site = small_site.make(folder / "offline", "1")
    with Chromium(600, 400) as browser:
        host = hosts.plain(site)
        page = browser.open(host.url + "mill/")
        kept(page)
        late = page.run("performance.getEntriesByType('resource').filter((one) => one.name.includes('late')).length")
        check(late == 0, "the late part was not asked for by the page")
        host.stop()
        page.close()
        for address in ("mill/", "mill/?mode=learn", "mill", ""):
            page = browser.open(host.url + address)
            page.wait("window.burr?.loaded", WAIT)
            check(page.run("burr.late()") == "late of 1", f"without a network, /{address} opens whole")
            page.close()


def update(folder):
    """A new version replaces the old one on the host while pages are open: each page has parts of one version alone."""
    site = small_site.make(folder / "site", "1")
    with Chromium(600, 400) as browser:
        host = hosts.plain(site)
        first = browser.open(host.url + "mill/")
        kept(first)
        one = json.loads((site / "version.json").read_text())["parts"]
        small_site.make(site, "2")
        two = json.loads((site / "version.json").read_text())["parts"]
        # a host that is half replaced, or damaged: nothing of it is kept
        part = site / two / "common/late.mjs"
        good = part.read_bytes()
        part.write_bytes(good + b"// damaged\n")
        second = browser.open(host.url + "mill/")
        second.wait("window.burr?.loaded", WAIT)
        end = installed(second, "redundant", two)
        check((end, second.run("burr.version"), second.run(VERSIONS)) == ("redundant", "1", [one]),
              f"of a new version with a damaged file nothing is kept: {end}, {second.run(VERSIONS)}")
        host.asked.clear()
        part.write_bytes(good)
        end = installed(second, "activated", two)
        check(end == "activated" and two in second.run(VERSIONS), f"the new version is kept: {end}")
        again = [path for path in host.asked if "same.mjs" in path or "bound_worker" in path]
        check(any("first.mjs" in path for path in host.asked) and not again, f"what has not changed is not fetched again {again}")
        for page in (first, second):
            check(page.run("burr.late()") == "late of 1", "a page of the old version goes on with its own parts, which the host no longer has")
        third = browser.open(host.url + "mill/")
        third.wait("window.burr?.loaded", WAIT)
        check((third.run("burr.version"), third.run("burr.late()")) == ("2", "late of 2"), "a page that is opened now is the new version")
        mixed = third.run("performance.getEntriesByType('resource').map((one) => one.name)")
        check(mixed and all(two in one for one in mixed), f"and has no part of another {[one for one in mixed if two not in one]}")
        check(set(third.run(VERSIONS)) == {one, two}, "the old version is kept as long as a page has it open")
        first.close()
        second.close()
        end = time.monotonic() + WAIT
        while any(one in name for name in third.run(LOCKS)) and time.monotonic() < end:
            time.sleep(0.2)
        third.send("Page.reload")
        end = time.monotonic() + WAIT
        while third.run(VERSIONS) != [two] and time.monotonic() < end:
            time.sleep(0.2)
        check(third.run(VERSIONS) == [two], f"and forgotten afterwards {third.run(VERSIONS)}")
        host.stop()


def main():
    missing = [one for one in ("chromium", "node") if not shutil.which(one)]
    if missing:
        print(f"left out: {' '.join(missing)} is missing (section [tools] of scripts/packages.txt)")
        sys.exit(1 if os.environ.get("BURR_REQUIRE_TOOLS") == "1" else 77)
    parts = {"files": files, "bound": bound, "framed": framed, "hosts": host_programs, "offline": offline, "update": update}
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        for name in sys.argv[1:] or parts:
            parts[name](pathlib.Path(folder))
    if bad:
        sys.exit("\n".join(bad))


main()
