#!/usr/bin/env python3
"""`burr batch` and `burr merge`: the same bytes whatever the shards, the kills, the instruction set and the engine; what cannot be done
is refused in one sentence.

    tests/batch/batch_test.py BURR [NAME...]        NAME: only these tests
"""
import contextlib
import csv
import hashlib
import io
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
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from batch_tools import HEAD, ROOT, Batch, killed_again_and_again  # noqa: E402

BURR = pathlib.Path(sys.argv[1]).resolve()
# rows of all kinds, each of a fraction of a second; the last one cannot be done
ROWS = (HEAD + "id,command,case,volume,stimulus,names,level,seed,seconds,motion,burr-mm,voxel-mm,observer,trials,quick,vice\n" +
        "".join(f"s{n},surgeon,tooth,,,,{level},{n},2,,,,,,,\n" for n, level in ((1000, "expert"), (1001, "average"), (1002, "careless"))) +
        "vice-1,surgeon,tooth,,,,expert,1003,2,,,,,,,tremor_mm=0.3;force_N=3\n" +
        "".join(f"m.{n},mill,,phantom:block,,,,,1,{motion},4,0.5,,,,\n" for n, motion in enumerate(("slot", "pocket", "plunge"))) +
        "".join(f"p_{n},psychophysics,,,stiffness,,,{n},,,,,\"threshold=0.12,seed={n}\",200,,\n" for n in range(4)) +
        "v-1,verify,,,,safety,,7,,,,,,,yes,\n" +
        "bad,surgeon,tooth,,,,expert,,2,,,,,,,no_such_vice=1\n")
SURGEON = HEAD + "id,command,case,seed,seconds\n"
# rows of some hundredths of a second
OBSERVER = HEAD + "id,command,stimulus,seed,observer,trials\n"


def observers(ids):
    return OBSERVER + "".join(f'{one},psychophysics,stiffness,{n},"threshold=0.12,seed={n}",10\n' for n, one in enumerate(ids))


def seed_of_today():
    """A new one in each run, so that the kills of a year come at many moments; BURR_SEED repeats one."""
    seed = int(os.environ.get("BURR_SEED", random.SystemRandom().randrange(1 << 32)))
    print(f"  BURR_SEED={seed}", flush=True)
    return seed


def refuses_what_is_no_manifest(folder):
    head = "id,command,case,seed\n"
    for text, code, said in (
            ("", 65, "line 1: is not \"# burr-manifest 1\""),
            ("id,command\n", 65, "line 1: is not"),
            (HEAD, 65, "ends after its first line"),
            (HEAD + head, 65, "has no rows"),
            (HEAD + "id,case\na,tooth\n", 65, "line 2: there is no column command"),
            (HEAD + "id,command,id\na,surgeon,b\n", 65, "line 2, column id: the column stands there twice"),
            (HEAD + "id,command,,case\na,surgeon,,tooth\n", 65, "column 3 has no name"),
            (HEAD + "id,command,colour\na,surgeon,red\n", 65, "line 2, column colour: none of the commands"),
            (HEAD + "id,command,record\na,surgeon,x.mcap\n", 65, "line 2, column record: a batch sets this itself"),
            (HEAD + head + "a,surgeon,tooth,1\n\n# a note\nb,surgeon,tooth\n", 65, "line 6: has 3 cells where there are 4"),
            (HEAD + head + "a,surgeon,tooth,1\na,surgeon,tooth,2\n", 65, "line 4, column id: a is the id of line 3 too"),
            (HEAD + head + "a/b,surgeon,tooth,1\n", 65, "line 3, column id: a/b is no id"),
            (HEAD + head + ",surgeon,tooth,1\n", 65, "column id: an empty cell is no id"),
            (HEAD + head + "x" * 65 + ",surgeon,tooth,1\n", 65, "is no id"),
            (HEAD + head + "a.time,surgeon,tooth,1\n", 65, "is no id"),
            (HEAD + head + "a,surgeon,\"tooth,1\n", 65, "line 3: a quote is opened and never closed"),
            (HEAD + head + "a,surgeon,\"tooth\"x,1\n", 65, "line 3: something stands behind the closing quote"),
            (HEAD + head + "a,surgeon,to\"oth,1\n", 65, "line 3: a quote stands inside the cell"),
            # found by --dry-run, row by row
            (HEAD + head + "a,surgeon,tooth,1\nb,dig,tooth,1\n", 65, "line 4, column command: dig is no command of a batch; use one of mill"),
            (HEAD + head + "a,surgeon,tooth,many\n", 65, "line 3, column seed: "),
            (HEAD + "id,command,case,quick\na,surgeon,tooth,yes\n", 65, "line 3, column quick: `burr surgeon` has no such option"),
            (HEAD + "id,command,names,quick\na,verify,safety,perhaps\n", 65, "line 3, column quick: perhaps is neither yes nor no"),
            (HEAD + head + "a,surgeon,,1\n", 65, "line 3: "),
    ):
        batch = Batch(BURR, folder, text)
        words = batch.do("out", "0/1", "--dry-run", code=code)
        assert said in words, f"{text!r}: {words} in place of {said}"
        assert "m.csv: " in words, words
    assert not (folder / "out").exists(), "a dry run made a folder"
    good = HEAD.replace("\n", "\r\n") + head.replace("\n", "\r\n") + '"x' + "x" * 62 + '","surgeon",tooth,1\r\n'
    assert "1 row of 1 in this shard, 0 that cannot" in Batch(BURR, folder, good).do("out", "0/1", "--dry-run")
    batch = Batch(BURR, folder, HEAD + head + "a,surgeon,tooth,1\n")
    for shard in ("1/1", "x/2", "3", "-1/2", "0/0", "1/2/3"):
        assert "--shard" in batch.do("out", shard, code=2)
    assert "--seconds-left" in batch.do("out", "0/1", "--finish", code=2)


