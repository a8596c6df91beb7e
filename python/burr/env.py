"""An environment for learning, in the shape of Gymnasium's: docs/use/python.md, "An environment for learning".

    import burr, burr.env
    environment = burr.env.Env(burr.Scene("tooth"))
    observation, info = environment.reset(seed=1)
    observation, reward, terminated, truncated, info = environment.step(environment.action_space.sample())

Gymnasium need not be there; where it is, its spaces are used. Units: SI. World frame: LPS [m].
"""
from __future__ import annotations

import concurrent.futures
import dataclasses
import math
from typing import Any, Callable, Mapping, Sequence

import numpy as np

import burr

try:  # not in Debian
    import gymnasium
    from gymnasium.spaces import Box, Dict
    _Base: Any = gymnasium.Env
except ImportError:
    _Base = object

    class Box:  # type: ignore[no-redef]
        """Numbers between bounds; as gymnasium.spaces.Box."""

        def __init__(self, low: Any, high: Any, shape: tuple[int, ...] | None = None, dtype: Any = np.float32):
            self.dtype = np.dtype(dtype)
            self.shape = tuple(shape) if shape is not None else np.shape(low)
            self.low = np.broadcast_to(np.asarray(low, self.dtype), self.shape)
            self.high = np.broadcast_to(np.asarray(high, self.dtype), self.shape)
            self._random = np.random.default_rng()

        def seed(self, seed: int | None = None) -> None:
            self._random = np.random.default_rng(seed)

        def sample(self) -> np.ndarray:
            if np.issubdtype(self.dtype, np.integer):
                return self._random.integers(self.low, self.high, dtype=self.dtype, endpoint=True)
            return self._random.uniform(self.low, self.high).astype(self.dtype)

        def contains(self, x: Any) -> bool:
            return (isinstance(x, np.ndarray) and x.shape == self.shape and x.dtype == self.dtype
                    and bool(np.all(x >= self.low) and np.all(x <= self.high)))

    class Dict:  # type: ignore[no-redef]
        """Several spaces by name; as gymnasium.spaces.Dict."""

        def __init__(self, spaces: Mapping[str, Any]):
            self.spaces = dict(spaces)

        def __getitem__(self, name: str) -> Any:
            return self.spaces[name]

        def keys(self) -> Any:
            return self.spaces.keys()

        def contains(self, x: Any) -> bool:
            return (isinstance(x, dict) and x.keys() == self.spaces.keys()
                    and all(space.contains(x[name]) for name, space in self.spaces.items()))


MOST_MOVE_M = 0.5e-3  # of the tip in a step, along each axis
MOST_TURN_RAD = math.radians(2)  # about each axis
REACH_MM = 20.0  # of the distances that are observed
RAMP_TICKS = 600  # after a start, in which forces begin slowly
PATCH = 16  # edge of the observed field round the burr [voxel]


@dataclasses.dataclass
class Step:
    """What a reward is made of: one step of the environment."""
    row: Any  # of its last tick
    removed: np.ndarray  # voxels that left the bone, by label
    target_mm3: float  # of these, what the case asks for
    spared_voxels: int  # of these, what must not be cut
    injured: bool  # a turning burr reaches into soft tissue that must be spared
    force_n: float  # on the hand, at the last tick


def default_reward(step: Step) -> float:
    """1 for a mm3 of target, -1000 for a voxel or a step in what must be spared, -0.1 for a newton above 2, -0.01 for a step."""
    return (step.target_mm3 - 1000.0 * step.spared_voxels - 1000.0 * step.injured - 0.1 * max(0.0, step.force_n - 2.0) - 0.01)


