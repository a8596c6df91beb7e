"""Reports and pictures are those of the program; and pictures of sessions."""
import os
import pathlib
import subprocess
import tempfile
import unittest
import unittest.mock

import numpy as np

import burr
import burr.program

BURR = os.environ["BURR_PROGRAM"]


class Program(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.place.name)
        cls.file = str(cls.folder / "s.mcap")
        cls.scene = burr.Scene("tooth", voxel_mm=0.2)
        with cls.scene.session(burr.Hand.motion("pocket", seconds=2), record=cls.file) as session:
            session.step(2000)
            cls.after = session.picture(width=160, height=120)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def by_hand(self, *arguments):
        subprocess.run([BURR, "--quiet", *map(str, arguments)], check=True, capture_output=True)

    def test_a_report_is_that_of_the_program(self):
        mine, theirs = self.folder / "mine.html", self.folder / "theirs.html"
        recording = burr.Recording(self.file)
        recording.report(str(mine), pictures=0, language="sv")
        self.by_hand("report", self.file, "--out", theirs, "--pictures", 0, "--language", "sv")
        self.assertEqual(mine.read_bytes(), theirs.read_bytes())
        self.assertGreater(len(mine.read_bytes()), 5000)
        with self.assertRaisesRegex(burr.Error, "html"):
            recording.report(str(self.folder / "mine.doc"))
        with self.assertRaisesRegex(burr.Error, "klingon.*en, "):
            recording.report(str(mine), language="klingon")
        with self.assertRaisesRegex(burr.Error, "0 to 100"):
            recording.report(str(mine), pictures=101)
        with self.assertRaisesRegex(burr.Error, "no-such-rubric"):
            recording.report(str(self.folder / "other.html"), rubric="no-such-rubric")

    def test_a_picture_is_that_of_the_program(self):
        mine, theirs = self.folder / "mine.png", self.folder / "theirs.png"
        burr.Recording(self.file).picture(str(mine), t=1.5, width=160, height=120, effects=True)
        self.by_hand("replay", self.file, "--picture", theirs, "--at", 1.5, "--picture-size", "160,120", "--effects")
        self.assertEqual(mine.read_bytes(), theirs.read_bytes())

    def test_a_picture_of_a_session(self):
        self.assertEqual((self.after.shape, self.after.dtype), ((120, 160, 3), np.dtype(np.uint8)))
        self.assertGreater(self.after.std(), 5)
        session = self.scene.session(burr.Hand.motion("pocket", seconds=2))
        before = session.picture(str(self.folder / "before.png"), width=160, height=120)
        self.assertEqual((self.folder / "before.png").read_bytes()[:4], b"\x89PNG")
        self.assertTrue((before != self.after).any())
        for _ in range(20):
            session.step(100)
            drawn = session.picture(width=160, height=120)
        np.testing.assert_array_equal(drawn, self.after)

    def test_a_picture_shows_what_was_cut(self):
        scene = burr.Scene("phantom:block", burr_mm=4, voxel_mm=0.5)
        lean, aside = (np.cos(0.5), np.sin(0.5), 0, 0), np.cross(scene.into, (0, 1.0, 0))

        def picture(pedal, often):
            session = scene.session()
            session.hand(scene.at_m - 6e-3 * scene.into, lean, pedal, ticks=0)
            session.step(600)
            for n in range(12):
                session.hand(scene.at_m + (-1) ** n * 4e-3 * aside + (-1.5e-3 + 2e-4 * n) * scene.into, ticks=150)
                session.step(150)
                if often:
                    session.picture(width=160, height=120)
            session.hand(scene.at_m - 15e-3 * scene.into + 10e-3 * aside, ticks=200)  # out of the way
            session.step(200)
            return session.picture(width=160, height=120).astype(int), session.outcome()["removed_mm3"]
        groove, removed = picture(1, False)
        self.assertGreater(removed, 5)
        whole, nothing = picture(0, False)
        self.assertEqual(nothing, 0)
        self.assertGreater((np.abs(groove - whole).max(axis=2) > 10).sum(), 100)
        # a surface that is mended step by step is the one that is made at once
        np.testing.assert_array_equal(picture(1, True)[0], groove)

    def test_any_command(self):
        account = burr.program.run("mill", "phantom:block", "--burr-mm", 4, "--motion", "pocket", "--seconds", 1, "--json")
        session = burr.Scene("phantom:block", burr_mm=4).session(burr.Hand.motion("pocket", seconds=1))
        session.step(1000)
        self.assertEqual(account["bone_hash"], session.bone().hash)
        self.assertIsNone(burr.program.run("phantom", "tooth", "--landmarks"))
        with self.assertRaisesRegex(burr.Error, "no-such-case"):
            burr.program.run("mill", "no-such-case.toml", "--motion", "pocket")

    def test_the_program_is_found(self):
        self.assertEqual(burr.program.find(), BURR)
        with unittest.mock.patch.dict(os.environ):
            del os.environ["BURR_PROGRAM"]
            self.assertTrue(os.path.samefile(burr.program.find(), BURR))  # beside the build
        with unittest.mock.patch.dict(os.environ, BURR_PROGRAM="/no/such/program"), self.assertRaisesRegex(burr.Error, "cannot be run"):
            burr.program.run("info")


if __name__ == "__main__":
    unittest.main()
