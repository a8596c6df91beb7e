#!/usr/bin/env python3
"""Which part of the full tier the gate (.ci/run) runs this time, besides ./test. Prints its number; says why on stderr.

    scripts/gate_share.py                  the part that has not passed on this computer for the longest time
    scripts/gate_share.py --passed PART    notes that it has passed

Four runs that pass, one after the other, so run all parts; a part that fails comes again. The times are kept in
~/.cache/burr/gate_share.txt (or below XDG_CACHE_HOME). Of parts whose time is not known, the day of the year decides.
BURR_SHARE=PART .ci/run chooses one by hand.
"""
import datetime
import os
import pathlib
import re
import sys
import time

PARTS = {  # cmake/tiers.cmake says which tests these are
    1: "ThreadSanitizer",
    2: "the second compiler and 64-bit ARM",
    3: "the web page and Windows",
    4: "Slurm, packages, installation, clang-tidy, each header alone, fuzzers, and AddressSanitizer of what reads no files",
}


def place():
    cache = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return pathlib.Path(cache) / "burr" / "gate_share.txt"


def passed():
    """{part: when it passed last, seconds since 1970}; lines that say something else are passed over."""
    try:
        text = place().read_text(errors="replace")
    except OSError:
        return {}
    return {int(part): int(when) for part, when in re.findall(r"^(\d) (\d{1,15})$", text, re.M) if int(part) in PARTS}


def choose(times, day, wanted=""):
    """(part, why)"""
    if wanted:
        if not wanted.isdecimal() or int(wanted) not in PARTS:
            sys.exit(f"gate_share.py: BURR_SHARE is {wanted!r}; give a number from 1 to {len(PARTS)}")
        return int(wanted), "BURR_SHARE says so"
    unknown = [part for part in PARTS if part not in times]
    if unknown:
        return unknown[day % len(unknown)], f"of {len(unknown)} parts no pass is known here; day {day} of the year decides"
    part = min(PARTS, key=lambda part: (times[part], part))
    return part, f"it passed last on {datetime.datetime.fromtimestamp(times[part]):%Y-%m-%d at %H:%M}, the others later"


def note(part, now):
    times = {**passed(), part: now}
    try:
        place().parent.mkdir(parents=True, exist_ok=True)
        place().write_text("".join(f"{part} {when}\n" for part, when in sorted(times.items())))
    except OSError as trouble:
        print(f"gate: {place()} cannot be written ({trouble.strerror}); the next run does not know of this one", file=sys.stderr)


def main():
    words = sys.argv[1:]
    if len(words) == 2 and words[0] == "--passed" and words[1].isdecimal() and int(words[1]) in PARTS:
        note(int(words[1]), int(time.time()))
        return 0
    if words:
        print(__doc__, file=sys.stderr)
        return 2
    day = datetime.date.today().timetuple().tm_yday
    part, why = choose(passed(), day, os.environ.get("BURR_SHARE", ""))
    print(f"gate: ./test, and part {part} of {len(PARTS)} of the full tier: {PARTS[part]} ({why})", file=sys.stderr)
    print(part)
    return 0


if __name__ == "__main__":
    sys.exit(main())
