#!/usr/bin/env python3
"""Checks that the help of every command of the program ends with examples of that command, and that each can be typed.

    scripts/checks/examples.py [BUILD]        BUILD: folder of the program; default build/release

Each example is run with --dry, which reads the command line as always and then does nothing.
"""
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BURR = (pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build/release").resolve() / "burr"
bad, count = [], 0


def said(*words):
    done = subprocess.run([BURR, *words], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def look(command):
    """The help of one command, and of those below it."""
    global count
    name = " ".join(["burr", *command])
    code, text = said(*command, "--help")
    body, _, examples = text.partition("\nexamples:\n")
    lines = [line.strip() for line in examples.splitlines() if line.strip()]
    if code != 0:
        bad.append(f"{name} --help: ends with {code}")
    if not lines:
        bad.append(f"{name} --help: has no examples at its end")
    for line in lines:
        typed = re.split(r" {3,}", line)[0]
        try:
            words = shlex.split(typed)
        except ValueError as problem:
            bad.append(f"{name} --help: cannot be typed: {typed} ({problem})")
            continue
        if words[: len(command) + 1] != ["burr", *command]:
            bad.append(f"{name} --help: is an example of another command: {typed}")
        code, told = said("--dry", *words[1:])
        count += 1
        if code != 0 or told:
            bad.append(f"{name} --help: does not work: {typed}\n    {told.strip()}")
    below = body.partition("\nSubcommands:\n")[2]
    for sub in re.findall(r"^  (\S+)", below, re.M):
        look([*command, sub])


look([])
# the check itself sees what is wrong
if said("--dry", "mill", "phantom:block", "--no-such-option")[0] == 0:
    bad.append("--dry accepts an option that does not exist")
if bad:
    sys.exit("\n".join(bad))
print(f"{count} examples can be typed")
