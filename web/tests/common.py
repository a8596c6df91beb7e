"""What the tests of the page share: a line for each thing looked at, the words, sizes of screens, fingers and keys."""
import json
import os
import pathlib
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
WAIT = int(os.environ.get("BURR_PAGE_WAIT", "300"))  # [s]

bad = []


def check(good, text):
    print(("good: " if good else "BAD:  ") + text, flush=True)
    if not good:
        bad.append(text)


def words_of(code):
    return (tomllib.loads((ROOT / f"words/{code}.toml").read_text()) |
            tomllib.loads((ROOT / f"web/words/{code}.toml").read_text()))


def ready(page):
    page.wait("window.burr && burr.ready && burr.loaded", WAIT)


def size(page, width, height, touch=False):
    page.send("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": touch})
    page.send("Emulation.setTouchEmulationEnabled", {"enabled": touch, "maxTouchPoints": 5})


def touch(page, kind, *points, at=None):
    """Fingers on the screen, as the browser gives them to whatever lies there: touchStart, touchMove, touchEnd. at: when, by the clock
    of the screen [s since 1970]; a busy page hears of it later."""
    what = {"type": kind, "touchPoints": [{"x": x, "y": y, "id": n} for n, (x, y) in enumerate(points)]}
    page.send("Input.dispatchTouchEvent", what | ({"timestamp": at} if at else {}))


def key(page, kind, name, code=None, shift=False):
    """kind: rawKeyDown or keyUp."""
    page.send("Input.dispatchKeyEvent", {"type": kind, "key": name, "code": code or name, "modifiers": 8 if shift else 0,
                                         "windowsVirtualKeyCode": {" ": 32, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}.get(name, 0)})


def text_of(page, id):
    return page.run(f"document.getElementById({json.dumps(id)}).textContent")
