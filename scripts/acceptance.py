#!/usr/bin/env python3
"""Do the marks of a case tell scripted surgeons apart? Runs `burr surgeon` and `burr score`, many times.

    scripts/acceptance.py temporal-bone --seeds 20 --jobs 2 --out out/acceptance
    scripts/acceptance.py temporal-bone --vices --seeds 10 --out out/vices

For each level and each seed (from 1000 on; tune with seeds 1 to 99 only) a surgeon does the case, and the recording is
scored. What it prints, and writes to OUT/CASE.json and OUT/CASE.md:

    AUC of the product's points between neighbouring levels, with a bootstrap interval: to be >= 0.9, lower end >= 0.8
    AUC by time alone: to be within 0.3 .. 0.7; by volume alone: at least 0.1 below that of the points, and the mean
    volumes of the three levels in no order; beside them, told only, the AUC by the time at which the surgeon was ready
    how often a gate breaks: careless >= 80 %, expert <= 5 %; a rubric without gates has no such bar
    with --blind: an expert who errs by 4 mm about where things are loses against the expert (AUC >= 0.9)

Time: nobody leaves the table early, and nobody stays longer (slot_s() below). So time alone tells nothing, by the make
of the sessions, not by the surgeons; who is ready looks on.

With --vices all numbers are the expert's but one, in five steps; the items named beforehand for that vice (VICES below)
must fall in what they earn (Jonckheere-Terpstra, one-sided, p < 0.01) and all others stay within 0.1. Exit code 1 if
something misses its bar, 2 if a run fails. Needs only Python. A run that is already in OUT is not repeated, so a broken-off
night goes on where it was. --keep leaves the recordings there, --rescore scores them again, and --only-existing makes the table
of the seeds that are there.
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import random
import subprocess
import sys
import time

LEVELS = ["expert", "average", "careless"]
FIRST_SEED = 1000
# vice: its values in five steps
STEPS = {
    "perception_mm": [0.25, 0.5, 1.0, 2.0, 4.0],
    "unfinished": [0.03, 0.1, 0.25, 0.4, 0.6],
    "stop_s": [0.1, 0.2, 0.4, 0.7, 1.0],
    "drift_mm": [0.1, 0.25, 0.5, 1.0, 1.5],
    "restraint": [0.35, 0.5, 0.7, 0.85, 1.0],
    "burr_near": [0.6, 0.8, 1.0, 1.2, 1.4],
    "saucer": [1, 0.5, 0, -0.5, -1],
    "stroke_mm": [7, 5, 3.5, 2, 1],
    "tremor_mm": [0.05, 0.1, 0.2, 0.4, 0.8],
}


def both(*names):
    """These items of the left and of the right pedicle."""
    return [f"{side}.{name}" for side in ("left", "right") for name in names]


def two(*names):
    """These items of both grooves."""
    return [f"{groove}.{name}" for groove in ("groove", "second-groove") for name in names]


# case: vice: the items that must fall, named before the first run; a name that ends in "*" stands for all with that beginning.
# Tremor alone has none anywhere: marks that fall with it would measure the device.
VICES = {
    "temporal-bone": {
        "perception_mm": ["labyrinth.intact", "sinus.intact", "dura.intact", "facial.intact", "tegmen.no-holes", "facial.not-bare",
                          "chorda.intact"],
        "unfinished": ["sinus.no-cells", "tegmen.no-cells", "sinus.identified", "facial.mastoid-identified", "recess.complete",
                       "canal-wall.no-cells", "tip.no-cells"],
        "stop_s": ["sinus.skeletonised", "tegmen.no-holes"],
        "drift_mm": ["sinus.skeletonised", "tegmen.no-holes"],
        "restraint": ["force.restraint"],
        "burr_near": ["burr.choice", "sinus.skeletonised", "facial.not-bare"],
        "saucer": ["cavity.no-overhang", "sinus.no-overhang"],
        "tremor_mm": [],
    },
    # defect.level: who errs about the gap fills beside it, who lifts late fills over its border, and so does a hand that drifts
    "jaw": {
        "perception_mm": ["cut.place", "bed.entry", "bed.end", "bed.angle", "bed.cleared", "bed.one-way", "defect.filled", "defect.level"],
        "unfinished": ["cut.cleared", "bed.depth", "bed.cleared", "defect.filled"],
        "stop_s": ["mouth.intact", "defect.level"],
        "drift_mm": ["cut.even-behind", "cut.even-front", "bed.width", "bed.one-way", "defect.level"],
        "tremor_mm": [],
    },
    "spine": {
        "perception_mm": both("entry", "end", "angle-axial", "angle-sagittal", "in-bone", "cleared", "one-way"),
        "unfinished": both("depth", "cleared"),
        "drift_mm": both("width", "one-way"),
        "tremor_mm": [],
    },
    "tooth": {
        "perception_mm": ["caries.soft", "caries.firm", "dentine.spared", "pulp.intact", "pulp.covered", "outline.kept", "pit.cleared",
                          "pit.outline", "pit.depth"],
        "unfinished": ["caries.firm", "pit.cleared"],
        "drift_mm": ["outline.kept", "pit.outline", "pit.floor", "dentine.spared"],
        "tremor_mm": [],
    },
    "block": {
        "perception_mm": two("cleared", "kept-narrow", "depth", "outline"),
        "unfinished": two("cleared"),
        "drift_mm": two("kept-narrow", "outline", "floor"),
        "stroke_mm": ["strokes.long"],
        "tremor_mm": [],
    },
}
BLIND = ("perception_mm", 4.0)  # all else as the expert


def auc(high, low):
    """Probability that one of `high` is above one of `low`; ties count half."""
    if not high or not low:
        return math.nan
    return sum((a > b) + 0.5 * (a == b) for a in high for b in low) / (len(high) * len(low))


def bootstrap(high, low, times=2000, seed=1):
    """95 % interval of the AUC."""
    if not high or not low:
        return math.nan, math.nan
    dice = random.Random(seed)
    found = sorted(auc(dice.choices(high, k=len(high)), dice.choices(low, k=len(low))) for _ in range(times))
    return found[int(0.025 * times)], found[int(0.975 * times) - 1]


def jonckheere(groups):
    """(share of ordered pairs that fall, one-sided p for falling values) of groups in the order of the vice.

    Normal approximation with the correction for ties (Hollander, Wolfe & Chicken 2014, section 6.2).
    """
    falls = sum((a > b) + 0.5 * (a == b) for i, g in enumerate(groups) for h in groups[i + 1:] for a in g for b in h)
    pairs = sum(len(g) * len(h) for i, g in enumerate(groups) for h in groups[i + 1:])
    sizes = [len(g) for g in groups]
    n = sum(sizes)
    counts = {}
    for group in groups:
        for value in group:
            counts[value] = counts.get(value, 0) + 1
    ties = list(counts.values())

    def one(m):
        return m * (m - 1) * (2 * m + 5)

    def two(m):
        return m * (m - 1) * (m - 2)

    def three(m):
        return m * (m - 1)

    spread = (one(n) - sum(map(one, sizes)) - sum(map(one, ties))) / 72
    if n > 2:
        spread += sum(map(two, sizes)) * sum(map(two, ties)) / (36 * n * (n - 1) * (n - 2))
    spread += sum(map(three, sizes)) * sum(map(three, ties)) / (8 * n * (n - 1))
    if spread <= 0:
        return falls / pairs, 1.0
    z = (falls - pairs / 2) / math.sqrt(spread)
    return falls / pairs, 0.5 * math.erfc(z / math.sqrt(2))


def last_json(text):
    return json.loads(text.strip().splitlines()[-1])


def slot_s(options, seed):
    """How long the table is booked for [s]: lognormal about --seconds by 20 %, by the seed and for every level alike.

    Nobody leaves before, and nobody stays longer.
    """
    return round(options.seconds * math.exp(0.2 * random.Random(f"slot {options.case} {seed}").gauss(0, 1)))


def worked_s(result):
    """When the surgeon was ready, whether or not the work was declared done then [s]."""
    steps = result["surgeon"]["steps"]
    return max((step.get("to_s", result["surgeon"]["seconds"]) for step in steps), default=0.0)


def session(options, name, level, seed, vice):
    """One surgeon's session: OUT/runs/NAME.mcap, and what the surgeon said as NAME.surgeon.json. Made once."""
    recording, said = options.out / "runs" / f"{name}.mcap", options.out / "runs" / f"{name}.surgeon.json"
    if recording.exists() and said.exists():
        return json.loads(said.read_text())
    seconds = slot_s(options, seed)
    command = [options.burr, "surgeon", options.case, "--level", level, "--seed", str(seed), "--seconds", str(seconds),
               "--least-seconds", str(seconds - 1), "--record", str(recording), "--embed", "--force", "--json", *voxel(options)]
    if options.bones:
        command += ["--bone", str(seed)]
    if vice:
        command += ["--vice", f"{vice[0]}={vice[1]}"]
    begun = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}: {done.stderr.strip()}")
    out = last_json(done.stdout) | {"took_s": time.monotonic() - begun}
    said.write_text(json.dumps(out))
    return out


