#!/usr/bin/env python3
"""Prints which rooms of src/burr and which folders of apps/burr include which, and fails where this differs from
docs/develop/architecture.md and program_floors.md.

    scripts/rooms.py [ROOT]               ROOT: the folder that holds src/burr and apps; default: this checkout
    scripts/rooms.py --above ROOM         prints ROOM and the rooms that include it, as far as they have tests (./test --room)

Fails on a room that is not listed, an arrow that is not listed, rooms that include each other in a circle, files that
include each other in a circle (in src/burr and in apps; a header and the source beside it count as one), a folder of
apps/burr that is on no floor or includes one that is not on a lower floor, and a third-party header in the wrong place:
graphics and headsets only in render/gl, the loudspeaker only in sound, file formats only in io, HTTP and WebSocket only
in net, a vendor's library only in its own folder.
"""
import collections
import os
import pathlib
import re
import sys

# Besides base and math, which every room may include. A room that is missing here is an error until
# it is added here, in docs/develop/architecture.md and in docs/develop/decisions.
ALLOWED = {
    "base": "",
    "math": "",
    "rt": "",
    "volume": "rt",
    "tool": "rt",
    "net": "",
    "device": "rt net",
    "people": "",
    "edit": "volume tool rt",
    "haptics": "volume tool rt device",
    "surface": "volume rt",
    "thermal": "volume rt",
    "sound": "tool rt",
    "phantom": "volume tool",
    "surgeon": "volume device tool scenario people rt",
    "scenario": "volume tool",
    "io": "surface volume rt",
    "render": "surface volume tool rt",
    "importing": "io scenario surface volume rt",
    "tick": "edit haptics surface thermal device tool volume rt",
    "record": "tick scenario device haptics edit volume tool rt",
    "sim": "tick edit record device haptics thermal people volume tool rt",
    "fit": "record",
    "metrics": "record tick thermal volume tool rt",
    "scoring": "metrics record rt scenario volume",
    "school": "people record",
    "words": "scenario",
    "guidance": "words workshop scoring record scenario tool volume rt",
    "report": "words scoring metrics workshop sim record render surface scenario edit volume rt",
    "mouse": "workshop device render scenario rt",
    "lrs": "school net",
    "workshop": "sim edit tick record importing io phantom surgeon scenario surface render sound device volume tool rt",
    "proof": "report workshop scoring metrics surgeon sim record scenario people tick device tool volume",
    "dataset": "workshop sim record render surface tick device volume tool",
}
# Headers that lie in no room: each is a list of the public headers of these rooms.
FRONTS = {"core.h": ("base", "math", "rt", "volume", "tool", "device", "edit", "haptics", "surface", "thermal", "tick")}
BASICS = {"base": set(), "math": {"base"}, "rt": {"base"}, "net": {"base"}}  # the lowest rooms, with shorter lists

