#!/usr/bin/env python3
"""Statements of sessions go to a learning record store that misbehaves: nothing is lost, and nothing is there twice.

    tests/school/xapi_test.py BURR [NAME...]       NAME: only these

The store is tests/school/lrs.py. Sessions come in as those that waited, so nothing has to be milled. How long something
takes is never judged.
"""
import hashlib
import json
import os
import pathlib
import random
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from lrs import Lrs  # noqa: E402

BURR = pathlib.Path(sys.argv[1]).resolve()
VERBS = "http://adlnet.gov/expapi/verbs/"
PROFILE = "https://w3id.org/burr/xapi"
SECRET = "s3cr3t-of-the-centre"
KEY = f"burr-key:{SECRET}"


def same(found, wanted, what):
    assert found == wanted, f"{what}: {found!r}, not {wanted!r}"


def session(learner, what, steps=2, finished=True):
    digest = hashlib.sha1(f"{learner} {what}".encode()).hexdigest()
    score = {"part": "product", "total": 66.5, "gates_broken": 1, "assessable_weight": 0.9, "made_ms": 1700000100000,
             "items": [{"id": "floor", "result": "met", "value": 0.3, "threshold": 0.25, "margin": 0.05, "evidence": "{}"}]}
    return {"learner": learner, "case": {"hash": "0xaa", "name": "Block, \"quoted\"", "text": "", "version": 2, "calibrated": 0},
            "rubric": {"hash": "0xbb", "name": "block rubric", "text": "", "version": 3, "calibrated": 0}, "scored_by": "0.1.0",
            "started_ms": 1700000000000, "seconds": 61.25, "mode": "exam", "guided": False, "finished": finished, "attempt": 2,
            "device": "simulated hand", "device_max_n": 3.3, "voxel_um": 250, "engine": "0.1.0", "recording_hash": digest,
            "recording_uri": f"file://elsewhere/{digest}.mcap", "scores": [score], "self_marks": [],
            "metrics": [{"name": f"step_done step-{n}", "unit": "s", "value": 10.0 * n} for n in range(1, steps + 1)]}


class Centre:
    def __init__(self, lrs, on=True):
        self.box = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.box.name)
        self.store = self.folder / "school.sqlite"
        self.lrs = lrs
        lrs.key = KEY
        self.key_file = self.folder / "xapi"
        self.write_key(KEY)
        self.said = ""
        self.run("learner", "add", "--id", "heron-4821", "--name", "Nora Nyberg")
        self.run("learner", "add", "--id", "otter-5")
        if on:
            self.run("learner", "xapi", "on", "--home-page", "https://centre.example")

    def write_key(self, key, endpoint=None, mode=0o600):
        self.key_file.write_text(f"{endpoint or self.lrs.endpoint}\n{key}\n")
        self.key_file.chmod(mode)

    def environment(self, sends):
        out = {name: value for name, value in os.environ.items() if not name.startswith(("BURR_STORE", "BURR_XAPI"))}
        out |= {"BURR_STORE": str(self.store), "XDG_DATA_HOME": str(self.folder / "data"), "XDG_CONFIG_HOME": str(self.folder / "config")}
        out["BURR_XAPI_FILE"] = str(self.key_file if sends else self.folder / "none")
        return out

    def run(self, *words, sends=False, code=0, **more):
        done = subprocess.run([BURR, *map(str, words)], capture_output=True, text=True, env=self.environment(sends) | more)
        self.said += done.stdout + done.stderr
        if code is not None:
            same(done.returncode, code, f"burr {words}: {done.stdout} {done.stderr}")
        return done

    def take_in(self, *sessions, sends=False):
        (self.folder / "pending").mkdir(exist_ok=True)
        for one in sessions:
            file = self.folder / "pending" / f"{one['recording_hash']}.json"
            file.write_text(json.dumps({"store": str(self.store), "session": one}))
        self.run("learner", "take-in", sends=sends)

    def send(self, *more, code=0):
        return self.run("learner", "xapi", "send", *more, sends=True, code=code)

    def status(self):
        return json.loads(self.run("learner", "xapi", "status", "--json").stdout.strip().splitlines()[-1])

    def rows(self):
        store = sqlite3.connect(f"file:{self.store}?mode=ro", uri=True)
        try:
            return store.execute("SELECT id, statement_json, state, tries FROM outbox WHERE id <> 'settings' ORDER BY id").fetchall()
        finally:
            store.close()

    def all_arrived(self, wanted):
        """Each statement once, and the outbox knows it."""
        there = [one["id"] for one, _ in self.lrs.statements()]
        same(len(there), len(set(there)), "statements that are there twice")
        same(sorted(there), sorted(row[0] for row in self.rows()), "statements")
        same(len(there), wanted, "statements")
        same({row[2] for row in self.rows()}, {"sent"}, "states")
        now = self.status()
        same([now["waiting"], now["sent"], now["parked"], now["trouble"]], [0, wanted, 0, ""], "status")

    def end(self):
        assert SECRET not in self.said, "the secret was printed"
        for file in self.folder.rglob("*"):
            if file.is_file() and file != self.key_file:
                assert SECRET.encode() not in file.read_bytes(), f"the secret is in {file}"
        self.box.cleanup()


