"""burr.env: shapes, bounds, seeds, ends, and many environments at once."""
import threading
import unittest

import numpy as np

import burr
import burr.env

LEAST = {"max_steps": 40, "ticks": 20}


def block(**more):
    """A plate of bone with a soft nerve 1 mm below its surface."""
    edge = 40
    depth = (edge / 2 - 0.5) - np.arange(edge)
    field = np.ascontiguousarray(np.broadcast_to(np.clip(32768 + depth * 16384, 0, 65535).astype(np.uint16)[:, None, None], (edge,) * 3))
    labels = np.ones((edge,) * 3, np.uint8)
    labels[14:17, :, 18:22] = 2
    field[14:17, :, 18:22] = 0
    tissues = [burr.Tissue("air", kind="air"), burr.Tissue("bone"), burr.Tissue("nerve", kind="soft", spare=True)]
    scene = burr.Scene(burr.Bone.from_array(field, 0.25, labels=labels, tissues=tissues, origin_mm=(-4.875,) * 3), burr_mm=3)
    scene.undo_bricks = 256
    return burr.env.Task(scene)


def down(env):
    """Towards the bone, with the pedal."""
    return np.array([*(0.5e-3 * env.task.into), 0, 0, 0, 1], np.float32)


class Environment(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.task = block()

    def test_shapes_and_bounds(self):
        env = burr.env.Env(self.task, **LEAST)
        observation, info = env.reset(seed=3)
        self.assertTrue(env.observation_space.contains(observation))
        self.assertEqual({name: (one.shape, one.dtype) for name, one in observation.items()},
                         {name: (size, np.dtype(np.float32)) for name, size in
                          [("pose", (7,)), ("velocity", (3,)), ("force", (3,)), ("torque", (3,)), ("near", (1,))]})
        env.action_space.seed(1)
        for _ in range(10):
            action = env.action_space.sample()
            self.assertTrue(env.action_space.contains(action))
            observation, reward, terminated, truncated, info = env.step(action)
            self.assertTrue(env.observation_space.contains(observation))
            self.assertIsInstance(reward, float)
            self.assertIsInstance(terminated, bool)
            self.assertIsInstance(truncated, bool)
        self.assertEqual(info["tick"], burr.env.RAMP_TICKS + 10 * env.ticks - 1)
        before = observation["pose"][:3]
        observation, *_ = env.step(np.full(7, 1e3))  # held to its bounds
        np.testing.assert_allclose(observation["pose"][:3] - before, 0.5e-3, atol=1e-6)

    def test_a_refused_action_changes_nothing(self):
        env, other = burr.env.Env(self.task, **LEAST), burr.env.Env(self.task, **LEAST)
        env.reset(seed=5)
        other.reset(seed=5)
        for step in range(12):
            if step % 3 == 1:
                for bad in (np.full(7, np.nan), [0, 0, np.inf, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, np.nan], np.zeros(6), "down", None, [[1, 2], [3]]):
                    with self.assertRaisesRegex(burr.Error, "this episode is as before the step"):
                        env.step(bad)
            mine, theirs = env.step(down(env)), other.step(down(other))
            for name in mine[0]:
                np.testing.assert_array_equal(mine[0][name], theirs[0][name])
            self.assertEqual(mine[1:], theirs[1:])  # reward, ends, tick, what was removed, hash
        self.assertGreater(mine[4]["removed_mm3"], 0)
        while not (mine[2] or mine[3]):
            mine = env.step(down(env))
        with self.assertRaisesRegex(burr.Error, "this episode is over"):
            env.step(np.full(7, np.nan))

    def test_of_many_none_moves_if_one_is_refused(self):
        many, alone = burr.env.Many(self.task, 3, **LEAST), burr.env.Many(self.task, 3, **LEAST)
        many.reset(seed=8)
        alone.reset(seed=8)
        good = np.stack([down(one) for one in many.envs])
        bad = good.copy()
        bad[2, 0] = np.nan
        with self.assertRaisesRegex(burr.Error, "environment 2: .*none of the environments moved"):
            many.step(bad)
        with self.assertRaisesRegex(burr.Error, "2 actions were given for 3"):
            many.step(good[:2])
        mine, theirs = many.step(good), alone.step(good)
        for name in mine[0]:
            np.testing.assert_array_equal(mine[0][name], theirs[0][name])
        self.assertEqual(mine[4], theirs[4])
        many.close()
        alone.close()

    def test_a_seed_is_an_episode(self):
        def episode(env, seed):
            env.reset(seed=seed)
            random = np.random.default_rng(7)
            out = []
            for _ in range(100):
                action = random.uniform(env.action_space.low, env.action_space.high)
                action[:3] += 0.2e-3 * env.task.into
                observation, reward, terminated, truncated, info = env.step(action)
                out.append((info["hash"], reward, *observation["pose"].tolist(), *observation["near"].tolist()))
                if terminated or truncated:
                    break
            return out
        options = {"max_steps": 100, "end_on_injury": False}
        one, other = burr.env.Env(self.task, **options), burr.env.Env(self.task, **options)
        first = episode(one, 5)
        self.assertEqual(len(first), 100)
        self.assertGreater(one.session.outcome()["removed_mm3"], 0.01)
        different = episode(one, 6)
        self.assertNotEqual(different, first)
        self.assertEqual(episode(one, 5), first)  # after another episode
        self.assertEqual(episode(other, 5), first)  # of another environment

    def test_ends_and_what_comes_after(self):
        env = burr.env.Env(self.task, **LEAST)
        with self.assertRaisesRegex(burr.Error, "reset"):
            env.step(np.zeros(7))
        env.reset(seed=1)
        for n in range(40):
            *_, terminated, truncated, info = env.step(np.zeros(7))
            self.assertFalse(terminated)
            self.assertEqual(truncated, n == 39)
        with self.assertRaisesRegex(burr.Error, "reset"):
            env.step(np.zeros(7))
        env.reset()
        env.step(np.zeros(7))
        env.close()
        with self.assertRaises(burr.Error):
            env.step(np.zeros(7))

    def test_rewards(self):
        seen = []

        def reward(step):
            seen.append(step)
            return 7.0
        env = burr.env.Env(self.task, reward=reward, max_steps=400, spread_mm=0.0)
        env.reset(seed=1)
        injured = False
        while not injured:
            observation, got, terminated, truncated, info = env.step(down(env))
            self.assertEqual(got, 7.0)
            self.assertFalse(truncated)
            injured = terminated
        self.assertTrue(info["injured"] and seen[-1].injured)
        self.assertLess(observation["near"][0], 1.5e-3)  # the burr reaches into the nerve
        self.assertTrue(all(not step.injured for step in seen[:-1]))
        voxels = sum(step.removed for step in seen)
        before, after = env.task.scene.bone.field() >= 32768, env.session.bone().field() >= 32768
        self.assertEqual(voxels.tolist(), np.bincount(env.task.labels[before & ~after], minlength=3).tolist())
        self.assertGreater(voxels[1], 50)
        total = sum(step.target_mm3 for step in seen)
        self.assertAlmostEqual(total, voxels[1] * 0.25 ** 3)
        step = burr.env.Step(None, np.array([0, 64]), 1.0, 2, True, 5.0)
        self.assertAlmostEqual(burr.env.default_reward(step), 1 - 2000 - 1000 - 0.3 - 0.01)

    def test_a_patch_and_a_picture_can_be_observed(self):
        env = burr.env.Env(self.task, patch=True, image=(64, 48), render_mode="rgb_array", max_steps=60, end_on_injury=False)
        observation, _ = env.reset(seed=3)
        self.assertTrue(env.observation_space.contains(observation))
        self.assertEqual((observation["patch"].shape, observation["patch"].dtype), ((16, 16, 16), np.dtype(np.uint8)))
        self.assertEqual((observation["image"].shape, observation["image"].dtype), ((48, 64, 3), np.dtype(np.uint8)))
        first = observation["image"]
        self.assertGreater(first.std(), 5)  # there is something to see
        for _ in range(25):
            observation, *_ = env.step(down(env))
            self.assertTrue(env.observation_space.contains(observation))
        # the patch is the field round the burr, z y x
        bone, row = env.session.bone(), env.session.row
        field, (i, j, k) = bone.field() >> 8, np.rint(bone.index_from_world(row["proxy_m"])).astype(int) - 8
        mine = np.zeros((16, 16, 16), np.uint8)
        lo, hi = np.maximum((k, j, i), 0), np.minimum((k + 16, j + 16, i + 16), field.shape)
        inside = tuple(slice(a, b) for a, b in zip(lo, hi))
        mine[tuple(slice(a - o, b - o) for a, b, o in zip(lo, hi, (k, j, i)))] = field[inside]
        np.testing.assert_array_equal(observation["patch"], mine)
        self.assertGreater(len(np.unique(mine)), 3)
        self.assertTrue((observation["image"] != first).any())
        np.testing.assert_array_equal(env.session.picture(width=64, height=48), observation["image"])
        self.assertEqual(env.render().shape, (480, 640, 3))
        again, _ = env.reset(seed=3)
        np.testing.assert_array_equal(again["image"], first)  # the bone is whole again in the picture too
        self.assertTrue(env.observation_space["patch"].contains(env.observation_space["patch"].sample()))
        env.close()
        for call, words in [(lambda: burr.env.Env(self.task, render_mode="human"), "rgb_array"),
                            (lambda: burr.env.Many(self.task, 2, image=(64, 48)), "main thread")]:
            with self.assertRaisesRegex(burr.Error, words):
                call()
        many = burr.env.Many(self.task, 2, threads=2, patch=True)
        self.assertEqual(many.reset(seed=1)[0]["patch"].shape, (2, 16, 16, 16))
        many.close()

    def test_pictures_are_for_the_main_thread(self):
        session = self.task.scene.session()
        refused = []

        def draw():
            try:
                session.picture()
            except burr.Error as error:
                refused.append(str(error))
        thread = threading.Thread(target=draw)
        thread.start()
        thread.join()
        self.assertIn("main thread", refused[0])
        # a session that was drawn may end on any thread
        kept = [session]
        first = session.picture(width=64, height=48)
        del session
        thread = threading.Thread(target=kept.clear)
        thread.start()
        thread.join()
        np.testing.assert_array_equal(self.task.scene.session().picture(width=64, height=48), first)

    def test_many_are_as_one(self):
        many = burr.env.Many(self.task, 3, threads=2, max_steps=12)
        single = burr.env.Env(self.task, max_steps=12)
        observation, _ = many.reset(seed=10)
        self.assertEqual(observation["pose"].shape, (3, 7))
        alone, _ = single.reset(seed=11)
        np.testing.assert_array_equal(observation["pose"][1], alone["pose"])
        action = down(single)
        for n in range(12):
            observation, rewards, terminated, truncated, infos = many.step([action] * 3)
            alone, reward, *_ = single.step(action)
            np.testing.assert_array_equal(observation["force"][1], alone["force"])
            self.assertEqual(rewards[1], reward)
        self.assertTrue(truncated.all())
        observation, rewards, terminated, truncated, infos = many.step([action] * 3)  # begins anew
        self.assertFalse(truncated.any())
        self.assertEqual({info["tick"] for info in infos}, {burr.env.RAMP_TICKS - 1})
        many.close()

    def test_a_case_has_targets(self):
        env = burr.env.Env(burr.Scene("tooth", voxel_mm=0.3), max_steps=5)
        self.assertTrue(env.task.done_mm3)
        self.assertIn("pulp", env.task.structures)
        env.reset(seed=1)
        env.step(down(env))


if __name__ == "__main__":
    unittest.main()
