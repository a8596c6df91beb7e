#!/usr/bin/env python3
"""scripts/checks/sentences.py must find options and commands in the library, and names that a front does not know."""
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts" / "checks"))
import sentences  # noqa: E402

FRONT = '''constexpr FrontWord kOptions[] = {
    {"region", "--roi"},
};
constexpr FrontWord kWays[] = {
    {"record::repair", "`burr repair`"},
};
'''
GOOD = 'return error("no bone; give `iso`, a smaller `region`, or see `record::repair`");'


class Sentences(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        self.write("apps/burr/shared/front_words.cpp", FRONT)
        self.write("apps/burr/a.cpp", 'app.add_subcommand("repair", "x");\ncommand.add_option("--iso", x);\n'
                                      'command.add_option("--roi,--box", x);\n')
        self.write("src/burr/record/a.h", "Status repair(double iso, Region region);\nint smooth;  // not there: spacing_mm\n")
        self.write("src/burr/record/a.cpp", GOOD)
        self.write("python/burr/__init__.pyi", "def load(iso: float, region: str, smooth: float) -> None: ...")
        self.patches = [mock.patch.object(sentences, name, {}) for name in ("COMMANDS", "NOT_GIVEN", "PYTHON_LACKS")]
        self.tables = [one.start() for one in self.patches]

    def tearDown(self):
        for one in self.patches:
            one.stop()
        self.folder.cleanup()

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text)

    def said(self, more=""):
        self.write("src/burr/record/a.cpp", GOOD + "\n" + more)
        return sentences.faults(self.root)[0]

    def one(self, more, part):
        said = self.said(more)
        self.assertEqual(len(said), 1, said)
        self.assertIn(part, said[0])

    def test_good(self):
        self.assertEqual(sentences.faults(self.root), ([], 3))
        self.assertEqual(self.said("// see --iso and `burr repair`\n/* --iso */ char c = '\"'; f(\"a--b\", \"`ulimit -v`\");"), [])

    def test_options_and_commands(self):
        self.one('error("choose with --iso");', "a.cpp:2: names --iso")
        self.one('error("(--box)");', "names --box")
        self.one('error("damaged; `burr "\n      "repair` saves it");', "a.cpp:2: names burr repair")
        self.one('error(R"(see burr repair)");', "names burr repair")
        self.assertEqual(self.said('error("the burr repairs nothing, burr reads it");'), [])

    def test_a_reason_lets_a_file_say_them_as_long_as_it_does(self):
        self.tables[0]["src/burr/record/a.cpp"] = "a reason"
        self.assertEqual(self.said('error("burr repair --iso");'), [])
        self.one("", "says no command any more")

    def test_names_that_nobody_knows(self):
        self.assertEqual(len(self.said('error("give `spacing_mm`");')), 3)  # of no header, no option, not of Python
        self.one('error("give `smooth`");', "no command has an option for `smooth`")
        self.assertEqual(self.said('error("see `record::mend`");'),
                         ["src/burr/record/a.cpp:2: no header of src/burr/record declares `record::mend`",
                          "src/burr/record/a.cpp:2: front_words.cpp has nothing for `record::mend`"])

    def test_python(self):
        self.write("python/burr/__init__.pyi", "def load(region: str) -> None: ...")
        self.one("", "Python has no `iso`")
        self.tables[2]["iso"] = "a reason"
        self.assertEqual(self.said(), [])
        self.tables[2]["region"] = "no reason: Python has it"
        self.one("", "region: Python has it")

    def test_lines_of_the_front_that_help_nobody(self):
        for line, part in (('{"smooth", "--iso"}', "no sentence of src/burr says `smooth`"),
                           ('{"iso", "--level"}', "the program has no --level")):
            self.write("apps/burr/shared/front_words.cpp", FRONT.replace('{"region"', line + ',\n    {"region"'))
            self.assertTrue(any(part in one for one in self.said()), self.said())
        self.write("apps/burr/shared/front_words.cpp", FRONT.replace("burr repair", "burr mend"))
        self.one("", "the program has no command mend")

    def test_without_names_nothing_was_checked(self):
        self.write("src/burr/record/a.cpp", "")
        self.assertEqual(sentences.faults(self.root)[1], 0)


if __name__ == "__main__":
    unittest.main()
