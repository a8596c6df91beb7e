"""A scene becomes the file of a case and back, byte-equal; the program runs the file with the hash that Python gives."""
import json
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import burr

BURR = os.environ["BURR_PROGRAM"]
TOOLS = """
[[tool]]
name = "own-bur"
title = "A custom bur"
source = "a test"
drive = "turning"
rpm = 31000
teeth = 6

[[tool.part]]
shape = "cylinder"
role = "cuts"
diameter_mm = 2.3
length_mm = 5
edge_mm = 0.3

[[tool]]
name = "other-bur"
title = "Another one"
drive = "turning"
rpm = 20000
[[tool.part]]
shape = "ball"
role = "cuts"
diameter_mm = 2.5
"""


def slab(edge=48, voxel_mm=0.25):
    depth = (edge / 2 - 0.5) - np.arange(edge)
    column = np.clip(32768 + depth * 16384, 0, 65535).astype(np.uint16)
    field = np.broadcast_to(column[:, None, None], (edge, edge, edge)).copy()
    middle = -voxel_mm * (edge - 1) / 2
    labels = np.ones((edge, edge, edge), np.uint8)
    labels[:10] = 2
    tissues = [burr.Tissue("air", kind="air"), burr.Tissue("bone", cutting_energy_j_m3=0.7e9), burr.Tissue("deep bone", spare=True)]
    return burr.Bone.from_array(field, voxel_mm, origin_mm=(middle,) * 3, labels=labels, tissues=tissues)


def hash_of(scene, seconds, motion="pocket"):
    session = scene.session(burr.Hand.motion(motion, seconds=seconds), rows=False, voxels=False)
    session.step(round(scene.rate_hz * seconds))
    assert session.outcome()["removed_mm3"] > 0
    return session.bone().hash


