"""Every block of Python in docs/python.md runs as it is printed, one after the other, in an empty folder."""
import os
import pathlib
import re
import tempfile
import unittest

PAGE = pathlib.Path(os.environ["BURR_CHECKOUT"]) / "docs" / "python.md"


class Page(unittest.TestCase):
    def test_every_block_runs(self):
        text = PAGE.read_text()
        blocks = [(text[:found.start()].count("\n") + 2, found.group(1)) for found in re.finditer(r"^```python\n(.*?)^```$", text, re.S | re.M)]
        self.assertGreater(len(blocks), 5)
        here = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                names = {"__name__": "__main__"}
                for line, block in blocks:
                    # the lines of the page, for a traceback
                    exec(compile("\n" * (line - 1) + block, str(PAGE), "exec"), names)
            finally:
                os.chdir(here)


if __name__ == "__main__":
    unittest.main()
