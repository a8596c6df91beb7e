#!/usr/bin/env python3
"""Behaviour cloning: a policy that does what hands did in recordings (least squares, numpy alone).

    clone.py [RECORDINGS]          RECORDINGS: a pattern such as "sessions/*.mcap"; without: it makes eight short ones itself

It says how far its moves are from those of a session that it did not learn from, and what reward it gets in burr.env,
beside moves by chance. It shows the way from recordings to a policy; it is no surgeon.
"""
import pathlib
import sys
import tempfile

import numpy as np

import burr
import burr.dataset
import burr.env

STEPS = 120


def teach(folder, scene, sessions=8):
    """Recordings of a hand that goes down and rubs to and fro; place and pace differ."""
    task = burr.env.Task(scene)
    aside = np.cross(task.into, (0, 1.0, 0))
    aside /= np.linalg.norm(aside)
    across = np.cross(task.into, aside)
    for seed in range(sessions):
        random = np.random.default_rng(seed)
        t = np.arange(0, 4.02, 0.02)
        work = np.maximum(0, t - 0.6)  # forces begin slowly: it waits
        deep = np.minimum(-5e-3 + random.uniform(8e-3, 10e-3) * work, random.uniform(-0.6e-3, -0.2e-3))
        stroke = random.uniform(1.8e-3, 2.2e-3) * (1 - np.cos(random.uniform(6.5, 7.5) * work)) / 2
        off = random.uniform(-1e-3, 1e-3, 2)
        points = (task.at + deep[:, None] * task.into + (off[0] + stroke)[:, None] * aside + off[1] * across)
        hand = burr.Hand.path(t, points, np.broadcast_to(task.lean, (len(t), 4)), t > 0.59, grip="rigid")
        with scene.session(hand, record=str(folder / f"{seed}.mcap"), rows=False, voxels=False) as session:
            while session.step(1000):
                pass
    return str(folder / "*.mcap")


def row_of(observation):
    return np.concatenate([observation[name] for name in ("pose", "velocity", "force", "near")], axis=-1).astype(np.float64)


class Policy:
    """Moves as a smooth function of what is seen: waves of random direction, weighted by least squares."""

    def __init__(self, seen, done, waves=200, stiffness=1e-3):
        random = np.random.default_rng(1)
        self.mean, self.scale = seen.mean(0), np.maximum(seen.std(0), 1e-6)
        self.directions = random.normal(0, 0.2, (seen.shape[1], waves))
        self.phases = random.uniform(0, 2 * np.pi, waves)
        self.unit = np.maximum(np.abs(done).max(0), 1e-9)
        made = self.features(seen)
        self.weights = np.linalg.solve(made.T @ made + stiffness * len(seen) * np.eye(made.shape[1]), made.T @ (done / self.unit))

    def features(self, seen):
        x = np.clip((seen - self.mean) / self.scale, -4, 4)
        return np.concatenate((np.ones((*x.shape[:-1], 1)), x, np.cos(x @ self.directions + self.phases)), axis=-1)

    def __call__(self, seen):
        return self.features(seen) @ self.weights * self.unit


def reward_of(env, act, seeds=(11, 12, 13)):
    total = 0.0
    for seed in seeds:
        observation, _ = env.reset(seed=seed)
        over = False
        while not over:
            observation, reward, terminated, truncated, _ = env.step(act(observation))
            total += reward
            over = terminated or truncated
    return total / len(seeds)


def main(recordings=None):
    scene = burr.Scene("phantom:block", burr_mm=4)
    with tempfile.TemporaryDirectory() as folder:
        shown = burr.dataset.from_recordings(recordings or teach(pathlib.Path(folder), scene))
    seen, done = row_of(shown.observations), shown.actions.astype(np.float64)
    held_out = shown.recording == shown.recording.max()  # a whole session, not single steps of all
    policy = Policy(seen[~held_out], done[~held_out])

    def off_by(moves):
        return 1e3 * float(np.sqrt(np.mean(np.sum((moves - done[held_out])[:, :3] ** 2, axis=1))))
    result = {"pairs": len(shown), "mean_mm": off_by(done[~held_out].mean(0)), "clone_mm": off_by(policy(seen[held_out]))}
    if recordings is None:
        env = burr.env.Env(scene, max_steps=STEPS, spread_mm=1.0)
        env.action_space.seed(5)
        result["chance_reward"] = reward_of(env, lambda _: env.action_space.sample())
        result["clone_reward"] = reward_of(env, lambda observation: policy(row_of(observation)))
        env.close()
    return result


if __name__ == "__main__":
    for name, value in main(*sys.argv[1:]).items():
        print(f"{name}: {value:.4g}")