def voxel(options):
    return ["--voxel-mm", str(options.voxel_mm)] if options.voxel_mm else []


def run(options, name, level, seed, vice=None):
    """One surgeon, one score; kept as OUT/runs/NAME.json."""
    kept, recording = options.out / "runs" / f"{name}.json", options.out / "runs" / f"{name}.mcap"
    if kept.exists() and not (options.rescore and recording.exists()):
        return json.loads(kept.read_text())
    said = session(options, name, level, seed, vice)
    begun = time.monotonic()
    rubric = ["--rubric", options.rubric] if options.rubric else []
    scored = subprocess.run([options.burr, "score", str(recording), "--json", *rubric, *voxel(options)], capture_output=True, text=True,
                            check=False)
    if scored.returncode:
        raise RuntimeError(f"burr score {recording}: {scored.stderr.strip()}")
    out = {"name": name, "level": level, "seed": seed, "vice": vice, "surgeon": said, "score": last_json(scored.stdout),
           "took_s": said["took_s"], "scored_s": time.monotonic() - begun}
    kept.write_text(json.dumps(out))
    if not options.keep:
        recording.unlink()
        recording.with_suffix(".surgeon.json").unlink()
    return out


def is_there(options, name):
    return any((options.out / "runs" / f"{name}{end}").exists() for end in (".json", ".surgeon.json"))


