#!/usr/bin/env python3
"""Measures the instructor's page with a large class: how long each view takes until it is shown.

    bench/school/page.py BURR [--learners 200] [--sessions 5000] [--real 6] [--times 5] [--store F.sqlite] [--no-browser]

Makes a store as a class would leave it: REAL sessions of scripted surgeons, each scored by its rubric, then copies of them
under other learners, days and results, and three raters who marked 150 products each. Then it opens each view in Chromium
and prints, for bench/results/school.md, the time from the choice of the view until it is shown, and the processor time of
`burr serve` for it, which does not depend on what else the machine does. Without a browser the answers of the server
are timed instead. --store keeps the store, and takes it as it is where it is there. The bar is 300 ms for each view.
"""
import argparse
import json
import os
import pathlib
import random
import re
import signal
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request
import uuid

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "web/tests"))
DAY = 86_400_000  # [ms]
RATERS, MARKED = ("A. Berg", "B. Dahl", "C. Ek"), 150


def run(*command):
    done = subprocess.run([str(one) for one in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return done.stdout


def real_sessions(args, store, folder):
    first = "heron-1000"
    run(args.burr, "learner", "add", "--store", store, "--id", first, "--level", "PGY2")
    for n in range(args.real):
        recording = folder / f"{n}.mcap"
        level = ("careless", "average", "expert")[n % 3]
        run(args.burr, "surgeon", "tooth", "--level", level, "--seed", 100 + n, "--learner", first, "--attempt", n + 1, "--record", recording)
        run(args.burr, "learner", "enter", "--store", store, first, recording)


def insert(database, table, row):
    database.execute(f"INSERT INTO {table} VALUES ({','.join('?' * len(row))})", row)


def copies(args, database):
    """Sessions, scores and items, each with results and points of its own, so that no figure is that of equal marks."""
    chance = random.Random(1)
    sessions = database.execute("SELECT * FROM session ORDER BY started_ms").fetchall()
    scores = {one[0]: database.execute("SELECT * FROM score WHERE session_id = ?", (one[0],)).fetchall() for one in sessions}
    items = {score[0]: database.execute("SELECT * FROM item WHERE score_id = ?", (score[0],)).fetchall() for of in scores.values() for score in of}
    marks = {one[0]: database.execute("SELECT * FROM self_mark WHERE session_id = ?", (one[0],)).fetchall() for one in sessions}
    metrics = {one[0]: database.execute("SELECT * FROM metric WHERE session_id = ?", (one[0],)).fetchall() for one in sessions}
    cohort = str(uuid.UUID(int=chance.getrandbits(128)))
    insert(database, "cohort", (cohort, "autumn"))
    insert(database, "cohort_member", (cohort, sessions[0][1]))
    now, made = int(time.time() * 1000), len(sessions)
    for n in range(1, args.learners):
        learner = f"otter-{1000 + n}"
        insert(database, "learner", (learner, now - 400 * DAY, f"PGY{1 + n % 5}", "", None, 0))
        insert(database, "cohort_member", (cohort, learner))
        start, tau = chance.uniform(30, 60), chance.uniform(2, 8)
        count = (args.sessions - len(sessions)) // (args.learners - 1) + (1 if n <= (args.sessions - len(sessions)) % (args.learners - 1) else 0)
        for k in range(count):
            one = chance.choice(sessions)
            new = str(uuid.UUID(int=chance.getrandbits(128)))
            started = now - (count - k) * 3 * DAY + chance.randrange(DAY)
            insert(database, "session", (new, learner, one[2], started, one[4], "learn" if k < 2 else "practise", int(k < 2), int(chance.random() > 0.05), k + 1, *one[9:13],
                                         format(chance.getrandbits(160), "040x"), one[14]))
            for score in scores[one[0]]:
                id = str(uuid.UUID(int=chance.getrandbits(128)))
                points = min(100, max(0, 95 - (95 - start) / (1 + k / tau) + chance.gauss(0, 4)))
                insert(database, "score", (id, new, *score[2:5], points, *score[6:8], started + 60_000))
                for item in items[score[0]]:
                    result = item[2] if item[2] == "not assessable" or chance.random() > 0.15 else chance.choice(("met", "unmet"))
                    insert(database, "item", (id, item[1], result, *item[3:]))
            for mark in marks[one[0]]:
                insert(database, "self_mark", (new, *mark[1:]))
            for metric in metrics[one[0]]:
                insert(database, "metric", (new, *metric[1:]))
            made += 1
    return made


def rater_marks(database):
    chance = random.Random(2)
    products = [row[0] for row in database.execute("SELECT id FROM session WHERE finished = 1 ORDER BY id LIMIT ?", (MARKED,))]
    for rater in RATERS:
        for product in products:
            for item, result in database.execute("SELECT item_id, result FROM item JOIN score ON score.id = item.score_id WHERE score.session_id = ? AND score.part = 'product'", (product,)).fetchall():
                mark = result if result != "not assessable" and chance.random() < 0.8 else chance.choice(("met", "unmet"))
                insert(database, "rater_mark", (str(uuid.UUID(int=chance.getrandbits(128))), product, rater, item, mark, 1, None, 0))


def standard(database):
    rubric = database.execute("SELECT rubric_hash FROM score LIMIT 1").fetchone()[0]
    database.execute("INSERT INTO standard (id, rubric_hash, part, method, cut, n_low, n_high, judges, fp, fn, text, set_by, made_ms) "
                     "VALUES ('bench', ?, 'product', 'contrasting groups', 70, 20, 20, NULL, 0.1, 0.1, '', 'A. Berg', 0)", (rubric,))


def make_store(args, store, folder):
    real_sessions(args, store, folder)
    database = sqlite3.connect(store)
    made = copies(args, database)
    rater_marks(database)
    standard(database)
    database.commit()
    items = database.execute("SELECT count(*) FROM item").fetchone()[0]
    database.close()
    return made, items


class Serving:
    def __init__(self, burr, store):
        self.process = subprocess.Popen([burr, "serve", "--store", store, "--port", "0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        said = ""
        while "Ctrl-C" not in said:
            line = self.process.stdout.readline()
            if not line:
                sys.exit("burr serve ended: " + said)
            said += line
        self.url = re.search(r"http://\S+", said).group(0)
        self.base, self.token = self.url.split("#token=")

    def processor_ms(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return 1000 * (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def ask(self, path, body=None):
        head = {"Authorization": "Bearer " + self.token, "Origin": self.base.rstrip("/"), "Content-Type": "application/json"}
        request = urllib.request.Request(self.base + path, None if body is None else json.dumps(body).encode(), head)
        with urllib.request.urlopen(request, timeout=600) as answer:
            return json.loads(answer.read())

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(20)


def new_marks(store):
    """One mark more, so that the server must compute the agreement again."""
    with sqlite3.connect(store) as database:
        session, item = database.execute("SELECT score.session_id, item.item_id FROM item JOIN score ON score.id = item.score_id JOIN session ON session.id = score.session_id "
                                         "WHERE session.finished = 1 AND score.part = 'product' ORDER BY random() LIMIT 1").fetchone()
        insert(database, "rater_mark", (str(uuid.uuid4()), session, "bench " + uuid.uuid4().hex[:8], item, "met", 1, None, int(time.time() * 1000)))


class Timed:
    """Of each view the milliseconds of the clock and of the server's processor."""
    def __init__(self, serving):
        self.serving, self.clock, self.processor = serving, {}, {}

    def add(self, name, work):
        before = self.serving.processor_ms()
        ms = work()
        self.clock.setdefault(name, []).append(ms)
        self.processor.setdefault(name, []).append(self.serving.processor_ms() - before)

    def show(self):
        print("| view | median [ms] | all [ms] | processor, median [ms] |\n|---|---|---|---|")
        for name, all_ms in self.clock.items():
            print(f"| {name} | {statistics.median(all_ms):.0f} | {', '.join(f'{ms:.0f}' for ms in all_ms)} | {statistics.median(self.processor[name]):.0f} |")
        worst = max(self.clock, key=lambda name: max(self.clock[name]))
        print(f"slowest: {worst}, {max(self.clock[worst]):.0f} ms; the bar is 300 ms")


def took(work):
    began = time.monotonic()
    work()
    return 1000 * (time.monotonic() - began)


def by_answers(args, store, serving, timed):
    overview = serving.ask("api/overview")
    cohort, learner = overview["cohorts"][0]["id"], overview["learners"][-1]["id"]
    session = serving.ask("api/learner?id=" + learner)["sessions"][0]["id"]
    for _ in range(args.times):
        for name, path in (("overview", "api/overview"), ("cohort", f"api/cohort?id={cohort}&case=tooth"), ("learner", "api/learner?id=" + learner),
                           ("session", "api/session?id=" + session), ("standards", "api/standards"), ("audit", "api/audit")):
            timed.add(name, lambda path=path: took(lambda: serving.ask(path)))
        new_marks(store)
        timed.add("agreement, after new marks", lambda: took(lambda: serving.ask("api/agreement")))
        timed.add("agreement again", lambda: took(lambda: serving.ask("api/agreement")))
        timed.add("next product to mark", lambda: took(lambda: serving.ask("api/rating/next", {"rater": "D. Frid", "rubric": ""})))


def by_browser(args, store, serving, timed):
    from chromium import Chromium
    print("Chromium:", run("chromium", "--version").strip())
    with Chromium(1100, 900) as browser:
        page = browser.open(serving.url)
        page.wait("document.body && document.body.dataset.shown", 60)
        overview = serving.ask("api/overview")
        cohort, learner = overview["cohorts"][0]["id"], overview["learners"][-1]["id"]
        session = serving.ask("api/learner?id=" + learner)["sessions"][0]["id"]

        def go(path):
            page.run("delete document.body.dataset.shown")
            page.run(f"(location.hash === '#' + {json.dumps(path)}) ? dispatchEvent(new Event('hashchange')) : (location.hash = {json.dumps(path)})")
            page.wait("document.body.dataset.shown", 60)
            return float(page.run("document.body.dataset.shown"))

        for _ in range(args.times):
            for name, path in (("overview", "/"), ("cohort", f"/cohort/{cohort}/tooth"), ("learner", "/learner/" + learner), ("session", "/session/" + session),
                               ("standards", "/standards"), ("audit", "/audit")):
                timed.add(name, lambda path=path: go(path))
            new_marks(store)
            timed.add("agreement, after new marks", lambda: go("/agreement"))
            go("/audit")
            timed.add("agreement again", lambda: go("/agreement"))
            page.run("sessionStorage.setItem('burr-rater', 'D. Frid')")
            timed.add("next product to mark", lambda: go("/rate"))
        if page.troubles:
            print("console:", page.troubles)


def main():
    wanted = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wanted.add_argument("burr", type=pathlib.Path)
    wanted.add_argument("--learners", type=int, default=200)
    wanted.add_argument("--sessions", type=int, default=5000)
    wanted.add_argument("--real", type=int, default=6, help="sessions that are not copies")
    wanted.add_argument("--times", type=int, default=5)
    wanted.add_argument("--store", type=pathlib.Path, help="keep it there, or use the one that is there")
    wanted.add_argument("--no-browser", action="store_true")
    args = wanted.parse_args()
    args.burr = args.burr.resolve()
    print("processors:", os.cpu_count(), "load:", os.getloadavg()[0])
    with tempfile.TemporaryDirectory() as place:
        os.environ["XDG_STATE_HOME"] = place  # burr keeps no list of the bench's recordings
        store = args.store or pathlib.Path(place) / "school.sqlite"
        if not store.exists():
            made, items = make_store(args, store, pathlib.Path(place))
            print(f"store: {args.learners} learners, {made} sessions, {items} items, {store.stat().st_size / 1e6:.0f} MB")
        serving = Serving(args.burr, store)
        timed = Timed(serving)
        try:
            (by_answers if args.no_browser else by_browser)(args, store, serving, timed)
        finally:
            serving.end()
        timed.show()
    print("load at the end:", os.getloadavg()[0])


main()