def equal_whatever_the_shards(folder):
    batch = Batch(BURR, folder, ROWS)
    said = batch.do("one", "0/1", "--json")
    assert json.loads(said.splitlines()[-1]) == {"shard": "0/1", "rows": 13, "done_before": 0, "done": 12, "refused": 1, "left": 0}, said
    assert "m.csv: line 15, column vice: " in said, said
    first, results = batch.merge("one"), batch.results("one")
    assert len(results) == 12
    batch.all("three", 3)
    batch.all("seven", 7, env={"BURR_SIMD": "scalar"})  # the same bits on every instruction set
    for other in ("three", "seven"):
        assert batch.results(other) == results, f"{other}: other bytes"
        assert batch.merge(other) == first, f"{other}: another table"
    # what a result holds
    hash_of_rows = hashlib.sha256(batch.manifest.read_bytes()).hexdigest()
    for name, text in results.items():
        one = json.loads(text)
        assert sorted(one) == ["engine", "id", "inputs", "manifest", "result"] and one["manifest"] == hash_of_rows
        assert name == f"{fnv1a64(one['id']) & 0xff:02x}/{one['id']}.json", name
        assert text == json.dumps(one, sort_keys=True, separators=(",", ":"), ensure_ascii=False).encode() + b"\n" or b"e" in text
        assert not re.search(rb'"(tick_us|wall_s|took_s|late|bytes)"', text), text
        times = json.loads((folder / "one" / "results" / name.replace(".json", ".time.json")).read_text())
        assert times["wall_s"] > 0 and times["isa"] and times["host"] and times["peak_mb"] > 1
    # the table
    table = list(csv.DictReader(io.StringIO((folder / "one.csv").read_text(), newline="")))
    assert [row["id"] for row in table] == [line.split(",")[0] for line in ROWS.splitlines()[2:]]
    by = {row["id"]: row for row in table}
    assert by["bad"]["code"] == "65" and "no_such_vice" in by["bad"]["sentence"]
    assert by["s1000"]["level"] == "expert" and float(by["s1000"]["result.seconds"]) == 2 and by["s1000"]["result.finished"] == "true"
    assert by["s1000"]["result.bone_hash"] != by["s1001"]["result.bone_hash"]
    assert float(by["m.0"]["result.removed_mm3"]) > 0.1 and by["v-1"]["result.failed"] == "0" and float(by["p_1"]["result.threshold"]) > 0
    with sqlite3.connect(folder / "one.sqlite") as base:
        assert base.execute('SELECT count(*), sum(code = 65) FROM result').fetchone() == (13, 1)
        assert base.execute('SELECT "result.removed_mm3" FROM result WHERE id = "m.0"').fetchone()[0] == float(by["m.0"]["result.removed_mm3"])
    # the same as the command itself says
    said = json.loads(subprocess.run([BURR, "--quiet", "surgeon", "tooth", "--level", "expert", "--seed", "1000", "--seconds", "2", "--json"],
                                     capture_output=True, text=True, check=True).stdout)
    assert json.loads(results[f"{fnv1a64('s1000') & 0xff:02x}/s1000.json"])["result"] == said
    # done is done: nothing is done again, also when rows are added, which keep their shards
    kept = {name: (folder / "one" / "results" / name).stat().st_mtime_ns for name in results}
    batch.manifest.write_text(ROWS + "s9,surgeon,tooth,,,,expert,9,2,,,,,,,\n")
    said = json.loads(batch.do("one", "0/1", "--json").splitlines()[-1])
    assert (said["done_before"], said["done"], said["refused"]) == (12, 1, 1), said
    assert kept == {name: (folder / "one" / "results" / name).stat().st_mtime_ns for name in results}
    assert batch.merge("one") != first