# Of these rooms only headers with plain structs: (from, to) -> headers.
ONLY = {
    ("tool", "rt"): {"rt.h"},
    ("io", "rt"): {"lanes.h", "simd.h"},
    ("importing", "rt"): {"lanes.h", "simd.h"},
    ("importing", "surface"): {"cases.h", "enclosed.h"},
    ("haptics", "device"): {"hand_state.h"},
    ("device", "net"): {"web_socket.h"},
    ("surgeon", "rt"): {"rt.h"},
    ("surgeon", "device"): {"hand_path.h", "device.h"},
    ("surgeon", "scenario"): {"lesson.h"},
    ("surgeon", "people"): {"random_stream.h"},
    ("record", "tick"): {"rows.h", "command.h", "tick_hash.h"},
    ("record", "device"): {"hand_state.h"},
    ("record", "haptics"): {"contact.h"},
    ("record", "edit"): {"ledger.h", "mirror.h"},
    ("record", "tool"): {"burr_tool.h", "limits.h", "state.h", "shaped_tool.h", "shape_grid.h"},
    ("sim", "edit"): {"piece_store.h", "piece_move.h", "bone_memory.h", "crossed.h"},
    ("workshop", "edit"): {"piece_store.h"},
    ("metrics", "tick"): {"rows.h"},
    ("metrics", "tool"): {"burr_tool.h", "state.h", "cutting_places.h", "shaped_tool.h"},
    ("scoring", "record"): {"player.h", "course.h"},
    ("school", "record"): {"identity.h", "sealer.h", "session_info.h"},
    ("words", "scenario"): {"lesson.h"},
    ("guidance", "record"): {"course.h", "private_text.h"},
    ("guidance", "scoring"): {"step_done.h", "step_target.h"},
    ("guidance", "workshop"): {"label_check.h"},
    ("report", "edit"): {"piece_store.h"},
    ("report", "sim"): {"move_pieces.h"},
    ("proof", "workshop"): {"label_check.h", "open_bone.h", "other_bone.h", "prepare.h", "recording.h"},
    ("proof", "people"): {"random_stream.h"},
    ("mouse", "scenario"): {"rack.h"},
    ("mouse", "workshop"): {"device_book.h"},
}

# The floors of apps/burr, the lowest first: a folder includes itself and folders of lower floors, so none of its own
# floor. "." is main.cpp.
FLOORS = [
    "shared window/hands window/station",
    "batch bench devices school",
    "doctor serve",
    "verify",
    "people",
    "window/ui",
    "window/parts",
    "window/import window/mill window/rate window/replay window/review window/start",
    "window/shell",
    "commands",
    ".",
]

# Third-party headers and the folders that may include them.
ELSEWHERE = [
    (r"(GL|GLES\d?|EGL|epoxy|GLFW)/|SDL(2/SDL)?_(open|video|render|vulkan)", ["render/gl"], "graphics"),
    (r"openxr/", ["render/gl"], "a headset"),
    (r"SDL", ["render/gl", "sound"], "graphics and sound"),
    (r"sqlite3|libpq|postgresql", ["school"], "a database"),
    (r"boost/(beast|asio)", ["net"], "HTTP and WebSocket"),
    (r"hdf5[.]h|H5", ["dataset"], "a format of data sets"),
    (r"itk|gdcm|dcmtk/|assimp/|vtk|png[.]h|yaml[.]h", ["io"], "a file format's library"),
    (r"dds/|crtk_messages", ["device/crtk"], "the bus of ROS 2"),
    (r"HD/hd|HDU|openhaptics|dhdc|drdc|chai3d|haply", None, "a vendor's library"),  # device/<vendor> only
]
# What headers may include: the standard library, Eigen, burr.
PUBLIC = re.compile(r"^(Eigen/|burr/|stdint\.h$|[a-z_0-9]+$|sys/|unistd|pthread|sched|semaphore|[a-z]+intrin\.h$)")

# A header whose first comment says this may include more and belongs to its room. It is never
# installed; cmake/install.cmake lists the headers that are.
PRIVATE = "of this room only"

# Such headers that another room may include all the same: (room, header).
LENT = {("scoring", "scenario/toml_reader.h"), ("scoring", "scenario/read_lesson.h")}

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.M)


def is_private(file):
    """True: the header's first comment says that it is for use of its own room only."""
    if not file.is_file():
        return False
    greeting = []
    for line in file.read_text(errors="replace").splitlines():
        if not line.startswith("//"):
            break
        greeting.append(line.lstrip("/ "))
    return PRIVATE in " ".join(greeting)


def read(root):
    """[(file inside src/burr, [(quoted, name)])]"""
    found = []
    for file in sorted(root.rglob("*")):
        if file.suffix in (".h", ".hpp", ".cpp", ".inl", ".c", ".cc"):
            names = [(bool(q), q or a) for q, a in INCLUDE.findall(file.read_text(errors="replace"))]
            found.append((file.relative_to(root), names))
    return found


