#!/usr/bin/env python3
"""Measures the tick on the scene of comparable programs, with all important options, and prints a Markdown table.

    scripts/bench_tick.py [build/release/burr] > bench/results/tick.md
"""
import json
import platform
import subprocess
import sys

burr = sys.argv[1] if len(sys.argv) > 1 else "build/release/burr"

ROWS = [  # what, options
    ("512, 6 mm", "--size 512"),
    ("512, 6 mm, caches evicted", "--size 512 --evict --ticks 1000"),
    ("512, 6 mm, scalar", "--size 512"),
    ("512, 6 mm, avx2", "--size 512"),
    ("256, 6 mm", "--size 256"),
    ("512, 2 mm", "--size 512 --burr-mm 2"),
    ("256, 2 mm", "--size 256 --burr-mm 2"),
    ("512, 6 mm, 200 mm/s", "--size 512 --speed-mm-s 200"),
    ("512, 6 mm, box", "--size 512 --shape box"),
    ("512, 6 mm, milling, slide 0.5 mm", "--size 512 --mill slide"),
    ("512, 6 mm, milling, slot 3 mm", "--size 512 --mill slot"),
    ("512, 6 mm, milling, plunge 3 mm held", "--size 512 --mill plunge"),
    ("256, 6 mm, milling, slide 0.5 mm", "--size 256 --mill slide"),
]


def processor():
    with open("/proc/cpuinfo") as info:
        for line in info:
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor()


print("# The tick\n")
print(f"Machine: {processor()}, {platform.system()} {platform.release().split('-')[0]}. Command: `scripts/bench_tick.py`.")
print("Thread CPU time of the whole tick, microseconds; scene of `burr bench tick` (the one CHAI3D was measured with: median")
print("731-776, p99 2368-3099 at 512 voxels and 6 mm, force direction off by 7 degrees in the median).\n")
print("| scene | p50 | p99 | p99.9 | max | direction error p50 / p99 [deg] | largest force step [N] | removed / asked [mm3] | reference / p50 |")
print("|---|---|---|---|---|---|---|---|---|")
for what, options in ROWS:
    environment = {"BURR_SIMD": what.rsplit(" ", 1)[1]} if what.endswith(("scalar", "avx2")) else {}
    line = subprocess.run([burr, "--quiet", "bench", "tick", "--json", *options.split()], check=True, text=True,
                          capture_output=True, env={"PATH": "/usr/bin:/bin", **environment}).stdout.splitlines()[-1]
    r = json.loads(line)
    error = r["direction_error_deg"]
    direction = f"{error['p50']:.2f} / {error['p99']:.2f}" if not r["mill"] else "-"
    removed = f"{r['removed_mm3']:.3f} / {r['asked_mm3']:.3f}" if r["mill"] else "-"
    print(f"| {what} | {r['p50_us']:.1f} | {r['p99_us']:.1f} | {r['p999_us']:.1f} | {r['max_us']:.1f} | {direction} "
          f"| {r['force_step_N_max']:.4f} | {removed} | {r['ratio']:.0f} |")
