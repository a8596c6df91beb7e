#!/usr/bin/env python3
"""Measures the page in Chromium: how soon it shows the bone, how much it fetches, how long ticks take while milling.

    bench/web/page.py SITE [--seconds 60] [--times 5] [--finer]

SITE: build/web/site, or what `burr web --out` wrote. Prints lines for bench/results/web.md.
"""
import argparse
import gzip
import json
import os
import pathlib
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "web/tests"))
from chromium import Chromium, Site  # noqa: E402

WAIT = 600
MILL = """(async (seconds) => {
  const canvas = document.getElementById('picture'), box = canvas.getBoundingClientRect();
  const send = (type, x, y, buttons) => canvas.dispatchEvent(new PointerEvent(type, {clientX: box.left + x,
      clientY: box.top + y, button: type === 'pointermove' ? -1 : 0, buttons, pointerId: 1, pointerType: 'mouse',
      bubbles: true, cancelable: true}));
  const wait = (ms) => new Promise((go) => setTimeout(go, ms));
  const x = 0.5 * box.width, y = 0.5 * box.height;
  send('pointermove', x, y, 0);
  await wait(1000);
  send('pointerdown', x, y, 1);
  burr.measure();
  const from = {...burr.state, pictures: burr.pictures};
  const begun = performance.now();
  while (performance.now() < begun + 1000 * seconds) {
    const t = (performance.now() - begun) / 1000;
    const far = 8 + 0.3 * t;
    send('pointermove', x + far * Math.cos(2.5 * t), y + far * Math.sin(2.5 * t), 1);
    await wait(16);
  }
  const took = (performance.now() - begun) / 1000;
  const at = {...burr.state, pictures: burr.pictures, removed: burr.figures.removed};
  send('pointerup', x, y, 0);
  return {took, ticks: at.ticks - from.ticks, left_out: at.left_out - from.left_out, p50: at.p50, p99: at.p99,
          pictures: (at.pictures - from.pictures) / took, removed: at.removed};
})"""


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("site", type=pathlib.Path)
    ask.add_argument("--seconds", type=float, default=60)
    ask.add_argument("--times", type=int, default=5)
    ask.add_argument("--finer", action="store_true", help="the bone of 0.25 mm too")
    options = ask.parse_args()
    print("Chromium:", subprocess.run(["chromium", "--version"], capture_output=True, text=True).stdout.strip())
    print("processors:", os.cpu_count(), "load:", os.getloadavg()[0])

    times = {}
    for _ in range(options.times):
        with Site(options.site) as site, Chromium(960, 540) as browser:
            page = browser.open(site.url + "mill/")
            page.wait("window.burr && burr.ready && burr.times.whole_picture", WAIT)
            for name, ms in page.run("burr.times").items():
                times.setdefault(name, []).append(ms)
            asked = [path.split("?")[0] for path in site.asked]
            gpu = page.run("burr.gpu")
    print("graphics:", gpu)
    for name, all_ms in times.items():
        print(f"{name}: median {statistics.median(all_ms):.0f} ms, {min(all_ms)} to {max(all_ms)}")

    def file_of(path):
        file = options.site / path.lstrip("/")
        return file / "index.html" if file.is_dir() else file
    files = sorted({file_of(path) for path in asked})
    plain = sum(file.stat().st_size for file in files)
    packed = sum(len(gzip.compress(file.read_bytes(), 9)) for file in files)
    print(f"to the first cut: {len(files)} files, {plain / 1e3:.0f} kB, {packed / 1e3:.0f} kB with gzip")

    with Site(options.site) as site, Chromium(960, 540) as browser:
        page = browser.open(site.url + "mill/")
        page.wait("window.burr && burr.ready", WAIT)
        time.sleep(2)
        print(f"milling {options.seconds:.0f} s:", json.dumps(page.run(f"{MILL}({options.seconds})")))
        if options.finer:
            page.run("document.getElementById('finer').click()")
            page.wait("burr.ready && burr.times.whole_picture", WAIT)
            print("0.25 mm, after the button:", page.run("JSON.stringify(burr.times)"))
            page.run("0")
            time.sleep(2)
            print(f"0.25 mm, milling {options.seconds / 3:.0f} s:",
                  json.dumps(page.run(f"{MILL}({options.seconds / 3})")))
            if page.troubles:
                print("console:", page.troubles)
    print("load at the end:", os.getloadavg()[0])


main()
