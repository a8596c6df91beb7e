#!/usr/bin/env python3
"""pointer_test.py BURR - a press counts after the window was left with the button down, and the button was let go
outside: each way to leave it, in a real X server with a window manager, by events that X itself makes.

SDL 2.26 believes then that the button is still down and swallows the next press (window/ui/pointer_truth.h).
Contacts are counted in the recording while it is written.
"""
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "record"))
from other_writer import Recording, get_text  # noqa: E402

BURR = pathlib.Path(sys.argv[1]).resolve()
PATIENCE = 60  # on a machine that has other work [s]
NEEDS = ("Xvfb", "openbox", "xdotool", "wmctrl", "xev")


def skip(why):
    print(why)
    sys.exit(1 if os.environ.get("BURR_REQUIRE_TOOLS") == "1" else 77)


def columns(data):
    at, out = 0, {}

    def varint():
        nonlocal at
        value = shift = 0
        while True:
            byte = data[at]
            at += 1
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value

    while at < len(data):
        field = varint() >> 3
        size = varint()
        out[field] = data[at : at + size]
        at += size
    return out


class Contacts:
    """How often the burr came to the bone, and whether it is there now. A gap of 0.15 s ends a contact."""

    def __init__(self, file):
        self.recording, self.count, self.last, self.tick = Recording(file), 0, -1000, 0

    def now(self):
        self.recording.go_on()
        ticks = {n for n, (_, content) in self.recording.channels.items() if get_text(content, 0)[0] == b"/ticks"}
        for number, _, _, _, data in self.recording.messages:
            if number not in ticks:
                continue
            fields = columns(data)
            numbers = struct.unpack(f"<{len(fields[1]) // 8}Q", fields[1])
            for self.tick, touching in zip(numbers, fields[27]):
                if touching:
                    self.count += self.tick - self.last > 150
                    self.last = self.tick
        self.recording.messages.clear()
        return self.count, self.tick - self.last < 150


def x(*words):
    return subprocess.run(["xdotool", *map(str, words)], stdout=subprocess.PIPE, text=True, timeout=30).stdout.split()


def wait(what, until):
    for _ in range(PATIENCE * 4):
        found = until()
        if found:
            return found
        time.sleep(0.25)
    raise AssertionError(f"waited in vain: {what}")


def window_of(name):
    return wait(f"the window {name}", lambda: x("search", "--name", name))[-1]


class Stage:
    """Windows on a screen, and a hand at the mouse."""

    def __init__(self, folder):
        self.folder, self.processes = folder, []
        display = folder / "display"
        with open(display, "w") as told:
            self.start("Xvfb", "-noreset", "-displayfd", str(told.fileno()), "-screen", "0", "1500x900x24", pass_fds=[told.fileno()])
        number = wait("Xvfb", lambda: display.read_text().strip())
        os.environ.update(DISPLAY=f":{number}", SDL_VIDEODRIVER="x11", HOME=str(folder), XDG_CONFIG_HOME=str(folder),
                          XDG_STATE_HOME=str(folder), XDG_CACHE_HOME=str(folder))
        self.start("openbox")
        self.start("xev", "-geometry", "400x300+1090+20")
        self.other = window_of("Event Tester")

    def start(self, *words, **more):
        self.processes.append(subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **more))
        return self.processes[-1]

    def end(self):
        for process in reversed(self.processes):
            process.kill()
            process.wait()


class Session:
    def __init__(self, stage):
        self.stage, self.file = stage, stage.folder / "out" / "session.mcap"
        self.burr = stage.start(str(BURR), "run", "block", "--voxel-mm", "0.5", "--no-sound", "--seconds", "600", "--out",
                                str(stage.folder / "out"))
        self.window = window_of("block.*burr")
        wait("the recording", lambda: self.file.exists() and self.file.stat().st_size > 50_000)
        self.seen, self.contacts = 0, Contacts(self.file)

    def in_front(self):
        return x("getactivewindow") == [self.window]

    def come_back(self):
        wait("the window in front", lambda: (x("windowactivate", self.window), time.sleep(1), self.in_front())[-1])

    def touches(self, what):
        self.seen += 1
        wait(f"contact {self.seen}: {what}", lambda: self.contacts.now() == (self.seen, True))

    def lets_go(self):
        wait(f"the end of contact {self.seen}", lambda: self.contacts.now() == (self.seen, False))

    def press_and_let_go(self, place, what):
        x("mousemove", "--window", self.window, *place)
        time.sleep(0.5)
        x("mousedown", 1)
        self.touches(what)
        x("mouseup", 1)
        self.lets_go()

    def leave_pressed(self, way, name, place):
        x("mousemove", "--window", self.window, 620, 400)
        time.sleep(0.5)
        x("mousedown", 1)
        self.touches("before it was left by " + name)
        way()
        x("mousemove", *place)
        time.sleep(0.5)
        x("mouseup", 1)
        self.lets_go()
        time.sleep(0.5)


def main():
    missing = [name for name in NEEDS if shutil.which(name) is None]
    if missing:
        skip("needs " + ", ".join(missing))
    with tempfile.TemporaryDirectory() as place:
        stage = Stage(pathlib.Path(place))
        try:
            session = Session(stage)
            session.come_back()
            session.press_and_let_go((620, 400), "a press as always")
            other = lambda: x("windowactivate", stage.other)  # noqa: E731
            ways = [
                # the other window lies half over burr's: let go above it, and beside it
                ("another window", other, (1150, 150)),
                ("another window", other, (1450, 150)),
                ("another workspace", lambda: subprocess.run(["wmctrl", "-s", "1"], check=True), (600, 400)),
                ("an icon", lambda: x("windowminimize", session.window), (1450, 700)),
            ]
            for name, way, place in ways:
                session.leave_pressed(way, name, place)
                subprocess.run(["wmctrl", "-s", "0"], check=True)
                session.come_back()
                session.press_and_let_go((700, 430), "the first press after " + name)
                session.press_and_let_go((560, 430), "the next press after " + name)
            print(f"{session.seen} contacts of {session.seen} presses")
            session.burr.terminate()
            session.burr.wait(60)
        finally:
            stage.end()


main()
