#!/usr/bin/env python3
"""A policy that improves: it learns how far to go down and how to stroke, by trying (random search, no library).

    learn.py [ROUNDS]

It shows the environment at work; it is no good surgeon.
"""
import sys

import numpy as np

import burr
import burr.env

STEPS = 60


def episode(env, policy):
    """policy: how fast down [mm a step], down to which depth [mm], width of a stroke [mm a step], steps of a stroke."""
    fast, depth, width, length = policy
    env.reset(seed=1)
    into = env.task.into
    aside = np.cross(into, (0, 1.0, 0))
    aside /= np.linalg.norm(aside)
    total, gone = 0.0, -1e3 * env.start_m
    for n in range(STEPS):
        down = min(max(fast, 0.0), 0.5, max(0.0, depth - gone))
        gone += down
        stroke = width if n // max(1, int(length)) % 2 == 0 else -width
        action = np.array([*(1e-3 * (down * into + stroke * aside)), 0, 0, 0, 1])
        _, reward, terminated, truncated, _ = env.step(action)
        total += reward
        if terminated or truncated:
            break
    return total


def main(rounds=20):
    env = burr.env.Env(burr.Scene("phantom:block", burr_mm=4), max_steps=STEPS + 1, spread_mm=0.0)
    random = np.random.default_rng(3)
    best = np.array([0.3, -2.5, 0.1, 5.0])  # stays above the bone
    score = first = episode(env, best)
    for _ in range(int(rounds)):
        tried = best + random.normal(0, (0.1, 1.0, 0.1, 3.0))
        got = episode(env, tried)
        if got > score:
            best, score = tried, got
            print(f"{score:8.2f}  {np.round(best, 2)}")
    print(f"from {first:.2f} to {score:.2f}")
    return first, score


if __name__ == "__main__":
    main(*sys.argv[1:])