def may(room, other):
    if room in BASICS:
        return other in BASICS[room]
    return other in ("base", "math") or other in ALLOWED[room].split()


def third_party(path, name):
    """Returns why this file may not include that third-party header; empty: it may."""
    folder = path.parent.as_posix()
    for pattern, homes, what in ELSEWHERE:
        if not re.match(pattern, name):
            continue
        if homes is None:
            if not re.match(r"device/\w+", folder):
                return f"{what} belongs into a folder of its own under device/"
        elif not any(folder == home or folder.startswith(home + "/") for home in homes):
            return f"{what} belongs into {' or '.join(homes)}"
    return ""


def look(root):
    """Returns the arrows (from, to) -> count and the list of complaints."""
    doors, wrong = collections.Counter(), []
    for path, names in read(root):
        where = f"src/burr/{path}"
        if len(path.parts) < 2:
            if path.name not in FRONTS:
                wrong.append(f"{where}: lies in no room")
            for _, name in names:
                if (room := name.split("/")[1] if name.startswith("burr/") else None) not in FRONTS.get(path.name, ()):
                    wrong.append(f"{where}: includes {name}; it is a list of headers of {', '.join(FRONTS.get(path.name, ()))}")
            continue
        room = path.parts[0]
        if room not in ALLOWED:
            wrong.append(f"{where}: room '{room}' is not listed; see docs/develop/architecture.md, section 2")
            continue
        for quoted, name in names:
            trouble = third_party(path, name)
            if trouble:
                wrong.append(f"{where}: includes {name}; {trouble}")
            parts = name.split("/")
            if parts[0] != "burr":
                if quoted:
                    wrong.append(f'{where}: includes "{name}"; say it from the root: "burr/<room>/<file>"')
                continue
            other = parts[1]
            if len(parts) < 3 or other not in ALLOWED:
                wrong.append(f"{where}: includes {name}; room '{other}' is not listed")
            elif other != room:
                doors[room, other] += 1
                only = ONLY.get((room, other))
                if not may(room, other):
                    wrong.append(f"{where}: includes {name}; the arrow {room} -> {other} is not listed")
                elif is_private(root / "/".join(parts[1:])) and (room, "/".join(parts[1:])) not in LENT:
                    wrong.append(f"{where}: includes {name}, which is for room {other} only")
                elif only and parts[-1] not in only:
                    wrong.append(f"{where}: includes {name}; of {other}, {room} may know only {', '.join(sorted(only))}")
            elif room == "device" and len(parts) > 3 and path.parts[1] != parts[2]:
                wrong.append(f"{where}: includes {name}; a vendor's folder is known only to itself")
        if path.suffix == ".h" and not is_private(root / path):
            for quoted, name in names:
                if not quoted and not PUBLIC.match(name):
                    wrong.append(f"{where}: a header shows others only the standard library and Eigen, not <{name}>")
    return doors, wrong


def look_at_floors(app):
    """The same for the folders of apps/burr."""
    level = {folder: number for number, floor in enumerate(FLOORS) for folder in floor.split()}
    doors, wrong = collections.Counter(), []
    files = dict(read(app))
    for path, names in files.items():
        where, folder = f"apps/burr/{path}", path.parent.as_posix()
        if folder not in level:
            wrong.append(f"{where}: folder '{folder}' is on no floor; see docs/develop/program_floors.md")
            continue
        for _, name in names:
            places = [pathlib.Path(os.path.normpath(place)) for place in (path.parent / name, name)]
            found = next((place for place in places if place in files), None)
            other = found.parent.as_posix() if found else folder
            if other == folder:
                continue
            doors[folder, other] += 1
            if other in level and level[other] >= level[folder]:
                same = "the same" if level[other] == level[folder] else "a higher"
                wrong.append(f"{where}: includes {name}; {other} is on {same} floor")
    return doors, wrong