# ---- what is said

def off_makes_nothing(centre):
    centre.take_in(session("heron-4821", "a"), sends=True)
    same(centre.rows(), [], "rows")
    same(centre.send(code=2).returncode, 2, "sending")
    same(centre.lrs.seen, [], "requests")


def what_a_session_says(centre):
    centre.take_in(session("heron-4821", "a"), session("otter-5", "b", steps=0, finished=False))
    centre.send()
    centre.all_arrived(6)
    by = {}
    for one, _ in centre.lrs.statements():
        by.setdefault(one["actor"]["account"]["name"], []).append(one)
        same(one["actor"]["account"]["homePage"], "https://centre.example", "home page")
        same(one["context"]["contextActivities"]["category"][0]["id"], PROFILE, "category")
        same(one["object"]["id"], PROFILE + "/cases/Block%2C%20%22quoted%22", "activity")
        assert "Nyberg" not in json.dumps(one)
    first, again, later, last = sorted(by["heron-4821"], key=lambda one: one["timestamp"])
    same([one["verb"]["id"] for one in (first, again, later, last)], [VERBS + v for v in ("initialized", "progressed", "progressed", "completed")], "verbs")
    same(len({one["context"]["registration"] for one in (first, again, later, last)}), 1, "registrations")
    same(first["timestamp"], "2023-11-14T22:13:20.000Z", "time")
    same(later["result"], {"duration": "PT10.00S", "extensions": {PROFILE + "/step": "step-2"}}, "a step")  # no score
    same(last["result"]["score"], {"scaled": 0.665, "raw": 66.5, "min": 0, "max": 100}, "score")
    same(last["result"]["duration"], "PT61.25S", "duration")
    same(last["result"]["extensions"], {PROFILE + "/" + name: value for name, value in {
        "guided": False, "mode": "exam", "rubric": "block rubric", "rubric-hash": "0xbb", "engine": "0.1.0", "attempt": 2,
        "product-points": 66.5, "product-gates-broken": 1}.items()}, "extensions")
    assert "success" not in last["result"]  # only a person says that
    begun, left = sorted(by["otter-5"], key=lambda one: one["timestamp"])
    same([left["verb"]["id"], left["result"]["completion"], "score" in left["result"]], [VERBS + "exited", False, False], "an unfinished one")


def profile_names_all(centre):
    profile = json.loads((pathlib.Path(__file__).resolve().parents[2] / "docs/teach/xapi-profile.jsonld").read_text())
    same(profile["id"], PROFILE, "profile")
    centre.take_in(session("heron-4821", "a"))
    used = set(re.findall(rf'"({PROFILE}/[a-z-]+)":', " ".join(row[1] for row in centre.rows())))
    known = {one["id"] for one in profile["concepts"] if one["type"] == "ResultExtension"}
    assert used and used <= known, f"not in the profile: {used - known}"


def coming_in_sends(centre):
    centre.take_in(session("heron-4821", "a"), sends=True)
    centre.all_arrived(4)
    centre.take_in(session("heron-4821", "a"), sends=True)  # once more the same
    centre.all_arrived(4)


