#!/usr/bin/env python3
"""reported_test.py BURR COMPILER - the inputs that people had trouble with, third round, as their user gives them to burr:
each row of the table in ../shared/data/reports3/README.md, but for the window (window.pointer has it, by real X events)
and the slide of a flat edge (docs/status.md says what is not met).

The bone of the scans is a ball and a block beside it: 960.5 mm3 at 300 HU, by marching cubes of another program.
Exit code 77: the inputs are not here.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BURR = pathlib.Path(sys.argv[1]).resolve()
COMPILER = sys.argv[2] if len(sys.argv) > 2 else "cc"
REPORTS = pathlib.Path(__file__).resolve().parents[3] / "shared/data/reports3"
TRUE_MM3 = 960.5
NEAR = 0.005  # of a volume: half a voxel's rounding at the surface is 0.2 %


class Answer:
    def __init__(self, done):
        self.code, self.said = done.returncode, done.stdout + done.stderr
        self.json = None
        for line in done.stdout.splitlines():
            if line.startswith("{"):
                self.json = json.loads(line)


def burr(*words, **environment):
    return Answer(subprocess.run([BURR, "--quiet", *map(str, words)], capture_output=True, text=True, timeout=120,
                                 env=os.environ | environment))


def info(name):
    return burr("info", REPORTS / name, "--json")


class Reported(unittest.TestCase):
    def bone(self, name, mm3=TRUE_MM3, parts=2):
        answer = info(name)
        self.assertEqual(answer.code, 0, answer.said)
        self.assertIsNotNone(answer.json["bone"], answer.said)
        found = answer.json["bone"]["parts"]
        self.assertAlmostEqual(found["mm3"], mm3, delta=NEAR * mm3, msg=f"{name}: {answer.said}")
        self.assertEqual(found["count"], parts, name)
        return answer

    def refused(self, name, *words):
        """`info` says why, and `mill` does not begin."""
        answer = info(name)
        self.assertIsNone(answer.json["bone"], answer.said)
        milled = burr("mill", REPORTS / name, "--motion", "touch", "--seconds", "1", "--json")
        self.assertNotEqual(milled.code, 0, milled.said)
        for text in (answer.said, milled.said):
            for word in words:
                self.assertIn(word, text, name)

    def test_no_ghost_of_a_bone(self):
        for name in ("ball_and_plate_a.nrrd", "ball_and_plate_b.nrrd", "oblique.zip"):
            answer = info(f"X1_ghost_bone/{name}")
            self.assertEqual(answer.json["bone"]["parts"]["count"], 2, answer.said)
        felt = burr("mill", REPORTS / "X1_ghost_bone/oblique.zip", "--path", REPORTS / "X1_ghost_bone/path_in_soft_tissue.csv",
                    "--burr-mm", 2, "--arm", "rigid", "--json")
        self.assertEqual(felt.code, 0, felt.said)
        self.assertEqual((felt.json["peak_force_N"], felt.json["removed_mm3"]), (0, 0), "a hand in soft tissue, 3 mm from bone")

    def test_an_inverted_picture(self):
        self.assertIn("inverted", self.bone("X2_mono1/inverted.zip").said)
        self.assertEqual(self.bone("X2_mono1/hu_control.zip").json["notices"], [])

    def test_pictures_that_are_not_there(self):
        self.refused("X3_absent/dicomdir", "lists 56 pictures", "22 of them are not here", "--allow-missing")
        self.refused("X3_absent/images_in_acquisition.zip", "has 56 pictures", "34 are here", "--allow-missing")
        self.refused("X3_absent/concatenation_without_first.zip", "1 of 3 parts", "--allow-missing")

    def test_two_places_in_one_file(self):
        for name in ("mirrored", "twice_as_large"):
            self.refused(f"X4_qform_sform/sform_{name}.nii.gz", "sform", "qform", "--as-it-is")
        moved = self.bone("X4_qform_sform/sform_moved.nii.gz").said
        self.assertIn("sform", moved)
        self.assertIn("qform", moved)
        self.assertNotIn("form", "".join(self.bone("X4_qform_sform/same.nii.gz").json["notices"]))

    def test_values_that_a_window_cut_off(self):
        for name, mm3 in (("w_m200_1300", 960.5), ("w_m200_1300_bone1400", 1068.8), ("w_m160_240", None)):
            answer = info(f"X5_clipped_values/{name}.nii.gz")
            bone = answer.json["bone"]
            right = mm3 and bone and abs(bone["parts"]["mm3"] - mm3) <= 2 * NEAR * mm3
            unsure = bone and bone.get("iso_sure") == "low" and re.search("cut off|pile|end of", answer.said)
            self.assertTrue(right or unsure or (not mm3 and not bone), f"{name}: {answer.said}")

    def test_what_is_no_ct(self):
        self.refused("X6_not_ct/mr_t1.zip", "MR", "bone is dark", "segment")
        self.refused("X6_not_ct/rtdose.zip", "RTDOSE", "dose")

    def test_sentences_about_a_path(self):
        def along(name):
            return burr("mill", "phantom:block", "--tool", "lindemann", "--path", REPORTS / name, "--arm", "rigid", "--json")
        inside = along("lindemann_begins_inside.csv")
        self.assertEqual((inside.code, inside.json["peak_force_N"]), (0, 0), inside.said)
        self.assertIn("inside the bone at the first point", " ".join(inside.json["noted"]))
        touches = along("lindemann_touches.csv")
        self.assertGreater(touches.json["peak_force_N"], 0.1)
        self.assertGreater(touches.json["removed_mm3"], 0.001)
        self.assertEqual(touches.json["noted"], [], "no sentence says that nothing is touched")

    def test_a_file_system_without_locks(self):
        with tempfile.TemporaryDirectory() as place:
            shim = f"{place}/no_locks.so"
            subprocess.run([COMPILER, "-shared", "-fPIC", "-o", shim, REPORTS / "no_locks.c", "-ldl"], check=True)
            for number in ("37", "38", "95"):
                file = f"{place}/{number}.mcap"
                done = burr("mill", "phantom:block", "--voxel-mm", 0.5, "--motion", "pocket", "--seconds", 1, "--record", file,
                            "--json", NO_LOCKS_ERRNO=number, LD_PRELOAD=shim)
                self.assertEqual(done.code, 0, done.said)
                self.assertEqual(done.said.count("has no locks"), 1, done.said)
                again = burr("replay", file, "--check")
                self.assertEqual(again.code, 0, again.said)

    def test_recordings_of_other_writers(self):
        for name in ("channel_zero", "schemas_in_chunks"):
            file = REPORTS / f"{name}.mcap"
            again = burr("replay", file, "--check", "--json")
            self.assertEqual(again.code, 0, again.said)
            self.assertEqual(again.json["ticks"], 1000, again.said)
            with tempfile.TemporaryDirectory() as place:
                mended = burr("repair", file, "--out", f"{place}/again.mcap")
                self.assertEqual(mended.code, 0, mended.said)
                self.assertIn("complete", mended.said)
                kept = burr("replay", f"{place}/again.mcap", "--check", "--json") if pathlib.Path(f"{place}/again.mcap").exists() else again
                self.assertEqual((kept.code, kept.json["ticks"]), (0, 1000), kept.said)


if __name__ == "__main__":
    if not REPORTS.exists():
        print(f"skipped: {REPORTS} is not here")
        sys.exit(1 if os.environ.get("BURR_REQUIRE_DATA") == "1" else 77)
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[3:]])
