"""Custom laws: by the program (--law, verify law), compiled and as a function; and the observer of a session."""
import gc
import hashlib
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import burr

PROGRAM = os.environ["BURR_PROGRAM"]
LAWS = pathlib.Path(PROGRAM).parent / "laws"
MOTION = "phantom:block --motion pocket --burr-mm 4 --seconds 2 --json".split()


def twice(law):
    return 2 * law.stiffness_n_per_m * law.depth_m * law.normal


def run(state, *words):
    told = {**os.environ, "XDG_STATE_HOME": str(state)}
    told.pop("PYTHONPATH", None)
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, env=told)


class Case(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)

    def tearDown(self):
        self.place.cleanup()

    def session(self, law, record="", seconds=2, **more):
        scene = burr.Scene("phantom:block", burr_mm=4)
        scene.law = law
        file = str(self.folder / record) if record else ""
        return scene.session(burr.Hand.motion("pocket", seconds=seconds), record=file, **more)


class Program(Case):
    def test_a_law_is_recorded_by_its_hash(self):
        file = self.folder / "s.mcap"
        done = run(self.folder, "mill", *MOTION, "--law", LAWS / "twice.so", "--record", file)
        self.assertEqual(done.returncode, 0, done.stderr)
        account = json.loads(done.stdout.splitlines()[-1])
        plain = json.loads(run(self.folder, "mill", *MOTION).stdout.splitlines()[-1])
        self.assertNotEqual(account["bone_hash"], plain["bone_hash"])
        words = burr.Recording(str(file)).info["words"]
        self.assertEqual(words["law_name"], "twice.so")
        self.assertEqual(words["law_sha256"], hashlib.sha256((LAWS / "twice.so").read_bytes()).hexdigest())

        same = run(self.folder, "replay", file, "--check", "--law", LAWS / "twice.so")
        self.assertEqual(same.returncode, 0, same.stderr)
        self.assertIn("the same to the bit: 2000 ticks", same.stdout)
        for words, sentence in ((["--law", LAWS / "pays.so"], "was made with another law"), ([], "give that file with --law")):
            other = run(self.folder, "replay", file, "--check", *words)
            self.assertEqual(other.returncode, 2, other.stderr)
            self.assertIn(sentence, other.stderr)

    def test_a_law_that_gives_no_numbers_is_said(self):
        done = run(self.folder, "mill", *MOTION, "--law", LAWS / "nan.so")
        self.assertEqual(done.returncode, 0, done.stderr)
        account = json.loads(done.stdout.splitlines()[-1])
        self.assertTrue(any("law of your own" in one for one in account["noted"]), account["noted"])
        self.assertEqual(account["removed_mm3"], 0)
        self.assertLessEqual(account["peak_force_N"], 1e-9)

    def test_real_time_only_after_its_trial(self):
        law = LAWS / "twice.so"
        paced = ["mill", *MOTION, "--realtime", "--law", law]
        refused = run(self.folder, *paced)
        self.assertEqual(refused.returncode, 2)
        self.assertIn(f"run `burr verify law {law}`", refused.stderr)
        tried = run(self.folder, "verify", "law", law, "--out", self.folder / "v", "--json")
        self.assertEqual(tried.returncode, 0, tried.stdout + tried.stderr)
        part = json.loads(tried.stdout.splitlines()[-1])["parts"][0]
        self.assertEqual(part["name"], "law")
        self.assertTrue((self.folder / "v" / "report.html").stat().st_size > 1000)
        self.assertEqual(run(self.folder, *paced).returncode, 0)
        self.assertEqual(run(self.folder / "another", *paced).returncode, 2)

    def test_a_trial_finds_what_is_wrong(self):
        for name, sentence in (("nan", "random.impossible"), ("crashes", "it crashed (signal 6"), ("shares", "same.new_state"),
                               ("pushes", "loop.touch.energy"), ("hangs", "it hung for more than 2 s")):
            tried = run(self.folder, "verify", "law", LAWS / f"{name}.so", "--longest", 2 if name == "hangs" else 300)
            self.assertEqual(tried.returncode, 1, (name, tried.stdout, tried.stderr))
            found = [line for line in (tried.stdout + tried.stderr).splitlines() if sentence in line]
            self.assertTrue(found and (found[0].endswith("FAIL") or name in ("crashes", "hangs")), (name, tried.stdout, tried.stderr))
            refused = run(self.folder, "mill", *MOTION, "--realtime", "--law", LAWS / f"{name}.so")
            self.assertEqual(refused.returncode, 2, name)
        none = run(self.folder, "verify", "law", LAWS / "is_none.so")
        self.assertEqual(none.returncode, 65)
        self.assertIn("no function burr_law_v1", none.stderr)


