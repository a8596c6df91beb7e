#!/usr/bin/env python3
"""Writes what the page needs of its case before the module that reads cases is there.

    web/case.py CASE.toml RUBRIC.toml OUT.json
"""
import json
import pathlib
import sys
import tomllib


def text_hash(data):
    """FNV-1a of 64 bits: scenario::text_hash()."""
    value = 14695981039346656037
    for byte in data:
        value = (value ^ byte) * 1099511628211 % 2**64
    return f"{value:016x}"


def main():
    case, rubric, out = map(pathlib.Path, sys.argv[1:])
    text = case.read_text()
    read = tomllib.loads(text)
    targets = [{"tissue": one["tissue"], "goal": one["goal"], "share": one.get("share", 1)} for one in read.get("target", [])]
    burr, work = read["burr"], read["work"]
    out.write_text(json.dumps({
        "name": case.stem.replace("_", "-"),
        "text": text,
        "phantom": f"phantom:{read['phantom']}",
        "burr_mm": burr["diameter_mm"], "diamond": burr["kind"] == "diamond", "rpm": burr["rpm"],
        "at": [one / 1000 for one in work["at_mm"]], "into": work["into"],
        "rubric_hash": text_hash(rubric.read_bytes()),
        "spare": [one["tissue"] for one in read.get("spare", [])],
        "targets": targets,
    }, ensure_ascii=False))


main()
