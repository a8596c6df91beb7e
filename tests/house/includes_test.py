#!/usr/bin/env python3
"""scripts/checks/includes.py must find a missing header of the C++ library, and nothing else."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "checks" / "includes.py"


def run(**texts):
    """The exit status and the words for a checkout of these files of src/burr/base."""
    with tempfile.TemporaryDirectory() as folder:
        room = pathlib.Path(folder) / "src" / "burr" / "base"
        room.mkdir(parents=True)
        for name, text in texts.items():
            (room / name.replace("_h", ".h").replace("_cpp", ".cpp")).write_text(text)
        done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True)
        return done.returncode, done.stdout


class Includes(unittest.TestCase):
    def test_named_by_itself_or_by_an_own_header(self):
        self.assertEqual(run(a_cpp="#include <vector>\nstd::vector<int> a;\n")[0], 0)
        self.assertEqual(run(a_h="#include <vector>\n", a_cpp='#include "burr/base/a.h"\nstd::vector<int> a;\n')[0], 0)

    def test_missing(self):
        code, said = run(a_h="#include <string>\n", a_cpp='#include "burr/base/a.h"\nint n = std::min(1, 2);\n')
        self.assertEqual(code, 1)
        self.assertIn("src/burr/base/a.cpp: std::min: #include <algorithm> is missing", said)

    def test_comments_and_texts_do_not_count(self):
        self.assertEqual(run(a_cpp='#include <string>\n// std::vector\nstd::string a = "std::map";\n')[0], 0)

    def test_no_checkout(self):
        self.assertEqual(run()[0], 2)


if __name__ == "__main__":
    unittest.main()