def run_all(options, jobs):
    (options.out / "runs").mkdir(parents=True, exist_ok=True)
    if options.only_existing:
        jobs = [job for job in jobs if is_there(options, job[0])]
    results = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        waiting = [pool.submit(run, options, *job) for job in jobs]
        for n, one in enumerate(concurrent.futures.as_completed(waiting), 1):
            if one.exception():
                pool.shutdown(wait=False, cancel_futures=True)  # those that run are finished
            result = one.result()
            results.append(result)
            print(f"{n} of {len(waiting)}: {result['name']}, {points(result):.0f} points, {result['took_s']:.0f} + {result['scored_s']:.0f} s",
                  file=sys.stderr, flush=True)
    return sorted(results, key=lambda result: result["name"])


def points(result, part="product"):
    """Points of a part; a part without a total counts what is met of what can be assessed, and work without a mark nothing."""
    if result["score"].get("no_mark"):
        return 0.0
    total = result["score"][part]
    if total.get("points") is not None:
        return float(total["points"])
    return 100.0 * total["met"] / total["assessable"] if total.get("assessable") else math.nan


def credits(result):
    """{item: what it earned, 0 to 1}; what cannot be assessed is left out."""
    return {item["id"]: item["credit"] for item in result["score"]["items"] if "credit" in item}


def verdicts(result):
    """{item: 1 met, 0 unmet}; what cannot be assessed is left out."""
    return {item["id"]: int(item["verdict"] == "met") for item in result["score"]["items"] if item["verdict"] in ("met", "unmet")}


def has_gate(results):
    return any(item.get("gate") for result in results for item in result["score"]["items"])


def gate_broken(result):
    """Something that must not happen was done. A gate that is unmet because too little was done to earn or to measure it harmed nobody."""
    return any(item.get("gate") and item["verdict"] == "unmet" and item.get("earned", True) and item.get("value") is not None
               for item in result["score"]["items"])


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else math.nan


