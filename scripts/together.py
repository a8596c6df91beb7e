#!/usr/bin/env python3
"""Which sources of a target are compiled together, as one source that includes them (cmake/together.cmake).

    scripts/together.py FOLDER TARGET < SOURCES      writes FOLDER/TARGET_N.cpp; prints these and the sources that stay alone

Most of the time of a build goes into templates of the C++ library and of Eigen, once for each source. Apart stay sources of
which one has a name of its own (in a namespace without a name) that the other uses for something else, and sources that leave
a macro defined.
"""
import dataclasses
import pathlib
import re
import sys

MOST_BYTES = 90_000  # of a group; a larger one keeps one processor busy at the end while the other waits


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


def names(text):
    """What a source calls its own, and the names that it uses. The text must be formatted as by clang-format."""
    code = re.sub(r"//.*|\"(?:[^\"\\]|\\.)*\"", "", text)
    found = Names(words=set(re.findall(r"(?<![\w.:>])[A-Za-z_]\w*|(?<=[^-]>)[A-Za-z_]\w*", code)))
    own = False
    for line in text.splitlines():
        if line == "namespace {":
            own = True
        elif line == "}  // namespace":
            own = False
        if not re.match(r"[A-Za-z\[]", line) or re.match(r"using namespace|namespace|return|TEST|(public|protected|private|default)\b", line):
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
    folder, target = pathlib.Path(sys.argv[1]), sys.argv[2]
    folder.mkdir(parents=True, exist_ok=True)
    for n, files in enumerate(groups([pathlib.Path(line.strip()) for line in sys.stdin if line.strip()])):
        if len(files) == 1:
            print(files[0])
            continue
        unit = folder / f"{target}_{n}.cpp"
        text = "".join(f'#include "{file}"\n' for file in files)
        if not unit.exists() or unit.read_text() != text:
            unit.write_text(text)
        print(unit)


if __name__ == "__main__":
    main()
