#!/usr/bin/env python3
"""Scripted surgeons on the plain jaw: the careless one does worse than the expert, a recording replays to the bit, and the same seed
gives the same score to the byte, on every instruction set and with one thread. A case on another bone is recorded, replayed and scored on
that bone, and a rubric that is another one now is named.

    scripts/checks/surgeons.py BURR FOLDER      FOLDER: for the recordings; made if it is not there
"""
import json
import os
import pathlib
import subprocess
import sys

SEEDS = (1, 2)
CASE = pathlib.Path(__file__).resolve().parents[2] / "tests" / "surgeon" / "implant_bed.toml"
RUBRIC = pathlib.Path(__file__).resolve().parents[2] / "tests" / "surgeon" / "jaw_rubric.toml"


def run(*command, simd=None):
    environment = dict(os.environ) | ({"BURR_SIMD": simd} if simd else {})
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, env=environment)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def session(burr, folder, level, seed, name=""):
    """The surgeon's account, its score as text, and the recording."""
    file = folder / f"{level}-{seed}{name}.mcap"
    account = json.loads(run(burr, "surgeon", CASE, "--level", level, "--seed", seed, "--seconds", 600, "--record", file, "--force", "--json")
                         .splitlines()[-1])
    return account, run(burr, "score", file, "--rubric", RUBRIC, "--json").splitlines()[-1], file


def cleared(score):
    """Share of the bed that is gone; what must stay whole must be whole."""
    items = {item["id"]: item for item in json.loads(score)["items"]}
    hurt = [name for name, item in items.items() if item["gate"] and item["verdict"] != "met"]
    return items["bed.cleared"]["value"], hurt


def other_bone(burr, folder):
    """What is not as it must be of a session on another bone of the tooth."""
    wrong, file = [], folder / "other-bone.mcap"
    run(burr, "surgeon", "tooth", "--bone", 2, "--seed", 1, "--seconds", 20, "--record", file, "--force")
    run(burr, "replay", file, "--check")
    if "tooth?graded,bone=2" not in run(burr, "info", file):
        wrong.append("a session on another bone does not say on which")
    usual = folder / "usual-bone.mcap"
    run(burr, "surgeon", "tooth", "--seed", 1, "--seconds", 20, "--record", usual, "--force")
    hashes = [json.loads(run(burr, "info", one, "--json").splitlines()[-1])["identity"] for one in (file, usual)]
    if hashes[0]["labels_hash"] == hashes[1]["labels_hash"]:
        wrong.append("bone 2 has the labels of the usual bone")
    score = json.loads(run(burr, "score", file, "--json").splitlines()[-1])
    if score["rubric_changed"] is not False or score["rubric_hash"] != hashes[0]["rubric_hash"]:
        wrong.append("the rubric of the recording is not that of the score")
    rubric = folder / "tooth.toml"
    text = (pathlib.Path(__file__).resolve().parents[2] / "rubrics" / "tooth.toml").read_text()
    rubric.write_text(text + "\n# another text\n")
    said = run(burr, "score", file, "--rubric", rubric, "--json")
    if json.loads(said.splitlines()[-1])["rubric_changed"] is not True or "was another one" not in said:
        wrong.append("a rubric that was changed after the recording is not named")
    return wrong


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    burr, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    wrong, marks, first = [], {}, None
    for level in ("expert", "careless"):
        for seed in SEEDS:
            account, score, file = session(burr, folder, level, seed)
            share, hurt = cleared(score)
            marks.setdefault(level, []).append(share)
            print(f"{level}, seed {seed}: {100 * share:.1f} % of the bed cleared, {account['seconds']:.0f} s, {account['removed_mm3']:.0f} mm3, "
                  f"{account['ending']}")
            if level == "expert" and hurt:
                wrong.append(f"expert, seed {seed}: not whole: {', '.join(hurt)}")
            if account["ending"] != "declared done":
                wrong.append(f"{level}, seed {seed}: the work was not finished in 600 s")
            first = first or (account, score, file)
    if min(marks["expert"]) <= max(marks["careless"]):
        wrong.append(f"share cleared by the expert {marks['expert']}, by the careless one {marks['careless']}")
    run(burr, "replay", first[2], "--check")
    account, score, _ = session(burr, folder, "expert", SEEDS[0], "-again")
    if score != first[1] or account["bone_hash"] != first[0]["bone_hash"]:
        wrong.append("the same seed gave another bone or another score")
    with open("/proc/cpuinfo") as cpu:
        known = set(next((line for line in cpu if line.startswith("flags")), "").split())
    for simd, one_thread in (("scalar", False), ("avx2", True), ("avx512", False)):
        if simd != "scalar" and not known & {simd, simd + "f"}:
            print(f"this processor has no {simd}: not compared")
            continue
        alone = ["taskset", "-c", min(os.sched_getaffinity(0))] if one_thread else []
        if run(*alone, burr, "score", first[2], "--rubric", RUBRIC, "--json", simd=simd).splitlines()[-1] != first[1]:
            wrong.append(f"{simd}{', one thread' if one_thread else ''}: another score")
    wrong += other_bone(burr, folder)
    for sentence in wrong:
        print("not as it must be: " + sentence)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
