#!/usr/bin/env python3
"""Measures every figure that burr must meet and prints a Markdown table: limit, measured, met.

    scripts/bench_performance.py --runs 2 --out bench/results/performance.md
    scripts/bench_performance.py --only tick        one group: tick mill direction volume rates endure surface
                                                    load memory growth
    scripts/bench_performance.py --seconds 60       a shorter endurance run than its ten minutes

Run it alone on a quiet machine; about 15 minutes a run, ten of them for endurance. No test depends on it.
"""
import argparse
import json
import os
import pathlib
import platform
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
GROUPS = ["tick", "mill", "direction", "volume", "rates", "endure", "surface", "load", "memory", "growth"]

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--burr", default=str(ROOT / "build/release/burr"), help="the program to measure")
parser.add_argument("--data", default=str(ROOT / "../shared/data"), help="where RT143_512 and the skull phantom lie")
parser.add_argument("--runs", type=int, default=1, help="how often everything is measured")
parser.add_argument("--only", choices=GROUPS, action="append", help="this group only; may be given several times")
parser.add_argument("--seconds", type=float, default=600, help="of the endurance run")
parser.add_argument("--machine", default="", help="a name for the heading, if the processor's is not enough")
parser.add_argument("--out", help="also write the table here")
options = parser.parse_args()

temporal_bone = pathlib.Path(options.data) / "temporal_bone/RT143_512.seg.nrrd"
phantom = pathlib.Path(options.data) / "skull_phantom/bone_1mm_jpegls"
cache = {}


class Missing(Exception):
    """Something that a row needs is missing; the text says what."""


def burr(command, simd=""):
    """The JSON of one run of the program; the same command twice in a run is measured once."""
    if (command, simd) in cache:
        return cache[command, simd]
    words = []
    for word in command.split():
        path = {"RT143_512": temporal_bone, "SKULL_PHANTOM": phantom}.get(word)
        if path is not None and not path.exists():
            raise Missing(f"{word} is not in {options.data}")
        words.append(str(path) if path is not None else word)
    print(f"  burr {command} {simd}", file=sys.stderr, flush=True)
    environment = {**os.environ, **({"BURR_SIMD": simd} if simd else {})}
    done = subprocess.run([options.burr, "--quiet", *words, "--json"], text=True, capture_output=True, env=environment)
    if done.returncode != 0:
        raise Missing((done.stderr.strip().splitlines() or ["no reason told"])[-1])
    cache[command, simd] = json.loads(done.stdout.splitlines()[-1])
    return cache[command, simd]


def tick(extra="", simd=""):
    return burr(f"bench tick --ticks 3000 {extra}".strip(), simd)


# ---- rows: (group, what, limit in words, function -> (text, met, or None without a limit))

ROWS = []


def row(group, what, bar):
    def keep(measure):
        ROWS.append((group, what, bar, measure))
        return measure
    return keep


def tick_row(what, extra, p50=None, p99=None):
    bar = " ".join(filter(None, [f"p50 <= {p50}" if p50 else "", f"p99 <= {p99} us" if p99 else ""]))

    @row("tick", what, bar)
    def _():
        r = tick(extra)
        return f"{r['p50_us']:.1f} / {r['p99_us']:.1f}", (not p50 or r["p50_us"] <= p50) and (not p99 or r["p99_us"] <= p99)


tick_row("tick, 512^3, 6 mm: p50 / p99", "--size 512", 10, 30)
tick_row("the same, caches evicted", "--size 512 --evict", None, 80)
tick_row("256^3", "--size 256", None, 20)
tick_row("2 mm burr", "--size 512 --burr-mm 2", None, 15)
tick_row("200 mm/s", "--size 512 --speed-mm-s 200", None, 60)
tick_row("box", "--size 512 --shape box", None, 40)
tick_row("1024^3", "--size 1024", None, 40)

for simd in ("scalar", "avx2", "avx512"):
    def _yardstick(simd=simd):
        r = tick("--size 512", simd)
        if r["simd"] != simd:
            raise Missing(f"this processor has no {simd}")
        return f"{r['reference_us']:.0f} us, {r['ratio']:.0f} times as long", None
    row("tick", f"the reference visit against p50, {simd}", "told")(_yardstick)

