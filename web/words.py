#!/usr/bin/env python3
"""Writes the words of the page: those that it shares with the window, and its own. A file for each language, so that nobody waits for
the words of another one, and the list of the languages.

    web/words.py ROOT SITE      writes SITE/words/CODE.json and SITE/common/languages.js

Every language of ROOT/words needs all keys of SHARED, and a file with the page's own words in ROOT/web/words.
"""
import json
import pathlib
import sys
import tomllib

# keys of words/*.toml that the page shows
SHARED = """language force speed burr removed ticks ticks_good ticks_lost undo redo reset smaller larger slower faster
undone redone back_to_start press pressing lifted time
coolant_on coolant_off suction_on suction_off
mode_title mode_free mode_learn mode_practise mode_exam done_button""".split()


def main():
    root, site = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    names = {}
    (site / "words").mkdir(parents=True, exist_ok=True)
    (site / "common").mkdir(exist_ok=True)
    own_keys = None
    for file in sorted((root / "words").glob("*.toml")):
        window = tomllib.loads(file.read_text())
        own_file = root / "web" / "words" / file.name
        if not own_file.exists():
            sys.exit(f"{own_file} is missing: the page needs its own words in each language")
        own = tomllib.loads(own_file.read_text())
        own_keys = own_keys or set(own)
        if set(own) != own_keys:
            sys.exit(f"{own_file}: these keys are not in all languages: {sorted(set(own) ^ own_keys)}")
        missing = [key for key in SHARED if key not in window]
        if missing:
            sys.exit(f"{file}: lacks {missing}, which the page shows")
        words = {key: window[key] for key in SHARED if key != "language"} | own
        (site / "words" / f"{file.stem}.json").write_text(json.dumps(words, ensure_ascii=False, sort_keys=True))
        names[file.stem] = window["language"]
    (site / "common/languages.js").write_text(
        f"// Written by web/words.py.\nexport const kLanguages = {json.dumps(names, ensure_ascii=False, sort_keys=True)};\n")


main()
