#!/usr/bin/env python3
"""Finds files that are too long: more than 500 lines in src and apps, but for those that one idea fills (WHOLE).

    scripts/checks/long_files.py [ROOT]       ROOT: a checkout; default: this one

A file of WHOLE that is no longer so long is a fault too: its line here is to be deleted.
"""
import pathlib
import sys

MOST = 500  # lines

# Files that stay whole, and why: docs/develop/decisions has a line for each.
WHOLE = {
    "src/burr/haptics/proxy.cpp": "one tick of the proxy, whose steps the compiler makes into one",
    "src/burr/haptics/six/six_proxy.cpp": "one tick of the proxy of six unknowns, likewise",
    "src/burr/importing/tissue_names.cpp": "one table of words, and the rules by which it is read",
}


def faults(root, whole):
    """(faults as sentences, number of files) of a checkout. whole: {path: reason}."""
    wrong, count, long_ones = [], 0, set()
    for folder in ("src", "apps"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".cpp", ".h", ".inc"):
                continue
            path = file.relative_to(root).as_posix()
            lines = len(file.read_text(errors="replace").splitlines())
            count += 1
            if lines <= MOST:
                continue
            long_ones.add(path)
            if path not in whole:
                wrong.append(f"{path}: {lines} lines, {MOST} are allowed; divide it by its ideas")
    if count == 0:
        wrong.append("no file found: is this a checkout?")
    for path in sorted(whole.keys() - long_ones):
        wrong.append(f"{path}: is not there, or has at most {MOST} lines; delete its line in scripts/checks/long_files.py")
    return wrong, count


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2]
    wrong, count = faults(root, WHOLE)
    for line in wrong:
        print(line)
    print(f"{count} files looked at, {len(wrong)} faults; {len(WHOLE)} may be longer")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
