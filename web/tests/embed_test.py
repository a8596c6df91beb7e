#!/usr/bin/env python3
"""The page "mill" inside of another page, and as a unit of a learning management system by cmi5, in Chromium without a screen.

    web/tests/embed_test.py SITE COURSE BURR [PICTURES]      SITE: build/web/site; COURSE: build/web/burr-cmi5.zip; BURR: the program

The learning management system is a fake; its record store is the strict one of tests/school.
"""
import base64
import http.server
import json
import pathlib
import subprocess
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.parse
import urllib.request
import uuid
import xml.etree.ElementTree as xml
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/school"))
from chromium import Chromium, Site
from common import WAIT, bad, check
from hand import POINTER
from lrs import Lrs

SITE, COURSE, BURR = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]).resolve()
PICTURES = pathlib.Path(sys.argv[4]) if len(sys.argv) > 4 else None

AROUND = b"""<!doctype html><title>a school</title><link rel="icon" href="data:,"><body><iframe id="burr" width="940" height="520"></iframe><script>
window.heard = [];
window.files = [];
addEventListener('message', ({origin, data}) => {
  if (data.bytes) { files.push(data.bytes); data = {...data, bytes: data.bytes.length}; }
  heard.push({origin, ...data});
});
window.kind = (name) => heard.filter((one) => one.kind === name);
window.ask = (what) => document.getElementById('burr').contentWindow.postMessage({burr: 1, ...what}, '*');
</script></body>"""
FRAME = "document.getElementById('burr').contentWindow"


def framed(browser):
    """A page of the same host gets messages about the session, and the recording when it asks."""
    with Site(SITE, instead={"/around.html": AROUND}) as site:
        page = browser.open(site.url + "around.html")
        page.wait("document.getElementById('burr') && window.kind", WAIT)
        page.run("document.getElementById('burr').src = 'mill/?language=en&mode=learn&case=block'")
        page.wait("kind('loaded').length > 0", WAIT)
        ready = page.run("kind('ready')[0]")
        check(ready == {"origin": site.url[:-1], "burr": 1, "kind": "ready", "case": "block", "mode": "learn", "voxel_mm": 0.25, "language": "en"},
              f"it says what it shows: {ready}")
        check(page.run("kind('step').length") > 0, f"and the step: {page.run('kind(`step`)[0].id')}")
        page.run(f"{FRAME}.document.getElementById('card_close').click()")
        page.run(POINTER.replace("document.", f"{FRAME}.document.").replace("new PointerEvent", f"new ({FRAME}.PointerEvent)")
                 .replace("burr.", f"{FRAME}.burr.") + "(2500)")
        page.wait("kind('figures').some((one) => one.removed_mm3 > 0.1)", WAIT)
        check(True, f"figures while it is milled: {page.run('kind(`figures`).at(-1)')}")
        page.run("ask({kind: 'recording'})")
        page.wait("files.length === 1", WAIT)
        check(page.run("kind('recording')[0].complete") is False, "the recording so far, and the session goes on")
        # another frame of the same page is not the page around it
        page.run("""new Promise((go) => { const other = document.createElement('iframe'); document.body.append(other);
          const script = other.contentDocument.createElement('script');
          script.textContent = "parent.document.getElementById('burr').contentWindow.postMessage({burr: 1, kind: 'language', code: 'de'}, '*')";
          other.contentDocument.body.append(script); setTimeout(go, 2000); })""")
        check(page.run(f"{FRAME}.document.documentElement.lang") == "en", "it takes no wish of another frame")
        page.run("ask({kind: 'language', code: 'sv'})")
        page.wait(f"{FRAME}.document.documentElement.lang === 'sv'", WAIT)
        page.run("ask({kind: 'finish'})")
        page.wait(f"{FRAME}.document.getElementById('done_yes')", WAIT)
        page.run(f"{FRAME}.document.getElementById('done_yes').click()")
        page.wait(f"{FRAME}.document.getElementById('self_skip')", WAIT)
        page.run(f"{FRAME}.document.getElementById('self_skip').click()")
        page.wait("kind('marked').length === 1", WAIT)
        check(page.run("kind('done').length") == 1, "it says that the work is done")
        page.run("ask({kind: 'recording'})")
        page.wait("files.length === 2", WAIT)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "framed.mcap"
            file.write_bytes(bytes(page.run("[...files[1]]")))
            told = subprocess.run([BURR, "--quiet", "score", file, "--json"], capture_output=True, text=True)
            native = json.loads(told.stdout.strip().splitlines()[-1])
            score = page.run("kind('marked')[0].score")
            check(score["items"] == native["items"], f"{len(native['items'])} marks are those of burr score on the recording it gave")
        before = page.run("heard.length")
        page.run("ask({kind: 'open', case: 'nothing', mode: 'exam'}); ask({kind: 'jump'}); ask({burr: 2, kind: 'finish'})")
        page.wait(f"{FRAME}.burr.ready && heard.length >= {before}", WAIT)
        check(not page.troubles, f"no errors on the console {page.troubles}")
        page.close()