def many_go_in_batches(centre):
    centre.take_in(*[session("heron-4821", n, steps=0) for n in range(60)])
    centre.send()
    centre.all_arrived(120)
    posts = [one for one in centre.lrs.seen if one[0] == "POST"]
    same(len(posts), 3, "posts")


# ---- what goes wrong

def after_a_fault(centre, fault, *more):
    centre.take_in(session("heron-4821", "a"), session("otter-5", "b"))
    centre.lrs.faults.append(fault)
    centre.send(*more, code=74)
    now = centre.status()
    same([now["waiting"], now["sent"], now["parked"]], [8, 0, 0], "status")
    assert now["trouble"]
    before = len(centre.lrs.seen)
    centre.send(code=74)  # it is not time yet: nobody is asked
    same(len(centre.lrs.seen), before, "requests")
    centre.send("--now")
    centre.all_arrived(8)


def error_500(centre):
    after_a_fault(centre, {"status": 500})


def error_503(centre):
    after_a_fault(centre, {"status": 503, "retry_after": 3600})
    # by date as well
    centre.take_in(session("heron-4821", "c", steps=0))
    centre.lrs.faults.append({"status": 503, "retry_after": time.strftime("%a, %d %b %Y %H:%M:%S GMT", time.gmtime(time.time() + 7200))})
    centre.send(code=74)
    wait = centre.status()["next_ms"] / 1000 - time.time()
    assert 3600 < wait <= 7200, wait


def cut_before(centre):
    after_a_fault(centre, {"cut": "before"})


def cut_within_the_answer(centre):
    after_a_fault(centre, {"cut": "within"})


def cut_after_it_was_stored(centre):
    after_a_fault(centre, {"cut": "after"})


def slow(centre):
    after_a_fault(centre, {"slow": 3}, "--wait", "0.5")


def not_an_lrs(centre):
    after_a_fault(centre, {"status": 200, "body": "<html>log in</html>"})


def too_many(centre):
    centre.take_in(session("heron-4821", "a"))
    centre.lrs.faults.append({"status": 429, "retry_after": 2})
    begun = time.time()
    centre.send(code=74)
    before = len(centre.lrs.seen)
    if time.time() < begun + 1.5:  # on a busy computer the time may be over
        centre.send(code=74)
        same(len(centre.lrs.seen), before, "requests before Retry-After")
    centre.send("--for", "3")
    centre.all_arrived(4)


def nobody_listens(centre):
    centre.take_in(session("heron-4821", "a"))
    centre.write_key(KEY, "http://localhost:9/xapi")
    centre.send(code=74)
    centre.write_key(KEY)
    centre.send("--now")
    centre.all_arrived(4)


def waits_grow(centre):
    centre.take_in(session("heron-4821", "a", steps=0))
    waits = []
    for _ in range(4):
        centre.lrs.faults.append({"status": 500})
        begun = time.time()
        centre.send("--now", code=74)
        waits.append(centre.status()["next_ms"] / 1000 - begun)
    for n, wait in enumerate(waits):
        assert 60 * 2 ** n - 1 <= wait <= 60 * 2 ** n + 60, waits


def wrong_credentials(centre):
    centre.take_in(session("heron-4821", "a"))
    centre.write_key("burr-key:other")
    assert "401" in centre.send(code=74).stderr
    same(centre.run("learner", "xapi", "test", sends=True, code=None).returncode, 1, "test")
    same([centre.status()["waiting"], centre.status()["parked"]], [4, 0], "status")
    centre.write_key(KEY)
    assert "takes the key" in centre.run("learner", "xapi", "test", sends=True).stdout
    centre.send("--now")
    centre.all_arrived(4)


def conflict_with_the_same(centre):
    centre.take_in(session("heron-4821", "a"))
    centre.lrs.faults.append({"cut": "after"})
    centre.send(code=74)
    centre.lrs.faults += [{"status": 409}] * 7  # of all four, of halves, of each
    centre.send("--now")
    centre.all_arrived(4)


