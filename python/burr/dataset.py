"""Sessions as demonstrations: what a hand saw and what it did, in the shapes of burr.env (docs/use/datasets.md).

    import burr.dataset
    shown = burr.dataset.from_recordings("sessions/*.mcap")
    for observation, action in shown: ...

Units: SI. World frame: LPS [m].
"""
from __future__ import annotations

import dataclasses
import glob
import os
from typing import Any, Iterator, Sequence

import numpy as np

import burr
from burr.env import MOST_MOVE_M, MOST_TURN_RAD, RAMP_TICKS, REACH_MM

LIFTED = 1 << 31  # bit of `buttons`: the hand moved without the tool


@dataclasses.dataclass
class Demonstrations:
    """n pairs of what was seen and what was done next."""
    observations: dict[str, np.ndarray]  # as burr.env.Env gives them; (n, ...) each
    actions: np.ndarray  # (n, 7), as burr.env.Env takes them
    clipped: np.ndarray  # (n) bool: the hand did more in this step than an action may
    recording: np.ndarray  # (n) index in `files`
    tick: np.ndarray  # (n) of the observation
    files: list[str]
    structures: list[str]  # whose distances are in observations["near"]

    def __len__(self) -> int:
        return len(self.actions)

    def __getitem__(self, n: int) -> tuple[dict[str, np.ndarray], np.ndarray]:
        return {name: column[n] for name, column in self.observations.items()}, self.actions[n]

    def __iter__(self) -> Iterator[tuple[dict[str, np.ndarray], np.ndarray]]:
        return (self[n] for n in range(len(self)))


def from_recordings(files: str | Sequence[str], *, ticks: int = 20, skip: int = RAMP_TICKS, check: bool = False,
                    volume: str = "") -> Demonstrations:
    """Pairs of observation and action from recordings.

    files: a pattern such as "sessions/*.mcap", or a list of files. ticks: of a step, as in burr.env.Env. skip: ticks at the
    beginning that are left out, because forces begin slowly. check: simulate each session again, and refuse one that comes
    out differently. volume: the scan, where burr does not find it.
    """
    if isinstance(files, (str, os.PathLike)):
        found = sorted(glob.glob(os.fspath(files), recursive=True))
        if not found:
            raise burr.Error(f"{files}: no file has such a name")
    else:
        found = [os.fspath(file) for file in files]
        if not found:
            raise burr.Error("the list of recordings is empty")
    if ticks < 1:
        raise burr.Error(f"ticks={ticks}: a step has at least one tick")
    known: dict[Any, list[Any]] = {}  # distances of a bone, which many sessions share
    structures: list[str] | None = None
    parts = []
    for number, file in enumerate(found):
        recording = burr.Recording(file, volume=volume)
        if check:
            again = recording.replay()
            if not again["same"]:
                raise burr.Error(f"{file}: simulated again it comes out differently: {again['difference']}")
        spare = recording.spare
        if structures is None:
            structures = spare
        elif structures != spare:
            raise burr.Error(f"{file}: what must be spared is not what it is in {found[0]} ({_named(spare)}; {_named(structures)}); "
                             "take recordings of one case")
        parts.append(_pairs(recording, number, _near(recording, spare, known), ticks, max(skip, 1)))
    assert structures is not None
    observations = {name: np.concatenate([part[0][name] for part in parts]) for name in parts[0][0]}
    actions, clipped, which, tick = (np.concatenate([part[k] for part in parts]) for k in range(1, 5))
    return Demonstrations(observations, actions, clipped, which, tick, found, structures)


def _named(names: list[str]) -> str:
    return ", ".join(names) if names else "nothing"


def _near(recording: burr.Recording, spare: list[str], known: dict[Any, list[Any]]) -> list[Any]:
    if not spare:
        return []
    key = (recording.info["volume"]["content_hash"], tuple(spare))
    if key not in known:
        bone = recording.before()
        known[key] = [bone.distance_to([name], reach_mm=REACH_MM) for name in spare]
    return known[key]


def _pairs(recording: burr.Recording, number: int, near: list[Any], ticks: int, skip: int) -> tuple[Any, ...]:
    rows = recording.ticks
    # a step goes from the end of one tick to the end of another one; both must be there, and all between
    first = np.searchsorted(rows["tick"], skip - 1)
    ends = np.arange(first, len(rows), ticks)
    a, b = ends[:-1], ends[1:]
    lost = np.cumsum((rows["buttons"] & np.uint32(LIFTED) != 0) | ~rows["hand_valid"])
    whole = (rows["tick"][b] - rows["tick"][a] == ticks) & (lost[b] == lost[a])
    a, b = a[whole], b[whole]

    p, q = rows["hand_m"], rows["hand_q"]
    proxy = rows["proxy_m"][a]
    distances = [np.asarray(one.at(proxy), np.float32).reshape(len(a)) for one in near]
    observations = {
        "pose": np.concatenate((p[a], q[a]), axis=1).astype(np.float32),
        "velocity": rows["hand_v_m_per_s"][a].astype(np.float32),
        "force": rows["force_n"][a].astype(np.float32),
        "torque": rows["torque_nm"][a].astype(np.float32),
        "near": np.minimum(np.stack(distances, axis=1) if near else np.zeros((len(a), 0), np.float32), np.float32(1e-3 * REACH_MM)),
    }
    did = np.concatenate((p[b] - p[a], _turns(q[a], q[b]), rows["pedal"][b][:, None]), axis=1)
    most = np.array([MOST_MOVE_M] * 3 + [MOST_TURN_RAD] * 3 + [1.0])
    least = np.where(np.arange(7) == 6, 0.0, -most)
    actions = np.clip(did, least, most).astype(np.float32)
    clipped = np.any((did < least * (1 + 1e-6) - 1e-9) | (did > most * (1 + 1e-6) + 1e-9), axis=1)
    return observations, actions, clipped, np.full(len(a), number), rows["tick"][a].astype(np.int64)


def _turns(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Rotation vectors of the world, (n, 3), that turn the first quaternions (w x y z) into the second."""
    w0, v0, w1, v1 = before[:, :1], before[:, 1:], after[:, :1], after[:, 1:]
    w = w1 * w0 + np.sum(v1 * v0, axis=1, keepdims=True)  # after * conjugate(before)
    v = w0 * v1 - w1 * v0 - np.cross(v1, v0)
    w, v = np.abs(w), np.where(w < 0, -v, v)  # the shorter way round
    length = np.linalg.norm(v, axis=1, keepdims=True)
    return v * np.where(length > 1e-12, 2 * np.arctan2(length, w) / np.maximum(length, 1e-12), 2.0)