class Task:
    """What all environments of one scene share: labels, distances, the place where work begins. It never changes."""

    def __init__(self, scene: burr.Scene):
        self.scene = scene
        bone = scene.bone
        self.labels = bone.labels()
        tissues = bone.tissues
        self.voxel_mm3 = bone.voxel_mm ** 3
        spare = set(scene.spare)
        self.structures = [t.name for t in tissues if t.name in spare]
        self.near = [bone.distance_to([name], reach_mm=REACH_MM) for name in self.structures]
        self.soft = [next(t for t in tissues if t.name == name).kind == "soft" for name in self.structures]
        self.spared = np.array([t.name in spare and t.kind == "solid" for t in tissues])
        wanted = {target["tissue"]: target["share"] for target in scene.targets if target["goal"] == "remove"}
        self.target = np.array([(t.name in wanted if wanted else t.name not in spare) and t.kind == "solid" for t in tissues])
        # the target is done when so much of each tissue is gone; nothing to remove: never
        self.done_mm3 = {n: wanted[t.name] * bone.volume_mm3(t.name) for n, t in enumerate(tissues) if t.name in wanted}
        self.at, self.into = scene.at_m, scene.into
        self.lean = _leaning(self.into)


class Env(_Base):
    """A session whose hand an agent moves. Action: 7 numbers, the move of the tip [m], its turn [rad], the pedal."""

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 50}

    def __init__(self, scene: burr.Scene | Task, *, reward: Callable[[Step], float] = default_reward, ticks: int = 20,
                 max_steps: int = 1000, end_on_injury: bool = True, start_mm: float = 5.0, spread_mm: float = 2.0, patch: bool = False,
                 image: tuple[int, int] | None = None, render_mode: str | None = None):
        """patch: observe the field round the burr, 16^3; image: (width, height) of a picture to observe, drawn on the main thread."""
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise burr.Error(f'render_mode "{render_mode}" is not known; use "rgb_array" or None')
        self.render_mode, self.patch, self.image = render_mode, patch, image
        self.task = scene if isinstance(scene, Task) else Task(scene)
        self.reward = reward
        self.ticks, self.max_steps, self.end_on_injury = ticks, max_steps, end_on_injury
        self.start_m, self.spread_m = 1e-3 * start_mm, 1e-3 * spread_mm
        high = np.array([MOST_MOVE_M] * 3 + [MOST_TURN_RAD] * 3 + [1.0], np.float32)
        low = -high
        low[6] = 0
        self.action_space = Box(low, high, dtype=np.float32)
        self._low, self._high = low.astype(np.float64), high.astype(np.float64)
        many = len(self.task.structures)
        free = {"pose": 7, "velocity": 3, "force": 3, "torque": 3}
        spaces = {name: Box(-np.inf, np.inf, (size,), np.float32) for name, size in free.items()}
        spaces["near"] = Box(-1.0, 1e-3 * REACH_MM, (many,), np.float32)
        if patch:
            spaces["patch"] = Box(0, 255, (PATCH,) * 3, np.uint8)
        if image is not None:
            spaces["image"] = Box(0, 255, (image[1], image[0], 3), np.uint8)
        self.observation_space = Dict(spaces)
        self.session = self.task.scene.session(rows=False)
        self._random = np.random.Generator(np.random.PCG64())
        self._steps, self._over, self._fresh = 0, True, True

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """The bone as it was, the hand above the place of work. The same seed gives the same episode."""
        if seed is not None:
            self._random = np.random.Generator(np.random.PCG64(seed))
        if not self._fresh:
            self.session.reset_to()
        self._fresh = False
        off = self._random.uniform(-1, 1, 3) * self.spread_m
        off -= off.dot(self.task.into) * self.task.into
        self._p = self.task.at - self.start_m * self.task.into + off
        self._q = self.task.lean
        self.session.hand(self._p, self._q, 0, ticks=0)
        self.session.step(RAMP_TICKS)
        self.session.removed()
        self._steps, self._over = 0, False
        self._gone = np.zeros(len(self.task.target), np.int64)
        return self._observe(self.session.row), self._info(self.session.row)

    def step(self, action: Any) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        """burr.Error: an action that is not seven finite numbers; nothing moved, and the episode goes on with the next good action."""
        self._act(action)
        try:
            self.session.step(self.ticks)
        except BaseException:  # Ctrl-C within the step: nobody knows how far it came
            self._over = True
            raise
        return self._judge()

    def render(self) -> np.ndarray | None:
        """With render_mode="rgb_array" a picture, (480, 640, 3) uint8; drawn off-screen, on Python's main thread."""
        return self.session.picture() if self.render_mode == "rgb_array" else None

    def close(self) -> None:
        self._over = True
        self.session.close()

    # ---- the two halves of a step, between which the session works without the GIL

    def _act(self, action: Any) -> None:
        if self._over:
            raise burr.Error("this episode is over; call reset()")
        p, q, pedal = self._wish(action)
        self.session.hand(p, q, pedal, ticks=self.ticks)  # may refuse; then this episode is as before the step
        self._p, self._q = p, q

    def _wish(self, action: Any) -> tuple[np.ndarray, tuple[float, float, float, float], float]:
        """Where the hand shall be. Changes nothing; burr.Error: the action is not seven numbers."""
        try:
            a = np.asarray(action, np.float64)
        except (TypeError, ValueError):
            a = np.empty(0)
        if a.size != 7:
            raise burr.Error("an action is 7 numbers: the move of the tip [m], its turn [rad], the pedal; this episode is as before the step")
        a = a.reshape(7)
        if not np.isfinite(a).all():
            raise burr.Error("an action holds a number that is not finite; this episode is as before the step: step it again, or call reset()")
        a = np.minimum(np.maximum(a, self._low), self._high)
        return self._p + a[:3], _turned(self._q, float(a[3]), float(a[4]), float(a[5])), float(a[6])

    def _judge(self) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        task, row = self.task, self.session.row
        voxels = self.session.removed()
        if len(voxels):
            removed = np.bincount(task.labels[voxels[:, 3], voxels[:, 2], voxels[:, 1]], minlength=len(task.target))
        else:
            removed = np.zeros(len(task.target), np.int64)
        self._gone += removed
        observation = self._observe(row)
        radius = float(row["tool_radius_m"])
        turning = abs(float(row["spindle_rad_per_s"])) > 1
        injured = turning and any(soft and d < radius for soft, d in zip(task.soft, observation["near"]))
        step = Step(row, removed, task.voxel_mm3 * float(removed[task.target].sum()), int(removed[task.spared].sum()), injured,
                    math.hypot(*row["force_n"].tolist()))
        self._steps += 1
        hurt = self.end_on_injury and (step.injured or step.spared_voxels > 0)
        done = bool(task.done_mm3) and all(task.voxel_mm3 * self._gone[n] >= mm3 for n, mm3 in task.done_mm3.items())
        terminated, truncated = hurt or done, self._steps >= self.max_steps
        self._over = terminated or truncated
        info = self._info(row)
        info["injured"] = step.injured or step.spared_voxels > 0
        return observation, float(self.reward(step)), terminated, truncated, info

    def _observe(self, row: Any) -> dict[str, np.ndarray]:
        proxy = row["proxy_m"]
        near = np.array([distance.at(proxy) for distance in self.task.near], np.float32)
        seen: dict[str, np.ndarray] = {}
        if self.patch:
            seen["patch"] = self.session.patch(edge=PATCH)
        if self.image is not None:
            seen["image"] = self.session.picture(width=self.image[0], height=self.image[1])
        return {**seen, "pose": np.concatenate((row["hand_m"], row["hand_q"])).astype(np.float32),
                "velocity": row["hand_v_m_per_s"].astype(np.float32), "force": row["force_n"].astype(np.float32),
                "torque": row["torque_nm"].astype(np.float32), "near": np.minimum(near, np.float32(1e-3 * REACH_MM))}

    def _info(self, row: Any) -> dict[str, Any]:
        return {"tick": int(row["tick"]), "removed_mm3": 1e9 * float(row["removed_m3"]), "hash": int(row["hash"])}


