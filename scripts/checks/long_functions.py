#!/usr/bin/env python3
"""Finds functions that are too long: more than 60 lines in src/burr/tick, more than 100 elsewhere in src and apps.

    scripts/checks/long_functions.py [ROOT]       ROOT: a checkout; default: this one

A function counts from the first line of its head to its closing brace; lambdas inside count as part of it.
"""
import pathlib
import re
import sys

LIMITS = [("src/burr/tick/", 60), ("", 100)]

BLANK = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^()\\\s]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\''
    r'|^[ \t]*#(?:[^\n\\]|\\.|\\\n)*', re.S | re.M)
OTHER = re.compile(r"\s*(?:inline\s+|export\s+)*(?:namespace|class|struct|union|enum|extern)\b(?![^{]*\)\s*(?:const)?\s*$)")


def blanked(text):
    """Comments, texts and directives become spaces; lines stay."""
    def spaces(match):
        start = match.start()
        if match.group().startswith("'") and start > 0 and text[start - 1].isalnum():
            return match.group().replace("'", " ") if "{" not in match.group() and "}" not in match.group() else match.group()
        return re.sub(r"[^\n]", " ", match.group())
    return BLANK.sub(spaces, text)


def head_is_function(head):
    """True for the text before a brace that opens a function's body."""
    if ")" not in head or OTHER.match(head):
        return False
    depth = 0
    for n, char in enumerate(head):
        depth += (char in "([{") - (char in ")]}")
        if char == "=" and depth == 0 and not re.search(r"operator\s*[=!<>+\-*/|&^%]*$", head[:n]):
            return False
    return True


def name_of(head):
    """Foo::bar of its head."""
    before = head
    depth = 0
    for n, char in enumerate(head):
        if char == "(" and depth == 0 and re.search(r"(\w|operator\W+|\])\s*$", head[:n]) and not head[:n].rstrip().endswith("decltype"):
            before = head[:n]
            break
        depth += (char in "(<") - (char in ")>" and not head[:n].endswith("-"))
    found = re.search(r"(?:[\w~]+(?:<[^<>]*>)?::)*(?:operator\s*\W+|[\w~]+)\s*$", before)
    return found.group().strip() if found else "lambda"


def functions(text):
    """[(name, lines, first line)] of a source text."""
    text = blanked(text)
    partner, stack = {}, []
    for at, char in enumerate(text):
        if char == "{":
            stack.append(at)
        elif char == "}" and stack:
            partner[stack.pop()] = at
    found, at, start = [], 0, 0
    while at < len(text):
        char = text[at]
        if char == "{" and at in partner:
            end = partner[at]
            head = text[start:at]
            follows = text[end + 1:].lstrip()[:1]
            if head.count("(") > head.count(")"):  # an argument
                at = end + 1
                continue
            if head_is_function(head):
                if follows in (",", "{"):  # a member's initialiser, the body comes later
                    at = end + 1
                    continue
                first = start + len(head) - len(head.lstrip())
                lines = text.count("\n", first, end) + 1
                found.append((name_of(head), lines, text.count("\n", 0, first) + 1))
                at = start = end + 1
                continue
            start = at + 1
        elif char in ";}":
            start = at + 1
        elif char == ":" and re.search(r"\b(public|private|protected)\s*$", text[start:at]):
            start = at + 1
        at += 1
    return found


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2]
    wrong, count = [], 0
    for folder in ("src", "apps"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".cpp", ".h", ".inc"):
                continue
            path = file.relative_to(root).as_posix()
            limit = next(most for start, most in LIMITS if path.startswith(start))
            for name, lines, first in functions(file.read_text(errors="replace")):
                count += 1
                if lines > limit:
                    wrong.append(f"{path}:{first}: {name} has {lines} lines, {limit} are allowed")
    if count == 0:
        wrong.append("no function found: is this a checkout?")
    for line in wrong:
        print(line)
    print(f"{count} functions looked at, {len(wrong)} too long")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
