#!/usr/bin/env python3
"""scripts/checks/header_names.py must find header names that come twice."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "checks" / "header_names.py"


def run(*paths):
    """(exit status, what it said) for a checkout with these empty files"""
    with tempfile.TemporaryDirectory() as folder:
        for path in paths:
            file = pathlib.Path(folder) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text("")
        done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True)
        return done.returncode, done.stdout


class HeaderNames(unittest.TestCase):
    def test_once_is_fine(self):
        code, said = run("src/burr/edit/plan.h", "src/burr/edit/plan.cpp", "apps/burr/plan.cpp", "tests/edit/plan_test.cpp")
        self.assertEqual((code, said), (0, "1 headers looked at, 0 names come twice\n"))

    def test_twice_in_any_two_folders(self):
        for other in ("src/burr/io/plan.h", "apps/burr/plan.h", "python/src/plan.h", "web/plan.h", "tests/io/plan.h"):
            code, said = run("src/burr/edit/plan.h", other)
            self.assertEqual(code, 1, said)
            self.assertIn("plan.h: ", said)
            self.assertIn(other, said)

    def test_no_checkout(self):
        code, said = run("README.md")
        self.assertEqual(code, 1)
        self.assertIn("is this a checkout?", said)


if __name__ == "__main__":
    unittest.main()