def conflict_with_another(centre):
    centre.take_in(session("heron-4821", "a"))
    other = json.loads(next(row for row in centre.rows() if "completed" in row[1])[1])
    other["result"]["score"]["scaled"] = 0.9
    other["object"] = {"id": other["object"]["id"]}
    for name in ("stored", "authority", "version"):
        other[name] = "x"
    other["version"], other["stored"] = "1.0.0", "2026-01-01T00:00:00Z"
    for some in other["context"]["contextActivities"]:
        other["context"]["contextActivities"][some] = list(other["context"]["contextActivities"][some])
    centre.lrs.store.put([other], {})
    centre.send()
    now = centre.status()
    same([now["waiting"], now["sent"], now["parked"]], [0, 3, 1], "status")
    same(now["first_parked"][0]["verb"], "completed", "parked")
    assert "another statement" in now["first_parked"][0]["why"]
    same(len(centre.lrs.statements()), 4, "statements")


def too_large(centre):
    centre.take_in(*[session("heron-4821", n) for n in range(10)])
    centre.lrs.largest = 4000
    centre.send()
    centre.all_arrived(40)
    centre.take_in(session("otter-5", "big"))
    centre.lrs.largest = 100  # not even one
    centre.send()
    same([centre.status()["parked"], centre.status()["waiting"]], [4, 0], "parked")
    centre.lrs.largest = 0
    centre.run("learner", "xapi", "retry")
    centre.send()
    centre.all_arrived(44)


def one_is_refused(centre):
    centre.take_in(session("heron-4821", "a"), session("otter-5", "b"))
    with sqlite3.connect(centre.store) as store:  # a slip that burr would not make
        row = store.execute("SELECT id, statement_json FROM outbox WHERE statement_json LIKE '%heron%completed%'").fetchone()
        bad = json.loads(row[1])
        bad["result"]["score"]["scaled"] = 7
        store.execute("UPDATE outbox SET statement_json = ? WHERE id = ?", (json.dumps(bad), row[0]))
    store.close()
    centre.send()
    now = centre.status()
    same([now["waiting"], now["sent"], now["parked"]], [0, 7, 1], "status")
    same(now["first_parked"][0], {"id": row[0], "verb": "completed", "why": "400: scaled"}, "parked")
    centre.send()
    same(len([one for one in centre.lrs.seen if one[0] == "POST"]), 7, "posts")  # 8, 4+4, 2+2, 1+1; and no more


def the_sentence_names_nobody(centre):
    centre.take_in(session("heron-4821", "a", steps=0))
    registration = json.loads(centre.rows()[0][1])["context"]["registration"]
    for _ in range(3):
        centre.lrs.faults.append({"status": 400, "body": f"heron-4821 may not {registration}"})
    centre.send()
    same({one["why"] for one in centre.status()["first_parked"]}, {"400: ... may not ..."}, "sentences")


# ---- a program that is killed

def wait_until(what):
    for _ in range(3000):
        if what():
            return
        time.sleep(0.01)
    raise AssertionError("it did not come to that")


def a_sentence_about_all_is_not_kept(centre):
    centre.take_in(session("heron-4821", "a"))
    centre.lrs.faults.append({"status": 500, "body": "heron-4821 is too much"})
    assert "too much" in centre.send(code=74).stderr
    same(centre.status()["trouble"], "the server answers 500", "trouble")


