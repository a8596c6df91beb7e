#!/usr/bin/env python3
"""Checks that everything named in the documents exists: links, pictures, files, the program's commands and options. Checks also that

- a page has at most 3000 words; figures of a day and diaries are in bench/results, which has no such rule;
- the README.md of a folder of docs/ names every page of the folder, in one screen;
- a page or folder of docs/ that any file of the project names is there, and so is the section whose name follows in quotes;
- the page of settings is what `burr settings --markdown` prints.

    scripts/checks/docs.py [BUILD]        BUILD: folder of the program; default build/release
"""
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BURR = (pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build/release") / "burr"
MOST_WORDS = 3000
SCREEN = 40  # lines
bad = []


def tracked(*patterns):
    out = subprocess.run(["git", "-c", "safe.directory=*", "ls-files", "-z", "--", *patterns], cwd=ROOT, check=True, capture_output=True, text=True)
    return [name for name in out.stdout.split("\0") if name and (ROOT / name).is_file()]


def headings(page):
    return [head.strip() for head in re.findall(r"^#+ +(.*)$", page.read_text(), re.M)]


helps = {}


def help_of(*command):
    if command not in helps:
        done = subprocess.run([BURR, *command, "--help"], capture_output=True, text=True)
        known = f"Usage: burr {' '.join(command)}".strip() + " "
        helps[command] = done.stdout if done.returncode == 0 and known in done.stdout else None
    return helps[command]


def check_links(name, text):
    for target in re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r'(?:src|href)="([^"]+)"', text):
        if re.match(r"[a-z]+:", target) or target.startswith("#"):
            continue
        file, _, anchor = target.partition("#")
        place = (ROOT / name).parent / file
        if not place.exists():
            bad.append(f"{name}: links to {target}, which is not there")
        elif anchor and place.suffix == ".md":
            heads = [re.sub(r"[^\w\- ]", "", head).strip().lower().replace(" ", "-") for head in headings(place)]
            if anchor not in heads:
                bad.append(f"{name}: links to {target}, but {file} has no such heading")


def check_size(name, text):
    words = len(text.split())
    if words > MOST_WORDS and not name.startswith("bench/results/"):
        bad.append(f"{name}: {words} words, {MOST_WORDS} at most; divide it by idea, and put figures of a day into bench/results")


def index_of(page):
    """The README.md that must name this page: of its folder, or of the nearest one above that has an index."""
    folder = page.parent.parent if page.name == "README.md" else page.parent
    while folder != ROOT / "docs" and not (folder / "README.md").exists():
        folder = folder.parent
    return folder / "README.md"


def check_indexes(documents):
    pages = [ROOT / name for name in documents if name.startswith("docs/")]
    for folder in sorted({page.parent for page in pages if page.parent.parent == ROOT / "docs"}):
        if not (folder / "README.md").exists():
            bad.append(f"{folder.relative_to(ROOT)}: has no README.md that names its pages")
    for page in pages:
        if page.name == "README.md":
            lines = page.read_text().count("\n")
            if lines > SCREEN:
                bad.append(f"{page.relative_to(ROOT)}: {lines} lines; an index has one screen, {SCREEN} lines")
            if page.parent == ROOT / "docs":
                continue
        index = index_of(page)
        if not index.exists():
            continue
        named = {(index.parent / target).resolve() for target in re.findall(r"\]\(([^)#\s]+)", index.read_text())}
        if page.resolve() not in named:
            bad.append(f"{index.relative_to(ROOT)}: does not name {page.relative_to(index.parent)}")


def check_names(name, text):
    """Pages of docs/ that a file names, with the sections in quotes after the name; both may be broken over lines of a comment."""
    for found in re.finditer(r"(?<![\w/.-])docs/[\w./{}-]*[\w}]", text):
        path = found[0]
        if not list(ROOT.glob(re.sub(r"\{\w*\}", "*", path))):
            bad.append(f"{name}: names {path}, which is not there")
        elif path.endswith(".md") and "{" not in path:
            after = re.sub(r"\n\s*(?://|#|\*)?\s*", " ", text[found.end():found.end() + 160])
            sections = re.match(r',? \\?"([^"\\]+)\\?"(?: and \\?"([^"\\]+)\\?")?', after)
            for section in filter(None, sections.groups() if sections else ()):
                if section not in headings(ROOT / path):
                    bad.append(f"{name}: names \"{section}\" of {path}, which has no such section")


