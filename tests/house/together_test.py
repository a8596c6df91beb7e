#!/usr/bin/env python3
"""scripts/together.py keeps sources apart that cannot be compiled as one, puts the others together, and loses none."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "together.py"


def groups(**texts):
    """The names of the sources that are compiled as one, as a sorted list of sorted lists."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        files = [folder / f"{name}.cpp" for name in texts]
        for file, text in zip(files, texts.values()):
            file.write_text(text)
        done = subprocess.run([sys.executable, SCRIPT, folder / "out", "target"], input="\n".join(map(str, files)),
                              capture_output=True, text=True, check=True)
        made = []
        for line in done.stdout.splitlines():
            unit = pathlib.Path(line)
            names = [unit.stem]
            if unit.parent.name == "out":
                names = [pathlib.Path(include.split('"')[1]).stem for include in unit.read_text().splitlines()]
            made.append(sorted(names))
        return sorted(made)


def own(text):
    return f"namespace burr {{\nnamespace {{\n{text}\n}}  // namespace\n}}  // namespace burr\n"


TOGETHER, APART = [["a", "b"]], [["a"], ["b"]]


class Together(unittest.TestCase):
    def test_different_names(self):
        self.assertEqual(groups(a=own("int one() { return 1; }"), b=own("int two() { return 2; }")), TOGETHER)

    def test_the_same_function(self):
        self.assertEqual(groups(a=own("int one() { return 1; }"), b=own("double one(int) { return 1; }")), APART)
        self.assertEqual(groups(a=own("int one() { return 1; }"), b="int one(int n) { return n; }\n"), APART)

    def test_the_same_type_constant_or_alias(self):
        self.assertEqual(groups(a=own("struct Row {};"), b=own("class Row {};")), APART)
        self.assertEqual(groups(a=own("enum class Kind { a };"), b=own("struct Kind {};")), APART)
        self.assertEqual(groups(a=own("constexpr double kNear = 1, kFar = 2;"), b=own("constexpr int kFar = 3;")), APART)
        self.assertEqual(groups(a=own("using Clock = int;"), b=own("using Clock = long;")), APART)

    def test_a_local_name_that_would_hide_one(self):
        self.assertEqual(groups(a=own("constexpr int kFar = 1;"), b="int f() {\n  const int kFar = 2;\n  return kFar;\n}\n"), APART)

    def test_members_qualified_names_comments_and_texts_are_no_clash(self):
        self.assertEqual(groups(a=own("struct Row {};"), b='int f(T t) { return t.Row + t->Row + X::Row; }  // Row "Row"\n'), TOGETHER)

    def test_a_fixture_is_not_taken_for_its_base(self):
        self.assertEqual(groups(a=own("class One : public Window {};"), b=own("class Two : public Window {};")), TOGETHER)

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
