#!/usr/bin/env python3
"""Finds header names that come twice: whoever reads `plan.h` must know which one is meant.

    scripts/checks/header_names.py [ROOT]       ROOT: a checkout; default: this one

Looks at src, apps, python, web, tests, bench, samples and fuzz.
"""
import collections
import pathlib
import sys

FOLDERS = ("src", "apps", "python", "web", "tests", "bench", "samples", "fuzz")


def faults(root):
    """(faults as sentences, number of headers) of a checkout."""
    places = collections.defaultdict(list)
    for folder in FOLDERS:
        for file in sorted((root / folder).rglob("*.h")):
            places[file.name].append(file.relative_to(root).as_posix())
    wrong = [f"{name}: {', '.join(found)}; rename all but one after what it holds"
             for name, found in sorted(places.items()) if len(found) > 1]
    count = sum(len(found) for found in places.values())
    return wrong if count else ["no header found: is this a checkout?"], count


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2]
    wrong, count = faults(root)
    for line in wrong:
        print(line)
    print(f"{count} headers looked at, {len(wrong)} names come twice")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
