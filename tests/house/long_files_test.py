#!/usr/bin/env python3
"""scripts/checks/long_files.py must find files that are too long, and exceptions that are none."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "checks" / "long_files.py"
sys.path.insert(0, str(SCRIPT.parent))
import long_files  # noqa: E402


class LongFiles(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, path, lines):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text("int a;\n" * lines)

    def test_limit(self):
        for path in ("src/burr/edit/a.cpp", "src/burr/edit/a.h", "src/burr/edit/a.inc", "apps/burr/a.cpp"):
            self.write(path, 500)
            self.assertEqual(long_files.faults(self.root, {})[0], [])
            self.write(path, 501)
            said = long_files.faults(self.root, {})[0]
            self.assertEqual(said, [f"{path}: 501 lines, 500 are allowed; divide it by its ideas"])
            self.write(path, 1)

    def test_other_files_do_not_count(self):
        self.write("src/a.cpp", 1)
        self.write("src/a.md", 501)
        self.write("tests/a.cpp", 501)
        self.assertEqual(long_files.faults(self.root, {}), ([], 1))

    def test_whole(self):
        self.write("src/a.cpp", 501)
        self.assertEqual(long_files.faults(self.root, {"src/a.cpp": "one table"})[0], [])
        self.write("src/a.cpp", 500)
        for path in ("src/a.cpp", "src/gone.cpp"):
            said = long_files.faults(self.root, {path: "one table"})[0]
            self.assertEqual(len(said), 1)
            self.assertIn(f"{path}: is not there, or has at most 500 lines", said[0])

    def test_status_and_words(self):
        self.write("src/burr/base/a.cpp", 501)
        done = subprocess.run([sys.executable, SCRIPT, self.root], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("src/burr/base/a.cpp: 501 lines", done.stdout)

    def test_no_checkout(self):
        self.assertEqual(long_files.faults(self.root, {})[0], ["no file found: is this a checkout?"])


if __name__ == "__main__":
    unittest.main()
