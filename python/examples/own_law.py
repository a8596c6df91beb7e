#!/usr/bin/env python3
"""Compares force laws: what stiffness a hand feels, and how much bone it removes.

    own_law.py [LAW.so]        a compiled law to compare as well, for example samples/laws/hardening.c (its first lines say how)

Touch: a hand that is held rigidly presses slowly into a block, with the spindle off. The felt stiffness is the slope of force over depth,
by least squares; the rest of the fit says whether the law is a straight line. Milling: the same hand, which gives way, makes a pocket.
"""
import sys

import numpy as np

import burr


def softer(law):
    """A law of our own, in Python: half as stiff as burr's."""
    return 0.5 * law.stiffness_n_per_m * law.depth_m * law.normal


def felt(law):
    """Stiffness [N/m], and what the line through it leaves [N], from the rows of a slow press."""
    scene = burr.Scene("phantom:block", burr_mm=4)
    scene.law = law
    with scene.session() as session:
        session.hand(scene.at_m - 4e-3 * scene.into, ticks=0)
        session.step(600)  # forces begin slowly
        session.hand(scene.at_m - 0.5e-3 * scene.into, ticks=2000)
        session.step(2000)
        rows = session.rows()
    rows = rows[rows["touching"] & (rows["flags"] == 0) & (rows["depth_m"] > 0.1e-3)]
    force = np.linalg.norm(rows["force_n"], axis=1)
    line = np.polyfit(rows["depth_m"], force, 1)
    return line[0], np.abs(np.polyval(line, rows["depth_m"]) - force).max()


def milled(law, seconds=4):
    """Removed volume [mm3] and mean force in contact [N], from the rows of a pocket."""
    scene = burr.Scene("phantom:block", burr_mm=4)
    scene.law = law
    with scene.session(burr.Hand.motion("pocket", seconds=seconds)) as session:
        session.step(int(1000 * seconds))
        rows = session.rows()
    force = np.linalg.norm(rows["force_n"][rows["touching"]], axis=1)
    return 1e9 * rows["removed_m3"][-1], force.mean()


def main(compiled=None):
    laws = {"burr's own": None, "half as stiff": softer}
    if compiled:
        laws["compiled"] = compiled
    table = {}
    print(f"{'law':>15} {'felt stiffness [N/m]':>21} {'off a line [N]':>15} {'removed [mm3]':>14} {'mean force [N]':>15}")
    for name, law in laws.items():
        table[name] = (*felt(law), *milled(law))
        print(f"{name:>15} {table[name][0]:21.1f} {table[name][1]:15.4f} {table[name][2]:14.3f} {table[name][3]:15.3f}")
    return table


if __name__ == "__main__":
    main(*sys.argv[1:])