def killed(centre):
    centre.take_in(*[session("heron-4821", n, steps=0) for n in range(30)])
    centre.lrs.faults.append({"slow": 1})  # 60 statements: of 50 it is being told, 10 follow
    sender = subprocess.Popen([BURR, "learner", "xapi", "send"], env=centre.environment(True), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_until(lambda: any(one[0] == "POST" for one in centre.lrs.seen))
    sender.send_signal(signal.SIGKILL)
    sender.wait()
    same(sum(row[2] == "trying" for row in centre.rows()), 50, "tried")
    wait_until(lambda: len(centre.lrs.statements()) == 50)  # they arrived, and nobody heard of it
    centre.send("--now")
    centre.all_arrived(60)


def killed_at_any_moment(centre):
    dice = random.Random(7)
    centre.take_in(*[session("heron-4821", n, steps=0) for n in range(150)])
    centre.lrs.faults += [dice.choice([{}, {"slow": 0.05}, {"cut": "after"}, {"status": 503}]) for _ in range(60)]
    for _ in range(40):
        sender = subprocess.Popen([BURR, "learner", "xapi", "send", "--now"], env=centre.environment(True), stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL)
        time.sleep(dice.uniform(0, 0.25))
        sender.send_signal(signal.SIGKILL)
        sender.wait()
    centre.lrs.faults.clear()
    centre.send("--now")
    centre.all_arrived(300)


def two_at_once(centre):
    centre.take_in(*[session("heron-4821", n, steps=0) for n in range(100)])
    senders = [subprocess.Popen([BURR, "learner", "xapi", "send", "--now"], env=centre.environment(True), stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True) for _ in range(3)]
    for one in senders:
        same(one.wait(), 0, one.stderr.read())
    centre.all_arrived(200)


# ---- forgetting

def forget_takes_back(centre):
    centre.take_in(session("heron-4821", "a", steps=0), session("otter-5", "b", steps=0))
    centre.send()
    centre.take_in(session("heron-4821", "waits", steps=0))  # never sent: nothing to take back
    centre.run("learner", "forget", "heron-4821")
    for row in centre.rows():
        assert "heron-4821" not in row[1]
    centre.send()
    theirs = [voided for one, voided in centre.lrs.statements() if one["actor"]["account"]["name"] == "heron-4821"]
    same(theirs, [True, True], "voided")
    same([voided for one, voided in centre.lrs.statements() if one["actor"]["account"]["name"] == "otter-5"], [False, False], "others")
    same(sum(one["verb"]["id"] == VERBS + "voided" for one, _ in centre.lrs.statements()), 2, "voidings")
    same(len(centre.lrs.statements()), 6, "statements")


def forget_after_a_kill(centre):
    centre.take_in(session("heron-4821", "a", steps=0))
    centre.lrs.faults.append({"cut": "after"})
    centre.send(code=74)  # they arrived, and burr does not know
    centre.run("learner", "forget", "heron-4821")
    centre.send("--now")
    same([voided for one, voided in centre.lrs.statements() if one["actor"]["account"]["name"] == "heron-4821"], [True, True], "voided")


# ---- the key

def the_key_is_kept(centre):
    centre.take_in(session("heron-4821", "a", steps=0))
    centre.write_key(KEY, mode=0o644)
    assert "chmod 600" in centre.send(code=2).stderr
    centre.write_key(KEY, "http://lrs.example.org/xapi")
    assert "https" in centre.send(code=2).stderr
    centre.write_key(KEY, "https://a:b@lrs.example.org/xapi")
    centre.send(code=2)
    same(centre.lrs.seen, [], "requests")
    # from the environment
    centre.run("learner", "xapi", "send", BURR_XAPI_ENDPOINT=centre.lrs.endpoint + "/", BURR_XAPI_KEY=KEY)
    centre.all_arrived(2)


def no_redirection(centre):
    centre.take_in(session("heron-4821", "a", steps=0))
    centre.lrs.faults.append({"status": 302})
    centre.send(code=74)
    same([centre.status()["waiting"], centre.status()["parked"]], [2, 0], "status")


def tls_is_checked():
    if not shutil.which("openssl"):
        print("tls_is_checked: left out, openssl is missing")
        return
    with tempfile.TemporaryDirectory() as box:
        made = {}
        for name in ("localhost", "elsewhere.example"):
            made[name] = [f"{box}/{name}.pem", f"{box}/{name}.key"]
            subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", f"/CN={name}", "-addext",
                            f"subjectAltName=DNS:{name}", "-out", made[name][0], "-keyout", made[name][1]], check=True, capture_output=True)
        for name, trusted, code in (("localhost", True, 0), ("localhost", False, 74), ("elsewhere.example", True, 74)):
            with Lrs(certificate=made[name]) as lrs:
                centre = Centre(lrs)
                centre.take_in(session("heron-4821", "a", steps=0))
                centre.run("learner", "xapi", "send", sends=True, code=code, SSL_CERT_FILE=made[name][0] if trusted else "/dev/null")
                same(len(lrs.statements()), 2 if code == 0 else 0, f"statements by TLS, {name}, {trusted}")
                centre.end()