for name, bar in (("slide", 120), ("slot", 150), ("plunge", 200)):
    def _mill(name=name, bar=bar):
        r = tick(f"--size 512 --mill {name}")
        return f"{r['p99_us']:.0f}, {r['over_1ms']} over 1 ms", r["p99_us"] <= bar and r["over_1ms"] == 0
    row("mill", f"tick, milling, {name}: p99", f"<= {bar} us, none over 1 ms")(_mill)

    def _evicted(name=name):
        r = tick(f"--size 512 --mill {name} --evict")
        return f"{r['p99_us']:.0f}, {r['over_1ms']} over 1 ms", r["p99_us"] <= 300 and r["over_1ms"] == 0
    row("mill", f"the same, caches evicted, {name}", "<= 300 us, none over 1 ms")(_evicted)

# at about 1 N: a slot of 3 mm takes 2.9 N
for name, where, extra, bar in (("slide", "slide", "", True), ("slot", "slot, 1 mm", " --sink-mm 1", True), ("plunge", "plunge", "", True),
                                ("slot", "slot, 3 mm", "", False)):
    def _step(name=name, extra=extra, bar=bar):
        r = tick(f"--size 512 --mill {name}{extra}")
        return f"{r['force_step_N_max']:.4f} N at {r['mean_force_N']:.1f} N", r["force_step_N_max"] <= 0.01 if bar else None
    row("mill", f"largest force step per tick, {where}", "<= 0.01 N" if bar else "told")(_step)

for size in (512, 256):
    for diameter in (6, 2):
        for speed in (20, 200):
            def _direction(size=size, diameter=diameter, speed=speed):
                e = tick(f"--size {size} --burr-mm {diameter} --speed-mm-s {speed}")["direction_error_deg"]
                return f"{e['p50']:.2f} / {e['p99']:.2f} deg", e["p50"] <= 0.3 and e["p99"] <= 1.5
            row("direction", f"force direction error p50 / p99, {size}^3, {diameter} mm, {speed} mm/s", "<= 0.3 / 1.5 deg")(_direction)

for name in ("slide", "slot", "plunge"):
    def _volume(name=name):
        fine, coarse = (tick(f"--size {size} --mill {name}")["removed_mm3"] for size in (512, 256))
        apart = abs(coarse - fine) / fine
        return f"{coarse:.3f} and {fine:.3f} mm3: {100 * apart:.2f} %", apart <= 0.01
    row("volume", f"removed volume, 256^3 against 512^3, {name}", "within 1 %")(_volume)


@row("rates", "10 kHz, touching RT143_512 with 5 mm: tick p99.9", "<= 60 us")
def _():
    r = burr("mill RT143_512 --motion touch --burr-mm 5 --rate 10000 --seconds 20 --realtime")
    return f"{r['tick_us']['p999']:.0f} us; {r['missed']} of {r['ticks'] + r['missed']} left out", r["tick_us"]["p999"] <= 60


@row("rates", "4 kHz, milling the same: tick p99.9", "<= 220 us")
def _():
    r = burr("mill RT143_512 --motion pocket --burr-mm 5 --rate 4000 --seconds 20 --realtime")
    return f"{r['tick_us']['p999']:.0f} us; {r['missed']} of {r['ticks'] + r['missed']} left out", r["tick_us"]["p999"] <= 220


def endure():
    return burr(f"bench endure --seconds {options.seconds:g}")


minutes = options.seconds / 60


@row("endure", f"{minutes:g} minutes with picture and recording: tick p99.9", "<= 500 us")
def _():
    r = endure()
    note = f"; {'; '.join(r['left_out'])}" if r["left_out"] else ""
    return f"{r['tick_us']['p999']:.0f} us{note}", r["tick_us"]["p999"] <= 500 and not r["left_out"]


@row("endure", "lateness p99.9, tick / waiting loop beside it / alone", "no worse than the loop's")
def _():
    r = endure()
    late = r["late_us"]
    alone = max(late["waiting_before"]["p999"], late["waiting_after"]["p999"])
    return (f"{late['tick']['p999']:.0f} / {late['waiting_beside']['p999']:.0f} / {alone:.0f} us; left out "
            f"{late['tick']['missed']} / {late['waiting_beside']['missed']}"), r["no_later_than_waiting"]


