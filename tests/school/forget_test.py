#!/usr/bin/env python3
"""Makes a learner with all that burr keeps of one, forgets it, and looks for it in every file there is.

    tests/school/forget_test.py BURR

Name, cohort, sessions with recordings and reports, what waits, damaged files, statements that were sent, sent without an
answer, or wait, exports. What the user exported stays, as docs/teach/school.md says; nothing else may hold the name, the
pseudonym or the id of a session, also within zip files. A second learner keeps all.
"""
import json
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import zipfile
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from lrs import Lrs  # noqa: E402

BURR = pathlib.Path(sys.argv[1]).resolve()
X, OTHER = "kestrel-4821", "otter-512"
NAMES = ["Ada Lovelace", "ada@example.org", "S-1815"]


def run(environment, *words, code=0):
    done = subprocess.run([BURR, *map(str, words)], capture_output=True, text=True, env=environment)
    assert done.returncode == code, f"burr {words}: {done.stdout} {done.stderr}"
    return done.stdout


def texts_of(file):
    """The file's bytes, and what is packed in them."""
    data = file.read_bytes()
    yield data
    if zipfile.is_zipfile(file):
        with zipfile.ZipFile(file) as packed:
            for name in packed.namelist():
                yield packed.read(name)
    for mark in (b"\x1f\x8b",):
        if data.startswith(mark):
            yield zlib.decompress(data, 31)


def holding(folder, words):
    out = {}
    for file in folder.rglob("*"):
        found = sorted(word for word in words if word in file.name)
        if file.is_file():
            found += sorted({word for word in words for text in texts_of(file) if word.encode() in text})
        if found:
            out[str(file.relative_to(folder))] = found
    return out


def rows_holding(store, words):
    out = []
    for path in (store, store.with_name("school-names.sqlite")):
        base = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
        for (table,) in base.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall():
            out += [(table, word) for row in base.execute(f"SELECT * FROM {table}") for word in words if any(word in str(value) for value in row)]
        base.close()
    return out


def session_ids(store, learner):
    base = sqlite3.connect(f"file:{store}?mode=ro", uri=True)
    try:
        return [row[0] for row in base.execute("SELECT id FROM session WHERE learner_id = ?", (learner,))]
    finally:
        base.close()


def main():
    with tempfile.TemporaryDirectory() as box, Lrs() as lrs:
        home = pathlib.Path(box)
        key = home / "config" / "burr" / "xapi"
        key.parent.mkdir(parents=True)
        key.write_text(f"{lrs.endpoint}\n{lrs.key}\n")
        key.chmod(0o600)
        away = {name: value for name, value in os.environ.items() if not name.startswith("BURR_")}
        env = away | {"HOME": str(home), "XDG_DATA_HOME": str(home / "data"), "XDG_STATE_HOME": str(home / "state"),
                      "XDG_CONFIG_HOME": str(home / "config"), "XDG_CACHE_HOME": str(home / "cache")}
        store = home / "data" / "burr" / "school.sqlite"
        run(env, "learner", "add", "--id", X, "--name", NAMES[0], "--mail", NAMES[1], "--external-id", NAMES[2], "--level", "PGY2")
        run(env, "learner", "add", "--id", OTHER, "--name", "Grace Hopper")
        run(env, "learner", "cohort", "add", "autumn", X, OTHER)
        run(env, "learner", "xapi", "on", "--home-page", "https://centre.example")
        # where the window keeps sessions, with what lies beside them; and elsewhere
        kept = home / "state" / "burr" / "sessions"
        kept.mkdir(parents=True)
        for n, (learner, folder) in enumerate([(X, kept), (X, home / "elsewhere"), (OTHER, kept)]):
            folder.mkdir(exist_ok=True)
            recording = folder / f"session_{n}.mcap"
            run(env, "surgeon", "tooth", "--level", "average", "--seed", n + 1, "--learner", learner, "--attempt", 1, "--record", recording)
            run(env, "report", recording, "--out", recording.with_suffix(".html"))
            run(env, "learner", "enter", learner, recording)
            if n == 0:
                run(env, "learner", "xapi", "send")  # these arrive
            if n == 1:
                lrs.faults.append({"cut": "after"})  # these too, and burr does not hear of it
                run(env, "learner", "xapi", "send", "--now", code=74)
        never = kept / "session_9.mcap"  # one that never came into the store
        shutil.copy(kept / "session_0.mcap", never)
        for beside in (never.with_suffix(".json"), never.with_suffix(".toml")):
            beside.write_text(f'learner = "{X}"\n')
        pending = store.parent / "pending"
        pending.mkdir(exist_ok=True)
        (pending / "recording.json").write_text(json.dumps(
            {"store": str(store), "recording": {"file": str(never), "learner": X, "rubric": ""}}))
        (pending / "torn.json.damaged").write_text(f'{{"learner":"{X}", "sess')
        out = home / "handed-out"
        out.mkdir()
        run(env, "learner", "export", X, "--out", out / "x.zip")
        run(env, "learner", "export", "--all", "--csv", out / "tables")
        run(env, "learner", "list", "--names")
        words = [X, *NAMES, *session_ids(store, X)]
        assert len(words) == 6, words
        before = holding(home, words)
        for place in ("data/burr/school.sqlite", "data/burr/school-names.sqlite", "state/burr/sessions/session_0.html", "elsewhere/session_1.html", "data/burr/pending/recording.json",
                      "handed-out/x.zip", "handed-out/tables/session.csv"):
            assert place in before, f"{place} does not hold the learner: {sorted(before)}"
        recordings = [kept / "session_0.mcap", home / "elsewhere" / "session_1.mcap", never]  # packed with zstd: they must be gone
        for one in recordings:
            assert X in run(env, "info", one, "--json"), one
        said = run(env, "learner", "forget", X, "--json")
        told = json.loads(said.strip().splitlines()[-1])["forgotten"][0]
        assert told["complete"] and told["sessions"] == 2 and told["voided"] >= 4, told
        assert told["unreached"] == [], told
        assert not any(one.exists() for one in recordings), recordings
        left = {place: found for place, found in holding(home, words).items() if not place.startswith("handed-out/")}
        assert left == {}, f"still there: {left}"
        assert rows_holding(store, words) == [], rows_holding(store, words)
        run(env, "learner", "xapi", "send", "--now")
        theirs = [voided for one, voided in lrs.statements() if one["actor"]["account"]["name"] == X]
        assert theirs and all(theirs), theirs
        assert not any(voided for one, voided in lrs.statements() if one["actor"]["account"]["name"] == OTHER)
        # the other one has all still
        there = holding(home, [OTHER, "Grace Hopper"])
        for place in ("data/burr/school.sqlite", "data/burr/school-names.sqlite", "state/burr/sessions/session_2.html"):
            assert place in there, place
        assert OTHER in run(env, "info", kept / "session_2.mcap", "--json")
        assert holding(home, words).keys() <= {"handed-out/x.zip", *(f"handed-out/tables/{one.name}" for one in (out / "tables").iterdir())}
    print(f"forgotten: {len(before)} files held the learner, {len(told['deleted'])} were deleted, {told['voided']} statements taken back")


if __name__ == "__main__":
    main()