def file_arrows(root):
    """{unit: units that it includes}; a unit is a header and its source: a path from ROOT without its suffix."""
    known = {}
    for folder in (root / "src" / "burr", root / "apps"):
        for file in sorted(folder.rglob("*")):
            if file.suffix in (".h", ".hpp", ".cpp", ".inl", ".inc", ".c", ".cc"):
                known[file.relative_to(root)] = INCLUDE.findall(file.read_text(errors="replace"))
    arrows = collections.defaultdict(set)
    for path, names in known.items():
        for quoted, angled in names:
            name = quoted or angled
            for place in (path.parent / name, pathlib.Path("src") / name, pathlib.Path("apps") / "burr" / name):
                if place in known and place.with_suffix("") != path.with_suffix(""):
                    arrows[path.with_suffix("").as_posix()].add(place.with_suffix("").as_posix())
                    break
    return arrows


def file_circles(arrows):
    """Groups of files each of which reaches all others of its group and itself."""
    reach = {}
    for start in arrows:
        seen, todo = set(), [start]
        while todo:
            for near in arrows.get(todo.pop(), ()):
                if near not in seen:
                    seen.add(near)
                    todo.append(near)
        reach[start] = seen
    groups = {frozenset(other for other in reach[file] if file in reach.get(other, ())) for file in reach if file in reach[file]}
    return sorted(sorted(group) for group in groups)


def circles(doors):
    reach = collections.defaultdict(set)
    for a, b in doors:
        reach[a].add(b)
    for _ in list(reach):  # transitive closure; enough rounds for the longest chain
        for room in list(reach):
            reach[room] |= {far for near in list(reach[room]) for far in reach.get(near, ())}
    return sorted(room for room in reach if room in reach[room])


def above(room):
    """Prints the room and those that include it, of those that have tests; 2: there is no such room."""
    root = pathlib.Path(__file__).resolve().parent.parent
    tested = {file.parent.name for file in root.glob("tests/*/*_test.cpp")}
    if room not in tested:
        print(f"rooms.py: no room {room!r} has tests; these have: {' '.join(sorted(tested))}", file=sys.stderr)
        return 2
    doors, _ = look(root / "src" / "burr")
    print("\n".join([room, *sorted({a for a, b in doors if b == room} & tested - {room})]))
    return 0


def main():
    if sys.argv[1:2] == ["--above"] and len(sys.argv) == 3:
        return above(sys.argv[2])
    arguments = [a for a in sys.argv[1:] if not a.startswith("-")]
    unknown = [a for a in sys.argv[1:] if a.startswith("-")]
    if unknown or len(arguments) > 1:
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).resolve().parent.parent
    checkout, root = root, root / "src" / "burr"
    if not root.is_dir():
        print(f"rooms.py: {root}: no such folder", file=sys.stderr)
        return 2
    doors, wrong = look(root)
    app_doors, app_wrong = look_at_floors(checkout / "apps" / "burr")
    wrong += app_wrong
    rooms = sorted({p.parts[0] for p, _ in read(root) if len(p.parts) > 1}, key=lambda r: list(ALLOWED).index(r) if r in ALLOWED else 99)
    for room in rooms:
        print(f"{room:9} -> " + (", ".join(f"{b} ({n})" for (a, b), n in sorted(doors.items()) if a == room) or "nobody"))
    folders = [folder for floor in FLOORS for folder in floor.split()]
    for folder in sorted({a for a, _ in app_doors}, key=folders.index):
        print(f"apps/burr/{folder} -> " + ", ".join(f"{b} ({n})" for (a, b), n in sorted(app_doors.items()) if a == folder))
    round_trips = circles(doors) + circles(app_doors)
    file_trips = file_circles(file_arrows(checkout))
    if round_trips or not file_trips:
        print("circles: " + (", ".join(round_trips) or "none"))
    for group in file_trips:
        print("circle of files: " + ", ".join(group))
    for complaint in wrong:
        print("not allowed: " + complaint)
    return 1 if wrong or round_trips or file_trips else 0


if __name__ == "__main__":
    sys.exit(main())