def what_it_adds(text):
    """The page without its C++ and its patches, and what these add to the project: files and options (checked by how_to_*.py)."""
    files = set(re.findall(r"`([\w/.]+)`:\n\n```cpp\n", text))
    options = set()
    for patch in re.findall(r"^```diff\n(.*?)^```", text, re.S | re.M):
        options.update(re.findall(r"^\+.*\"(--[\w-]+)\"", patch, re.M))
        # a row of the table of settings is an option by its word
        options.update("--" + word.replace("_", "-") for word in re.findall(r"^\+.*\btyped\(\"(\w+)\"", patch, re.M))
    return re.sub(r"^```(?:cpp|diff)\n.*?^```\n", "", text, flags=re.S | re.M), files, options


def check_paths(name, text, added):
    for path in re.findall(r"`((?:src|docs|scripts|tests|bench|samples|scenes|cases|apps|cmake|fuzz|\.ci)/[\w./-]*)`", text):
        if path not in added and not (ROOT / path).exists() and not list(ROOT.glob(path + ".*")):
            bad.append(f"{name}: names {path}, which is not there")


def check_command(name, line, added):
    """Checks one line of a document that runs the program, ./run or ./test."""
    line = line.split("  #")[0].strip()
    line = re.sub(r"^[\w$ ]*\$ ", "", line)
    try:
        words = shlex.split(line.replace("|", " | ").replace("&&", " ; "), comments=True)
    except ValueError:
        bad.append(f"{name}: cannot be typed: {line}")
        return
    while words and re.fullmatch(r"[A-Z_]+=.*", words[0]):
        words = words[1:]
    if not words:
        return
    program = words[0]
    if program in ("./run", "./test") or program.startswith("scripts/"):
        if not (ROOT / program).exists():
            bad.append(f"{name}: runs {program}, which is not there")
        return
    if program not in ("burr", "build/release/burr") or len(words) < 2 or not BURR.exists():
        return
    command = []
    for word in words[1:4]:
        if re.fullmatch(r"[a-z][a-z-]*", word) and help_of(*command, word) is not None:
            command.append(word)
        else:
            break
    if not command:
        if words[1] not in ("--version", "--help", "help"):
            bad.append(f"{name}: `burr {words[1]}` is no command: {line}")
        return
    known = help_of(*command) + (help_of() or "")
    for word in words[2:]:
        if word in ("|", ";", ">"):
            break
        option = word.split("=")[0]
        if option not in added and re.fullmatch(r"--[a-z][a-z-]*", option) and not re.search(re.escape(option) + r"(?![\w-])", known):
            bad.append(f"{name}: `burr {' '.join(command)}` has no {option}: {line}")


def check_printed():
    page = ROOT / "docs/use" / "settings.md"
    if not page.exists() or not BURR.exists():
        return
    if subprocess.run([BURR, "settings", "--markdown"], capture_output=True, text=True).stdout != page.read_text():
        name = page.relative_to(ROOT)
        bad.append(f"{name}: is not what the program prints; write it anew: build/release/burr settings --markdown > {name}")


documents = [n for n in tracked("*.md") if not n.startswith("tests/")]
for name in documents:
    text, new_files, new_options = what_it_adds((ROOT / name).read_text())
    check_size(name, (ROOT / name).read_text())
    check_links(name, text)
    check_paths(name, text, new_files)
    inside = False
    joined = ""
    for line in text.splitlines():
        if line.startswith("```"):
            inside = not inside
            continue
        if inside or line.startswith("    "):
            joined += line.strip()
            if joined.endswith("\\"):
                joined = joined[:-1] + " "
                continue
            check_command(name, joined, new_options)
            joined = ""
    for code in re.findall(r"`((?:build/release/)?burr [^`]+|\./(?:run|test)[^`]*)`", text):
        check_command(name, code, new_options)

check_printed()
check_indexes(documents)
# the marks of learners name the text of their rubric by its hash, so not a comment of it is changed
for name in tracked(".", ":!third_party", ":!rubrics"):
    try:
        check_names(name, (ROOT / name).read_text())
    except UnicodeDecodeError:
        continue  # no text

for line in bad:
    print(line)
print(f"{len(documents)} documents, {len(bad)} complaints")
sys.exit(bool(bad))
