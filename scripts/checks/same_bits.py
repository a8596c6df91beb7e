#!/usr/bin/env python3
"""Checks that the same session gives the same bits: on every instruction set, with one thread and two, in real time
and as fast as possible, with the C library of a processor that cannot multiply and add in one step; and in another
build.

    scripts/checks/same_bits.py PROGRAM                       PROGRAM is tests/bits/same_bits, built
    scripts/checks/same_bits.py PROGRAM --against OTHER       OTHER: the same from another build
    [--only NAME]                                             one of its lines
"""
import argparse
import os
import subprocess
import sys


# the functions of glibc take other code, with other last bits, where these are missing
OLD_PROCESSOR = "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA_Usable,-AVX2_Usable"


def say(program, simd=None, threads=2, realtime=False, only=(), old=False):
    """Its lines as {name: (ticks, bone)}; and the names of sessions that the watchdog changed."""
    lines, lost = {}, set()
    for one in only or [None]:
        command = [program, "--threads", str(threads)]
        command += ["--realtime"] if realtime else []
        command += ["--only", one] if one else []
        environment = dict(os.environ)
        environment.pop("BURR_SIMD", None)
        if simd:
            environment["BURR_SIMD"] = simd
        if old:
            environment["GLIBC_TUNABLES"] = OLD_PROCESSOR
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)} (BURR_SIMD={simd}) ends with {done.returncode}:\n{done.stderr}")
        for line in done.stdout.splitlines():
            name, ticks, bone, *more = line.split()
            lines[name] = (ticks, bone)
            if more:
                lost.add(name)
    if not lines:
        sys.exit(f"{' '.join(command)} says nothing")
    return lines, lost


def differences(what, first, second, lost=()):
    bad = []
    for name in first:
        if name in lost:
            continue
        for part, a, b in zip(("ticks", "bone"), first[name], second.get(name, ("nothing", "nothing"))):
            if a != b:
                bad.append(f"{what}: {name}: the {part} differ: {a} and {b}")
    return bad


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("--against")
    arguments.add_argument("--only", action="append", default=[])
    options = arguments.parse_args()
    first, _ = say(options.program, only=options.only)
    for name, (ticks, bone) in first.items():
        print(f"{name:16} ticks {ticks} bone {bone}")
    bad = []
    if options.against:
        other, _ = say(options.against, only=options.only)
        bad += differences(options.against, first, other)
    else:
        with open("/proc/cpuinfo") as cpu:
            known = set(next((line for line in cpu if line.startswith("flags")), "").split())
        for simd, threads in (("scalar", 1), ("avx2", 2), ("avx512", 1)):
            if simd != "scalar" and not known & {simd, simd + "f"}:
                print(f"this processor has no {simd}: not compared")
                continue
            bad += differences(f"{simd}, {threads} threads", first, say(options.program, simd, threads, only=options.only)[0])
        bad += differences("without multiply-add", first, say(options.program, only=options.only, old=True)[0])
        by_clock, lost = say(options.program, realtime=True, only=options.only or ["pocket", "plunge"])
        bad += differences("by the clock", {name: first[name] for name in by_clock}, by_clock, lost)
        for name in sorted(lost):
            print(f"{name}, by the clock: the machine stood still or was too busy; it replays to the bit")
    print("\n".join(bad) if bad else "all the same")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