def strangers(browser):
    """A page of another host gets no message, unless ?parent= names that host."""
    with Site(SITE) as site, Site(pathlib.Path(tempfile.gettempdir()), instead={"/around.html": AROUND}) as other:
        for more, told in (("", False), ("&parent=" + other.url, True), ("&parent=https://example.org", False)):
            page = browser.open(other.url + "around.html")
            page.wait("document.getElementById('burr') && window.kind", WAIT)
            page.run(f"document.getElementById('burr').src = '{site.url}mill/?language=en{more}'")
            time.sleep(2)
            if told:
                page.wait("kind('ready').length > 0", WAIT)
            else:
                time.sleep(15)
            page.run("ask({kind: 'recording'})")
            time.sleep(2)
            heard = page.run("heard.length")
            check((heard > 0) is told, f"a page of another host, {more or 'which is not named'}, gets {heard} messages")
            page.close()


class School(http.server.ThreadingHTTPServer):
    """A learning management system: gives a token once, hands everything else to the record store, with the heads that another host's page needs."""
    daemon_threads = True

    def __init__(self, lrs):
        self.lrs, self.tokens, self.secret = lrs, 0, lrs.key
        self.seen, self.down = [], False
        super().__init__(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server_address[1]}/"
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def give(self, status, body=b"", kind="application/json"):
        self.send_response(status)
        for name, value in {"Access-Control-Allow-Origin": "*", "Access-Control-Allow-Headers": "authorization, content-type, x-experience-api-version",
                            "Access-Control-Allow-Methods": "GET, PUT, POST", "Content-Type": kind, "Content-Length": str(len(body))}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)

    def do_OPTIONS(self):
        self.give(204)

    def do_POST(self):
        if not self.path.startswith("/fetch"):
            return self.hand_on()
        self.server.tokens += 1
        if self.server.tokens > 1:
            return self.give(200, json.dumps({"error-code": "1", "error-text": "the token was given"}).encode())
        self.give(200, json.dumps({"auth-token": base64.b64encode(self.server.secret.encode()).decode()}).encode())

    def do_GET(self):
        self.hand_on()

    do_PUT = do_GET

    def hand_on(self):
        length = int(self.headers.get("Content-Length") or 0)
        body = self.rfile.read(length) if length else None
        self.server.seen.append((self.command, self.path, body))
        if self.server.down:
            return self.give(503)
        heads = {name: self.headers[name] for name in ("Authorization", "X-Experience-API-Version", "Content-Type", "If-None-Match") if self.headers[name]}
        asked = urllib.request.Request(self.server.lrs.endpoint.rstrip("/") + self.path.removeprefix("/xapi"), body, heads, method=self.command)
        try:
            with urllib.request.urlopen(asked, timeout=30) as answer:
                self.give(answer.status, answer.read(), answer.headers.get("Content-Type", "text/plain"))
        except urllib.error.HTTPError as refused:
            self.give(refused.code, refused.read())

    def log_message(self, *_):
        pass


ACTOR = {"objectType": "Agent", "account": {"homePage": "https://lms.example.org", "name": "heron-4821"}}
CATEGORY = "https://w3id.org/xapi/cmi5/context/categories/"
VERB = "http://adlnet.gov/expapi/verbs/"


def put_document(school, path, query, value):
    secret = "Basic " + base64.b64encode(school.secret.encode()).decode()
    asked = urllib.request.Request(f"{school.url}xapi/{path}?{urllib.parse.urlencode(query)}", json.dumps(value).encode(),
                                   {"Authorization": secret, "X-Experience-API-Version": "1.0.3", "Content-Type": "application/json", "If-None-Match": "*"}, method="PUT")
    urllib.request.urlopen(asked, timeout=30).close()


def launch(school, folder_url, unit, registration, mode):
    data = {"contextTemplate": {"extensions": {"https://w3id.org/xapi/cmi5/context/extensions/sessionid": "s-1"},
                                "contextActivities": {"grouping": [{"id": "https://lms.example.org/course"}], "category": [{"id": CATEGORY + "cmi5"}]}},
            "launchMode": mode, "moveOn": "Completed", "returnURL": folder_url + "back.html"}
    agent = json.dumps(ACTOR)
    put_document(school, "activities/state", {"stateId": "LMS.LaunchData", "activityId": unit["id"], "registration": registration, "agent": agent}, data)
    school.tokens = 0
    more = urllib.parse.urlencode({"endpoint": school.url + "xapi/", "fetch": school.url + "fetch?once=1", "actor": agent, "registration": registration,
                                   "activityId": unit["id"]})
    return f"{folder_url}{unit['url']}&{more}"


def mill_and_finish(page, pressed=True):
    page.wait(f"document.getElementById('burr') && {FRAME}.burr?.ready && {FRAME}.burr.loaded", WAIT)
    if not pressed:
        return
    page.run(f"{FRAME}.document.getElementById('card_close').click()")
    page.run(POINTER.replace("document.", f"{FRAME}.document.").replace("new PointerEvent", f"new ({FRAME}.PointerEvent)")
             .replace("burr.", f"{FRAME}.burr.") + "(2000)")
    page.run(f"{FRAME}.burr.course.ask_done(); {FRAME}.document.getElementById('done_yes').click()")
    page.wait(f"{FRAME}.document.getElementById('self_skip')", WAIT)
    page.run(f"{FRAME}.document.getElementById('self_skip').click()")


