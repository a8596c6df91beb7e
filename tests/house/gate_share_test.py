#!/usr/bin/env python3
"""scripts/gate_share.py: four runs that pass have run every part; a part that fails comes again; cmake knows the same parts."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts" / "gate_share.py"
sys.path.insert(0, str(SCRIPT.parent))
import gate_share  # noqa: E402


class GateShare(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.cache = pathlib.Path(self.folder.name) / "cache"
        self.addCleanup(self.folder.cleanup)

    def run_it(self, *words, share="", code=0):
        done = subprocess.run([sys.executable, SCRIPT, *words], capture_output=True, text=True,
                              env={**os.environ, "XDG_CACHE_HOME": str(self.cache), "BURR_SHARE": share})
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout.strip(), done.stderr

    def keep(self, text):
        (self.cache / "burr").mkdir(parents=True, exist_ok=True)
        (self.cache / "burr" / "gate_share.txt").write_text(text)

    def test_four_passes_are_all_parts(self):
        seen = []
        for _ in range(4):
            part, said = self.run_it()
            self.assertIn(gate_share.PARTS[int(part)], said)
            seen.append(part)
            self.run_it("--passed", part)
        self.assertEqual(sorted(seen), ["1", "2", "3", "4"])

    def test_the_oldest_comes_next(self):
        self.keep("1 400\n2 100\n3 300\n4 200\n")
        for expected in "2431":
            part, _ = self.run_it()
            self.assertEqual(part, expected)
            self.run_it("--passed", part)

    def test_what_failed_comes_again(self):
        self.keep("1 400\n2 100\n3 300\n4 200\n")
        self.assertEqual([self.run_it()[0] for _ in range(3)], ["2"] * 3)

    def test_without_a_cache_four_days_are_all_parts(self):
        for day in (1, 17, 362):
            self.assertEqual({gate_share.choose({}, day + n)[0] for n in range(4)}, set(gate_share.PARTS))

    def test_damage_is_passed_over(self):
        self.keep("1 400\n2 x\n9 1\n3 -5\n\0\n4 99999999999999999999\n")
        part, said = self.run_it()
        self.assertIn(part, "234")
        self.assertIn("of 3 parts no pass is known", said)

    def test_a_cache_that_cannot_be_written_is_said(self):
        self.cache.write_text("a file")
        self.assertIn("cannot be written", self.run_it("--passed", "1")[1])

    def test_by_hand(self):
        self.assertEqual(self.run_it(share="3")[0], "3")
        self.assertIn("from 1 to 4", self.run_it(share="5", code=1)[1])
        self.run_it("--passed", "5", code=2)

    def test_cmake_knows_the_same_parts(self):
        text = (ROOT / "cmake" / "tiers.cmake").read_text()
        self.assertEqual({int(n) for n in re.findall(r"^set\(full_(\d) ", text, re.M)}, set(gate_share.PARTS))


if __name__ == "__main__":
    unittest.main()