@row("endure", "memory, from the second fifth to the last", "does not grow")
def _():
    r = endure()
    return f"{r['memory_grew_MB']:+.1f} MB of {r['memory_MB'][-1][1]:.0f}", r["memory_grew_MB"] < 1


@row("surface", "first whole surface, 512^3: part of flying edges' time, 1 / 2 threads", "<= 0.5")
def _():
    r = burr("bench surface")
    if r["ratio_1t"] is None:
        return f"{r['ours_1t_ms']:.0f} / {r['ours_2t_ms']:.0f} ms; VTK is not here", None
    return f"{r['ratio_1t']:.2f} / {r['ratio_2t']:.2f} ({r['ours_1t_ms']:.0f} / {r['ours_2t_ms']:.0f} ms)", max(r["ratio_1t"], r["ratio_2t"]) <= 0.5


@row("surface", "cut to new mesh, burr 12 voxels across: p99", "<= 1 ms")
def _():
    r = burr("bench carve")
    return f"{r['p99_ms']:.2f} ms", r["p99_ms"] <= 1


@row("load", "140 slices of JPEG-LS to the first surface", "<= 4 s")
def _():
    r = burr("bench load SKULL_PHANTOM")
    return f"{r['wall_s']:.2f} s", r["wall_s"] <= 4


@row("memory", "RT143_512 with labels and surface: peak / then", "<= 700 / 400 MB")
def _():
    r = burr("bench memory RT143_512")
    return f"{r['peak_MB']:.0f} / {r['steady_MB']:.0f} MB", r["peak_MB"] <= 700 and r["steady_MB"] <= 400


# ---- how the time of a tick grows

def growth():
    lines = ["| burr, voxels across | 256^3 | 512^3 | 1024^3 |", "|---|---|---|---|"]
    for voxels in (8, 16, 32, 64):
        cells = []
        for size in (256, 512, 1024):
            diameter = voxels * 49.2 / size
            try:
                cells.append(f"{tick(f'--size {size} --burr-mm {diameter:.4f}')['p50_us']:.1f}" if 0.6 <= diameter <= 20 else "-")
            except Missing as why:
                cells.append(str(why))
        lines.append(f"| {voxels} | {' | '.join(cells)} |")
    return lines


# ---- the table

def processor():
    with open("/proc/cpuinfo") as info:
        for line in info:
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor()


def version():
    return subprocess.run([options.burr, "--version"], text=True, capture_output=True, check=True).stdout.strip()


def measured(measure):
    try:
        return measure()
    except Missing as why:
        return f"not measured: {why}", None


groups = options.only or GROUPS
rows = [r for r in ROWS if r[0] in groups]
results, started = [], time.monotonic()
for number in range(options.runs):
    print(f"run {number + 1} of {options.runs}", file=sys.stderr)
    cache.clear()
    results.append([measured(measure) for *_, measure in rows])

lines = ["# Performance\n",
         f"Machine: {options.machine or processor()}, {os.cpu_count()} cores, {platform.system()} {platform.release().split('-')[0]}; {version()}.",
         f"Command: `scripts/bench_performance.py`, {time.strftime('%Y-%m-%d')}. Thread CPU time unless it says wall.\n"]
if rows:
    heads = ["measured"] if options.runs == 1 else [f"run {n + 1}" for n in range(options.runs)]
    lines += [f"| what | bar | {' | '.join(heads)} | met |", "|" + "---|" * (3 + len(heads))]
    for i, (_, what, bar, _) in enumerate(rows):
        met = [result[i][1] for result in results]
        word = "-" if None in met else "yes" if all(met) else "no" if not any(met) else "at times"
        lines.append(f"| {what} | {bar} | {' | '.join(result[i][0] for result in results)} | {word} |")
if "growth" in groups:
    lines += ["", "Median of the tick without milling, in us, as burr and volume grow:", "", *growth()]
text = "\n".join(lines) + "\n"
print(text, end="")
print(f"{time.monotonic() - started:.0f} s", file=sys.stderr)
if options.out:
    pathlib.Path(options.out).write_text(text)
