#!/usr/bin/env python3
"""The same surgeons in 1, 7 and 40 shards, on three engines, killed at random and resumed: is the merged table the same to the byte?

    scripts/batch_bytes.py --burr build/release/burr [--rows 300] [--seconds 5] [--kills 5] [--folder DIR]
    scripts/batch_bytes.py --burr build/release/burr --observers --rows 10000 --kills 50
    scripts/batch_bytes.py --burr build/release/burr --stops 40

Prints a table for bench/results/batch.md. The first run is a plain loop over one shard, and nobody kills it. In each other run, at
random moments, a random one of its `burr batch` is killed (SIGKILL or SIGTERM); when the engine has ended, the same command goes on
until nothing is left. With --observers the rows are simulated observers of some hundredths of a second, in 1 and 64 shards. Slurm needs root, munge, slurmctld and slurmd; without them a plain loop does its part.
With --stops, sends SIGTERM at random moments to sessions on the temporal bone, and prints how long they took to end.
"""
import argparse
import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
TABLE = ("| shards | engine | kills | commands | wall [s] | processor [s] | most memory [MB] | results | CSV | SQLite |\n"
         "|---|---|---|---|---|---|---|---|---|---|")
sys.path.insert(0, str(ROOT / "tests/batch"))
from batch_tools import HEAD, Batch, done_rows  # noqa: E402
from slurm import Slurm, missing  # noqa: E402


def batches_of(out):
    """The processes that write to this folder, but for their children."""
    found = []
    for place in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (place / "cmdline").read_bytes().split(b"\0")
            parent = int((place / "stat").read_text().rsplit(")", 1)[1].split()[1])
        except (OSError, IndexError, ValueError):
            continue
        if b"batch" in words and os.fsencode(out) in words and b"--shard" in words:
            found.append((int(place.name), parent))
    ids = {one for one, _ in found}
    return [one for one, parent in found if parent not in ids]


def kill_some(batch, out, rows, kills, chance, stopped, met):
    """One kill whenever so many rows are done as were drawn."""
    for share in sorted(chance.uniform(0.02, 0.95) for _ in range(kills)):
        while not stopped.is_set():
            running = batches_of(batch.folder / out) if done_rows(batch, out) >= share * rows else []
            if running:
                number = chance.choice((signal.SIGKILL, signal.SIGTERM))
                try:
                    os.kill(chance.choice(running), number)
                    met.append(signal.Signals(number).name[3:])
                except ProcessLookupError:
                    continue
                break
            stopped.wait(0.1)