class SceneFile(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)

    def tearDown(self):
        self.place.cleanup()

    def mill(self, file, seconds=2):
        done = subprocess.run([BURR, "--quiet", "mill", str(file), "--motion", "pocket", "--seconds", str(seconds), "--json"],
                              capture_output=True, text=True, check=True)
        return json.loads(done.stdout.splitlines()[-1])["bone_hash"]

    def check(self, scene, seconds=2):
        """The file is the scene: its text, its settings, its hash here and in the program."""
        file = self.folder / "mine.toml"
        scene.save(str(file), force=True)
        text = file.read_text()
        again = burr.Scene(str(file))
        self.assertEqual(again.to_toml(folder=str(self.folder)), text)
        third = burr.Scene.from_toml(text, name="mine", folder=str(self.folder))
        self.assertEqual(third.to_toml(folder=str(self.folder)), text)
        again.save(str(file), force=True)
        self.assertEqual(file.read_text(), text)
        self.assertEqual(again.bone.hash, scene.bone.hash)
        here = hash_of(scene, seconds)
        self.assertEqual(hash_of(again, seconds), here)
        self.assertEqual(self.mill(file, seconds), here)
        return file, text

    def test_an_array_with_all_settings(self):
        # numbers that do not survive a way through metres and radians
        scene = burr.Scene(slab(), burr_mm=4.9, rpm=23456.7)
        scene.stiffness_n_per_m, scene.drag, scene.torque_mnm, scene.vibration = 777.7, 0.3, 13.1, 0.1
        scene.rate_hz, scene.touch, scene.removal, scene.teeth = 900, "shaft", "chips", 7
        scene.guarded, scene.irrigated, scene.undo_bricks = True, True, 500
        scene.title, scene.seconds = 'Mine "and" yours', 3
        file, text = self.check(scene)
        self.assertTrue((self.folder / "mine.bone").exists())
        again = burr.Scene(str(file))
        for name in ("burr_mm", "rpm", "rate_hz", "stiffness_n_per_m", "touch", "removal", "drag", "vibration", "torque_mnm", "guarded",
                     "irrigated", "undo_bricks", "teeth", "diamond", "tool", "title", "motion", "seconds"):
            self.assertEqual(getattr(again, name), getattr(scene, name), name)
        self.assertIn("diameter_mm = 4.9\n", text)
        self.assertIn("rpm = 23456.7\n", text)
        self.assertEqual(again.spare, ["deep bone"])  # what the tissues say goes with the bone
        # each setting counts: without it the hash is another one
        self.assertNotEqual(hash_of(burr.Scene(slab(), burr_mm=4.9, rpm=23456.7), 2), hash_of(again, 2))

    def test_a_phantom(self):
        # 1000 turns and 6.5 mm lose their last bit on the way through rad/s and the radius
        scene = burr.Scene("phantom:block", burr_mm=6.5, rpm=1000, voxel_mm=0.45)
        file, text = self.check(scene)
        self.assertIn('phantom = "block"\n', text)
        self.assertIn("voxel_mm = 0.45\n", text)
        self.assertIn("diameter_mm = 6.5\n", text)
        self.assertFalse((self.folder / "mine.bone").exists())
        self.assertEqual(scene.to_toml(), text)

    def test_a_case_keeps_what_it_teaches(self):
        scene = burr.Scene("tooth", voxel_mm=0.2)
        scene.stiffness_n_per_m = 600
        file, text = self.check(scene, 1)
        self.assertIn("[[step]]", text)
        self.assertRegex(text, 'title = {.*de = ".*sv = "')  # in all languages
        again = burr.Scene(str(file))
        self.assertEqual((again.targets, again.spare, again.title), (scene.targets, scene.spare, scene.title))
        np.testing.assert_array_equal(again.at_m, scene.at_m)
        subprocess.run([BURR, "--quiet", "case", "check", str(file)], check=True, capture_output=True)

    def test_a_case_on_a_bone_of_ones_own(self):
        tooth = burr.Scene("tooth", voxel_mm=0.3)
        session = tooth.session(burr.Hand.motion("pocket", seconds=1))
        session.step(1000)
        scene = burr.Scene(session.bone(), case="tooth")
        with self.assertRaisesRegex(burr.Error, r"save\(\)"):
            scene.to_toml()
        file, text = self.check(scene, 1)
        self.assertIn('volume = "mine.bone"', text)
        self.assertEqual(burr.Bone.load(str(self.folder / "mine.bone")).hash, session.bone().hash)

    def test_a_tool_of_ones_own(self):
        tools = self.folder / "tools.toml"
        tools.write_text(TOOLS)
        scene = burr.Scene(slab(), tool="own-bur", tools=str(tools))
        file, text = self.check(scene)
        self.assertIn("[[own_tool]]", text)
        self.assertNotIn("other-bur", text)
        tools.unlink()  # the definition is in the case
        again = burr.Scene(str(file))
        self.assertEqual((again.tool, again.tools), ("own-bur", ""))
        self.assertEqual(self.mill(file), hash_of(again, 2))
        self.assertNotEqual(hash_of(again, 2), hash_of(burr.Scene(slab()), 2))

    def test_the_program_runs_it_without_a_display(self):
        scene = burr.Scene(slab(), burr_mm=4.9, rpm=23456.7)
        scene.stiffness_n_per_m, scene.motion, scene.seconds = 900, "slot", 2
        file = self.folder / "mine.toml"
        scene.save(str(file))
        out = self.folder / "out"
        subprocess.run([BURR, "--quiet", "run", str(file), "--headless", "--out", str(out)], check=True, capture_output=True)
        recording = burr.Recording(str(out / "session.mcap"))
        self.assertEqual(recording.case, "mine")
        self.assertEqual(recording.bone().hash, hash_of(scene, 2, "slot"))
        self.assertTrue(recording.replay()["same"])

    def test_a_recording_of_it_is_of_its_case(self):
        scene = burr.Scene(slab(), burr_mm=4)
        scene.save(str(self.folder / "mine.toml"))
        again = burr.Scene(str(self.folder / "mine.toml"))
        with again.session(burr.Hand.motion("pocket", seconds=1), record=str(self.folder / "s.mcap")) as session:
            session.step(1000)
        recording = burr.Recording(str(self.folder / "s.mcap"), volume=str(self.folder / "mine.bone"))
        self.assertEqual((recording.case, recording.bone().hash), ("mine", session.bone().hash))
        self.assertTrue(recording.replay()["same"])

    def test_what_cannot_be_a_case_is_refused_with_a_sentence(self):
        scene = burr.Scene(slab(), burr_mm=4)
        scene.save(str(self.folder / "mine.toml"))
        for call, words in [(lambda: scene.save(str(self.folder / "mine.toml")), "force=True"),
                            (lambda: scene.save(str(self.folder / "mine.json")), "must end in .toml"),
                            (lambda: scene.to_toml(), "comes from an array"),
                            (lambda: burr.Scene.from_toml("title = 3"), "scene.toml: line 1: title"),
                            (lambda: burr.Bone.load(str(self.folder / "mine.bone"), voxel_mm=0.5), "holds a bone as it is"),
                            (lambda: burr.Bone.load(str(self.folder / "no.bone")), "no.bone: cannot read")]:
            with self.assertRaises(burr.Error) as raised:
                call()
            self.assertIn(words, str(raised.exception))
        scene.rpm = -5000
        with self.assertRaisesRegex(burr.Error, "rpm"):
            scene.save(str(self.folder / "other.toml"))
        scene.rpm, scene.rate_hz = 40000, 20
        with self.assertRaisesRegex(burr.Error, "rate_hz: must be a number from 500 to 10000"):
            scene.save(str(self.folder / "third.toml"))
        self.assertEqual(sorted(file.name for file in self.folder.iterdir()), ["mine.bone", "mine.toml"])
        (self.folder / "mine.bone").write_bytes((self.folder / "mine.bone").read_bytes()[:-40])
        with self.assertRaisesRegex(burr.Error, "mine.bone"):
            burr.Scene(str(self.folder / "mine.toml"))

    def test_a_wrong_session_in_a_file(self):
        good = burr.Scene("phantom:block", burr_mm=4).to_toml()
        for old, new, words in [('touch = "constraint"', 'touch = "fingers"', 'session.touch: must be one of constraint, '),
                                ('removal = "energy"', 'removal = "wish"', 'session.removal: must be one of energy, thesis, chips, not "wish"'),
                                ("drag = 1.0", "drag = 11", "session.drag: must be a number from 0 to 10, not 11"),
                                ("drag = 1.0", "drags = 1", "session.drags: is not a known field"),
                                ("teeth = 12", "teeth = 2.5", "session.teeth: must be a whole number from 1 to 64, not 2.5")]:
            self.assertIn(old.split(" ")[0], good)
            line = next(line for line in good.splitlines() if line.startswith(old.split(" ")[0] + " "))
            bad = good.replace(line, new)
            with self.assertRaises(burr.Error) as raised:
                burr.Scene.from_toml(bad)
            self.assertIn(words, str(raised.exception))
            file = self.folder / "bad.toml"
            file.write_text(bad)
            done = subprocess.run([BURR, "--quiet", "mill", str(file), "--motion", "pocket"], capture_output=True, text=True, check=False)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(words, done.stderr)

    def test_what_a_mode_allows_is_that_of_the_window(self):
        scene = burr.Scene("block", voxel_mm=1, burr_mm=6)
        known = {mode: scene.allowed(mode) for mode in ("free", "learn", "practise", "exam")}  # the table of docs/use/window_steps.md
        self.assertEqual([one["tone_below_mm"] for one in known.values()], [5, 5, 1, 0])
        self.assertEqual([one["distance"] for one in known.values()], [True, True, False, False])
        self.assertEqual([one["injury"] for one in known.values()], ["sound", "stop", "sound", "silent"])
        narrowed = burr.Scene.from_toml(scene.to_toml() + '\n[feedback]\nlearn = ["step"]\n')
        self.assertFalse(narrowed.allowed("learn")["distance"])
        with self.assertRaisesRegex(burr.Error, "free, learn, practise or exam"):
            scene.allowed("play")

    def test_an_option_goes_before_the_file(self):
        scene = burr.Scene("phantom:block", burr_mm=4)
        scene.stiffness_n_per_m = 500
        file = self.folder / "mine.toml"
        scene.save(str(file))
        done = subprocess.run([BURR, "--quiet", "mill", str(file), "--motion", "pocket", "--seconds", "2", "--stiffness", "1200", "--json"],
                              capture_output=True, text=True, check=True)
        scene.stiffness_n_per_m = 1200
        self.assertEqual(json.loads(done.stdout.splitlines()[-1])["bone_hash"], hash_of(scene, 2))
        self.assertTrue(math.isfinite(scene.stiffness_n_per_m))


if __name__ == "__main__":
    unittest.main()
