"""Drives Debian's Chromium without a screen, by the DevTools protocol over a pipe, and serves a folder to it.

    with Site(folder) as site, Chromium(960, 540) as browser:
        page = browser.open(site.url + 'mill/')
        page.wait('window.burr && burr.ready', 120)

Needs Python and Chromium, nothing else.
"""
import base64
import fcntl
import functools
import http.server
import json
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import tempfile
import threading
import time
import zlib

FLAGS = """--headless --no-sandbox --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --ignore-gpu-blocklist
--no-first-run --disable-background-networking --disable-component-update --disable-sync --disable-extensions --mute-audio
--hide-scrollbars --remote-debugging-pipe""".split()


class Site:
    """A plain static server on 127.0.0.1, without any special headers but those that are given. instead: {path: bytes} of files that
    are not as they lie in the folder."""

    def __init__(self, folder, headers=None, instead=None):
        self.asked = []  # paths, in order

        class Handler(http.server.SimpleHTTPRequestHandler):
            extensions_map = http.server.SimpleHTTPRequestHandler.extensions_map | {
                ".mjs": "text/javascript", ".js": "text/javascript", ".wasm": "application/wasm"}

            def do_GET(handler):
                other = (instead or {}).get(handler.path.split("?")[0])
                if other is None:
                    return super().do_GET()
                handler.send_response(200)
                handler.send_header("Content-Type", handler.guess_type(handler.path))
                handler.send_header("Content-Length", str(len(other)))
                handler.end_headers()
                handler.wfile.write(other)

            def log_message(handler, *_):
                self.asked.append(handler.path)

            def end_headers(handler):
                for name, value in (headers or {}).items():
                    handler.send_header(name, value)
                super().end_headers()

        self.server = http.server.ThreadingHTTPServer(
            ("127.0.0.1", 0), functools.partial(Handler, directory=str(folder)))
        self.url = f"http://127.0.0.1:{self.server.server_address[1]}/"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.shutdown()