def by_script(name):
    def engine(batch, out, shards):
        return subprocess.run([ROOT / f"samples/clusters/{name}.sh", batch.manifest, batch.folder / out, str(shards)],
                              env=dict(os.environ) | {"BURR": batch.burr}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0
    return engine


def by_slurm(slurm):
    def engine(batch, out, shards):
        slurm.run("sbatch", f"--array=0-{shards - 1}", f"--output={batch.folder}/slurm-%a.log", ROOT / "samples/clusters/slurm.sh", batch.manifest,
                  batch.folder / out, shards)
        while slurm.run("squeue", "-h"):
            time.sleep(0.5)
        return True
    return engine


def sums(batch, out):
    cpu = sum(json.loads(file.read_text())["cpu_s"] for file in (batch.folder / out / "results").rglob("*.time.json"))
    peak = max(json.loads(file.read_text())["peak_mb"] for file in (batch.folder / out / "results").rglob("*.time.json"))
    return cpu, peak


def kills_in_words(met):
    if len(met) < 10:
        return ": " + ", ".join(met) if met else ""
    return f": {met.count('KILL')} KILL, {met.count('TERM')} TERM"


def one_run(batch, out, name, engine, shards, rows, kills, seed):
    met, stopped, turns = [], threading.Event(), 0
    killer = threading.Thread(target=kill_some, args=(batch, out, rows, kills, random.Random(seed), stopped, met))
    killer.start()
    began = time.monotonic()
    while done_rows(batch, out) < rows:
        engine(batch, out, shards)
        turns += 1
    wall = time.monotonic() - began
    stopped.set()
    killer.join()
    batch.merge(out)
    table, base = (hashlib.sha256((batch.folder / f"{out}.{end}").read_bytes()).hexdigest()[:16] for end in ("csv", "sqlite"))
    every = hashlib.sha256(b"".join(name.encode() + text for name, text in sorted(batch.results(out).items()))).hexdigest()[:16]
    cpu, peak = sums(batch, out)
    print(f"| {shards} | {name} | {len(met)}{kills_in_words(met)} | {turns} | {wall:.0f} | {cpu:.0f} | {peak:.0f} | `{every}` | `{table}` | "
          f"`{base}` |", flush=True)
    return every, table, base


def stops(burr, folder, count):
    """The seconds from SIGTERM to the end, and at which moment."""
    chance, took = random.Random(5), []
    for n in range(count):
        file = folder / "s.mcap"
        words = (["surgeon", "temporal-bone", "--seconds", "3000", "--record", file, "--force"],
                 ["surgeon", "temporal-bone", "--bone", "3", "--seconds", "3000"],
                 ["mill", "temporal-bone", "--motion", "pocket", "--seconds", "3000", "--record", file, "--force"])[n % 3]
        program = subprocess.Popen([str(word) for word in (burr, "--quiet", *words)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(chance.uniform(0.1, 12))
        began = time.monotonic()
        program.terminate()
        code = program.wait()
        took.append((time.monotonic() - began, words[0], code))
    took.sort()
    codes = {code for _, _, code in took}
    print(f"{count} times SIGTERM: median {took[count // 2][0]:.2f} s, longest {took[-1][0]:.2f} s ({took[-1][1]}), exit codes {codes}, load {os.getloadavg()[0]:.0f}")


def observers(burr, folder, args):
    batch = Batch(burr, folder, HEAD + "id,command,stimulus,seed,observer,trials\n" + "".join(
        f'p{n},psychophysics,stiffness,{n},"threshold=0.12,seed={n}",10\n' for n in range(args.rows)))
    print(f"seed of the kills: {args.seed}\n\n{TABLE}", flush=True)
    found = [one_run(batch, "loop", "plain loop", by_script("loop"), 1, args.rows, 0, 1)]
    name = "parallel" if shutil.which("parallel") else "loop"
    found.append(one_run(batch, "parallel", "GNU parallel" if name == "parallel" else "plain loop", by_script(name), 64, args.rows, args.kills, args.seed))
    left = batch.remains("parallel")
    equal = len(set(found)) == 1
    print(f"\n{'all equal' if equal else 'NOT EQUAL'}, {len(left)} half files left after the merge")
    return 0 if equal and not left else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--burr", required=True)
    parser.add_argument("--rows", type=int, default=300)
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--kills", type=int, default=5)
    parser.add_argument("--stops", type=int, default=0)
    parser.add_argument("--observers", action="store_true")
    parser.add_argument("--seed", type=int, default=2, help="of the kills")
    parser.add_argument("--folder", type=pathlib.Path, help="that is kept; default: a temporary one")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="burr_bytes_") as place:
        folder = args.folder or pathlib.Path(place)
        folder.mkdir(parents=True, exist_ok=True)
        if args.stops:
            stops(pathlib.Path(args.burr).resolve(), folder, args.stops)
            return 0
        if args.observers:
            return observers(pathlib.Path(args.burr).resolve(), folder, args)
        levels = ("expert", "average", "careless")
        batch = Batch(pathlib.Path(args.burr).resolve(), folder, HEAD + "id,command,case,level,seed,seconds\n" + "".join(
            f"s{n},surgeon,tooth,{levels[n % 3]},{1000 + n},{args.seconds:g}\n" for n in range(args.rows)))
        print(TABLE)
        found = [one_run(batch, "loop", "plain loop", by_script("loop"), 1, args.rows, 0, 1)]
        second = "GNU parallel" if shutil.which("parallel") else "plain loop"
        found.append(one_run(batch, "parallel", second, by_script("parallel" if shutil.which("parallel") else "loop"), 7, args.rows, args.kills, 2))
        if missing():
            found.append(one_run(batch, "slurm", "plain loop", by_script("loop"), 40, args.rows, args.kills, 3))
        else:
            with Slurm(folder / "cluster") as slurm:
                slurm.env["BURR"] = batch.burr
                found.append(one_run(batch, "slurm", "Slurm", by_slurm(slurm), 40, args.rows, args.kills, 3))
        equal = len(set(found)) == 1
        print(f"\n{'all equal' if equal else 'NOT EQUAL'}")
        return 0 if equal else 1


if __name__ == "__main__":
    sys.exit(main())
