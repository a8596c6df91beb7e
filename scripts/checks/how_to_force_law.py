#!/usr/bin/env python3
"""Follows docs/develop/how_to_add_a_force_law.md: writes its new files and applies its patch to a copy of the sources, compiles what they change, and
runs the test that the page prints.

    scripts/checks/how_to_force_law.py [BUILD]        BUILD: for the flags; default build/release
"""
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = (pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build/release").resolve()
PAGE = (ROOT / "docs/develop/how_to_add_a_force_law.md").read_text()


def run(*words, where):
    done = subprocess.run([str(word) for word in words], cwd=where, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"docs/develop/how_to_add_a_force_law.md: {' '.join(map(str, words))[:200]}\n{done.stdout}{done.stderr}")
    return done.stdout


files = re.findall(r"`([\w/.]+)`:\n\n```cpp\n(.*?)```", PAGE, re.S)
patches = re.findall(r"```diff\n(.*?)```", PAGE, re.S)
if len(files) != 2 or len(patches) != 1:
    sys.exit(f"docs/develop/how_to_add_a_force_law.md: {len(files)} new files and {len(patches)} patches; 2 and 1 were expected")

with tempfile.TemporaryDirectory() as folder:
    copy = pathlib.Path(folder)
    for part in ("src", "apps", "third_party", "tests/support"):
        shutil.copytree(ROOT / part, copy / part)
    for name, text in files:
        if (ROOT / name).exists():
            sys.exit(f"docs/develop/how_to_add_a_force_law.md: {name} is there already")
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_text(text)
    patch = copy / "hardening.patch"
    patch.write_text(patches[0])
    run("git", "apply", "--unsafe-paths", "--directory=" + folder, patch, where="/")
    changed = re.findall(r"^\+\+\+ b/(\S+\.cpp)", patches[0], re.M)
    flags = ["-std=c++20", "-fsyntax-only", "-O0", "-w", f"-I{copy}/src", f"-I{copy}/apps/burr", f"-I{copy}/third_party",
             f"-I{BUILD}/words", "-isystem", "/usr/include/eigen3", '-DBURR_VERSION="0"']
    for library in ("sdl2", "epoxy", "imgui"):
        found = subprocess.run(["pkg-config", "--cflags", library], capture_output=True, text=True)
        flags += shlex.split(found.stdout) if found.returncode == 0 else []
    for name in changed:
        run("c++", *flags, copy / name, where=copy)
    law, test = (name for name, _ in files)
    run("c++", "-std=c++20", "-O0", "-Wall", "-Wextra", "-Werror", f"-I{copy}/src", "-isystem", "/usr/include/eigen3", copy / test,
        "-o", copy / "try", "-lgtest", "-lgtest_main", "-lpthread", where=copy)
    said = run(copy / "try", where=copy)
    if "1 test from" not in said or "[  PASSED  ]" not in said:
        sys.exit(said)
print(f"the page's patch applies, {len(changed)} changed files compile, its test passes")
