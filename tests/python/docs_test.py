"""Every block of Python and of the shell in docs/use/python.md and docs/use/datasets.md runs as it is printed, one after the other, in an
empty folder."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

DOCS = pathlib.Path(os.environ["BURR_CHECKOUT"]) / "docs" / "use"
PROGRAMS = str(pathlib.Path(os.environ["BURR_PROGRAM"]).parent)


class Page(unittest.TestCase):
    def run_page(self, name, least):
        page = DOCS / name
        text = page.read_text()
        blocks = [(text[:found.start()].count("\n") + 2, found.group(1), found.group(2))
                  for found in re.finditer(r"^```(python|sh)\n(.*?)^```$", text, re.S | re.M)]
        self.assertGreater(len(blocks), least)
        here = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                names = {"__name__": "__main__"}
                for line, language, block in blocks:
                    if language == "sh":
                        done = subprocess.run(["bash", "-euo", "pipefail", "-c", block], capture_output=True, text=True,
                                              env={**os.environ, "PATH": PROGRAMS + os.pathsep + os.environ["PATH"]})
                        self.assertEqual(done.returncode, 0, f"{page}:{line}\n{done.stdout}{done.stderr}")
                        continue
                    # the lines of the page, for a traceback
                    exec(compile("\n" * (line - 1) + block, str(page), "exec"), names)
            finally:
                os.chdir(here)

    def test_every_block_about_python_runs(self):
        self.run_page("python.md", 5)

    def test_every_block_about_data_sets_runs(self):
        try:
            import h5py  # noqa: F401
        except ImportError:
            self.skipTest("h5py is missing: apt-get install python3-h5py")
        self.run_page("datasets.md", 5)


if __name__ == "__main__":
    unittest.main()
