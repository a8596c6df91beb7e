#!/usr/bin/env python3
"""The short list of .clang-tidy holds in the library.

    scripts/checks/tidy.py [BUILD]         BUILD: has compile_commands.json; default build/release

Most of clang-tidy's time goes into the headers of Eigen and of the standard library, once for each file. So many files are
looked at together, as one source that includes them. Files whose names clash are put into different groups (together.py);
where two of a group cannot be compiled together all the same, the group is halved until they are apart.

Left out: what includes ITK, GDCM or DCMTK (a minute a file), and a kernel's copies for other processors.
"""
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

MOST = 60  # files in a group: about 40 s
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import together  # noqa: E402  (which sources can be compiled as one)


def commands(build):
    """{file: how it is compiled, without its own name and what is written}"""
    found = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        files = [pathlib.Path(entry["file"])]
        if files[0].parent.name == "together":  # several sources compiled as one (cmake/together.cmake)
            files = [(files[0].parent / name).resolve() for name in re.findall(r'#include "(.*)"', files[0].read_text())]
        files = [file for file in files if file.is_relative_to(ROOT / "src" / "burr")]
        if files:
            words = shlex.split(entry["command"])
            at = words.index("-o")
            words = words[:at] + words[at + 2:]
            while "-include" in words:  # g++'s precompiled headers, which clang-tidy cannot read
                at = words.index("-include")
                words = words[:at] + words[at + 2:]
            how = tuple(word for word in words if word not in ("-c", "-Winvalid-pch", entry["file"]))
            found.update((file, how) for file in files)
    return found


def settings(command):
    """What of a command says what the source means: compiler and language; then defines and folders, a pair each."""
    words, rest, pairs = iter(command), [], []
    for word in words:
        if word in ("-isystem", "-I", "-D"):
            pairs.append((word, next(words)))
        elif re.match("-[ID]", word):
            pairs.append((word,))
        elif not re.match("-[WO]|--param=", word):  # warnings, optimisation and g++'s memory change nothing for clang-tidy
            rest.append(word)
    return tuple(rest), pairs


def alike(found):
    """The same with few commands: one for all that differ in defines and folders only, with those of all of them.

    The headers cost more than the files, so many small groups would take twice the time. A define that has two values keeps
    its files apart.
    """
    made = {}  # compiler and language: list of [defines with their values, pairs, files]
    for file, command in sorted(found.items()):
        rest, pairs = settings(command)
        values = dict("".join(pair)[2:].partition("=")[::2] for pair in pairs if pair[0].startswith("-D"))
        for one in made.setdefault(rest, []):
            if all(one[0].get(name, value) == value for name, value in values.items()):
                break
        else:
            one = [{}, [], []]
            made[rest].append(one)
        one[0].update(values)
        one[1].extend(pair for pair in pairs if pair not in one[1])
        one[2].append(file)
    return {file: (*rest, *(word for pair in pairs for word in pair))
            for rest, ones in made.items() for _, pairs, files in ones for file in files}


def with_kernels(file, text):
    """The text, and that of the kernels that it includes for its processor (x.inc)."""
    kernels = re.findall(r'#include "burr/(.*\.inc)"', text)
    return text + "".join((ROOT / "src" / "burr" / kernel).read_text(errors="replace") for kernel in kernels)


def groups(build):
    """Lists of files that can be looked at together and do not define the same names, and how."""
    made = []  # [command, files, {room: its names}]; each room is a namespace
    for file, command in sorted(alike(commands(build)).items()):
        text = file.read_text(errors="replace")
        if file.suffix != ".cpp" or re.search(r"_avx(2|512)\.cpp$", file.name) or re.search(r"#include <(itk|gdcm|dcmtk)", text):
            continue
        room, mine = file.relative_to(ROOT / "src" / "burr").parts[0], together.names(with_kernels(file, text))
        if re.search(r"#include <(X11/|GL/glx)|OPENXR|SDL_syswm", text):  # whose macros change what other files say
            command = (*command, "-DALONE")
        for group in made:
            if group[0] == command and len(group[1]) < MOST and not group[2].setdefault(room, together.Names()).clash(mine):
                break
        else:
            group = [command, [], {room: together.Names()}]
            made.append(group)
        group[1].append(file)
        group[2][room].take(mine)
    for command, files, _ in made:
        yield files, command


def look(files, command, folder):
    """What clang-tidy says about these files."""
    place = pathlib.Path(tempfile.mkdtemp(dir=folder))
    source = place / "together.cpp"
    if len(files) == 1:
        source = files[0]
    else:
        source.write_text("".join(f'#include "{file}"  // NOLINT\n' for file in files))
    (place / "compile_commands.json").write_text(json.dumps(
        [{"directory": str(place), "file": str(source), "command": shlex.join([*command, "-c", str(source)])}]))
    done = subprocess.run(["clang-tidy", "-p", str(place), "--quiet", f"--config-file={ROOT / '.clang-tidy'}",
                           f"--header-filter={ROOT}/src/burr/.*", "--extra-arg=-Wno-unknown-warning-option", str(source)],
                          capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return ""
    if len(files) > 1:  # not together, or a finding: who it was is said of smaller groups
        return look(files[::2], command, folder) + look(files[1::2], command, folder)
    said = "\n".join(line for line in (done.stdout + done.stderr).splitlines() if not re.match(r"\d+ warnings? ", line))
    return said + "\n" if said.strip() else f"clang-tidy ended with {done.returncode} at {files[0]}\n"


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "release").resolve()
    work = sorted(groups(build), key=lambda group: -sum(file.stat().st_size for file in group[0]))
    if not work:
        print(f"tidy.py: {build}/compile_commands.json names no file of src/burr", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        workers = int(os.environ.get("BURR_CORES", 0)) or os.cpu_count()
        with concurrent.futures.ThreadPoolExecutor(workers) as pool:  # the longest first
            said = list(pool.map(lambda group: look(*group, folder), work))
    sys.stdout.write("".join(said))
    return 1 if any(said) else 0


if __name__ == "__main__":
    sys.exit(main())
