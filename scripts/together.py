#!/usr/bin/env python3
"""Which sources of a target are compiled together, as one source that includes them (cmake/together.cmake).

    scripts/together.py FOLDER < SOURCES

SOURCES: a line <NAME>, then a line for each source that may be compiled with the others of this name; and so on. Writes
FOLDER/NAME_N.cpp; prints, after the line <NAME>, these and the sources that stay alone.

Most of the time of a build goes into templates of the C++ library and of Eigen, once for each source. A source's own names
(in a namespace without a name) get an ending by macros, so that two sources may use the same name. Where a macro would change
something else, the name stays as it is, and a source that uses it for something else stays apart. So do sources that leave a
macro defined.
"""
import dataclasses
import functools
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = [ROOT / "src", ROOT / "apps" / "burr", ROOT / "tests", ROOT]  # where an #include looks
KEYWORDS = set("auto bool case char class const constexpr default double else enum false float for if inline int long namespace return short"
               " signed static static_assert struct switch template this true typedef union unsigned using void while".split())
MOST_BYTES = 90_000  # of a group; a larger one keeps one processor busy at the end while the other waits
MOST_BYTES_OF_GLUE = 200_000  # the program's window and the tests only call the library: a compiler's time goes into headers
GLUE = ("burr_app_", "burr_program_", "test_")


@dataclasses.dataclass
class Names:
    """Names of a source, or of a group."""
    functions: set = dataclasses.field(default_factory=set)  # of its own
    others: set = dataclasses.field(default_factory=set)     # its own constants, variables and types
    public: set = dataclasses.field(default_factory=set)     # functions that it defines for others
    words: set = dataclasses.field(default_factory=set)      # without members and qualified names

    def clash(self, other):
        return bool(self.functions & (other.functions | other.public) or self.public & other.functions
                    or self.others & other.words or other.others & self.words)

    def take(self, other):
        for field in dataclasses.fields(self):
            getattr(self, field.name).update(getattr(other, field.name))


def without_raw_strings(text):
    return re.sub(r'R"(\w*)\((?:.|\n)*?\)\1"', '""', text)


def names(text):
    """What a source calls its own, and the names that it uses. The text must be formatted as by clang-format."""
    text = without_raw_strings(text)
    code = re.sub(r"//.*|\"(?:[^\"\\]|\\.)*\"", "", text)
    found = Names(words=set(re.findall(r"(?<![\w.:>])[A-Za-z_]\w*|(?<=[^-]>)[A-Za-z_]\w*", code)))
    own = False
    for line in text.splitlines():
        if line == "namespace {":
            own = True
        elif line == "}  // namespace":
            own = False
        if not re.match(r"[A-Za-z\[]", line) or re.match(r"using namespace|namespace|return|static_assert|TEST|(public|protected|private|default)\b", line):
            continue
        head = re.split(r"[({=;]", re.sub(r"^template *<.*?> *(?=\w)", "", line), maxsplit=1)[0]
        last = re.search(r"(?<![\w:])(\w+)(?:\[\w*\])* *$", head)
        name = {last.group(1)} if last and not re.match(r"(struct|class|enum|union|using)\b", line) else set()
        a_function = line[len(head):].startswith("(") or "(" in line and "=" not in line
        if not own and not line.startswith(("static ", "const ", "constexpr ")):
            found.public.update(name if a_function else ())
            continue
        found.others.update(re.findall(r"(?:struct|enum class|class|enum|union) (\w+)", line), re.findall(r"^using (\w+) =", line))
        if re.match(r"(static )?const", line) and not a_function:
            found.others.update(re.findall(r"(\w+)(?:\[\w*\])* *=(?!=)", line))  # several in one line
        (found.functions if a_function else found.others).update(name)
    return found


@functools.cache
def header_of(name):
    """Functions and external variables that a header of the project declares, and headers that it includes; of another header nothing."""
    for folder in FOLDERS:
        if (folder / name).is_file():
            text = (folder / name).read_text(errors="replace")
            declared = re.findall(r"^[A-Za-z\[][^(=\n]*?(\w+)\(|^extern .*?(\w+)(?:\[\w*\])*;", text, re.M)
            return {name for pair in declared for name in pair}, re.findall(r'^#include "(.*)"', text, re.M)
    return [], []


