#!/usr/bin/env python3
"""Makes a store of learners as a class of scripted surgeons leaves it: two months of practice, everybody at a pace of their own.

    scripts/class_of_surgeons.py --burr build/release/burr --store class.sqlite --learners 30 --sessions 12

Each learner begins near the level `careless` or `average` and comes nearer to `expert` from attempt to attempt, as
1 - exp(-n / tau); tau, the start, and how often somebody practises are drawn from the seed. The first sessions are in the
mode `learn` (guided), as a course has it. Each session is a real one: recorded, scored by its rubric, entered. To look at
`burr serve` and to try `burr study`; it says nothing about people. The recordings are deleted unless --keep is given. A
session that is in the store is not repeated, so a broken-off run goes on where it was.
"""
import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import time

# docs/understand/surgeon.md: expert, average, careless
NUMBERS = {"perception_mm": (0.25, 0.45, 1.5), "tremor_mm": (0.05, 0.12, 0.25), "drift_mm": (0.1, 0.25, 0.5),
           "force_noise": (0.15, 0.3, 0.5), "restraint": (0.35, 0.7, 1), "stop_s": (0.1, 0.2, 0.45), "stroke_mm": (7, 5, 3),
           "view": (0.95, 0.8, 0.5), "unfinished": (0.03, 0.1, 0.25)}
BIRDS = "heron lark wren robin finch crane plover dunlin siskin linnet martin swift kestrel osprey avocet".split()


def run(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr.strip() or done.stdout.strip()}")
    return done.stdout


def between(numbers, skill):  # 0: careless, 0.5: average, 1: expert
    expert, average, careless = numbers
    return careless + (average - careless) * 2 * skill if skill < 0.5 else average + (expert - average) * (2 * skill - 1)


def learners_of(args):
    chance = random.Random(args.seed)
    for n in range(args.learners):
        start, tau = chance.uniform(0.05, 0.5), chance.uniform(2, 8)
        count = max(1, round(args.sessions * chance.choice([1, 1, 1, 1, 0.75, 0.5, 0.25])))
        days = sorted(chance.uniform(0, args.days) for _ in range(count))
        yield {"id": f"{BIRDS[n % len(BIRDS)]}-{1000 + n}", "level": f"PGY{1 + n % 5}", "start": start, "tau": tau, "days": days,
               "guided": chance.choice([2, 2, 3, 1]), "seed": 20000 + 1000 * n}


def practise(args, learner):
    there = json.loads(run([args.burr, "learner", "list", "--store", args.store, learner["id"], "--json"])
                       .splitlines()[-1])
    done = len(there.get("sessions", []))
    began = time.time() - 86400 * args.days
    for n, day in enumerate(learner["days"], 1):
        if n <= done:
            continue
        skill = learner["start"] + (1 - learner["start"]) * (1 - math.exp(-(n - 1) / learner["tau"]))
        recording = args.folder / f"{learner['id']}-{n:02}.mcap"
        vices = [x for name, numbers in NUMBERS.items() for x in ("--vice", f"{name}={between(numbers, skill):.4g}")]
        run([args.burr, "surgeon", args.case, "--level", "expert", "--seed", str(learner["seed"] + n), *vices, "--learner",
             learner["id"], "--attempt", str(n), "--mode", "learn" if n <= learner["guided"] else "practise", "--record", recording,
             "--force"])
        at = began + 86400 * day
        os.utime(recording, (at, at))
        run([args.burr, "learner", "enter", "--store", args.store, learner["id"], recording])
        if not args.keep:
            recording.unlink()
    return learner["id"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--burr", required=True)
    parser.add_argument("--store", required=True)
    parser.add_argument("--case", default="tooth")
    parser.add_argument("--learners", type=int, default=30)
    parser.add_argument("--sessions", type=int, default=12, help="of a diligent learner")
    parser.add_argument("--days", type=float, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("."), help="for the recordings")
    parser.add_argument("--keep", action="store_true", help="keep the recordings")
    args = parser.parse_args()
    args.burr = str(pathlib.Path(args.burr).resolve())
    args.folder.mkdir(parents=True, exist_ok=True)
    learners = list(learners_of(args))
    there = json.loads(run([args.burr, "learner", "list", "--store", args.store, "--json"]).splitlines()[-1])
    known = {one["id"] for one in there["learners"]}
    for learner in learners:
        if learner["id"] not in known:
            run([args.burr, "learner", "add", "--store", args.store, "--id", learner["id"], "--level", learner["level"]])
    half = len(learners) // 2
    for title, group in (("spring", learners[:half]), ("autumn", learners[half:])):
        if group:
            run([args.burr, "learner", "cohort", "add", "--store", args.store, title, *[one["id"] for one in group]])
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for n, name in enumerate(pool.map(lambda one: practise(args, one), learners), 1):
            print(f"{n} of {len(learners)}: {name}", flush=True)


if __name__ == "__main__":
    main()
