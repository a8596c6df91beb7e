#!/usr/bin/env python3
"""An observer of known threshold feels springs; the experiment finds the threshold from the answers alone.

    psychophysics.py [THRESHOLD] [TRIALS] [RUNS]

The observer presses a burr into a wall in a session, estimates the stiffness from force and depth, and adds noise of its own. Put a
person and a device in its place for a real experiment: `burr psychophysics` does that (docs/understand/psychophysics.md).
"""
import math
import sys

import numpy as np

import burr

LAPSE = 0.02  # of the answers are guesses
QUARTER = 0.6744897501960817  # standard deviations: half of a normal distribution is nearer to its middle


def wall():
    """A session with a flat wall at z = 0, and a hand above it."""
    edge = 32
    depth = (edge / 2 - 0.5) - np.arange(edge)
    field = np.clip(32768 + depth * 16384, 0, 65535).astype(np.uint16)
    field = np.ascontiguousarray(np.broadcast_to(field[:, None, None], (edge,) * 3))
    session = burr.Scene(burr.Bone.from_array(field, 0.5, origin_mm=(-7.75,) * 3), burr_mm=4).session(voxels=False)
    session.hand((0, 0, 4e-3), pedal=0, ticks=0)
    session.step(600)
    return session


def felt(session, stiffness):
    """Presses 1 mm deep: the stiffness that force and depth at the hand show [N/m]."""
    session.set_stiffness_n_per_m(stiffness)
    session.hand((0, 0, 1e-3), ticks=60)
    session.step(120)
    row = session.row
    there = float(row["force_n"][2]) / float(row["proxy_m"][2] - row["hand_m"][2])
    session.hand((0, 0, 4e-3), ticks=60)
    session.step(120)
    session.rows()  # nobody looks at them
    return there


def run(threshold, trials, seed):
    """One observer: what the experiment says of it."""
    session, random = wall(), np.random.default_rng(seed)
    # so that at the threshold half of the answers beyond chance are right
    sigma = math.log(1 + threshold) / (math.sqrt(2) * QUARTER)
    experiment = burr.Experiment("stiffness", trials=trials, lapse=LAPSE, seed=seed)
    while not experiment.finished:
        trial = experiment.next()
        first, second = (math.log(felt(session, trial.shown(n))) + sigma * random.normal() for n in (1, 2))
        answer = 1 if first > second else 2
        if random.random() < 2 * LAPSE:  # half of the guesses are right
            answer = int(random.integers(1, 3))
        experiment.answer(answer)
    return experiment.outcome()


def main(threshold=0.12, trials=300, runs=8):
    threshold, outcomes = float(threshold), []
    for seed in range(1, int(runs) + 1):
        outcome = run(threshold, int(trials), seed)
        outcomes.append(outcome)
        if outcome["found"]:
            print(f"{100 * outcome['threshold']:5.1f} %  (95 % interval {100 * outcome['low']:.1f} to {100 * outcome['high']:.1f})")
        else:
            print("no threshold found:", outcome["why"])
    found = [outcome["threshold"] for outcome in outcomes if outcome["found"]]
    print(f"mean {100 * np.mean(found):.1f} %; the truth is {100 * threshold:.1f} %")
    return outcomes


if __name__ == "__main__":
    main(*sys.argv[1:])
