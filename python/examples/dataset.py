#!/usr/bin/env python3
"""A data set: many short sessions, each from its own seed, as one table and one file of rows for each.

    dataset.py [OUT] [SESSIONS] [SECONDS]

A table of voxels that left the bone goes with each. The same seeds give the same files on the same build.
"""
import csv
import pathlib
import sys

import numpy as np

import burr


def path(random, scene, seconds):
    """A hand that wanders over the place of work and presses by a random amount."""
    times = np.arange(0, seconds + 0.25, 0.25)
    aside = np.cross(scene.into, (0, 1.0, 0))
    aside /= np.linalg.norm(aside)
    across = np.cross(scene.into, aside)
    offsets = random.uniform(-3e-3, 3e-3, (len(times), 2))
    deep = random.uniform(-2e-3, 0.5e-3, len(times))
    deep[:3] = -6e-3  # from above
    points = scene.at_m + offsets[:, :1] * aside + offsets[:, 1:] * across + deep[:, None] * scene.into
    quats = np.broadcast_to((np.cos(0.5), np.sin(0.5), 0, 0), (len(times), 4))
    return burr.Hand.path(times, points, quats, np.ones(len(times)))


def main(out="dataset", sessions=5, seconds=3.0):
    folder = pathlib.Path(out)
    folder.mkdir(exist_ok=True)
    scene = burr.Scene("phantom:block", burr_mm=4)
    table = []
    for seed in range(int(sessions)):
        session = scene.session(path(np.random.default_rng(seed), scene, float(seconds)))
        while session.step(1000):
            pass
        outcome = session.outcome()
        np.savez(folder / f"{seed:05d}.npz", rows=session.rows(), removed=session.removed())
        table.append({"seed": seed, "ticks": outcome["ticks"], "removed_mm3": outcome["removed_mm3"],
                      "peak_force_n": outcome["peak_force_n"], "bone_hash": session.bone().hash})
    with open(folder / "sessions.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, table[0].keys())
        writer.writeheader()
        writer.writerows({name: burr.table_text(cell) if isinstance(cell, str) else cell for name, cell in row.items()} for row in table)
    return table


if __name__ == "__main__":
    for line in main(*sys.argv[1:]):
        print(line)