class Chromium:
    def __init__(self, width, height, flags=(), folder=None):
        """folder: the profile of another one, which was killed."""
        self.width, self.height = width, height
        self.fresh = False  # each page that is opened finds nothing that one before it has kept
        self.folder = folder or tempfile.mkdtemp(prefix="burr_chromium_")
        to_read, self.to = map(_high, os.pipe())
        self.back, from_write = map(_high, os.pipe())
        program = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")

        # it reads from descriptor 3 and writes to 4
        self.process = subprocess.Popen(
            [program, *FLAGS, *flags, f"--user-data-dir={self.folder}", f"--window-size={width},{height}", "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            preexec_fn=lambda: (os.dup2(to_read, 3), os.dup2(from_write, 4)), close_fds=False)
        os.close(to_read)
        os.close(from_write)
        self.next, self.answers, self.rest, self.listeners = 0, {}, b"", []
        self.lock = threading.Condition()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        while True:
            try:
                some = os.read(self.back, 1 << 20)
            except OSError:
                some = b""
            if not some:
                with self.lock:
                    self.answers = None
                    self.lock.notify_all()
                return
            *whole, self.rest = (self.rest + some).split(b"\0")
            for text in whole:
                message = json.loads(text)
                with self.lock:
                    if "id" in message:
                        self.answers[message["id"]] = message
                        self.lock.notify_all()
                    else:
                        for listener in self.listeners:
                            listener(message)

    def send(self, method, params=None, session=None, wait_s=300):
        with self.lock:
            self.next += 1
            number = self.next
        message = {"id": number, "method": method, "params": params or {}}
        if session:
            message["sessionId"] = session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        with self.lock:
            if not self.lock.wait_for(lambda: self.answers is None or number in self.answers, wait_s):
                raise TimeoutError(f"no answer to {method} within {wait_s} s")
            if self.answers is None:
                raise RuntimeError("Chromium has ended")
            answer = self.answers.pop(number)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def open(self, url, first=None, before=None):
        """first: a script that runs before those of the page; before(page): is called before the page is asked for."""
        return Page(self, url, first, before)

    def kill(self):
        """As a power cut does it, to this program; its profile stays until the end."""
        processes = _below(self.process.pid)
        for one in processes:
            try:
                os.kill(one, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.process.wait()
        end = time.monotonic() + 60  # the others hold files of the profile until they are gone
        while any(_runs(one) for one in processes) and time.monotonic() < end:
            time.sleep(0.1)
        for name in pathlib.Path(self.folder).glob("Singleton*"):
            name.unlink(missing_ok=True)

    def sleep(self, seconds):
        """As a lid that is closed does it: all of it stands still, and goes on."""
        processes = _below(self.process.pid)
        for what in (signal.SIGSTOP, signal.SIGCONT):
            for one in processes:
                os.kill(one, what)
            if what == signal.SIGSTOP:
                time.sleep(seconds)

    def keep_downloads(self, folder):
        self.send("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(folder)})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.send("Browser.close", wait_s=10)
            self.process.wait(20)
        except Exception:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


class Page:
    def __init__(self, browser, url, first=None, before=None):
        self.browser = browser
        self.troubles = []  # what the console says as a warning or an error, and what was thrown
        self.requests = []  # (seconds since the start, address)
        self.sent = []  # their methods: GET, POST
        self.asked_at = []  # [ms since 1970] by the browser's clock, as performance.timeOrigin
        self.target = browser.send("Target.createTarget", {"url": "about:blank"})["targetId"]
        self.session = browser.send("Target.attachToTarget", {"targetId": self.target, "flatten": True})["sessionId"]
        self.sessions = {self.session}
        self.workers = []  # their sessions
        self.begun = time.monotonic()
        browser.listeners.append(self._hear)
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.send(domain + ".enable")
        # workers too, which wait until their requests are watched; not what keeps the page (sw.js), which belongs to no page
        self.send("Target.setAutoAttach", {"autoAttach": True, "waitForDebuggerOnStart": True, "flatten": True,
                                           "filter": [{"type": "service_worker", "exclude": True}, {}]})
        if first:
            self.send("Page.addScriptToEvaluateOnNewDocument", {"source": first})
        self.send("Emulation.setDeviceMetricsOverride", {"width": browser.width, "height": browser.height,
                                                         "deviceScaleFactor": 1, "mobile": False})
        if before:
            before(self)
        if browser.fresh:
            self.send("Storage.clearDataForOrigin", {"origin": "/".join(url.split("/")[:3]), "storageTypes": "all"})
        self.send("Page.navigate", {"url": url})

    def _hear(self, message):
        method, params = message["method"], message.get("params", {})
        if message.get("sessionId") not in self.sessions:
            return
        if method == "Target.attachedToTarget":
            session = params["sessionId"]
            self.sessions.add(session)
            if params["targetInfo"]["type"] == "worker":
                self.workers.append(session)

            def listen():  # not from the thread that reads
                for method in ("Runtime.enable", "Network.enable", "Runtime.runIfWaitingForDebugger"):
                    try:
                        self.browser.send(method, session=session)
                    except Exception:
                        pass
            threading.Thread(target=listen, daemon=True).start()
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
            self.troubles.append(" ".join(str(one.get("value", one.get("description"))) for one in params["args"]))
        elif method == "Runtime.exceptionThrown":
            detail = params["exceptionDetails"]
            self.troubles.append(detail.get("exception", {}).get("description") or detail["text"])
        elif method == "Log.entryAdded" and params["entry"]["level"] in ("error", "warning"):
            self.troubles.append(params["entry"]["text"] + " " + params["entry"].get("url", ""))
        elif method == "Network.requestWillBeSent":
            self.requests.append((time.monotonic() - self.begun, params["request"]["url"]))
            self.sent.append(params["request"]["method"])
            self.asked_at.append(1000 * params["wallTime"])

    def send(self, method, params=None):
        return self.browser.send(method, params, self.session)

    def close(self):
        self.browser.send("Target.closeTarget", {"targetId": self.target})

    def run(self, script, worker=None):
        """The value of a JavaScript expression, in the page or in one of its workers; a promise is waited for."""
        answer = self.browser.send("Runtime.evaluate", {"expression": script, "awaitPromise": True, "returnByValue": True,
                                                        "allowUnsafeEvalBlockedByCSP": False}, worker or self.session)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"].get("exception", {}).get("description", "?"))
        return answer["result"].get("value")

    def choose(self, selector, *files):
        """Gives files to an <input type=file>."""
        root = self.send("DOM.getDocument")["root"]["nodeId"]
        node = self.send("DOM.querySelector", {"nodeId": root, "selector": selector})["nodeId"]
        self.send("DOM.setFileInputFiles", {"nodeId": node, "files": [str(file) for file in files]})

    def wait(self, condition, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.run(f"!!({condition})"):
                return
            if self.run("window.burr?.trouble") and not self.run(f"!!({condition})"):
                raise RuntimeError("the page says: " + self.run("burr.trouble"))
            time.sleep(0.1)
        raise TimeoutError(f"not within {seconds} s: {condition}; console: {self.troubles}")

    def picture(self, file=None):
        """A screenshot as rows of (red, green, blue)."""
        png = base64.b64decode(self.send("Page.captureScreenshot", {"format": "png"})["data"])
        if file:
            with open(file, "wb") as out:
                out.write(png)
        return Picture(png)


class Picture:
    """An 8-bit PNG without interlace, RGB or RGBA."""

    def __init__(self, png):
        at, packed = 8, b""
        while at < len(png):
            length, kind = struct.unpack(">I4s", png[at:at + 8])
            data = png[at + 8:at + 8 + length]
            if kind == b"IHDR":
                self.width, self.height, depth, colour = struct.unpack(">IIBB", data[:10])
                assert depth == 8 and colour in (2, 6), "an unknown kind of PNG"
                self.step = 3 if colour == 2 else 4
            elif kind == b"IDAT":
                packed += data
            at += 12 + length
        raw, wide, step = zlib.decompress(packed), self.width * self.step, self.step
        before = bytearray(wide)
        self.rows = []
        for y in range(self.height):
            kind, row = raw[y * (wide + 1)], bytearray(raw[y * (wide + 1) + 1:(y + 1) * (wide + 1)])
            if kind == 1:
                for i in range(step, wide):
                    row[i] = (row[i] + row[i - step]) & 255
            elif kind == 2:
                row = bytearray((a + b) & 255 for a, b in zip(row, before))
            elif kind == 3:
                for i in range(wide):
                    row[i] = (row[i] + ((row[i - step] if i >= step else 0) + before[i]) // 2) & 255
            elif kind == 4:
                for i in range(wide):
                    a, b, c = (row[i - step] if i >= step else 0), before[i], (before[i - step] if i >= step else 0)
                    p, pa, pb, pc = a + b - c, abs(b - c), abs(a - c), abs(a + b - 2 * c)
                    row[i] = (row[i] + (a if pa <= pb and pa <= pc else b if pb <= pc else c)) & 255
            self.rows.append(row)
            before = row

    def pixel(self, x, y):
        return tuple(self.rows[y][x * self.step:x * self.step + 3])

    def different(self, other, more_than=12):
        """The places where a colour differs by more than that: [(x, y)]."""
        found = []
        for y, (a, b) in enumerate(zip(self.rows, other.rows)):
            if a == b:
                continue
            for x in range(self.width):
                i = x * self.step
                if max(abs(a[i] - b[i]), abs(a[i + 1] - b[i + 1]), abs(a[i + 2] - b[i + 2])) > more_than:
                    found.append((x, y))
        return found


def _below(process):
    """A process and all that it has started."""
    found = [process]
    for one in found:
        for task in pathlib.Path(f"/proc/{one}/task").glob("*/children"):
            found += [int(child) for child in task.read_text().split()]
    return found


def _runs(process):
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


def _high(descriptor):
    """The same pipe under a number above 10."""
    high = fcntl.fcntl(descriptor, fcntl.F_DUPFD, 10)
    os.close(descriptor)
    return high
