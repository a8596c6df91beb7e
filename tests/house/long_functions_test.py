#!/usr/bin/env python3
"""scripts/checks/long_functions.py must measure functions, and nothing else, and complain about those too long."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "checks" / "long_functions.py"
sys.path.insert(0, str(SCRIPT.parent))
import long_functions  # noqa: E402


def run(name, text):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / name
        file.parent.mkdir(parents=True)
        file.write_text(text)
        done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True)
        return done.returncode, done.stdout


def lines(count):
    return "void f(int a) {\n" + "  a = 1;\n" * (count - 2) + "}\n"


class LongFunctions(unittest.TestCase):
    def measured(self, text, *expected):
        self.assertEqual([(name, long) for name, long, _ in long_functions.functions(text)], list(expected))

    def test_limits(self):
        for folder, most in (("src/burr/tick/", 60), ("src/burr/edit/", 100), ("apps/burr/", 100)):
            self.assertEqual(run(folder + "a.cpp", lines(most))[0], 0)
            code, said = run(folder + "a.cpp", lines(most + 1))
            self.assertEqual(code, 1)
            self.assertIn(f"f has {most + 1} lines, {most} are allowed", said)

    def test_no_checkout(self):
        self.assertEqual(run("other/a.cpp", lines(3))[0], 1)

    def test_heads(self):
        self.measured("namespace a {\nint A::b(int c,\n  int d) const noexcept {\n  return c;\n}\n}\n", ("A::b", 4))
        self.measured("A::A(int b)\n  : b_{b},\n    c_(b, {.d = 1}) {\n  go();\n}\n", ("A::A", 5))
        self.measured("class A {\n public:\n  int b() { return 1; }\n};\nstruct B final : A {\n  bool operator==(B) const {\n    return true;\n  }\n};\n", ("b", 1), ("operator==", 3))

    def test_not_heads(self):
        self.measured("const int kA[] = {\n  1,\n  f(2),\n};\nenum class E : int { a, b };\nstruct S {\n  int a;\n};\n")
        self.measured('// void f() {\nconst char* t = "void g() {";\n#define A(b) \\\n  void b() {}\n')

    def test_braces_in_texts(self):
        self.measured("void f() {\n  char a = '{';\n  g(\"}\", 1'000);\n}\nvoid g() {\n}\n", ("f", 4), ("g", 2))


if __name__ == "__main__":
    unittest.main()