class Many:
    """n environments of one scene, stepped in threads of this process. An episode that is over begins anew in the next step."""

    def __init__(self, scene: burr.Scene | Task, n: int, *, threads: int = 1, **options: Any):
        if options.get("image") is not None:
            raise burr.Error("pictures are drawn on Python's main thread alone, and Many steps in others; leave out image")
        task = scene if isinstance(scene, Task) else Task(scene)
        self.envs = [Env(task, **options) for _ in range(n)]
        self.num_envs = n
        self.single_action_space, self.single_observation_space = self.envs[0].action_space, self.envs[0].observation_space
        self._pool = concurrent.futures.ThreadPoolExecutor(max(1, threads))

    def reset(self, *, seed: int | Sequence[int] | None = None) -> tuple[dict[str, np.ndarray], list[dict[str, Any]]]:
        """seed: a number s gives environment k the seed s + k."""
        seeds = [None if seed is None else seed + k if isinstance(seed, int) else seed[k] for k in range(self.num_envs)]
        made = list(self._pool.map(lambda pair: pair[0].reset(seed=pair[1]), zip(self.envs, seeds)))
        return _stacked([one[0] for one in made]), [one[1] for one in made]

    def step(self, actions: Any) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        actions = list(actions)
        if len(actions) != self.num_envs:
            raise burr.Error(f"{len(actions)} actions were given for {self.num_envs} environments; none of them moved")
        for number, (env, action) in enumerate(zip(self.envs, actions)):  # all are good before one of them moves
            if not env._over:
                try:
                    env._wish(action)
                except burr.Error as refused:
                    raise burr.Error(f"environment {number}: {refused}; none of the environments moved") from None

        def one(pair: tuple[Env, Any]) -> Any:
            env, action = pair
            if env._over:
                observation, info = env.reset()
                return observation, 0.0, False, False, info
            return env.step(action)
        made = list(self._pool.map(one, zip(self.envs, actions)))
        return (_stacked([m[0] for m in made]), np.array([m[1] for m in made]), np.array([m[2] for m in made]),
                np.array([m[3] for m in made]), [m[4] for m in made])

    def close(self) -> None:
        self._pool.shutdown()
        for env in self.envs:
            env.close()


