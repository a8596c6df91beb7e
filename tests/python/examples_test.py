"""Every script in python/examples runs, and does what it says."""
import csv
import importlib.util
import os
import pathlib
import tempfile
import unittest

import numpy as np

EXAMPLES = pathlib.Path(os.environ["BURR_CHECKOUT"]) / "python" / "examples"


def script(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.main


class Examples(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)

    def tearDown(self):
        self.place.cleanup()

    def test_all_are_here(self):
        self.assertEqual({file.stem for file in EXAMPLES.glob("*.py")}, {"load_and_cut", "dataset", "learn", "own_law"})

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


if __name__ == "__main__":
    unittest.main()