# ---- cmi5

def launch(centre, mode="Normal"):
    actor = {"objectType": "Agent", "account": {"homePage": "https://lms.example", "name": "1625378"}}
    registration, activity = "760e3480-ba55-4991-94b0-01820dbd23a2", "https://lms.example/units/bone"
    centre.lrs.launch = {"token": "bG1zOnRva2Vu"}
    template = {"contextActivities": {"grouping": [{"id": "https://publisher.example/bone"}]},
                "extensions": {"https://w3id.org/xapi/cmi5/context/extensions/sessionid": "session-1"}}
    owner = json.dumps([activity, "account https://lms.example 1625378", registration])
    centre.lrs.store.db.execute("INSERT INTO document VALUES ('state', ?, 'LMS.LaunchData', 'application/json', ?, ?)", (
        owner, json.dumps({"contextTemplate": template, "launchMode": mode, "moveOn": "CompletedOrPassed", "masteryScore": 0.5}).encode(),
        "2026-01-01T00:00:00Z"))
    return "burr://run?" + urllib.parse.urlencode({
        "endpoint": centre.lrs.endpoint + "/", "fetch": centre.lrs.endpoint + "/fetch", "actor": json.dumps(actor),
        "registration": registration, "activityId": activity}, quote_via=urllib.parse.quote)


def run_headless(centre, url, code=0):
    return centre.run("run", "block", "--headless", "--seconds", "1", "--out", centre.folder / f"out{random.random()}", "--cmi5", url, code=code)


def cmi5(centre):
    url = launch(centre)
    done = run_headless(centre, url)
    assert "bG1zOnRva2Vu" not in done.stdout + done.stderr
    told = [one for one, _ in centre.lrs.statements()]
    same([one["verb"]["id"] for one in told], [VERBS + v for v in ("initialized", "completed", "terminated")], "verbs")
    same(sorted(one["timestamp"] for one in told), [one["timestamp"] for one in told], "times")
    same(len({one["timestamp"] for one in told}), 3, "times")
    for one in told:
        same(one["actor"]["account"]["name"], "1625378", "actor")
        same(one["object"]["id"], "https://lms.example/units/bone", "object")
        same(one["context"]["registration"], "760e3480-ba55-4991-94b0-01820dbd23a2", "registration")
        same(one["context"]["extensions"], {"https://w3id.org/xapi/cmi5/context/extensions/sessionid": "session-1"}, "session id")
        same(one["context"]["contextActivities"]["grouping"][0]["id"], "https://publisher.example/bone", "template")
        categories = {some["id"].rsplit("/", 1)[1] for some in one["context"]["contextActivities"]["category"]}
        same(categories, {"cmi5", "moveon"} if one["verb"]["id"].endswith("completed") else {"cmi5"}, "categories")
        assert "score" not in one.get("result", {}) and "success" not in one.get("result", {})  # cmi5 wants neither here
    same([one.get("result") for one in told], [None, {"completion": True, "duration": "PT1.00S"}, {"duration": "PT1.00S"}], "results")
    same([one[1] for one in centre.lrs.seen][:3], ["/activities/state", "/agents/profile", "/statements"], "order")
    assert "already" in run_headless(centre, url, code=74).stderr  # one use of one address
    same(len(centre.lrs.statements()), 3, "statements")


def cmi5_browse(centre):
    run_headless(centre, launch(centre, "Browse"))
    same([one["verb"]["id"] for one, _ in centre.lrs.statements()], [VERBS + v for v in ("initialized", "terminated")], "verbs")


def cmi5_with_faults(centre):
    url = launch(centre)
    centre.lrs.faults += [{"cut": "after"}, {}, {"status": 500}, {"cut": "after"}, {"cut": "before"}, {"status": 503}]
    run_headless(centre, url)
    same([one["verb"]["id"] for one, _ in centre.lrs.statements()], [VERBS + v for v in ("initialized", "completed", "terminated")], "verbs")