def _stacked(observations: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    return {name: np.stack([one[name] for one in observations]) for name in observations[0]}


def _product(a: Sequence[float], b: Sequence[float]) -> tuple[float, float, float, float]:
    """Of quaternions w x y z."""
    return (a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0])


def _turned(q: Sequence[float], x: float, y: float, z: float) -> tuple[float, float, float, float]:
    """q, turned further by a rotation vector of the world."""
    angle = math.sqrt(x * x + y * y + z * z)
    if angle < 1e-12:
        return tuple(q)  # type: ignore[return-value]
    s = math.sin(angle / 2) / angle
    r = _product((math.cos(angle / 2), s * x, s * y, s * z), q)
    length = math.sqrt(sum(part * part for part in r))
    return tuple(part / length for part in r)  # type: ignore[return-value]


def _leaning(into: np.ndarray) -> tuple[float, float, float, float]:
    """The handle out of the bone, 36 degrees aslant: a burr cuts with its side."""
    out = -into
    aside = np.cross(out, (1.0, 0, 0) if abs(out[0]) < 0.9 else (0, 1.0, 0))
    aside /= np.linalg.norm(aside)
    handle = math.cos(0.63) * out + math.sin(0.63) * aside
    # the shortest turn from +z to the handle
    axis = np.cross((0, 0, 1.0), handle)
    q = np.array([1 + handle[2], *axis])
    if np.linalg.norm(q) < 1e-9:
        q = np.array([0.0, 1.0, 0, 0])
    q /= np.linalg.norm(q)
    return tuple(float(part) for part in q)  # type: ignore[return-value]
