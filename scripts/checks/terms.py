#!/usr/bin/env python3
"""Checks that the texts for users in Swedish and German use one term a thing, as docs/develop/terms.md lists them.

    scripts/checks/terms.py

A second term of its table may not occur at the beginning of a word, in upper or lower case, in
words/*.toml, or in the Swedish and German texts of cases/*.toml and rubrics/*.toml. Also checks that each term of the table is used.
"""
import pathlib
import re
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
bad = []


def texts_in(value, language):
    """All texts below a key that is the language's code, in a case or a rubric."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key == language and isinstance(inner, str):
                yield inner
            yield from texts_in(inner, language)
    elif isinstance(value, list):
        for inner in value:
            yield from texts_in(inner, language)


def texts_of(language):
    words = tomllib.loads((ROOT / "words" / f"{language}.toml").read_text())
    yield from ((f"words/{language}.toml, {key}", text) for key, text in words.items())
    for path in sorted([*ROOT.glob("cases/*.toml"), *ROOT.glob("rubrics/*.toml")]):
        for text in texts_in(tomllib.loads(path.read_text()), language):
            yield f"{path.relative_to(ROOT)}", text


def table():
    page = (ROOT / "docs" / "develop" / "terms.md").read_text()
    rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in page.splitlines() if line.startswith("|")]
    return rows[2:]


def found(term, text):
    return re.search(rf"\b{re.escape(term)}", text, re.I)


rows = table()
for language, column in (("sv", 1), ("de", 2)):
    texts = list(texts_of(language))
    for row in rows:
        if not any(found(row[column], text) for _, text in texts):
            bad.append(f"docs/develop/terms.md: {row[column]} ({language}) is in no text")
        for second in filter(None, (one.strip() for one in row[column + 2].split(","))):
            for place, text in texts:
                if found(second, text):
                    bad.append(f"{place}: “{second}” should be “{row[column]}” ({row[0]}): {text}")
if not rows:
    bad.append("docs/develop/terms.md: the table of terms is empty")
if bad:
    sys.exit("\n".join(bad))
print(f"{len(rows)} terms, each with one word in a language")
