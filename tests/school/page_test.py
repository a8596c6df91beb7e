#!/usr/bin/env python3
"""Opens the instructor's page in Chromium without a screen: every view in three languages, and what must not happen.

    tests/school/page_test.py BURR [PICTURES]      BURR: the program; PICTURES: a folder to keep screenshots in

With BURR_AXE=axe.min.js (npm's axe-core) each view is also checked for accessibility. How long a view takes is printed, never
judged.
"""
import csv
import json
import os
import pathlib
import re
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.parse
import urllib.request
import uuid

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "web/tests"))
import small_site  # noqa: E402
from chromium import Chromium, Site  # noqa: E402

BURR = pathlib.Path(sys.argv[1]).resolve()
PICTURES = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
AXE = os.environ.get("BURR_AXE")
MARKUP = '<img src=x onerror="document.title=1"><script>document.title=2</script>'
WAIT = 60  # [s]


def run(*command, data=None):
    """data: the folder of burr's data, where keys lie; default: that of whoever runs the test."""
    env = os.environ if data is None else {**os.environ, "XDG_DATA_HOME": str(data)}
    done = subprocess.run([BURR, *map(str, command)], capture_output=True, text=True, env=env)
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


def seal(database, session, learner, given_ms):
    """As if a station had sealed it: whoever owns the file owns all of it. `burr learner check` would find out."""
    nonce = uuid.uuid4().hex
    database.execute("INSERT INTO nonce VALUES (?, 'test-station', ?, 'practise', '', '', ?)", (nonce, learner, given_ms))
    database.execute("INSERT INTO seal VALUES (?, ?, 'test-station', ?, ?, '', '', '', '')", (session, nonce, given_ms, given_ms + 1))
    database.execute("UPDATE session SET standing = 'sealed' WHERE id = ?", (session,))


def fill(store):
    """16 people more, 8 of them surgeons, each with the second session's scores and other points, sealed; returns their sessions."""
    database = sqlite3.connect(store)
    database.execute("INSERT INTO station VALUES ('test-station', '', 'station', 0, '', NULL, NULL)")
    session = database.execute("SELECT * FROM session ORDER BY started_ms LIMIT 1").fetchone()
    scores = database.execute("SELECT * FROM score WHERE session_id = ?", (session[0],)).fetchall()
    made = []
    for n in range(16):
        learner, new = f"otter-{2000 + n}", str(uuid.uuid4())
        database.execute("INSERT INTO learner VALUES (?, 0, ?, '', NULL, 0)", (learner, "surgeon" if n < 8 else "PGY1"))
        for k in range(2):
            new = str(uuid.uuid4())
            made.append(new)
            database.execute("INSERT INTO session VALUES (" + ",".join("?" * len(session)) + ")", (new, learner, session[2], session[3] + k + 1, *session[4:6], 0, 1, *session[8:]))
            seal(database, new, learner, session[3] + k + 1)
            for score in scores:
                id = str(uuid.uuid4())
                points = (60 if n < 8 else 30) + 5 * (n % 4) + 3 * k
                database.execute("INSERT INTO score VALUES (" + ",".join("?" * len(score)) + ")", (id, new, *score[2:5], points, 0, *score[7:]))
                for item in database.execute("SELECT * FROM item WHERE score_id = ?", (score[0],)).fetchall():
                    database.execute("INSERT INTO item VALUES (" + ",".join("?" * len(item)) + ")", (id, *item[1:]))
    database.commit()
    return made


def rows(store, sql):
    return sqlite3.connect(store).execute(sql).fetchall()


def marks_by(store, folder, rater, sessions, shift):
    table = folder / "marks.csv"
    with open(table, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["session", "item", "mark", "reason"])
        for n, session in enumerate(sessions):
            items = json.loads(run("rate", "--store", store, "--session", session, "--json").splitlines()[-1])["items"]
            for k, item in enumerate(items):
                if item["part"] == "product":
                    out.writerow([session, item["id"], "met" if (n * k + shift) % 3 else "unmet", "as, seen" if k == 0 else ""])
    run("rate", "--store", store, "--rater", rater, "--from", table)


