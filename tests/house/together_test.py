#!/usr/bin/env python3
"""scripts/together.py keeps sources apart that cannot be compiled as one, puts the others together, and loses none."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts" / "together.py"


def groups(**texts):
    """The names of the sources that are compiled as one, as a sorted list of sorted lists."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        files = [folder / f"{name}.cpp" for name in texts]
        for file, text in zip(files, texts.values()):
            file.write_text(text)
        done = subprocess.run([sys.executable, SCRIPT, folder / "out"], input="\n".join(["<target>", *map(str, files)]),
                              capture_output=True, text=True, check=True)
        made = []
        for line in done.stdout.splitlines()[1:]:
            unit = pathlib.Path(line)
            names = [unit.stem]
            if unit.parent.name == "out":
                names = [pathlib.Path(name).stem for name in re.findall(r'^#include "(.*\.cpp)"$', unit.read_text(), re.M)]
                subprocess.run(["c++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wshadow", "-Werror", "-Wno-unused", "-I", ROOT / "src", unit],
                               check=True)  # what is put together compiles
            made.append(sorted(names))
        return sorted(made)


def own(text):
    return f"namespace burr {{\nnamespace {{\n{text}\n}}  // namespace\n}}  // namespace burr\n"


TOGETHER, APART = [["a", "b"]], [["a"], ["b"]]


class Together(unittest.TestCase):
    def test_different_names(self):
        self.assertEqual(groups(a=own("int one() { return 1; }"), b=own("int two() { return 2; }")), TOGETHER)

    def test_the_same_function(self):
        self.assertEqual(groups(a=own("int one() { return 1; }"), b=own("double one(int) { return 1; }")), TOGETHER)
        self.assertEqual(groups(a=own("int one() { return 1; }"), b="int one(int n) { return n; }\n"), TOGETHER)

    def test_the_same_type_constant_or_alias(self):
        self.assertEqual(groups(a=own("struct Row {};"), b=own("class Row {};")), TOGETHER)
        self.assertEqual(groups(a=own("enum class Kind { a };"), b=own("struct Kind {};")), TOGETHER)
        self.assertEqual(groups(a=own("constexpr double kNear = 1, kFar = 2;"), b=own("constexpr int kFar = 3;")), TOGETHER)
        self.assertEqual(groups(a=own("using Clock = int;"), b=own("using Clock = long;")), TOGETHER)

    def test_a_local_name_that_would_hide_one(self):
        self.assertEqual(groups(a=own("constexpr int kFar = 1;"), b="int f() {\n  const int kFar = 2;\n  return kFar;\n}\n"), TOGETHER)

    def test_a_name_that_a_macro_must_not_change(self):
        one = own("int one() { return 1; }")
        member = "struct T {\n  int one;\n};\nint f(T t) { return t.one; }\n"
        self.assertEqual(groups(a=one + member, b=one), TOGETHER)  # it is enough that the other's changes
        self.assertEqual(groups(a=one + member, b=one + member.replace("T", "S")), APART)
        a_macro = "#define SAY one()\n#undef SAY\n"
        self.assertEqual(groups(a=one + a_macro, b=one + a_macro), APART)
        self.assertEqual(groups(a=own("EM_JS(int, f, (), {});"), b=own("EM_JS(int, g, (), {});")), APART)  # a macro of others
        fixture = own("class Fix {};\nTEST_F(Fix, works) {\n}\n")
        self.assertEqual(groups(a=fixture, b=fixture), APART)
        overload = '#include "burr/base/trimmed.h"\n' + own("int trimmed(int n) { return n; }")
        self.assertEqual(groups(a=overload, b=overload), APART)

    def test_headers_keep_their_names(self):
        self.assertEqual(groups(a=own("int size() { return 1; }"), b="#include <vector>\n" + own("int size() { return 2; }")), TOGETHER)

    def test_members_qualified_names_comments_and_texts_are_no_clash(self):
        self.assertEqual(groups(a=own("struct Row {};"), b='template <class X, class T>\nint f(T t) { return t.Row + t->Row + X::Row; }  // Row "Row"\n'), TOGETHER)

    def test_a_fixture_is_not_taken_for_its_base(self):
        self.assertEqual(groups(a="class Window {};\n" + own("class One : public Window {};"), b=own("class Two : public Window {};")), TOGETHER)

    def test_a_macro_that_stays(self):
        self.assertEqual(groups(a="#define M 1\n", b="int b;\n"), APART)
        self.assertEqual(groups(a="#define M 1\n#undef M\n", b="int b;\n"), TOGETHER)

    def test_none_is_lost_and_no_group_is_too_large(self):
        texts = {f"f{n}": f"int function_{n}();\n" + "// long\n" * 4000 for n in range(20)}
        made = groups(**texts)
        self.assertEqual(sorted(sum(made, [])), sorted(texts))
        self.assertLessEqual(max(map(len, made)), 3)


if __name__ == "__main__":
    unittest.main()