def levels(options):
    jobs = [(f"{options.case}-{level}-{seed}", level, seed) for seed in range(options.first, options.first + options.seeds) for level in LEVELS]
    if options.blind:
        jobs += [(f"{options.case}-blind-{seed}", "expert", seed, BLIND) for seed in range(options.first, options.first + options.seeds)]
    results = run_all(options, jobs)
    by_level = {level: [r for r in results if r["level"] == level and not r["vice"]] for level in LEVELS}
    blind = [r for r in results if r["vice"]]
    out = {"case": options.case, "seeds": options.seeds, "levels": {}, "pairs": {}, "items": {}, "missed": []}
    lines = [f"## {options.case}: {options.seeds} seeds from {options.first}, voxels of {options.voxel_mm or 'the case'}", "",
             "| level | points of the product | process | a gate broken | steps all done | ready after minutes | mm3 removed |", "|---|---|---|---|---|---|---|"]
    for level, runs in (by_level | ({"blind robot": blind} if blind else {})).items():
        row = {"points": mean(map(points, runs)), "process": mean(points(r, "process") for r in runs),
               "gates": mean(map(gate_broken, runs)), "done": mean(all("to_s" in step for step in r["surgeon"]["steps"]) for r in runs),
               "minutes": mean(worked_s(r) / 60 for r in runs), "removed_mm3": mean(r["surgeon"]["removed_mm3"] for r in runs)}
        out["levels"][level] = row
        process = "-" if math.isnan(row["process"]) else f"{row['process']:.1f}"
        lines.append(f"| {level} | {row['points']:.1f} | {process} | {100 * row['gates']:.0f} % | {100 * row['done']:.0f} % "
                     f"| {row['minutes']:.1f} | {row['removed_mm3']:.0f} |")
    lines += ["", "| pair | AUC by points (95 %) | by time alone | by volume alone | by the time when ready |", "|---|---|---|---|---|"]
    for high, low in zip(LEVELS, LEVELS[1:]):
        a, b = by_level[high], by_level[low]
        mark = auc(list(map(points, a)), list(map(points, b)))
        low_end, high_end = bootstrap(list(map(points, a)), list(map(points, b)))
        # that of the table: the recording of who declares it done is a second shorter than that of who is cut off
        by_time = auc(*([slot_s(options, r["seed"]) for r in runs] for runs in (a, b)))
        by_volume = auc([r["surgeon"]["removed_mm3"] for r in a], [r["surgeon"]["removed_mm3"] for r in b])
        out["pairs"][f"{high} : {low}"] = {"auc": mark, "low": low_end, "high": high_end, "time": by_time, "volume": by_volume}
        ready = auc(list(map(worked_s, a)), list(map(worked_s, b)))
        lines.append(f"| {high} : {low} | {mark:.2f} ({low_end:.2f} to {high_end:.2f}) | {by_time:.2f} | {by_volume:.2f} | {ready:.2f} |")
        check(out, mark >= 0.9 and low_end >= 0.8, f"{high} : {low}: AUC {mark:.3f}, lower end {low_end:.3f}, required 0.90 and 0.80")
        check(out, 0.3 <= by_time <= 0.7, f"{high} : {low}: AUC by time alone is {by_time:.2f}, required 0.30 to 0.70")
        check(out, by_volume <= mark - 0.1, f"{high} : {low}: AUC by volume alone is {by_volume:.2f}, required at most {mark - 0.1:.2f}")
    careless, expert = out["levels"]["careless"]["gates"], out["levels"]["expert"]["gates"]
    if blind:
        mark = auc(list(map(points, by_level["expert"])), list(map(points, blind)))
        lines.append(f"| expert : blind robot | {mark:.2f} | | | |")
        check(out, mark >= 0.9, f"expert : blind robot: AUC {mark:.2f}, required 0.90")
    volumes = [out["levels"][level]["removed_mm3"] for level in LEVELS]
    check(out, volumes not in (sorted(volumes), sorted(volumes, reverse=True)), "the mean volumes of the three levels are in order")
    gates = has_gate(results)
    check(out, not gates or careless >= 0.8, f"careless: a gate broken in {100 * careless:.0f} % of the runs, required at least 80 %")
    check(out, not gates or expert <= 0.05, f"expert: a gate broken in {100 * expert:.0f} % of the runs, required at most 5 %")
    if not gates:
        lines += ["", "The rubric has no gate, so there is no bar for gates."]
    lines += ["", "| item, share met | " + " | ".join(LEVELS) + " |", "|---|" + "---|" * len(LEVELS)]
    for item in [entry["id"] for entry in results[0]["score"]["items"]]:
        shares = [mean(v[item] for v in map(verdicts, by_level[level]) if item in v) for level in LEVELS]
        out["items"][item] = dict(zip(LEVELS, shares))
        lines.append(f"| {item} | " + " | ".join("-" if math.isnan(s) else f"{s:.2f}" for s in shares) + " |")
    return out, lines


