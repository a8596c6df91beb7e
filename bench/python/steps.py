#!/usr/bin/env python3
"""Steps a second, resets, start and memory of the module `burr`; prints a Markdown table.

    PYTHONPATH=build/release/python /usr/bin/python3 bench/python/steps.py

Processor time of this process: a loaded machine changes it less than wall time.
"""
import math
import os
import subprocess
import sys
import time

import numpy as np

import burr
import burr.env

TICKS = 20


def plate(edge=80, voxel_mm=0.25):
    depth = (edge / 2 - 0.5) - np.arange(edge)
    field = np.broadcast_to(np.clip(32768 + depth * 16384, 0, 65535).astype(np.uint16)[:, None, None], (edge,) * 3)
    return burr.Bone.from_array(np.ascontiguousarray(field), voxel_mm, origin_mm=(-voxel_mm * (edge - 1) / 2,) * 3)


def resident_mb():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def timed(work, count):
    began = time.process_time()
    for _ in range(count):
        work()
    return (time.process_time() - began) / count


def stroking(session, deep):
    """Strokes along the plate, `deep` below its surface [m]; above it where it is negative."""
    session.hand((-4e-3, 0, 5e-3), (math.cos(0.5), math.sin(0.5), 0, 0), 1, ticks=0)
    session.step(600)
    state = {"n": 0}

    def one():
        state["n"] += 1
        n = state["n"]
        session.hand((4e-3 * math.sin(0.02 * n), 3e-3 * math.sin(0.007 * n), 2e-3 - deep), ticks=TICKS)
        session.step(TICKS)
        return session.row
    return one


def start(statement):
    best = math.inf
    for _ in range(5):
        began = time.perf_counter()
        subprocess.run([sys.executable, "-c", statement], check=True)
        best = min(best, time.perf_counter() - began)
    return best


def main():
    print("| what | measured |\n|---|---|")
    nothing = start("pass")
    print(f"| `import numpy` | {start('import numpy') - nothing:.2f} s |")
    print(f"| `import burr` after it | {start('import numpy, burr') - start('import numpy'):.2f} s |")
    bone = plate()
    scene = burr.Scene(bone, burr_mm=4)
    before = resident_mb()
    kept = [scene.session(rows=False, voxels=False) for _ in range(10)]
    print(f"| memory of a session beside its bone's copy ({bone.shape[0]}^3 voxels) | {(resident_mb() - before) / 10:.1f} MB |")
    del kept
    print(f"| a session made and dropped | {1e3 * timed(lambda: scene.session(rows=False, voxels=False), 20):.1f} ms |")
    for what, deep, mode in (("in free air", -3e-3, "cut"), ("touching, nothing cut", 0.3e-3, "touch"), ("cutting", 0.3e-3, "cut")):
        session = scene.session(rows=False, voxels=False)
        session.set_mode(mode)
        work = stroking(session, deep)
        for _ in range(100):
            work()
        took = timed(work, 1000)
        touching = bool(session.row["touching"])
        print(f"| {TICKS} ticks {what} | {1e6 * took:.0f} us: {1 / took:.0f} steps/s, {1e6 * took / TICKS:.1f} us a tick "
              f"({'touching' if touching else 'free'}) |")
    session = scene.session(rows=False, voxels=False)
    session.hand((0, 0, 8e-3), ticks=0)
    idle = timed(lambda: (session.hand((0, 0, 8e-3), ticks=0), session.row), 20000)
    print(f"| the module's own part of a step (hand, row) | {1e6 * idle:.1f} us |")
    work = stroking(session, 0.6e-3)
    while session.outcome()["removed_mm3"] < 10:
        work()
    state = session.snapshot()
    took = []
    for n in range(20):
        began = time.process_time()
        session.reset_to(None if n % 2 else state)
        took.append(1e3 * (time.process_time() - began))
    print(f"| `reset_to` over 10 mm3 of removed bone, {bone.shape[0]}^3 voxels | {sorted(took)[10]:.2f} ms, worst {max(took):.2f} |")
    big = burr.Scene("temporal-bone")
    session = big.session(burr.Hand.motion("pocket", seconds=60), rows=False, voxels=False)
    while session.outcome()["removed_mm3"] < 10 and session.step(100):
        pass
    state = session.snapshot()
    took = []
    for n in range(20):
        began = time.process_time()
        session.reset_to(None if n % 2 else state)
        took.append(1e3 * (time.process_time() - began))
    print(f"| the same, temporal bone of {'x'.join(str(n) for n in big.bone.shape)} voxels | {sorted(took)[10]:.2f} ms, worst {max(took):.2f} |")
    env = burr.env.Env(scene, max_steps=1 << 30, end_on_injury=False)
    env.reset(seed=1)
    action = np.zeros(7, np.float32)
    for _ in range(20):
        action[:3] = 0.4e-3 * env.task.into
        action[6] = 1
        env.step(action)
    action[:3] = 0
    wave = {"n": 0}

    def agent():
        wave["n"] += 1
        action[0] = 0.3e-3 * math.cos(0.05 * wave["n"])
        return env.step(action)
    took = timed(agent, 1000)
    print(f"| a step of `burr.env.Env`, {TICKS} ticks, {'touching' if env.session.row['touching'] else 'free'} | "
          f"{1e6 * took:.0f} us: {1 / took:.0f} steps/s |")
    print(f"| an episode's `reset`, {burr.env.RAMP_TICKS} ticks of it | {1e3 * timed(env.reset, 20):.1f} ms |")


if __name__ == "__main__":
    main()