class Compiled(Case):
    def test_gives_the_bits_of_the_program(self):
        with self.session(LAWS / "twice.so", "s.mcap", rows=True) as session:
            session.step(2000)
            bone = session.bone().hash
        done = run(self.folder, "mill", *MOTION, "--law", LAWS / "twice.so")
        self.assertEqual(json.loads(done.stdout.splitlines()[-1])["bone_hash"], bone)
        recording = burr.Recording(str(self.folder / "s.mcap"))
        self.assertTrue(recording.replay(law=str(LAWS / "twice.so"))["same"])
        with self.assertRaisesRegex(burr.Error, "another law"):
            recording.replay(law=str(LAWS / "pays.so"))

    def test_pays_for_what_it_removes(self):
        with self.session(LAWS / "pays.so") as session:
            session.step(2000)
            rows = session.rows()
        self.assertGreater(rows["removed_m3"][-1], 0)
        paid = np.where(rows["law_state"] == 1, rows["law_energy_j"], 0).sum()
        self.assertLessEqual(rows["cutting_energy_j"][-1], paid * (1 + 1e-12))

    def test_says_what_is_wrong(self):
        for law, sentence in (("absent.so", "no such file"), (LAWS / "is_none.so", "no function burr_law_v1")):
            with self.assertRaisesRegex(burr.Error, sentence):
                self.session(law)


class Function(Case):
    def test_gives_the_bits_of_the_compiled_one_and_replays_without_python(self):
        hashes = []
        for law, name in ((twice, "f.mcap"), (LAWS / "twice.so", "c.mcap")):
            with self.session(law, name) as session:
                session.step(2000)
                rows = session.rows()
                hashes.append(rows["hash"])
        np.testing.assert_array_equal(*hashes)
        self.assertGreater((rows["law_state"] == 1).sum(), 500)
        done = run(self.folder, "replay", self.folder / "f.mcap", "--check")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("the same to the bit: 2000 ticks", done.stdout)
        refused = run(self.folder, "replay", self.folder / "f.mcap", "--check", "--law", LAWS / "twice.so")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("function of Python", refused.stderr)

    def test_may_return_what_the_page_says(self):
        def ticks(law):
            with self.session(law) as session:
                session.step(1500)
                return session.rows()

        plain = ticks(None)
        for same in (lambda law: None, lambda law: law.force_n, lambda law: (None, -1), lambda law: tuple(law.force_n),
                     lambda law: (law.force_n, -1.0, 0.0)):
            np.testing.assert_array_equal(ticks(same)["force_n"], plain["force_n"])
        nothing = ticks(lambda law: (None, 0.0))
        self.assertGreater(plain["removed_m3"][-1], 0)
        self.assertEqual(nothing["removed_m3"][-1], 0)

    def test_that_raises_ends_the_step(self):
        calls = []

        def law(now):
            calls.append(now.depth_m)
            if len(calls) == 900:
                raise ValueError("no idea")

        session = self.session(law)
        with self.assertRaisesRegex(ValueError, "no idea"):
            session.step(2000)
        self.assertLess(session.ticks, 1100)
        session.step(500)  # goes on without a force
        self.assertEqual(len(calls), 900)
        self.assertEqual(np.abs(session.rows()["force_n"][-100:]).max(), 0)
        self.assertTrue(any("law of your own" in one for one in session.outcome()["noted"]))
        for wrong in ((lambda law: 3), (lambda law: (1, 2)), (lambda law: "force")):
            with self.assertRaises((TypeError, ValueError)):
                self.session(wrong).step(50)

    def test_is_let_go(self):
        class Law:
            def __call__(self, now):
                return None

        import weakref
        law = Law()
        seen = weakref.ref(law)
        session = self.session(law)
        session.step(10)
        del law, session
        gc.collect()
        self.assertIsNone(seen())


class Observer(Case):
    def test_sees_every_row_once_and_wishes_are_recorded(self):
        batches, asked = [], []
        with self.session(None, "s.mcap") as session:
            def watch(rows):
                batches.append(rows)
                if rows["removed_m3"][-1] > 1e-11 and not asked:
                    asked.append(int(rows["tick"][-1]))
                    session.set_stiffness_n_per_m(500)
                    session.set_rpm(20000)

            session.observe(watch, every_ms=20)
            for ticks in (7, 493, 1000, 500):
                session.step(ticks)
            rows = session.rows()
        np.testing.assert_array_equal(np.concatenate(batches), rows)
        self.assertEqual({len(one) for one in batches}, {20})
        self.assertEqual(len(rows), 2000)
        recording = burr.Recording(str(self.folder / "s.mcap"))
        self.assertEqual([one["tick"] for one in recording.commands()], [asked[0] + 1] * 2)
        self.assertTrue(recording.replay()["same"])

    def test_changes_nothing_by_itself_and_is_bound_to_wishes(self):
        def hashes(observer, **more):
            with self.session(None, **more) as session:
                session.observe(observer)
                session.step(1000)
                return session.bone().hash

        self.assertEqual(hashes(lambda rows: None), hashes(None))
        self.assertEqual(hashes(lambda rows: None, rows=False), hashes(None))
        session = self.session(None)
        session.observe(lambda rows: session.step(1))
        with self.assertRaisesRegex(burr.Error, "in use"):
            session.step(100)
        session.observe(None)
        session.step(100)
        with self.assertRaisesRegex(burr.Error, "every_ms"):
            session.observe(lambda rows: None, every_ms=0)

    def test_an_error_in_it_ends_the_step(self):
        session = self.session(None)

        def watch(rows):
            raise RuntimeError("enough")

        session.observe(watch, every_ms=50)
        with self.assertRaisesRegex(RuntimeError, "enough"):
            session.step(1000)
        self.assertEqual(session.ticks, 50)
        self.assertEqual(len(session.rows()), 50)


if __name__ == "__main__":
    unittest.main()
