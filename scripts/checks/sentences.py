#!/usr/bin/env python3
"""Holds the sentences of the library to words that all who use it can read: no option and no command of the program.

    scripts/checks/sentences.py [ROOT]       ROOT: a checkout; default: this one

A sentence of src/burr names what can be given by its name in C++, in backticks: `spacing_mm`, `record::repair`. The fronts
say their own word for it (apps/burr/shared/front_words.h); Python's parameter is the same word. A fault is

- a text in src/burr with an option (--iso) or a command of the program (burr repair);
- a name in backticks that no header of src/burr declares, or that no option and no line of front_words.cpp stands for;
- a name that Python does not have in a room that Python uses;
- a line of front_words.cpp for a name that no sentence says, or with an option or a command that the program does not have.
"""
import pathlib
import re
import sys

# Texts that say a command, and why.
COMMANDS = {
    "src/burr/report/make_report.cpp": "the page of a report lists the commands that make its figures again",
    "src/burr/record/session_schema.cpp": "every recording holds this text, to the letter",
}
# Names in backticks that nobody gives, and why.
NOT_GIVEN = {
    "tools": "a field of a recording, in the description of a column that recordings hold to the letter",
}
# Rooms whose sentences Python never sees: what they do is not in it.
NOT_IN_PYTHON = {"device", "fit", "lrs", "net", "school", "sound", "surgeon", "dataset", "proof"}
# Names in the other rooms that Python has no parameter for, and why it never meets the sentence.
PYTHON_LACKS = {
    "accepted_labels": "Python checks no labels and accepts none",
    "device": "Python opens no haptic device",
    "drop_islands_mm3": "said only where it is given",
    "keep": "said only where it is given",
    "study": "Python writes no DICOM segmentation",
    "uid_root": "Python writes no DICOM segmentation",
}
NAME = re.compile(r"^[a-z][a-z0-9_]*$")
FUNCTION = re.compile(r"^[a-z]+(::[A-Za-z_]+)+$")
LITERAL = re.compile(r'R"(\w*)\((?P<raw>.*?)\)\1"|"(?P<text>(?:[^"\\\n]|\\.)*)"', re.S)
COMMENT = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'|(?P<comment>//[^\n]*|/\*.*?\*/)', re.S)
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]*")
SPAN = re.compile(r"`([^`]*)`")


def code_of(file):
    """The file without its comments, lines kept."""
    text = file.read_text(errors="replace")
    return COMMENT.sub(lambda m: re.sub(r"[^\n]", " ", m[0]) if m["comment"] else m[0], text)


def texts_of(code):
    """(line, text) of each string; those that stand behind each other are one."""
    end, line, joined = None, 0, ""
    for found in LITERAL.finditer(code):
        # what is code for the graphics processor has comments of its own
        text = re.sub(r"//[^\n]*", "", found["raw"]) if found["raw"] is not None else found["text"]
        if end is None or code[end:found.start()].strip():
            if end is not None:
                yield line, joined
            line, joined = code.count("\n", 0, found.start()) + 1, ""
        joined += text
        end = found.end()
    if end is not None:
        yield line, joined


def front(root):
    """(options, commands, other options, other ways) of the program; the last two as {name: typed}."""
    options, commands = set(), set()
    for file in (root / "apps/burr").rglob("*.cpp"):
        code = code_of(file)
        commands.update(re.findall(r'\bapp\.add_subcommand\(\s*"([a-z-]+)"', code))
        if file.name != "front_words.cpp":
            for _, text in texts_of(code):
                options.update(re.findall(r"(?:^|,)(--[a-z][a-z0-9-]*)(?=$|,)", text))
    code = code_of(root / "apps/burr/shared/front_words.cpp")
    tables = [dict(re.findall(r'\{"([\w:]+)",\s*"([^"]+)"\}', part))
              for part in re.findall(r"constexpr FrontWord \w+\[\] = \{(.*?)\n\};", code, re.S)]
    settings = code_of(root / "src/burr/tick/setting_table.cpp") if (root / "src/burr/tick/setting_table.cpp").exists() else ""
    options.update("--" + word.replace("_", "-") for word in re.findall(r'\.word = "(\w+)"', settings))
    return options, commands, tables[0], tables[1]


def faults(root):
    """(faults as sentences, number of names in backticks)."""
    options, commands, others, ways = front(root)
    command = re.compile(r"\bburr (" + "|".join(sorted(commands)) + r")\b")
    declared = {}
    for file in sorted((root / "src/burr").rglob("*.h")):
        room = file.relative_to(root / "src/burr").parts[0]
        declared.setdefault(room, set()).update(re.findall(r"\w+", code_of(file)))
    everywhere = set().union(*declared.values())
    python = set(re.findall(r"\w+", (root / "python/burr/__init__.pyi").read_text()))
    wrong, count, said, excused, lacking = [], 0, set(), set(), set()
    for file in sorted(p for p in (root / "src/burr").rglob("*") if p.suffix in (".cpp", ".h")):
        path = file.relative_to(root).as_posix()
        room = file.relative_to(root / "src/burr").parts[0]
        for line, text in texts_of(code_of(file)):
            where = f"{path}:{line}"
            found = OPTION.findall(text) + [f"burr {one}" for one in command.findall(text)]
            if found and path in COMMANDS:
                excused.add(path)
            elif found:
                wrong.append(f"{where}: names {found[0]}, which only the command line has; name the field or the function in "
                             "backticks (apps/burr/shared/front_words.h)")
            for name in SPAN.findall(text):
                if not NAME.match(name) and not FUNCTION.match(name):
                    continue  # a command of the system
                if name in NOT_GIVEN:
                    continue
                count += 1
                said.add(name)
                if "::" in name:
                    parts = name.split("::")
                    if not all(one in declared.get(parts[0], ()) for one in parts[1:]):
                        wrong.append(f"{where}: no header of src/burr/{parts[0]} declares `{name}`")
                    if name not in ways:
                        wrong.append(f"{where}: front_words.cpp has nothing for `{name}`")
                    continue
                if name not in everywhere:
                    wrong.append(f"{where}: no header of src/burr declares `{name}`")
                if others.get(name, "--" + name.replace("_", "-")) not in options:
                    wrong.append(f"{where}: no command has an option for `{name}`; add the option to front_words.cpp")
                if room not in NOT_IN_PYTHON and name not in python:
                    lacking.add(name)
                    if name not in PYTHON_LACKS:
                        wrong.append(f"{where}: Python has no `{name}`; give it one, or say in PYTHON_LACKS why not")
    for name, typed in sorted({**others, **ways}.items()):
        if name not in said:
            wrong.append(f"front_words.cpp: no sentence of src/burr says `{name}`; delete its line")
        for option in OPTION.findall(typed):
            if option not in options:
                wrong.append(f"front_words.cpp: `{name}`: the program has no {option}")
        for one in re.findall(r"burr ([a-z-]+)", typed):
            if one not in commands:
                wrong.append(f"front_words.cpp: `{name}`: the program has no command {one}")
    for name in sorted(PYTHON_LACKS.keys() - lacking):
        wrong.append(f"{name}: Python has it, or no sentence says it; delete its line of PYTHON_LACKS")
    for path in sorted(COMMANDS.keys() - excused):
        wrong.append(f"{path}: says no command any more; delete its line in scripts/checks/sentences.py")
    return wrong, count


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2]
    wrong, count = faults(root)
    for one in wrong:
        print(one)
    print(f"{count} names in sentences of the library, {len(wrong)} faults")
    return 1 if wrong or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