def fnv1a64(text):
    value = 0xcbf29ce484222325
    for byte in text.encode():
        value = (value ^ byte) * 0x100000001b3 & 0xffffffffffffffff
    return value


def equal_after_kills(folder):
    batch = Batch(BURR, folder, SURGEON + "".join(f"s{n},surgeon,tooth,{n},4\n" for n in range(1000, 1012)))
    began = time.monotonic()
    batch.do("whole")
    a_row = (time.monotonic() - began) / 12
    met = killed_again_and_again(batch, "killed", 3, 8, seed=4, longest_s=2.5 * a_row)  # before, in and after a row
    assert met >= 5, f"only {met} kills met a running program"
    assert batch.results("killed") == batch.results("whole")
    assert batch.merge("killed") == batch.merge("whole")
    assert not batch.remains("killed"), "the table is made, and half files are left"


def equal_after_many_kills_in_many_shards(folder):
    """64 shards, and 50 kills at random moments: the bytes of one run that nobody disturbed. Where all rows are done before the last
    kill, it begins anew."""
    seed, kills = seed_of_today(), 50
    batch = Batch(BURR, folder, observers(f"p{n}" for n in range(128)))
    batch.do("whole")
    results, table = batch.results("whole"), batch.merge("whole")
    assert len(results) == 128
    batch.all("many", 64)
    assert batch.results("many") == results and batch.merge("many") == table
    met, turn = 0, 0
    while met < kills:
        out = f"killed{turn}"
        met += killed_again_and_again(batch, out, 4, kills - met, seed=seed + turn, longest_s=0.3)
        assert batch.results(out) == results, f"{out}: other bytes"
        assert batch.merge(out) == table, f"{out}: another table"
        assert not batch.remains(out), "the table is made, and half files are left"
        turn += 1
        assert turn < 20, "no kill meets a running program"


def ten_thousand_rows(folder):
    """A manifest of 10 000 rows, with ids as long as they may be: few shards of many are done, the others are named as missing; a doubled id is
    refused with both of its lines; with all results there, the table has the manifest's order."""
    longest = "Az09_.-" + "x" * 57
    ids = [longest, longest[:-1] + "y"] + [f"row-{n}.of.{10000 - n}" for n in range(9998)]
    assert len(longest) == 64 and len(set(ids)) == 10000
    batch = Batch(BURR, folder, observers(ids))
    shard = fnv1a64(longest) % 2000
    mine = [one for one in ids if fnv1a64(one) % 2000 == shard]
    said = json.loads(batch.do("out", f"{shard}/2000", "--json").splitlines()[-1])
    assert said["rows"] == said["done"] == len(mine) and 1 <= len(mine) < 40, (said, mine)
    done = {json.loads(text)["id"]: text for text in batch.results("out").values()}
    assert sorted(done) == sorted(mine)
    said = batch.merge("out", code=75)
    assert f"{10000 - len(mine)} rows are missing" in said and f"missing {longest}\n" not in said, said[-300:]
    # the other results as the same program would write them, but for what it found
    one = json.loads(done[longest])
    for n, name in enumerate(ids):
        if name in done:
            continue
        file = folder / "out" / "results" / f"{fnv1a64(name) & 0xff:02x}" / f"{name}.json"
        file.parent.mkdir(parents=True, exist_ok=True)
        one["id"], one["inputs"]["seed"], one["inputs"]["observer"] = name, str(n), f"threshold=0.12,seed={n}"
        file.write_text(json.dumps(one, sort_keys=True, separators=(",", ":")) + "\n")
    batch.merge("out")
    table = list(csv.DictReader(io.StringIO((folder / "out.csv").read_text(), newline="")))
    assert [row["id"] for row in table] == ids and table[777]["seed"] == "777"
    assert json.loads(batch.do("out", "0/1", "--json").splitlines()[-1]) == {"shard": "0/1", "rows": 10000, "done_before": 10000, "done": 0,
                                                                             "refused": 0, "left": 0}
    batch.manifest.write_text(observers([*ids, ids[4711]]))
    said = batch.do("out", code=65)
    assert f"line 10003, column id: {ids[4711]} is the id of line {4711 + 3} too" in said, said


