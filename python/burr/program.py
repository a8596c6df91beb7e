"""The program `burr` from Python: for what it can do and the module cannot, such as scripted surgeons.

    import burr.program
    account = burr.program.run("surgeon", "block", "--level", "expert", "--seed", "1000", "--json")

It runs as a process of its own, so its memory and its crashes are not those of Python.
"""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
from typing import Any

import burr


def find() -> str:
    """The program of the same installation: $BURR_PROGRAM, beside the build, <prefix>/bin, or on the PATH."""
    named = os.environ.get("BURR_PROGRAM")
    if named:
        return named
    package = pathlib.Path(burr.__file__).resolve().parent
    # build/release/python/burr; <prefix>/lib/python3/dist-packages/burr
    for place in [package.parents[1] / "burr", *(folder / "bin" / "burr" for folder in package.parents)]:
        if place.is_file() and os.access(place, os.X_OK):
            return str(place)
    found = shutil.which("burr")
    if found is None:
        raise burr.Error("the program burr was not found; install the package burr, or set BURR_PROGRAM to its path")
    return found


def run(*arguments: Any) -> dict[str, Any] | None:
    """Runs `burr ARGUMENTS`. With --json among them, returns its account. What it refuses is raised as burr.Error."""
    command = [find(), "--quiet", *map(str, arguments)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
    except OSError as error:
        raise burr.Error(f"{command[0]}: cannot be run ({error.strerror}); check BURR_PROGRAM") from error
    if done.returncode != 0:
        lines = [line for line in done.stderr.splitlines() if line.strip()]
        raise burr.Error(lines[-1].removeprefix("burr: ") if lines else f"burr {arguments[0]} ended with code {done.returncode}")
    if "--json" not in arguments:
        return None
    account: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return account


def picture(self: burr.Recording, out: str, *, t: float | None = None, width: int = 1280, height: int = 720, view: str = "",
            effects: bool = False) -> None:
    """A picture (.png) of the bone and the tool at t [s] (None: at the end), as `burr replay --picture`."""
    more = ["--at", repr(float(t))] * (t is not None) + ["--view", view] * bool(view) + ["--effects"] * effects + _volume(self)
    run("replay", self.path, "--picture", out, "--picture-size", f"{width},{height}", *more)


def _volume(recording: burr.Recording) -> list[str]:
    return ["--volume", recording.volume] * bool(recording.volume)
