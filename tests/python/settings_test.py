"""Values out of range through C++, the command line, a case and Python: one sentence, each front with its own word for the setting."""
import math
import os
import pathlib
import re
import subprocess
import unittest

import burr

PROGRAM = pathlib.Path(os.environ["BURR_PROGRAM"])
TRIED = [line.split("\t") for line in
         subprocess.run([PROGRAM.parent / "setting_trial"], capture_output=True, text=True, check=True).stdout.splitlines()]


def mill(*words):
    """What `burr mill` says against these words."""
    done = subprocess.run([PROGRAM, "mill", "phantom:block", "--motion", "pocket", *words], capture_output=True, text=True, check=False)
    return done.returncode, done.stderr.splitlines()[0] if done.stderr else ""


def numbers(sentence):
    """(words without numbers and unit, [least, most, value]) of a sentence."""
    found = re.fullmatch(r"must be (a number|a whole number) from (\S+) to (\S+)(?: [^,]+)?, not (\S+)", sentence)
    return (found[1], [float(one) for one in found.groups()[1:]]) if found else (sentence.rpartition(", not ")[0], [])


class Settings(unittest.TestCase):
    def in_python(self, name, value):
        scene = burr.Scene("phantom:block", burr_mm=4)
        kind = type(getattr(scene, name))
        setattr(scene, name, kind(value))
        with self.assertRaises(burr.Error) as raised:
            scene.session()
        word, _, sentence = str(raised.exception).partition(": ")
        self.assertEqual(word, name)
        return sentence

    def in_a_case(self, place, name, value):
        lines = burr.Scene("phantom:block", burr_mm=4).to_toml().splitlines()
        number = next(n for n, line in enumerate(lines) if line.startswith(name + " ="))
        lines[number] = f'{name} = "{value}"' if lines[number].endswith('"') else f"{name} = {value}"
        with self.assertRaises(burr.Error) as raised:
            burr.Scene.from_toml("\n".join(lines), name="mine")
        before = f"mine.toml: line {number + 1}: {place}.{name}: "
        self.assertTrue(str(raised.exception).startswith(before), str(raised.exception))
        return str(raised.exception)[len(before):]

    def test_all_fronts_say_the_same(self):
        self.assertGreater(len(TRIED), 35)
        for word, option, name, place, one_in_si, value, in_cpp in TRIED:
            with self.subTest(word=word, value=value):
                option = "--" + option.replace("_", "-")
                code, said = mill(option, value)
                self.assertEqual(code, 2, said)
                self.assertTrue(said.startswith(option + ": must be "), said)
                sentence = said[len(option) + 2:]
                self.assertTrue(sentence.endswith(", not " + (f'"{value}"' if value == "wrong" else value)), sentence)
                if place:
                    self.assertEqual(self.in_python(name, value), sentence)
                if place == "session":
                    self.assertEqual(self.in_a_case(place, word, value), sentence)
                if word == "burr_mm":
                    self.assertEqual(self.in_a_case(place, "diameter_mm", value), sentence)
                # C++ says it in SI
                words, mine = numbers(sentence)
                in_si = in_cpp.partition(": ")[2]
                self.assertEqual(numbers(in_si)[0], words)
                for a, b in zip(mine, numbers(in_si)[1], strict=True):
                    self.assertTrue(math.isclose(a * float(one_in_si), b, rel_tol=1e-5) or math.isnan(a) and math.isnan(b), (sentence, in_si))
                if float(one_in_si) == 1 and not value == "wrong":
                    self.assertEqual(in_si, sentence)

    def test_what_is_no_number(self):
        for option, value, sentence in [("--torque-mnm", "much", 'must be a number from 0 to 1000 mN m, not "much"'),
                                        ("--teeth", "2.5", "must be a whole number from 1 to 64, not 2.5"),
                                        ("--rate", "1000Hz", 'must be a number from 500 to 10000 Hz, not "1000Hz"'),
                                        ("--touch", "", "must be one of constraint, ")]:
            code, said = mill(option, value)
            self.assertEqual(code, 2)
            self.assertTrue(said.startswith(f"{option}: {sentence}"), said)
        for name, value, sentence in [("drag", '"much"', 'must be a number from 0 to 10, not "much"'), ("drag", "true", "must be a number from 0 to 10, not true"),
                                      ("guard", "1", "must be true or false, not 1"), ("teeth", "2.5", "must be a whole number from 1 to 64, not 2.5")]:
            self.assertEqual(self.in_a_case("session", name, value), sentence)

    def test_other_commands_with_the_same_options(self):
        for command in (["run", "block", "--headless"], ["arm", "block"], ["bench", "frame"]):
            done = subprocess.run([PROGRAM, *command, "--burr-mm", "8"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(done.stderr.splitlines()[0], "--burr-mm: must be a number from 0.6 to 7 mm, not 8")

    def test_the_list_names_every_option(self):
        def program(*words):
            return subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=True).stdout
        told, page, helped = program("settings"), program("settings", "--markdown"), program("mill", "--help")
        for word, option, *_ in TRIED:
            self.assertIn("--" + option.replace("_", "-") + " ", told)
            self.assertIn(f"|`--{option.replace('_', '-')}`|", page)
            self.assertIn("--" + option.replace("_", "-") + " ", helped, word)


if __name__ == "__main__":
    unittest.main()