def clock_jumps(folder):
    """The clock of the computer is years wrong, or jumps while a row is done: nothing but the times beside the results changes."""
    library = next(iter(sorted(pathlib.Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"))), None)
    if library is None:
        assert os.environ.get("BURR_REQUIRE_TOOLS") != "1", "faketime is missing"
        print("  faketime is missing (section [test] of scripts/packages.txt): not tried")
        return
    batch = Batch(BURR, folder, SURGEON + "".join(f"s{n},surgeon,tooth,{n},1\n" for n in range(1000, 1008)))
    batch.do("true")
    clock, over = folder / "clock", threading.Event()
    clock.write_text("+0\n")

    def jump():
        for offset in ("+40d", "-9y", "+1h", "-1h", "+30y", "-1s"):
            if over.wait(0.15):
                return
            new = folder / "clock.new"
            new.write_text(offset + "\n")
            new.rename(clock)
    for out, env in (("past", {"FAKETIME": "@1999-12-31 23:59:58"}), ("future", {"FAKETIME": "@2043-07-01 00:00:00"}),
                     ("jumps", {"FAKETIME_TIMESTAMP_FILE": str(clock), "FAKETIME_NO_CACHE": "1"})):
        env |= {"LD_PRELOAD": str(library), "FAKETIME_DONT_FAKE_MONOTONIC": "1"}
        over.clear()
        jumping = threading.Thread(target=jump)
        if out == "jumps":
            jumping.start()
        try:
            batch.do(out, "0/2", env=env)
            batch.do(out, "0/1", env=env if out != "past" else None)  # and back to the true time: done is done
        finally:
            over.set()
            if out == "jumps":
                jumping.join()
        assert batch.results(out) == batch.results("true"), f"{out}: other bytes"
        times = [json.loads(one.read_text()) for one in (folder / out / "results").rglob("*.time.json")]
        assert len(times) == 8 and all(0 <= one["wall_s"] < 600 for one in times), times
        years = {one["began"][:4] for one in times}
        assert out == "jumps" or ("1999" in years or "2000" in years if out == "past" else years == {"2043"}), years
        assert batch.merge(out) == batch.merge("true"), f"{out}: another table"


def stopped_says_so(folder):
    """SIGTERM: 143, Ctrl-C: 130; what was stopped never looks finished."""
    for number, code in ((signal.SIGTERM, 143), (signal.SIGINT, 130)):
        for words in (["surgeon", "tooth", "--seconds", "3000"], ["mill", "phantom:block", "--burr-mm", "4", "--motion", "pocket", "--seconds", "3000"]):
            file = folder / f"{words[0]}{code}.mcap"
            program = subprocess.Popen([BURR, "--quiet", *words, "--record", file, "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            until(lambda: file.exists() and file.stat().st_size > 100_000, program)
            program.send_signal(number)
            out, err = program.communicate()
            assert program.returncode == code and "stopped" in err, (program.returncode, err)
            said = json.loads(out.splitlines()[-1])
            assert said["finished"] is False and said["recording"]["finished"] is False and said["recording"]["whole"] is True, said
            assert said.get("ending", "stopped") == "stopped", said
            info = json.loads(subprocess.run([BURR, "info", file, "--json"], capture_output=True, text=True, check=True).stdout.splitlines()[-1])
            assert info["finished"] is False, info
    # in a batch: the row's result is dropped, its recording is closed and says that it was stopped
    batch = Batch(BURR, folder, SURGEON + "short,surgeon,tooth,1,1\nlong,surgeon,tooth,1,3000\n")
    for number, code in ((signal.SIGTERM, 143), (signal.SIGINT, 130)):
        out = f"stopped{code}"
        program = subprocess.Popen([str(word) for word in batch.words(out, "0/1", "--record")], stderr=subprocess.PIPE, text=True,
                                   start_new_session=True)
        file = folder / out / "recordings" / f"{fnv1a64('long') & 0xff:02x}" / "long.mcap"
        until(lambda: file.exists() and file.stat().st_size > 100_000, program)
        os.killpg(program.pid, number)  # to the program and to what it started, as a terminal or Slurm sends it
        err = program.communicate()[1]
        assert program.returncode == code and "1 row of this shard is left" in err, (program.returncode, err)
        assert list(batch.results(out)) == [f"{fnv1a64('short') & 0xff:02x}/short.json"]
        info = json.loads(subprocess.run([BURR, "info", file, "--json"], capture_output=True, text=True, check=True).stdout.splitlines()[-1])
        assert info["finished"] is False, info
        assert "missing long" in batch.merge(out, code=75)


def until(ready, program):
    end = time.monotonic() + 120
    while not ready():
        assert program.poll() is None and time.monotonic() < end, "did not come so far"
        time.sleep(0.01)


def finishes_the_row(folder):
    """--finish: the row ends if the longest one so far would have ended in time; no further one begins."""
    batch = Batch(BURR, folder, SURGEON + "".join(f"s{n},surgeon,tooth,{n},20\n" for n in range(4)))
    for out, more, expected in (("long", ["--finish", "--seconds-left", "600"], 2), ("short", [], 1)):
        program = subprocess.Popen([str(word) for word in batch.words(out, "0/1", "--record", *more)], stderr=subprocess.PIPE, text=True)
        second = folder / out / "recordings" / f"{fnv1a64('s1') & 0xff:02x}" / "s1.mcap"
        until(second.exists, program)
        program.send_signal(signal.SIGTERM)
        program.communicate()
        assert program.returncode == 143 and len(batch.results(out)) == expected, (out, program.returncode, len(batch.results(out)))


def merge_refuses(folder):
    batch = Batch(BURR, folder, SURGEON + "a,surgeon,tooth,1,1\nb,surgeon,tooth,2,1\nc,surgeon,tooth,3,1\n")
    batch.do("out", "0/2")
    batch.do("out", "1/2")
    whole = batch.merge("out")
    place = {one: folder / "out" / "results" / f"{fnv1a64(one) & 0xff:02x}" / f"{one}.json" for one in "abc"}
    text = place["b"].read_text()
    place["b"].unlink()
    said = batch.merge("out", code=75)
    assert "missing b" in said and "1 row is missing" in said and "missing a" not in said, said
    place["b"].write_text(text[:40])
    assert "is no result of `burr batch`" in batch.merge("out", code=65)
    assert "is no result of `burr batch`" in batch.do("out", code=65)
    other = json.loads(text)
    other["engine"]["build"] = "0123456789abcdef"
    place["b"].write_text(json.dumps(other))
    said = batch.merge("out", code=65)
    assert "2 builds of burr" in said and "2 results by" in said and "1 result by" in said, said
    batch.merge("out", "--mixed")
    other = json.loads(text)
    other["inputs"]["seed"] = "7"
    place["b"].write_text(json.dumps(other))
    assert "foreign b: was made from another row" in batch.merge("out", code=65)
    assert "was made from another row of this id" in batch.do("out", code=65)
    place["b"].write_text(text)
    (place["b"].parent / "stranger.json").write_text(text.replace('"b"', '"stranger"'))
    assert "foreign stranger: is no row" in batch.merge("out", code=65)
    (place["b"].parent / "stranger.json").unlink()
    (place["b"].parent / "b.json.part-1-1").write_text("half")
    assert batch.merge("out") == whole and not batch.remains("out")


def full_disk_and_missing_files(folder):
    # a file that is not there will not come: 65; a folder that is not there may: 75
    batch = Batch(BURR, folder, HEAD + f"id,command,recording\na,score,{folder}/none.mcap\n")
    assert "1 refused" in batch.do("file")
    batch = Batch(BURR, folder, HEAD + f"id,command,recording\na,score,{folder}/no/none.mcap\n")
    assert "1 row of this shard is left" in batch.do("folder", code=75)
    assert json.loads((folder / "folder" / "failed" / "a.json").read_text())["code"] == 75
    # a row that is killed from outside does not take the others with it
    batch = Batch(BURR, folder, SURGEON + "long,surgeon,tooth,1,3000\nshort,surgeon,tooth,1,1\n")
    program = subprocess.Popen([str(word) for word in batch.words("killed")], stderr=subprocess.DEVNULL)
    children = pathlib.Path(f"/proc/{program.pid}/task/{program.pid}/children")
    until(lambda: children.read_text().strip(), program)
    time.sleep(0.2)
    os.kill(int(children.read_text().split()[0]), signal.SIGKILL)
    assert program.wait() == 75 and [name[3:] for name in batch.results("killed")] == ["short.json"]
    assert "was killed from outside" in json.loads((folder / "killed" / "failed" / "long.json").read_text())["sentence"]
    disk = folder / "disk"
    disk.mkdir()
    if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", disk], capture_output=True).returncode:
        print("  no small disk can be mounted here: a full disk was not tried")
        return
    try:
        (disk / "filler").write_bytes(b"x" * 60000)
        batch = Batch(BURR, folder, SURGEON + "a,surgeon,tooth,1,1\nb,surgeon,tooth,2,1\n")
        said = batch.do("disk", code=75)
        assert "disk is full" in said and "results cannot be written" in said, said
        assert not batch.remains("disk") and not [one for one in disk.rglob("*.json") if not one.name.endswith(".time.json")]
        (disk / "filler").unlink()
        batch.do("disk")
        assert len(batch.results("disk")) == 2
    finally:
        subprocess.run(["umount", disk], check=False)


def prepared_bones_are_kept(folder):
    """--cache: the same bytes with and without, from a read-only cache and a damaged one; a changed scan is another entry."""
    cache, scan = folder / "cache", folder / "block.seg.nrrd"
    subprocess.run([BURR, "--quiet", "phantom", "block", "--voxel-mm", "0.5", "--out", scan], check=True, stdout=subprocess.DEVNULL)
    batch = Batch(BURR, folder, HEAD + "id,command,case,volume,bone,motion,burr-mm,seconds\n" + "other,surgeon,tooth,,3,,,1\n" +
                  f"scan,mill,,{scan},,slot,4,1\n")
    batch.do("without")
    said = batch.do("dry", "0/1", "--dry-run", "--cache", cache)
    assert re.search(r"^bone 3, case tooth, command surgeon: \d+ MB$", said, re.M) and "the largest needs" in said, said
    entries = sorted(cache.iterdir())
    assert len(entries) == 2 and all(one.suffix == ".prepared" for one in entries), entries
    for step in ("kept", "sealed", "damaged"):
        before = {one: one.read_bytes() for one in cache.iterdir()}
        if step == "damaged":
            entries[0].write_bytes(before[entries[0]][:-100])
        if step == "sealed":
            with read_only(cache):
                batch.do(step, "0/1", "--cache", cache)
        else:
            batch.do(step, "0/1", "--cache", cache)
        assert batch.results(step) == batch.results("without"), step
        assert before == {one: one.read_bytes() for one in cache.iterdir()}, f"{step}: the cache is another one"
    empty = folder / "empty"  # that cannot be filled: each row makes its own bone
    empty.mkdir()
    with read_only(empty):
        batch.do("unkept", "0/1", "--cache", empty)
    assert batch.results("unkept") == batch.results("without") and not list(empty.iterdir())
    text = scan.read_bytes()
    scan.write_bytes(text.replace(b"0.5", b"0.6"))
    batch.do("changed", "0/1", "--cache", cache)
    assert len(list(cache.iterdir())) == 3 and batch.results("changed") != batch.results("without")


@contextlib.contextmanager
def read_only(place):
    """Root may write whatever the permissions: it gets a folder that is mounted to be read alone."""
    mounted = os.geteuid() == 0 and subprocess.run(["mount", "--bind", "-o", "ro", place, place], capture_output=True).returncode == 0
    place.chmod(0o555) if not mounted else None
    try:
        if mounted or os.geteuid() != 0:
            assert not os.access(place, os.W_OK), "the folder can be written"
        else:
            print("  nothing can be mounted here: a folder to be read alone was not tried")
        yield
    finally:
        subprocess.run(["umount", place], check=True) if mounted else place.chmod(0o755)


def engines(folder):
    """The example files, as docs/use/clusters.md has them; a score of what was recorded."""
    batch = Batch(BURR, folder, SURGEON + "".join(f"s{n},surgeon,tooth,{n},1\n" for n in range(6)))
    env = dict(os.environ) | {"BURR": str(BURR)}
    subprocess.run([ROOT / "samples/clusters/loop.sh", batch.manifest, folder / "loop", "2"], env=env, check=True, stdout=subprocess.DEVNULL)
    table = batch.merge("loop")
    if shutil.which("parallel"):
        subprocess.run([ROOT / "samples/clusters/parallel.sh", batch.manifest, folder / "parallel", "3"], env=env, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        assert batch.merge("parallel") == table
        assert len((folder / "parallel" / "joblog").read_text().splitlines()) == 4
    else:
        assert os.environ.get("BURR_REQUIRE_TOOLS") != "1", "parallel is missing"
        print("  GNU parallel is missing (section [tools] of scripts/packages.txt): not tried")
    batch.do("recorded", "0/1", "--record")
    assert batch.results("recorded") == batch.results("loop"), "recording changes a result"
    recordings = sorted((folder / "recorded" / "recordings").rglob("*.mcap"))
    assert len(recordings) == 6
    scores = Batch(BURR, folder, HEAD + "id,command,recording\n" + "".join(f"{one.stem},score,{one}\n" for one in recordings[:2]))
    scores.do("scores")
    one = json.loads(next(iter(scores.results("scores").values())))["result"]
    assert one["items"] and one["rubric_changed"] is False, one


def the_page_as_printed(folder):
    """The lines of docs/use/clusters.md, with 3 sessions of a second in place of 300 of a minute; Slurm has a test of its own."""
    blocks = re.findall(r"^```\n(.*?)^```", (ROOT / "docs/use/clusters.md").read_text(), re.S | re.M)
    text = "".join(block for block in blocks if "burr" in block).replace("seq 1000 1299", "seq 1000 1002").replace("$n,60;", "$n,1;")
    lines = [line for line in text.splitlines() if not line.startswith("sbatch") and (shutil.which("parallel") or "parallel.sh" not in line)]
    assert text.count("burr batch") >= 4 and "seq 1000 1002" in text and "$n,1;" in text, text
    (folder / "samples").symlink_to(ROOT / "samples")
    (folder / "burr").write_text(f'#!/bin/sh\nexec {BURR} --quiet "$@"\n')
    (folder / "burr").chmod(0o755)
    done = subprocess.run(["bash", "-e", "-c", "\n".join(lines)], cwd=folder, capture_output=True, text=True,
                          env=dict(os.environ) | {"PATH": f"{folder}:{os.environ['PATH']}"})
    assert done.returncode == 0, done.stdout + done.stderr
    for name in ("run1.csv", "scores1.csv"):
        assert len((folder / name).read_text().splitlines()) == 4, name


def main():
    tests = [refuses_what_is_no_manifest, equal_whatever_the_shards, equal_after_kills, equal_after_many_kills_in_many_shards, ten_thousand_rows, clock_jumps,
             stopped_says_so, finishes_the_row, merge_refuses, prepared_bones_are_kept, full_disk_and_missing_files, engines, the_page_as_printed]
    for test in tests:
        if sys.argv[2:] and test.__name__ not in sys.argv[2:]:
            continue
        began = time.monotonic()
        with tempfile.TemporaryDirectory(prefix="burr_batch_") as folder:
            test(pathlib.Path(folder))
        print(f"{test.__name__}: {time.monotonic() - began:.1f} s", flush=True)


if __name__ == "__main__":
    main()