def declared_in_headers(text):
    """The functions and external variables that its headers declare, and those that these include."""
    found, seen, next_ones = set(), set(), re.findall(r'^#include "(.*)"', text, re.M)
    while next_ones:
        name = next_ones.pop()
        if name not in seen:
            seen.add(name)
            functions, more = header_of(name)
            found.update(functions)
            next_ones.extend(more)
    return found


@functools.cache
def gets_an_ending(file):
    """Which of a source's own names a macro may change: those that mean one thing wherever they stand.

    Not: a name of a member too, or of something in a namespace; of what a header declares; in a macro; in the name of a test.
    """
    text = file.read_text(errors="replace")
    own, code = names(text), re.sub(r"//.*|\"(?:[^\"\\]|\\.)*\"", "", without_raw_strings(text))
    other = set(re.findall(r"(?:(?<!\.)\.|->|::) *~?(\w+)", code)) | own.functions & set(re.findall(r"(\w+)::", code))
    for line in re.findall(r"^ *#(?:.*\\\n)*.*|^(?:[A-Z_]*TEST[A-Z_]*|INSTANTIATE\w*|MATCHER\w*)\(.*(?:\n .*)?", code, re.M):
        other.update(re.findall(r"\w+", line))
    other.update(name for name in own.functions | own.others if len(name) < 3 or name in KEYWORDS or re.fullmatch("[A-Z0-9_]+", name))
    return (own.functions | own.others) - other - declared_in_headers(text)


def headers(file, text, folder):
    """The lines that include a header, but those on a condition, and headers that say something else each time.

    FOLDER: of the source that says these lines.
    """
    depth, found = 0, []
    for line in text.splitlines():
        depth += bool(re.match(r" *# *if", line)) - bool(re.match(r" *# *endif", line))
        line = re.match(r'#include (<[^>]+>|"[^"]+\.h")', line) if depth == 0 else None
        if line and line[1].startswith("<"):
            found.append(line[0])
        elif line:
            places = [place / line[1].strip('"') for place in (file.parent, *FOLDERS)]
            place = next((place for place in places if place.is_file()), None)
            if place and re.search("^#pragma once$", place.read_text(errors="replace"), re.M):
                found.append(f'#include "{os.path.relpath(place, folder)}"')
    return found


def unit(files, folder):
    """The source in FOLDER that includes them, by their way from there: so it is the same in another checkout, and a
    compiler's cache knows it."""
    texts = [file.read_text(errors="replace") for file in files]
    first = dict.fromkeys(line for file, text in zip(files, texts) for line in headers(file, text, folder))  # macros must not change what a header says
    said = "".join(f"{line}\n" for line in first)
    for n, file in enumerate(files):
        own = sorted(gets_an_ending(file))
        said += "".join(f"#define {name} {name}_of_{n}\n" for name in own)
        said += f'#include "{os.path.relpath(file, folder)}"\n'
        said += "".join(f"#undef {name}\n" for name in own)
    return said


def leaves_a_macro(text):
    """Whether it defines a macro and does not take it back."""
    return bool(set(re.findall(r"^ *# *define (\w+)", text, re.M)) - set(re.findall(r"^ *# *undef (\w+)", text, re.M)))


def groups(files, most_bytes=MOST_BYTES):
    """Lists of files that may be compiled as one; a file that must be alone is a list of its own."""
    made, alone = [], []  # made: [files, names, bytes]
    for file in sorted(files):
        text = file.read_text(errors="replace")
        if leaves_a_macro(text):
            alone.append([file])
            continue
        mine = names(text)
        ending = gets_an_ending(file)
        for those in (mine.functions, mine.others, mine.words):
            those -= ending
        for group in made:
            if group[2] + len(text) <= most_bytes and not group[1].clash(mine):
                break
        else:
            group = [[], Names(), 0]
            made.append(group)
        group[0].append(file)
        group[1].take(mine)
        group[2] += len(text)
    return [group[0] for group in made] + alone


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    wanted = {}
    for line in filter(None, map(str.strip, sys.stdin)):
        if line.startswith("<"):
            wanted[name := line.strip("<>")] = []
        else:
            wanted[name].append(pathlib.Path(line))
    for name, sources in wanted.items():
        print(f"<{name}>")
        for n, files in enumerate(groups(sources, MOST_BYTES_OF_GLUE if name.startswith(GLUE) else MOST_BYTES)):
            if len(files) == 1:
                print(files[0])
                continue
            source, text = folder / f"{name}_{n}.cpp", unit(files, folder)
            if not source.exists() or source.read_text() != text:
                source.write_text(text)
            print(source)


if __name__ == "__main__":
    main()