def cmi5_waits(centre):
    """The system answers no more at the end: what it was to be told waits, in order, and is told later; a refusal ends it."""
    state = {"XDG_STATE_HOME": str(centre.folder / "state")}
    url = launch(centre)
    centre.lrs.faults += [{}] + [{"status": 503}] * 40
    done = centre.run("run", "block", "--headless", "--seconds", "1", "--out", centre.folder / "out", "--cmi5", url, **state)
    assert "tells it later" in done.stderr, done.stderr
    same([one["verb"]["id"] for one, _ in centre.lrs.statements()], [VERBS + "initialized"], "verbs")
    files = list((centre.folder / "state/burr/cmi5").glob("*"))
    same(len(files), 1, "files that wait")
    same(files[0].stat().st_mode & 0o777, 0o600, "who may read the token")
    kept = files[0].read_text()
    same([one["verb"]["id"] for one in json.loads(kept)["statements"]], [VERBS + "completed", VERBS + "terminated"], "verbs that wait")
    assert "1 launch" in centre.run("learner", "xapi", "status", **state).stdout
    centre.lrs.faults[:] = [{"status": 503}] * 3
    centre.run("learner", "take-in", **state)  # still away: it waits on
    same(files[0].read_text(), kept, "what waits")
    centre.lrs.faults.clear()
    said = centre.run("learner", "take-in", **state).stderr
    assert "1 launch kept from earlier" in said, said
    told = [one for one, _ in centre.lrs.statements()]
    same([one["verb"]["id"] for one in told], [VERBS + v for v in ("initialized", "completed", "terminated")], "verbs")
    same(sorted(one["timestamp"] for one in told), [one["timestamp"] for one in told], "times")
    same([one.exists() for one in files], [False], "files after that")
    # the system has ended the session by itself, so it takes the token no more
    files[0].write_text(kept.replace(json.loads(kept)["statements"][0]["id"], "760e3480-ba55-4991-94b0-01820dbd23ff"))
    centre.lrs.launch.clear()
    assert "ended the session by itself" in centre.run("learner", "take-in", **state).stderr
    same([one.exists() for one in files], [False], "files after a refusal")
    # nobody waits longer than a week; a torn file is said and goes
    late = json.loads(kept)
    late["until_ms"] = 1700000000000
    files[0].write_text(json.dumps(late))
    assert "7 days" in centre.run("learner", "take-in", **state).stderr
    files[0].write_text(kept[:100])
    assert "cannot be read" in centre.run("learner", "take-in", **state).stderr
    same([one.exists() for one in files], [False], "files after that")
    same(len(centre.lrs.statements()), 3, "statements")
    assert "bG1zOnRva2Vu" not in centre.said


def cmi5_is_whole(centre):
    url = launch(centre)
    for name in ("endpoint", "fetch", "actor", "registration", "activityId"):
        assert name in run_headless(centre, re.sub(rf"{name}=[^&]*&?", "", url), code=2).stderr
    same(centre.lrs.statements(), [], "statements")


TESTS = [off_makes_nothing, what_a_session_says, profile_names_all, coming_in_sends, many_go_in_batches, error_500, error_503, cut_before,
         cut_within_the_answer, cut_after_it_was_stored, slow, not_an_lrs, too_many, nobody_listens, waits_grow, wrong_credentials,
         conflict_with_the_same, conflict_with_another, too_large, one_is_refused, the_sentence_names_nobody, a_sentence_about_all_is_not_kept, killed, killed_at_any_moment,
         two_at_once, forget_takes_back, forget_after_a_kill, the_key_is_kept, no_redirection, cmi5, cmi5_browse, cmi5_with_faults, cmi5_waits, cmi5_is_whole]

if __name__ == "__main__":
    wanted = sys.argv[2:]
    for test in TESTS:
        if wanted and test.__name__ not in wanted:
            continue
        with Lrs() as lrs:
            centre = Centre(lrs, on=test is not off_makes_nothing)
            test(centre)
            centre.end()
        print(f"{test.__name__}: fine", flush=True)
    if not wanted or "tls_is_checked" in wanted:
        tls_is_checked()
        print("tls_is_checked: fine")
