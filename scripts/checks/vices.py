#!/usr/bin/env python3
"""Every name in VICES of scripts/acceptance.py is a vice with steps and an item of the rubric of its case. A misspelt item would never be
looked at.

    scripts/checks/vices.py
"""
import importlib.util
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def acceptance():
    spec = importlib.util.spec_from_file_location("acceptance", ROOT / "scripts" / "acceptance.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def faults(vices, steps, items_of):
    """Sentences. items_of: the ids of a case's items."""
    wrong = []
    for case, by_vice in vices.items():
        known = items_of(case)
        for vice, names in by_vice.items():
            if vice not in steps:
                wrong.append(f"{case}: {vice} has no values in STEPS")
            for name in names:
                hit = any(item.startswith(name[:-1]) for item in known) if name.endswith("*") else name in known
                if not hit:
                    wrong.append(f"{case}: {vice}: the rubric has no item {name}")
    return wrong


def items_in(case):
    rubric = ROOT / "rubrics" / f"{case.replace('-', '_')}.toml"
    return re.findall(r'^id = "([^"]+)"', rubric.read_text(), re.MULTILINE)


def main():
    sys.dont_write_bytecode = True
    tool = acceptance()
    # the check itself sees what it is for
    made = faults({"c": {"a": ["one", "on*", "two"], "b": []}}, {"a": []}, lambda case: ["one"])
    if made != ["c: a: the rubric has no item two", "c: b has no values in STEPS"]:
        print(f"vices.py does not find the faults of a made table: {made}", file=sys.stderr)
        return 1
    wrong = faults(tool.VICES, tool.STEPS, items_in)
    for sentence in wrong:
        print(f"scripts/acceptance.py: {sentence}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
