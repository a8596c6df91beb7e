#!/usr/bin/env python3
"""Puts the npm package burr-core into a folder, as `npm install FOLDER` and `npm pack FOLDER` take it.

    web/npm/pack.py BUILT OUT VERSION      BUILT: the folder with burr_core.mjs, burr_core.wasm and codecs/
"""
import json
import pathlib
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def main():
    built, out, version = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    about = json.loads((HERE / "package.json").read_text())
    about["version"] = version
    for name in about["files"]:
        source = next((one / name for one in (HERE, built, built / "codecs", ROOT / "web/pages/common", ROOT) if (one / name).exists()), None)
        if source is None:
            sys.exit(f"burr: {name} of web/npm/package.json was not found")
        if source.is_dir():
            shutil.copytree(source, out / name)
        else:
            shutil.copy(source, out / name)
    (out / "package.json").write_text(json.dumps(about, indent=2) + "\n")  # last: the build looks for it


main()
