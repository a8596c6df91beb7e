#!/usr/bin/env python3
"""Checks the output of the commands that measure the machine: burr check, burr bench endure, burr mill --rate. Fields and
sums, never times.

    scripts/checks/measures.py BUILD
"""
import json
import pathlib
import subprocess
import sys
import tempfile

burr = str(pathlib.Path(sys.argv[1]).resolve() / "burr")
bad = []


def run(*words, code=0):
    done = subprocess.run([burr, "--quiet", *words], text=True, capture_output=True, timeout=300)
    if done.returncode != code:
        bad.append(f"{' '.join(words)}: exit code {done.returncode} instead of {code}: {done.stderr.strip()}")
    return done


def of_json(*words):
    lines = run(*words, "--json").stdout.splitlines()
    try:
        return json.loads(lines[-1])
    except (IndexError, ValueError):
        bad.append(f"{' '.join(words)}: the last line is no JSON object")
        return None


def holds(what, true):
    if not true:
        bad.append(f"does not hold: {what}")


def rises(row):
    return row["p50"] <= row["p99"] <= row["p999"] <= row["max"] * 1.01 + 1


# ---- burr check
seen = of_json("check", "--seconds", "4", "--voxel-mm", "0.5")
if seen:
    holds("check: a verdict", seen["verdict"] in ("good", "usable", "not good enough"))
    holds("check: the sentence begins with the verdict", seen["sentence"].startswith(seen["verdict"]))
    holds("check: good if and only if there is no reason against it", (seen["verdict"] == "good") == (seen["reasons"] == []))
    for phase in ("waiting", "milling", "waiting_loaded", "milling_loaded"):
        part = seen[phase]
        # four thirds of a second each; ticks that were not made were counted as missed
        holds(f"check: {phase} counts its ticks ({part['ticks']} and {part['missed']})", 700 <= part["ticks"] + part["missed"] <= 4000)
        holds(f"check: {phase} has rising tails", rises(part["late_us"]) and rises(part["work_us"]))
    holds("check: milling is work", seen["milling"]["work_us"]["p50"] > seen["waiting"]["work_us"]["p50"])
    named = [line["what"] for line in seen["lines"]]
    holds(f"check: one line for each fact ({named})", named == ["processor", "instructions", "priority", "memory", "kernel", "frequency", "clock", "virtual machine"])
    holds("check: without SCHED_FIFO the cure is named", seen["fifo"] or "rtprio" in seen["lines"][2]["change"] or "SCHED_FIFO" in seen["lines"][2]["change"])
    holds("check: cores", seen["machine"]["cores"] >= 1)
words = run("check", "--seconds", "1.5", "--voxel-mm", "0.5", "--no-picture").stdout
for word in ("p99.9", "a loop that only waits", "milling, all else at work", "priority", "kernel", "virtual machine"):
    holds(f"check: says '{word}'", word in words)
run("check", "--seconds", "0", code=2)
run("check", "--voxel-mm", "7", code=2)

# ---- burr bench endure
with tempfile.TemporaryDirectory() as folder:
    kept = pathlib.Path(folder) / "endured.mcap"
    seen = of_json("bench", "endure", "phantom:block", "--voxel-mm", "0.5", "--seconds", "7", "--waiting-seconds", "0.5", "--memory-every", "0.5",
                   "--record", str(kept), "--picture-size", "320,200")
    if seen:
        ticks, missed = seen["ticks"], seen["late_us"]["tick"]["missed"]
        holds(f"endure: all ticks of seven seconds are accounted for ({ticks} and {missed})", 5000 <= ticks + missed <= 12_000)
        holds("endure: every tick is recorded or counted as dropped", seen["recorded"]["ticks"] + seen["recorded"]["dropped_ticks"] == ticks)
        holds("endure: the steps of load sum up to the ticks", sum(seen["load_ticks"]) == ticks)
        holds("endure: memory, rows and growth", 4 <= len(seen["memory_MB"]) <= 16 and all(mb > 1 for _, mb in seen["memory_MB"]) and isinstance(seen["memory_grew_MB"], float))
        for loop in ("tick", "waiting_beside", "waiting_before", "waiting_after"):
            holds(f"endure: lateness of {loop}", seen["late_us"][loop]["ticks"] > 100 and rises(seen["late_us"][loop]))
        holds("endure: something was drawn, or it says why not", (seen["frames"] > 0 and seen["patches"] > 0) or seen["left_out"])
        owed = seen["asked_mm3"] - seen["removed_mm3"] - seen["not_cut_mm3"] - seen["owed_mm3"]
        holds(f"endure: the account balances ({owed})", abs(owed) <= 1e-6 * seen["asked_mm3"])
        # after lost ticks the force is released and comes back slowly: a machine that stalls mills little, and says so
        released = any("the force was released" in line for line in seen["noted"])
        holds(f"endure: it mills ({seen['removed_mm3']} mm3, noted: {seen['noted']})", seen["removed_mm3"] > (0 if released else 1))
        holds(f"endure: the force is released for lost ticks only ({missed} missed)", missed > 0 or not released)
        run("replay", str(kept), "--check")

# ---- other rates
for rate, motion in (("10000", "touch"), ("4000", "pocket")):
    seen = of_json("mill", "phantom:block", "--voxel-mm", "0.5", "--motion", motion, "--burr-mm", "5", "--rate", rate, "--seconds", "1.5", "--realtime")
    if seen:
        holds(f"{rate} Hz: ticks ({seen['ticks']})", seen["ticks"] >= 1.4 * float(rate) and seen["rate_hz"] == float(rate))
        holds(f"{rate} Hz: tails", rises(seen["tick_us"]) and rises(seen["late_us"]))
        holds(f"{rate} Hz: {motion} removes {seen['removed_mm3']} mm3", (seen["removed_mm3"] > 0) == (motion == "pocket"))

print("\n".join(bad) if bad else "what measures says what it should")
sys.exit(1 if bad else 0)
