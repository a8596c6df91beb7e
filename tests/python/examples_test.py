"""Every script in python/examples runs, and does what it says."""
import csv
import importlib.util
import os
import pathlib
import tempfile
import unittest

import numpy as np

import burr.program

EXAMPLES = pathlib.Path(os.environ["BURR_CHECKOUT"]) / "python" / "examples"


def module(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    made = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


def script(name):
    return module(name).main


class Examples(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)

    def tearDown(self):
        self.place.cleanup()

    def test_all_are_here(self):
        self.assertEqual({file.stem for file in EXAMPLES.glob("*.py")},
                         {"load_and_cut", "dataset", "learn", "clone", "psychophysics", "score_study", "own_law"})

    def test_load_and_cut(self):
        rows = script("load_and_cut")(out=self.folder)
        self.assertGreater(rows["removed_m3"][-1], 1e-9)
        self.assertGreater((self.folder / "removed.stl").stat().st_size, 1000)
        np.testing.assert_array_equal(np.load(self.folder / "ticks.npy"), rows)

    def test_dataset(self):
        table = script("dataset")(self.folder / "a", 2, 2)
        again = script("dataset")(self.folder / "b", 2, 2)
        self.assertEqual(table, again)
        self.assertNotEqual(table[0]["bone_hash"], table[1]["bone_hash"])
        with open(self.folder / "a" / "sessions.csv") as file:
            self.assertEqual(len(list(csv.DictReader(file))), 2)
        with np.load(self.folder / "a" / "00001.npz") as data:
            self.assertEqual(len(data["rows"]), table[1]["ticks"])
            self.assertGreater(len(data["removed"]), 0)

    def test_own_law(self):
        built = pathlib.Path(os.environ["BURR_PROGRAM"]).parent / "laws" / "hardening.so"
        table = script("own_law")(built)
        plain, softer, harder = table["burr's own"], table["half as stiff"], table["compiled"]
        self.assertAlmostEqual(plain[0], 1000, delta=20)  # the spring that is set, and damping on the way in
        self.assertAlmostEqual(softer[0], 500, delta=1)
        self.assertLess(softer[1], 1e-3)
        self.assertGreater(harder[0], 1.5 * plain[0])
        self.assertGreater(harder[1], 10 * max(plain[1], softer[1]))  # no straight line
        self.assertLess(softer[2], plain[2])  # presses less, removes less
        self.assertGreater(harder[2], plain[2])

    def test_a_policy_improves(self):
        first, last = script("learn")(12)
        self.assertGreater(last, first + 1)

    def test_a_known_threshold_is_found_back(self):
        outcomes = script("psychophysics")(0.12, 300, 6)
        found = [outcome["threshold"] for outcome in outcomes if outcome["found"]]
        self.assertEqual(len(found), 6)
        # as docs/understand/psychophysics.md says of such observers: single runs scatter by 14 %, and a 95 % interval holds the truth
        self.assertAlmostEqual(np.mean(found), 0.12, delta=0.12 * 0.12)
        self.assertGreaterEqual(sum(outcome["low"] <= 0.12 <= outcome["high"] for outcome in outcomes), 5)
        # another truth is found as another number
        other = script("psychophysics")(0.24, 300, 3)
        self.assertAlmostEqual(np.mean([outcome["threshold"] for outcome in other]), 0.24, delta=0.2 * 0.24)

    def test_scores_tell_scripted_surgeons_apart(self):
        table, found = script("score_study")(self.folder, "tooth", 2, 2, 300)
        self.assertEqual(len(table), 12)
        self.assertGreater(found["auc"], 0.7)
        told = burr.program.run("study", "reliability", self.folder / "marks.csv", "--marks", 2, "--json")
        self.assertEqual(told["learners"], 6)
        self.assertAlmostEqual(told["of"][1]["g"], found["g"], places=9)

    def test_the_figures_of_the_study_are_right(self):
        study = module("score_study")
        self.assertEqual(study.auc([3, 4], [1, 2]), 1)
        self.assertEqual(study.auc([1, 2], [3, 4]), 0)
        self.assertEqual(study.auc([1, 2], [1, 2]), 0.5)
        # R 4.2.2: wilcox.test(c(5, 7, 7, 9), c(4, 7, 6)) gives W = 9, of 12 pairs
        self.assertEqual(study.auc([5, 7, 7, 9], [4, 7, 6]), 9 / 12)
        # Brennan, Generalizability Theory (2001), table 2.2: 10 persons, 12 items; by R 0.05740741 and 0.1268519
        marks = [[int(mark) for mark in row] for row in
                 ("101000000000 111001000000 111110000000 110110010000 111110100000 "
                  "111011100000 111111100000 111101111100 111111111110 111111111111").split()]
        self.assertAlmostEqual(study.reliability(marks), 0.05740741 / (0.05740741 + 0.1268519 / 12), places=6)
        with open(self.folder / "brennan.csv", "w") as file:  # and by the program
            file.write("learner,mark\n" + "".join(f"person-{n},{mark}\n" for n, row in enumerate(marks) for mark in row))
        told = burr.program.run("study", "reliability", self.folder / "brennan.csv", "--marks", 12, "--json")
        self.assertAlmostEqual(told["of"][11]["g"], study.reliability(marks), places=12)
        marks = np.array([[1.0, 2.0], [2.0, 1.0], [1.5, 1.5]])
        self.assertEqual(study.reliability(marks), 0)  # nobody differs

    def test_a_policy_learns_from_recordings(self):
        made = script("clone")()
        self.assertGreater(made["pairs"], 500)
        self.assertLess(made["clone_mm"], 0.5 * made["mean_mm"])  # on a session that it has not seen
        self.assertGreater(made["clone_reward"], made["chance_reward"] + 1)


if __name__ == "__main__":
    unittest.main()