class Serving:
    def __init__(self, store):
        self.process = subprocess.Popen([BURR, "serve", "--store", store, "--port", "0", "--live"], stdout=subprocess.PIPE, text=True)
        said = ""
        while "Ctrl-C" not in said:
            line = self.process.stdout.readline()
            assert line, "burr serve ended: " + said
            said += line
        self.url = re.search(r"http://\S+", said).group(0)
        self.base, self.token = self.url.split("#token=")
        self.station_token = re.search(r"^  ([0-9a-f]{64})$", said, re.M).group(1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(20)
        same(code, 0, "exit code of burr serve after SIGTERM")


def ask(server, path, body=None, origin=True, token=True, kind="application/json"):
    """The status and the body of an answer."""
    head = {"Authorization": "Bearer " + server.token} if token else {}
    if body is not None:
        head["Content-Type"] = kind
    if origin:
        head["Origin"] = server.base.rstrip("/") if origin is True else origin
    request = urllib.request.Request(server.base.rstrip("/") + path, None if body is None else body.encode(), head)
    try:
        with urllib.request.urlopen(request, timeout=WAIT) as answer:
            return answer.status, answer.read().decode(errors="replace")
    except urllib.error.HTTPError as refused:
        return refused.code, refused.read().decode(errors="replace")


def check_guard(server, store, folder):
    """What a change needs, and that nothing else changes anything."""
    asked = json.dumps({"rater": "C. Ek", "rubric": ""})
    for status, given in ((401, {"token": False}), (403, {"origin": False}), (403, {"origin": "http://evil.example"}), (415, {"kind": "text/plain"})):
        same(ask(server, "/api/rating/next", asked, **given)[0], status, f"a post with {given}")
    same(ask(server, "/api/rating/next")[0], 405, "to get what is to be posted")
    for path in ("/api/overview", "/api/standards", "/api/agreement", "/api/rating/product"):
        same(ask(server, path, "{}")[0], 405, "a post to " + path)
    for wrong in ("[", "[]", '{"rater": ""}', '{"rater": "machine"}', '{"rater": 3}'):
        same(ask(server, "/api/rating/next", wrong)[0], 400, "a post of " + wrong)
    status, text = ask(server, "/api/rating/next", asked)
    same(status, 200, "the next product")
    code = json.loads(text)["code"]
    product = json.loads(ask(server, "/api/rating/product?code=" + code)[1])
    # nothing says whose it is, when it was made, or what the machine thinks
    known = {row[0] for row in rows(store, "SELECT id FROM learner UNION SELECT id FROM session UNION SELECT recording_hash FROM session")}
    for said in (text, json.dumps(product)):
        for word in ("PGY", "surgeon", "started", "result", "value", "threshold", "mcap", *known):
            assert word not in said, f"an answer to a rater says {word}: {said}"
    marks = [{"item": item["id"], "mark": "met", "reason": ""} for item in product["items"]]
    good = {"rater": "C. Ek", "code": code, "marks": marks}
    before = rows(store, "SELECT count(*) FROM audit")
    for status, wrong in ((404, {**good, "code": "x"}), (404, {**good, "rater": "D. Frid"}), (400, {**good, "marks": []}), (400, {**good, "marks": marks + [{"item": "x", "mark": "met"}]}),
                          (400, {**good, "marks": [{**marks[0], "mark": "good"}]}), (400, {**good, "marks": [{**marks[0], "reason": "x" * 501}]}), (400, {**good, "marks": marks[:1] * 201})):
        same(ask(server, "/api/rating/marks", json.dumps(wrong))[0], status, "bad marks")
    try:
        refused = ask(server, "/api/rating/marks", " " * 70000 + json.dumps(good))[0]
    except OSError:  # the line was cut
        refused = 413
    same(refused, 413, "a body of 70 kB")
    same(ask(server, "/api/rating/marks", json.dumps(good), origin=False)[0], 403, "marks from nowhere")
    same(rows(store, "SELECT count(*) FROM rater_mark WHERE rater_id = 'C. Ek'"), [(0,)], "marks that were refused")
    same(rows(store, "SELECT count(*) FROM audit"), before, "rows of the audit")
    same(ask(server, "/api/rating/marks", json.dumps(good))[0], 200, "good marks")
    same(rows(store, "SELECT count(*), min(blinded) FROM rater_mark WHERE rater_id = 'C. Ek'"), [(len(marks), 1)], "marks that were kept")
    same(rows(store, "SELECT count(*) FROM audit WHERE what = 'marked by a person'")[0][0], 25, "markings in the audit")
    same(ask(server, "/api/rating/marks", json.dumps(good))[0], 400, "the same marks again")


def check_marking(page, server, store):
    """A rater marks a product in the page."""
    go(page, "/rate")
    page.run("(() => { document.getElementById('rater').value = 'E. Gran'; document.querySelector('main form').requestSubmit(); })()")
    page.wait("document.querySelectorAll('.pictures img').length && [...document.querySelectorAll('.pictures img')].every(one => one.naturalWidth > 0)", 3 * WAIT)
    same(page.run("document.querySelectorAll('.pictures img').length"), 10, "pictures")
    assert all(page.run("[...document.querySelectorAll('.pictures img')].map(one => one.alt.length > 4)"))
    known = {row[0] for row in rows(store, "SELECT id FROM learner UNION SELECT id FROM session")}
    shown = page.run("document.documentElement.outerHTML") + " ".join(url for _, url in page.requests if "rating" in url)
    same([one for one in known if one in shown], [], "what tells a rater whose it is")
    for language in ("sv", "de", "en"):
        speak(page, language)
        page.wait("document.body.dataset.shown && document.querySelectorAll('.pictures img').length === 10 && [...document.querySelectorAll('.pictures img')].every(one => one.naturalWidth > 0) && document.documentElement.lang === " + json.dumps(language), WAIT)
        look(page, "rate_" + language)
    address = next(url for _, url in page.requests if "rating/picture" in url)
    status, picture = ask(server, "/" + address.removeprefix(server.base))
    same(status, 200, "a picture")
    assert picture[1:4] == "PNG"
    for word in ("tEXt", "iTXt", "zTXt", "heron", "otter", *known):
        assert word not in picture, "a picture says " + word
    # nothing is kept before every item has a mark
    page.run("document.querySelector('form.marks').requestSubmit()")
    page.wait("document.getElementById('state').className === 'wrong'", WAIT)
    assert page.run("document.activeElement.type") == "radio"
    same(rows(store, "SELECT count(*) FROM rater_mark WHERE rater_id = 'E. Gran'"), [(0,)], "marks before all are given")
    items = page.run("document.querySelectorAll('form.marks fieldset').length")
    left = page.run("document.querySelector('main div > p').textContent")
    page.run("document.querySelectorAll('form.marks fieldset').forEach((one, n) => one.querySelectorAll('input[type=radio]')[n % 3].click())")
    page.run("document.querySelector('form.marks input[type=text]').value = '<b>why</b>'")
    page.run("document.querySelector('form.marks').requestSubmit()")
    page.wait("document.querySelector('main div > p') && document.querySelector('main div > p').textContent !== " + json.dumps(left), WAIT)
    kept = rows(store, "SELECT mark, reason FROM rater_mark WHERE rater_id = 'E. Gran'")
    same(len(kept), items, "marks that were kept")
    same({mark for mark, _ in kept}, {"met", "unmet", "not assessable"}, "the kinds of marks")
    assert any(reason == "<b>why</b>" for _, reason in kept)


def check_figures(page, server, store, folder, sessions):
    """Agreement and standards are those that `burr study` gives; no word of passing without a standard."""
    go(page, "/standards")
    same(re.findall(r"\b(pass|fail)\b", page.run("document.querySelector('main').innerText")), [], "words of passing without a standard")
    for command in (("raters",), ("reliability", "--marks", "2"), ("curve",), ("standard", "--low", "PGY1", "--high", "surgeon")):
        table = folder / "table.csv"
        first = run("study", command[0], "--store", store, *command[1:], "--out", table, "--json")
        more = [one for one in command[1:] if one not in ("--low", "--high", "PGY1", "surgeon")]
        same(run("study", command[0], table, *more, "--json"), first, f"figures of burr study {command[0]} from its table")
    few = subprocess.run([BURR, "study", "standard", "--store", store, "--low", "PGY2", "--high", "surgeon", "--set-by", "A. Berg"], capture_output=True, text=True)
    assert few.returncode != 0 and "8" in few.stderr, few
    nobody = subprocess.run([BURR, "study", "reliability", "--store", store], capture_output=True, text=True)
    assert nobody.returncode != 0, nobody
    same(rows(store, "SELECT count(*) FROM standard"), [(0,)], "standards")
    run("study", "standard", "--store", store, "--low", "PGY1", "--high", "surgeon", "--set-by", "A. Berg", "--note", "in May")
    standard = rows(store, "SELECT id FROM standard")[0][0]
    said = run("learner", "decide", "--store", store, "otter-2000")
    assert "proposal: reached" in said and "A person decides" in said, said
    run("station", "enrol", "a-berg", "--decides", "--store", store, data=folder / "keys")
    run("learner", "decide", "--store", store, "otter-2000", "--standard", standard, "--outcome", "pass", "--reason", "as proposed", data=folder / "keys")
    alone = subprocess.run([BURR, "learner", "decide", "--store", store, "otter-2001", "--standard", standard, "--outcome", "pass"], capture_output=True, text=True)
    assert alone.returncode != 0, "a decision without a person"
    same(rows(store, "SELECT count(*) FROM decision"), [(1,)], "decisions")
    figures = json.loads(run("study", "raters", "--store", store, "--json").splitlines()[-1])
    shown = json.loads(ask(server, "/api/agreement")[1])["raters"]["figures"]
    same([(one["item"], one["agreement"], one["kappa"], one["ac1"]) for one in shown["pairs"]],
         [(one["item"], one["agreement"], one["kappa"], one["ac1"]) for one in figures["pairs"]], "figures of the page")
    same(shown["icc"], figures["icc_a1"], "ICC of the page")
    assert shown["icc"] is not None and shown["complete"] == 12, shown
    check_views(page, {"agreement": "/agreement", "standards": "/standards"})
    go(page, "/standards")
    text = page.run("document.querySelector('main').innerText")
    assert "pass, a-berg" in text and "reached, in sessions 1 and 2" in text and "2 of 5" in text, text


def check_practice(page, server, store):
    """When to practise again: the command line and the page say the same, and of too few sessions nothing."""
    day = 86400_000
    noon = int(time.time() * 1000) // day * day + day // 2
    database = sqlite3.connect(store)
    sessions = [row[0] for row in database.execute("SELECT id FROM session WHERE learner_id = 'otter-2000' ORDER BY started_ms")]
    template = database.execute("SELECT * FROM session WHERE id = ?", (sessions[0],)).fetchone()
    rubric = database.execute("SELECT rubric_hash FROM score LIMIT 1").fetchone()[0]

    def practised(learner, last, points):
        database.execute("INSERT INTO learner VALUES (?, 0, 'PGY1', '', NULL, 0)", (learner,))
        database.execute("INSERT INTO cohort_member SELECT id, ? FROM cohort", (learner,))
        for n, value in enumerate(points):
            id = str(uuid.uuid4())
            database.execute("INSERT INTO session VALUES (" + ",".join("?" * len(template)) + ")",
                             (id, learner, template[2], noon - (last + len(points) - 1 - n) * day, *template[4:6], 0, 1, *template[8:]))
            database.execute("INSERT INTO score VALUES (?, ?, ?, '0.1.0', 'product', ?, 0, 1, 1)", (str(uuid.uuid4()), id, rubric, value))

    practised("plover-1", 3, [80 - 40 / n for n in range(1, 7)])    # rises: due, since a day
    practised("plover-2", 3, [80 - 40 / n for n in range(1, 9)])    # flat: in 11 days
    practised("plover-3", 0, [50, 50])                              # too few
    database.commit()
    said = {name: json.loads(run("learner", "list", "--store", store, name, "--json").splitlines()[-1])["practice"] for name in ("plover-1", "plover-2", "plover-3")}
    one = said["plover-1"][0]["next"]
    same([one["trend"], one["in_days"], one["due"], one["sessions"], one["other_bone"]], ["rising", -1, True, 2, False], "the proposal of a rising curve")
    one = said["plover-2"][0]["next"]
    same([one["trend"], one["in_days"], one["due"], one["sessions"], one["other_bone"]], ["flat", 11, False, 1, True], "the proposal of a flat curve")
    same([said["plover-3"][0]["next"], said["plover-3"][0]["finished"]], [None, 2], "the proposal of too few sessions")
    text = run("learner", "list", "--store", store, "plover-1")
    assert "due, from" in text and "because the curve still rises" in text and "a proposal" in text, text
    text = run("learner", "list", "--store", store, "plover-3")
    assert "no proposal, 2 of 3 finished sessions" in text, text
    for name, wanted in said.items():
        same(json.loads(ask(server, "/api/learner?id=" + name)[1])["practice"], wanted, "the proposal on the page of " + name)
    all_of = json.loads(ask(server, "/api/overview")[1])
    same({one["id"]: one["practice"] for one in all_of["learners"] if one["id"] in said}, {name: one[0] for name, one in said.items()}, "proposals of the overview")
    cohort = all_of["cohorts"][0]["id"]
    speak(page, "en")
    go(page, "/")
    due = page.run("document.getElementById('due').textContent")
    assert "plover-1" in due and "plover-2" not in due and "plover-3" not in due, due
    go(page, "/learner/plover-1")
    text = page.run("document.querySelector('p.again').textContent")
    assert "due, since" in text and "at most 2 sessions" in text and "still rises" in text and "nobody has tested" in text, text
    go(page, "/learner/plover-3")
    text = page.run("document.querySelector('p.again').textContent")
    assert "2 of 3 finished sessions" in text and "since" not in text, text
    go(page, f"/cohort/{cohort}/tooth")
    lines = page.run("[...document.querySelectorAll('table.again tbody tr')].map(row => row.textContent)")
    found = [next(n for n, line in enumerate(lines) if line.startswith(name)) for name in ("plover-1", "plover-2", "plover-3")]
    same(found, sorted(found), "the order of who is due")
    assert "The curve is flat. Better on another bone." in lines[found[1]], lines
    check_views(page, {"overview_due": "/", "learner_due": "/learner/plover-1", "learner_flat": "/learner/plover-2", "cohort_due": f"/cohort/{cohort}/tooth"})
    # the rest of this test counts on the people that were there before
    for table, column in (("score", "session_id"), ("session", "learner_id"), ("cohort_member", "learner_id"), ("learner", "id")):
        where = "IN (SELECT id FROM session WHERE learner_id LIKE 'plover-%')" if table == "score" else "LIKE 'plover-%'"
        database.execute(f"DELETE FROM {table} WHERE {column} {where}")
    database.commit()
    database.close()


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


def speak(page, language):
    page.run("delete document.body.dataset.shown")  # what is shown until then is in the old language
    page.run(f"(() => {{ const one = document.getElementById('language'); one.value = '{language}'; one.dispatchEvent(new Event('change')); }})()")


def check_views(page, views):
    for language in ("sv", "de", "en"):
        speak(page, language)
        for name, path in views.items():
            go(page, path)
            assert page.run("document.querySelector('h1').textContent.length") > 2, name
            same(page.run("document.documentElement.lang"), language, "the language")
            look(page, f"{name}_{language}")
            if language == "en":
                print(f"{name}: {page.run('document.body.dataset.shown')} ms")


def asked(server, path, token=None):
    """(status, body) without a browser."""
    request = urllib.request.Request(server.base + path.lstrip("/"), headers={"Authorization": "Bearer " + (token or server.token)})
    try:
        with urllib.request.urlopen(request, timeout=WAIT) as answer:
            return answer.status, answer.read()
    except urllib.error.HTTPError as refused:
        return refused.code, refused.read()


def line_of(server, session):
    while True:
        status, body = asked(server, f"api/replay?session={session}")
        if status != 202:
            return status, json.loads(body)
        time.sleep(0.2)


def check_replay_answers(server, store, folder, session, recording):
    """The time line, and the recording byte for byte; nothing of another file, and nothing of a session that has gone."""
    status, line = line_of(server, session)
    same(status, 200, "status of a replay")
    told = json.loads(run("score", recording, "--json").splitlines()[-1])
    unmet = {item["id"] for item in told["items"] if item["verdict"] == "unmet"}
    assert {one["id"] for one in line["lost"]} <= unmet and line["lost"], (line["lost"], unmet)
    assert all(0 <= one["at_s"] <= line["seconds"] for one in line["lost"]), line["lost"]
    assert len(line["steps"]) >= 2 and line["steps"][0]["from_s"] < line["steps"][-1]["to_s"], line["steps"]
    same(len(line["force_n"]), len(line["nearest_mm"]), "parts of the time line")
    found = b""
    while len(found) < line["bytes"]:
        status, part = asked(server, f"api/replay/recording?session={session}&from={len(found)}")
        assert status == 200 and part, status
        found += part
    assert found == recording.read_bytes(), "the recording that came is another one"
    for begin in ("-1", "x", "", str(line["bytes"] + 1), "1e3"):
        same(asked(server, f"api/replay/recording?session={session}&from={begin}")[0], 400, f"status for the byte {begin!r}")
    for path in ("api/replay", "api/replay/recording", "api/replay/bone"):
        same(asked(server, f"{path}?session={session}&from=0", "0" * 64)[0], 401, path + " without the token")
        same(asked(server, f"{path}?session=nobody&from=0")[0], 404, path + " of no session")
    # an address in the store that leads to another file; a recording that was written again
    database = sqlite3.connect(store)

    def with_uri(uri):
        with database:
            database.execute("INSERT INTO session SELECT 'odd', learner_id, case_hash, started_ms, seconds, mode, guided, finished, attempt, device, "
                             "device_max_n, voxel_um, engine, recording_hash, ?, standing FROM session WHERE id = ?", (uri, session))
        status, answer = line_of(server, "odd")
        with database:
            database.execute("DELETE FROM session WHERE id = 'odd'")
        return status, answer.get("error", answer)

    host = database.execute("SELECT recording_uri FROM session WHERE id = ?", (session,)).fetchone()[0].split("/")[2]
    for uri, why in ((f"file://{host}/etc/passwd", "has changed"), ("file://elsewhere/x.mcap", "on another computer"), ("", "without its recording"),
                     (f"file://{host}/dev/zero", "not on this computer"), (f"file://{host}{folder}/none.mcap", "not on this computer")):
        status, said = with_uri(uri)
        assert status == 409 and why in said, (uri, status, said)
    before = recording.stat()
    with open(recording, "r+b") as file:
        file.write(b"X")
    same(asked(server, f"api/replay/recording?session={session}&from=0")[0], 409, "status of a recording that has changed")
    with open(recording, "r+b") as file:
        file.write(found[:1])
    os.utime(recording, ns=(before.st_atime_ns, before.st_mtime_ns))
    database.close()


def check_doors(page):
    """The page's worker asks another host and runs text as code, or tries to."""
    with tempfile.TemporaryDirectory() as folder, Site(folder) as elsewhere:
        for worker in (None, *page.workers):
            tried = page.run(f"({small_site.TRY})('{elsewhere.url}')", worker)
            same({one for one, came in tried.items() if came.startswith("worked")}, small_site.MAY, f"what works of {tried}")
        assert page.workers and not elsewhere.asked, elsewhere.asked
        # the browser tells of these tries too, which it stopped; any other request elsewhere is found at the end
        page.requests[:] = [one for one in page.requests if not one[1].startswith(elsewhere.url)]
    page.troubles.clear()  # the browser says on the console what it refused


def check_replay(page, sessions):
    """In the page: the time line, jumps to lost points, the bone; two sessions step by step."""
    built = (BURR.parent / "../web/published/version.json").exists()
    speak(page, "en")
    go(page, "/replay/" + sessions[0])
    page.wait("document.querySelector('.player')", WAIT)
    drawn = "[...document.querySelectorAll('.bone-state')].every(one => one.textContent === '')"
    stopped = "document.querySelectorAll('.bone-state.wrong').length"
    page.wait(f"{drawn} || {stopped} > 0", 4 * WAIT)
    if built:
        check_doors(page)
    same(page.run(stopped), 0 if built else 1, "troubles of the picture: " + page.run("document.querySelector('.bone-state').textContent"))
    moment = "document.querySelector('.figures').textContent"
    first = page.run(moment)
    button = "[...document.querySelectorAll('main button')].find(one => one.textContent === {})"
    page.run(button.format("'Lost point ▶'") + ".click()")
    at = float(page.run("document.querySelector('.player input').value"))
    lost = page.run("[...document.querySelectorAll('svg .lost')].map(one => Number(one.getAttribute('x1')))")
    total = float(page.run("document.querySelector('.player input').max"))
    assert lost and min(abs(x / 1000 * total - at) for x in lost) < 0.01 * total, (lost, at, total)
    assert page.run(moment) != first, "the words of the moment stand still"
    if built:
        page.wait("window.performance.now() > 0 && document.querySelector('canvas.bone').width > 100", WAIT)
    look(page, "replay")
    page.run(button.format("'Play'") + ".click()")
    page.wait(f"Number(document.querySelector('.player input').value) !== {at}", WAIT)
    page.run(button.format("'Pause'") + ".click()")
    if built:
        check_evidence(page)
        look(page, "evidence")
    # an item's moment in the session's table leads into the replay; a moment in the address is taken
    go(page, f"/replay/{sessions[0]}/3")
    page.wait("document.querySelector('.player')", WAIT)
    same(page.run("Number(document.querySelector('.player input').value)"), 3, "the moment of the address")
    go(page, "/beside/" + "/".join(sessions))
    page.wait("document.querySelector('.two')", 2 * WAIT)
    page.wait(f"{drawn} || {stopped} > 0", 4 * WAIT)
    same(page.run(stopped), 0 if built else 2, "troubles of the two pictures")
    steps = int(page.run("document.querySelector('.player input').max"))
    assert steps >= 2, "steps in common"
    page.run("(() => { const one = document.querySelector('.player input'); one.value = 1.5; one.dispatchEvent(new Event('input')); })()")
    titles = page.run("[...document.querySelectorAll('.figures')].map(one => /Step: (.*?)[.] /.exec(one.textContent)[1])")
    same(titles[0], titles[1], "the step that both show")
    look(page, "beside")
    same(page.run("document.querySelectorAll('.two canvas').length"), 2, "pictures beside each other")
    # another view ends the pictures
    go(page, "/")


def check_evidence(page):
    """A lost point with a place: the view turns to it, and a ring marks it in the middle of the picture. A lost context: the picture comes back."""
    ring = """(() => { const one = document.querySelector('.bone-ring');
      const [a, b] = [one, document.querySelector('canvas.bone')].map(part => part.getBoundingClientRect());
      return one.hidden ? Infinity : Math.hypot(a.left + a.width / 2 - b.left - b.width / 2, a.top + a.height / 2 - b.top - b.height / 2); })()"""
    places = "[...document.querySelectorAll('main td')].filter(one => one.querySelector('button') && / mm$/.test(one.textContent))"
    assert page.run(f"{places}.length") > 0, "no lost point has a moment and a place"
    page.run("document.querySelector('canvas.bone').dispatchEvent(new KeyboardEvent('keydown', {key: 'f'}))")  # the whole bone
    page.wait(f"{ring} > 3", WAIT)
    page.run(f"{places}[0].querySelector('button').click()")
    page.wait(f"{ring} < 3", WAIT)
    before = colours(page)
    page.run("(() => { const one = document.querySelector('canvas.bone'); one.was_lost = true; one.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext(); })()")
    page.wait("document.querySelector('.bone-state.wrong') || !document.querySelector('canvas.bone')?.was_lost", WAIT)
    same(page.run("document.querySelectorAll('.bone-state.wrong').length"), 0, "troubles after a lost context")
    end = time.monotonic() + WAIT
    while colours(page) < 0.5 * before and time.monotonic() < end:
        time.sleep(0.5)
    assert colours(page) >= 0.5 * before > 5, f"{colours(page)} colours of bone after a lost context, {before} before"
    page.wait(f"{ring} < 3", WAIT)


def colours(page):
    """Of the bone's picture, on a line through its middle: a picture that is gone has one or two."""
    page.run("document.querySelector('canvas.bone').scrollIntoView({block: 'center'})")
    left, top, wide, high = page.run("(() => { const one = document.querySelector('canvas.bone').getBoundingClientRect(); return [one.left, one.top, one.width, one.height]; })()")
    picture = page.picture()
    return len({picture.pixel(int(left + 0.05 * wide + n), int(top + 0.4 * high)) for n in range(int(0.9 * wide))})


def check_live(page, server, folder):
    """A station with a window of its own, without a screen: its picture comes, a word and a mark reach it."""
    # its token reads nothing, and the page's token is no station's
    for path in ("api/overview", "api/live", "api/live/picture?station=x"):
        same(asked(server, path, server.station_token)[0], 401, path + " with the token of the stations")
    same(asked(server, "api/station?name=x")[0], 401, "a station with the token of the page")
    speak(page, "en")
    go(page, "/live")
    assert "No station" in page.run("document.querySelector('main').textContent")
    token = folder / "station.token"
    token.write_text(server.station_token)
    token.chmod(0o600)
    name = 'place "4" <b>å</b>'
    station = subprocess.Popen([BURR, "run", "block", "--no-sound", "--learner", "heron-1000", "--live", server.base, "--live-token-file", token, "--station", name,
                                "--out", folder / "live", "--seconds", "600"],
                               env={**os.environ, "DISPLAY": ":none", "SDL_VIDEODRIVER": "offscreen", "XDG_DATA_HOME": str(folder / "data"), "XDG_CONFIG_HOME": str(folder / "config")},
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        page.wait(f"document.querySelector('main').textContent.includes({json.dumps(name)})", WAIT)
        same(page.run("document.querySelectorAll('main b').length"), 0, "elements out of a station's name")
        go(page, "/live/" + urllib.parse.quote(name, safe=""))
        page.wait("document.querySelector('img.live').naturalWidth === 640", WAIT)
        facts = page.run("document.querySelector('.facts').textContent")
        assert "heron-1000" in facts, facts
        page.wait("document.querySelector('img.live').dataset.rate > 0", WAIT)
        print(f"live: {page.run('document.querySelector(`img.live`).dataset.rate')} pictures a second")
        page.run("(() => { const one = document.querySelector('img.live'), box = one.getBoundingClientRect();"
                 " one.dispatchEvent(new MouseEvent('click', {clientX: box.left + box.width / 2, clientY: box.top + box.height / 2})); })()")
        same(page.run("document.querySelector('.ring').hidden"), False, "whether the mark is hidden")
        page.run("document.getElementById('word').value = 'slower here'")
        page.run("[...document.querySelectorAll('main button')].find(one => one.textContent === 'Send').click()")
        page.wait("/◎ slower here – the station has it/.test(document.querySelector('main ul').textContent)", WAIT)
        time.sleep(1)  # the word is in the picture that comes back
        look(page, "live")
    finally:
        station.send_signal(signal.SIGINT)
        said = station.communicate(timeout=WAIT)[1]
    same(station.returncode in (0, 130), True, f"exit code {station.returncode} of the station: {said}")
    # the recording says that the instructor helped
    told = run("info", folder / "live/session.mcap")
    assert "help was shown" in told, told


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
            # which recording is whose: by the name that the page shows
            names = [json.loads(asked(server, "api/session?id=" + one)[1])["recording"] for one in sessions]
            cohort = overview["cohorts"][0]["id"]
            check_views(page, {"overview": "/", "cohort": f"/cohort/{cohort}/tooth", "learner": "/learner/heron-1000",
                               "learner_without": "/learner/heron-1003", "session": "/session/" + sessions[0],
                               "compare": "/compare/" + "/".join(sessions), "audit": "/audit"})
            few = page.run("fetch('/api/agreement', {headers: {Authorization: 'Bearer ' + sessionStorage.getItem('burr-token')}}).then(a => a.json())")
            same(few["raters"]["figures"], None, "figures of raters without marks")
            same([one["figures"] for one in few["reliability"]], [None, None], "reliability of one person")
            check_views(page, {"agreement_few": "/agreement", "standards_none": "/standards", "rate_begin": "/rate"})
            more = fill(store)
            marks_by(store, pathlib.Path(place), "A. Berg", more[:12], 0)
            marks_by(store, pathlib.Path(place), "B. Dahl", more[:12], 1)
            check_guard(server, store, pathlib.Path(place))
            check_marking(page, server, store)
            check_figures(page, server, store, pathlib.Path(place), more)
            check_practice(page, server, store)
            # markup stays text
            go(page, f"/cohort/{cohort}/tooth")
            assert MARKUP in page.run("document.querySelector('h1').textContent")
            same(page.run("document.querySelectorAll('main img, main script').length"), 0, "elements out of a title")
            # the items that were met, as the store has them
            cells = page.run("[...document.querySelectorAll('.heat tbody tr:first-child td')].map(cell => cell.textContent)")
            assert any(re.fullmatch(r"\d/2", cell) for cell in cells), cells
            check_replay_answers(server, store, place, sessions[0], pathlib.Path(place) / names[0])
            check_replay(page, sessions)
            check_live(page, server, pathlib.Path(place))
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
            keys = page.run("import('/rating_words.mjs').then(m => Object.values(m.ratingWords).map(one => Object.keys(one).sort().join()))")
            same(len(set(keys)), 1, "sets of keys of the languages of marking")
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