def named(item, patterns):
    return any(item == p or (p.endswith("*") and item.startswith(p[:-1])) for p in patterns)


def vices(options):
    items_of = VICES[options.case]
    chosen = options.only or list(items_of)
    jobs = [(f"{options.case}-{vice}-{value}-{seed}", "expert", seed, (vice, value))
            for vice in chosen for value in STEPS[vice] for seed in range(options.first, options.first + options.seeds)]
    results = run_all(options, jobs)
    out = {"case": options.case, "seeds": options.seeds, "vices": {}, "missed": []}
    lines = [f"## {options.case}: one vice at a time, {options.seeds} seeds from {options.first}", "",
             "| vice | points at the five steps | items that must fall | earned, first and last step | p |", "|---|---|---|---|---|"]
    for vice in chosen:
        steps = [[r for r in results if list(r["vice"]) == [vice, value]] for value in STEPS[vice]]
        marks = [mean(map(points, step)) for step in steps]
        entry = {"values": STEPS[vice], "points": marks, "items": {}}
        out["vices"][vice] = entry
        known = sorted(set().union(*(credits(r) for step in steps for r in step)))
        for item in known:
            groups = [[v[item] for v in map(credits, step) if item in v] for step in steps]
            if not all(groups):
                continue
            _, p = jonckheere(groups)
            first, last = mean(groups[0]), mean(groups[-1])
            must = named(item, items_of.get(vice, []))
            entry["items"][item] = {"first": first, "last": last, "p": p, "must_fall": must}
            if must:
                lines.append(f"| {vice} | {', '.join(f'{m:.0f}' for m in marks)} | {item} | {first:.2f}, {last:.2f} | {p:.4f} |")
                check(out, p < 0.01, f"{vice}: {item} does not fall (p = {p:.3f})")
            else:
                check(out, abs(first - last) <= 0.1, f"{vice}: {item} moves from {first:.2f} to {last:.2f}, and was not named for this vice")
    return out, lines


def check(out, good, sentence):
    if not good:
        out["missed"].append(sentence)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    parser.add_argument("--burr", default="burr", help="the program")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first", type=int, default=FIRST_SEED, help="first seed; below 1000 only to tune")
    parser.add_argument("--seconds", type=float, default=600, help="how long the table is booked for, median; see slot_s()")
    parser.add_argument("--voxel-mm", type=float, default=0, help="default: that of the case")
    parser.add_argument("--bones", action="store_true", help="each seed on the bone of its number, in place of the bone of the case")
    parser.add_argument("--rubric", default="", help="default: that of the case")
    parser.add_argument("--jobs", type=int, default=1, help="sessions at the same time")
    parser.add_argument("--vices", action="store_true", help="one vice at a time instead of the levels")
    parser.add_argument("--blind", action="store_true", help="a blind robot beside the three levels")
    parser.add_argument("--only", nargs="*", help="with --vices: these")
    parser.add_argument("--keep", action="store_true", help="keep the recordings")
    parser.add_argument("--rescore", action="store_true", help="score again what was recorded and kept in OUT/runs")
    parser.add_argument("--only-existing", action="store_true", help="no new session: the table of those that are in OUT/runs")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("acceptance"))
    options = parser.parse_args()
    for vice in options.only or []:
        if vice not in STEPS:
            parser.error(f"--only {vice}: use one of {', '.join(STEPS)}")
    if options.vices and options.case not in VICES:
        parser.error(f"--vices: no items are named beforehand for {options.case}; there are some for {', '.join(VICES)}")
    try:
        out, lines = vices(options) if options.vices else levels(options)
    except RuntimeError as trouble:
        print(f"acceptance.py: {trouble}", file=sys.stderr)
        return 2
    lines += ["", "All bars are met." if not out["missed"] else "Missed:"] + [f"- {sentence}" for sentence in out["missed"]]
    name = options.case.replace("/", "_") + ("-vices" if options.vices else "")
    (options.out / f"{name}.json").write_text(json.dumps(out, indent=1))
    (options.out / f"{name}.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    return 1 if out["missed"] else 0


if __name__ == "__main__":
    sys.exit(main())