def said(school, registration, count):
    """The statements of a launch, in their order."""
    end = time.monotonic() + 60
    while time.monotonic() < end:
        found = sorted((one for one, _ in school.lrs.statements() if one["context"]["registration"] == registration), key=lambda one: one["timestamp"])
        if len(found) >= count:
            break
        time.sleep(0.3)
    return found


def judge(found, verbs, what):
    check([one["verb"]["id"].removeprefix(VERB) for one in found] == verbs, f"{what}: {[one['verb']['id'].removeprefix(VERB) for one in found]}")
    for one in found:
        name = one["verb"]["id"].removeprefix(VERB)
        categories = {each["id"].removeprefix(CATEGORY) for each in one["context"]["contextActivities"]["category"]}
        wanted = {"cmi5", "moveon"} if name == "completed" else {"cmi5"}
        good = categories == wanted and "score" not in one.get("result", {}) and "success" not in one.get("result", {}) and \
            one["context"]["extensions"] and one["context"]["contextActivities"]["grouping"] and \
            (name == "initialized" or one["result"]["duration"].startswith("PT")) and (name != "completed" or one["result"]["completion"] is True)
        if not good:
            check(False, f"{name} is as cmi5 wants it: {json.dumps(one)}")


def course(browser):
    """The zip: its cmi5.xml, and the statements of a launch that is finished, left, only browsed, or not complete."""
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(COURSE) as zipped:
            zipped.extractall(folder)
        names = {"c": "https://w3id.org/xapi/profiles/cmi5/v1/CourseStructure.xsd"}
        tree = xml.parse(pathlib.Path(folder) / "cmi5.xml").getroot()
        units = [{"id": one.get("id"), "url": one.find("c:url", names).text, "move": one.get("moveOn")} for one in tree.findall("c:au", names)]
        check(len(units) == 5 and len({one["id"] for one in units}) == 5 and all(one["move"] == "Completed" for one in units), f"{len(units)} units")
        check(all((pathlib.Path(folder) / one["url"].split("?")[0]).is_file() for one in units), "each has its page in the zip")
        (pathlib.Path(folder) / "back.html").write_text('<title>the course</title><link rel="icon" href="data:,">')
        unit = next(one for one in units if one["id"].endswith("block"))
        with Site(folder) as host, Lrs() as lrs:
            school = School(lrs)
            put_document(school, "agents/profile", {"profileId": "cmi5LearnerPreferences", "agent": json.dumps(ACTOR)},
                         {"languagePreference": "de-DE,en", "audioPreference": "off"})
            one = str(uuid.uuid4())
            page = browser.open(launch(school, host.url, unit, one, "Normal"))
            mill_and_finish(page)
            page.wait("document.getElementById('say')?.textContent.startsWith('Die Arbeit ist fertig')", WAIT)
            check(page.run(f"{FRAME}.document.documentElement.lang") == "de", "the language is the learner's")
            page.picture(PICTURES and PICTURES / "cmi5.png")
            page.run("document.getElementById('leave').click()")
            end = time.monotonic() + WAIT
            while "/back.html" not in host.asked and time.monotonic() < end:
                time.sleep(0.2)
            check("/back.html" in host.asked, "Leave goes back to the course")
            judge(said(school, one, 3), ["initialized", "completed", "terminated"], "a session that is done")
            page.close()

            two = str(uuid.uuid4())
            page = browser.open(launch(school, host.url, unit, two, "Normal"))
            mill_and_finish(page, pressed=False)
            page.send("Page.navigate", {"url": "about:blank"})
            judge(said(school, two, 2), ["initialized", "terminated"], "a page that is left")
            page.close()

            three = str(uuid.uuid4())
            page = browser.open(launch(school, host.url, unit, three, "Browse"))
            mill_and_finish(page)
            page.run("document.getElementById('leave').click()")
            judge(said(school, three, 2), ["initialized", "terminated"], "Browse counts nothing")
            page.close()

            page = browser.open(launch(school, host.url, unit, str(uuid.uuid4()), "Normal").replace("&fetch=", "&no_fetch="))
            page.wait("document.getElementById('say')?.textContent.includes('fetch')", WAIT)
            check(page.run("document.getElementById('burr').src") == "", f"without fetch: {page.run('document.getElementById(`say`).textContent')}")
            page.close()
            address = launch(school, host.url, unit, str(uuid.uuid4()), "Normal")
            school.tokens = 1
            page = browser.open(address)
            page.wait("document.getElementById('say')?.textContent.includes('the token was given')", WAIT)
            check(True, f"an address used twice: {page.run('document.getElementById(`say`).textContent')}")
            page.close()
            school.shutdown()


def main():
    with Chromium(980, 620) as browser:
        framed(browser)
        strangers(browser)
        course(browser)
    if bad:
        sys.exit("\n".join(bad))


main()
