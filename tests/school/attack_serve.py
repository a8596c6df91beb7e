#!/usr/bin/env python3
"""Attacks a `burr serve` of its own for a given time, with variations from a seed, and looks after each what came of it.

    tests/school/attack_serve.py BURR [--seconds 60] [--seed 1] [--rate 40]      BURR: the program; rate: attacks a second, at most

What must hold after each attack: the server lives and answers its owner; nothing but parts of the page comes without
the token; no answer holds a line of a file from elsewhere, or a person's name; every answer forbids what it should
(Content-Security-Policy) and permits no other page (CORS). At the end: the memory has not grown, no connection and no
file is left open, the store is unchanged but for the audit. Prints counts as JSON; ends with 1 where something did not
hold. Needs Python alone. docs/teach/security.md says what is defended, and how long this was run.
"""
import argparse
import collections
import json
import os
import pathlib
import random
import re
import signal
import socket
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time
import urllib.parse

CANARY = "canary-7c1f20"  # stands in a file beside the store, and in the names
MARKUPS = ['<img src=x onerror=alert(1)>', '"><script>alert(1)</script>', "'; DROP TABLE learner; --", "' OR '1'='1",
           "{{7*7}}", "%00", "\u202e\u0000x", "javascript:alert(1)", "../../../etc/passwd", "\\..\\x", "a\r\nSet-Cookie: x=1"]
FILES = ["etc/passwd", "proc/self/environ", "school.sqlite", "school-names.sqlite", "canary.txt", "../canary.txt",
         "proc/self/cmdline", ".ssh/id_rsa", "school-names.sqlite-wal"]
APIS = ["overview", "cohort", "learner", "session", "audit", "sessions.csv", "", "x", "..", "learner/../audit"]
PAGE = ["/", "/index.html", "/school.css", "/school.mjs", "/words.mjs"]


class Fault(Exception):
    pass


class Server:
    def __init__(self, burr, folder):
        self.folder = folder
        self.store = folder / "inner" / "school.sqlite"
        self.store.parent.mkdir()
        (folder / "canary.txt").write_text(CANARY + " outside\n")
        (folder / "inner" / "canary.txt").write_text(CANARY + " beside\n")
        self.burr = burr
        for n in range(4):
            self.run("learner", "add", "--store", self.store, "--id", f"heron-{1000 + n}", "--name", CANARY + " Nora Nyberg")
        for title in MARKUPS[:4]:
            self.run("learner", "cohort", "add", "--store", self.store, title, "heron-1000", "heron-1001")
        with sqlite3.connect(self.store) as store:  # what burr itself would refuse
            for text in MARKUPS:
                store.execute("INSERT INTO learner VALUES (?, 0, 'PGY1', '', NULL, 0)", (text.replace("\0", ""),))
        self.before = self.content()
        self.process = subprocess.Popen([burr, "serve", "--store", self.store, "--port", "0"], stdout=subprocess.PIPE,
                                        stderr=open(folder / "stderr.txt", "wb"), text=True, cwd=self.store.parent)
        said = ""
        while "Ctrl-C" not in said:
            line = self.process.stdout.readline()
            if not line:
                raise SystemExit("burr serve ended: " + said)
            said += line
        self.port, self.token = re.search(r"http://127.0.0.1:(\d+)/#token=(\w+)", said).groups()
        self.port = int(self.port)

    def run(self, *words):
        done = subprocess.run([self.burr, *map(str, words)], capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(f"burr {words}: {done.stderr}")

    def content(self):
        store = sqlite3.connect(f"file:{self.store}?mode=ro", uri=True)
        try:
            tables = sorted(row[0] for row in store.execute("SELECT name FROM sqlite_master WHERE type = 'table'"))
            return {t: sorted(map(repr, store.execute(f"SELECT * FROM {t}"))) for t in tables if t != "audit"}
        finally:
            store.close()

    def memory(self):  # [KiB]
        text = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", text)[1])

    def handles(self):
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))

    def connect(self, patience=20):
        return socket.create_connection(("127.0.0.1", self.port), patience)


def received(wire, most=4 << 20):
    out = b""
    try:
        while len(out) < most:
            some = wire.recv(65536)
            if not some:
                break
            out += some
    except OSError:
        pass
    return out


def answers(raw):
    """[(status, fields, body)] of what came on one connection."""
    out = []
    while raw:
        head, mark, rest = raw.partition(b"\r\n\r\n")
        match = re.match(rb"HTTP/1\.1 (\d{3}) ", head)
        if not match or not mark:
            raise Fault(f"no answer of HTTP/1.1: {raw[:80]!r}")
        fields = {}
        for line in head.split(b"\r\n")[1:]:
            name, _, value = line.partition(b":")
            fields[name.strip().lower().decode("latin1")] = value.strip().decode("latin1")
        length = int(fields.get("content-length", "0"))
        if rest.startswith(b"HTTP/1.1 "):  # the answer to a HEAD: it says how long the body would be
            length = 0
        out.append((int(match[1]), fields, rest[:length]))
        raw = rest[length:]
    return out


class Attacks:
    def __init__(self, server, seed):
        self.server, self.random = server, random.Random(seed)
        self.own = f"127.0.0.1:{server.port}"
        self.slow = []

    # ---- pieces

    def one(self, *choices):
        return self.random.choice(choices)

    def noise(self, most=64, alphabet=None):
        size = self.random.randint(0, most)
        return bytes(self.random.choice(alphabet) if alphabet else self.random.randrange(256) for _ in range(size))

    def encoded(self, text):
        """Some of the letters as %xx, some of these once more."""
        out = ""
        for c in text:
            kind = self.random.random()
            code = "".join(f"%{b:02x}" for b in c.encode())
            out += code if kind < 0.3 else code.replace("%", "%25") if kind < 0.45 else c
        return out

    def api(self):
        query = urllib.parse.quote(self.one("heron-1000", *MARKUPS), safe="")
        return f"/api/{self.one(*APIS[:6])}" + self.one("", f"?id={query}", f"?id={query}&case={query}")

    def request(self, method="GET", target="/", fields=(), body=b"", host=None, close=True):
        head = f"{method} {target} HTTP/1.1\r\n"
        lines = [f"Host: {self.own if host is None else host}"] + [f"{n}: {v}" for n, v in fields]
        if close:
            lines.append("Connection: close")
        return (head + "\r\n".join(lines) + "\r\n\r\n").encode("utf-8", "surrogateescape") + body

    def bearer(self, token=None):
        return ("Authorization", "Bearer " + (self.server.token if token is None else token))

    def say(self, raw, parts=1):
        with self.server.connect() as wire:
            try:
                step = max(1, len(raw) // parts)
                for n in range(0, len(raw), step):
                    wire.sendall(raw[n:n + step])
                wire.shutdown(socket.SHUT_WR)
            except OSError:
                pass  # it was closed on us, which is its right
            return received(wire)

    # ---- kinds; each returns what came back, and whether the attacker had the token

    def no_token(self):
        token = self.server.token
        at = self.random.randrange(len(token))
        other = token[:at] + self.one("0", "f", "x", "\u00e9") + token[at + 1:]
        wrong = self.one("", token[:-1], token[:at], token + "0", token.upper() + "A", token[::-1], "null", " " + token + "0",
                         token + token, other + "1", "*", "0" * 64)
        fields = self.one([], [("Authorization", "Bearer " + wrong)], [("Authorization", "Basic " + token)],
                          [("authorization", "bearer " + token)], [("Cookie", "token=" + token)], [("X-Token", token)],
                          [("Authorization", token)], [("Authorization", "Bearer" + token)])
        target = self.api() + self.one("", "&token=" + token, "#token=" + token)
        return self.say(self.request(self.one("GET", "HEAD", "POST"), target, fields)), False

    def origin(self):
        fields = [self.bearer(), self.one(
            ("Origin", self.one("http://evil.example", "null", "https://" + self.own, f"http://{self.own}.evil.example",
                                f"http://127.0.0.1:{self.server.port + 1}", f"http://{self.own}/", "file://", "HTTP://" + self.own)),
            ("Sec-Fetch-Site", self.one("cross-site", "same-site", "Same-Origin ,x", "cross-site, none")))]
        return self.say(self.request("GET", self.api(), fields)), False  # nothing may come of it, though the token is right

    def host(self):
        port = self.server.port
        name = self.one("evil.example", f"evil.example:{port}", "127.0.0.1", f"127.0.0.1:{port + 1}", f"127.1:{port}",
                        f"0x7f000001:{port}", f"2130706433:{port}", f"127.0.0.1:{port}@evil", f"evil@127.0.0.1:{port}",
                        f"127.0.0.1:{port}, evil", f"[::1]:{port}", "", f"127.0.0.1.:{port}", f"127.0.0.1:{port}/", f"LOCALHOST:0{port}")
        raw = self.request("GET", self.api(), [self.bearer()], host=name)
        if self.random.random() < 0.2:  # two, or none
            raw = raw.replace(b"Host: ", self.one(b"Host: evil.example\r\nHost: ", b"X-Host: ", b"Host:\r\nHost: "), 1)
        return self.say(raw), False

    def path(self):
        up = self.one("../", "..\\", "%2e%2e/", "..%2f", "%2e%2e%2f", "..%5c", "%252e%252e%252f", "..%c0%af", "....//", "..;/", "/",
                      "%00/", ".\\./", "..%00/", "..%ff/", "%u002e%u002e/")
        file = self.one(*FILES, "school.css", "index.html")
        target = self.one("/", "//", "/school.css/", "/api/", "", "/./", "file:///", "http://127.0.0.1/", "\\") + \
            up * self.random.randint(0, 9) + self.one(file, self.encoded(file), file + "%00.css", file + "\0.css", file + "?", "/" + file)
        raw = self.request("GET", "@@", self.one([], [self.bearer()])).replace(b"@@", target.encode("latin1"), 1)
        return self.say(raw), True

    def oversized(self):
        kind = self.random.randrange(6)
        n = self.one(1 << 12, 1 << 14, (1 << 14) + 1, 1 << 16, (1 << 16) + 1, 1 << 20)
        if kind == 0:
            raw = self.request("GET", "/" + "a" * n)
        elif kind == 1:
            raw = self.request("GET", "/", [("X-" + "a" * n, "b")])
        elif kind == 2:
            raw = self.request("GET", "/", [("Cookie", "a" * n)])
        elif kind == 3:
            raw = self.request("POST", "/api/x", [("Content-Length", n), ("Content-Type", "application/json")], b"[" * n)
        elif kind == 4:
            raw = self.request("POST", "/api/x", [("Content-Length", self.one("99999999999999999999", "-1", "0x10", "1e9", "+5", "5 5"))], b"x")
        else:
            raw = self.request("A" * n, "/")
        return self.say(raw, self.random.randint(1, 9)), False

    def torn(self):
        raw = self.request(self.one("GET", "POST"), self.api(), [self.bearer(), ("Content-Length", "50")], b"x" * 50)
        raw = raw[:self.random.randrange(len(raw))]
        with self.server.connect() as wire:
            wire.sendall(raw)
            if self.random.random() < 0.5:  # a reset instead of an end
                wire.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                return b"", True
            wire.shutdown(socket.SHUT_WR)
            return received(wire), True

    def slow_client(self):
        """Left open, fed a byte now and then; looked at again later."""
        for wire in self.slow[:]:
            try:
                wire.send(self.noise(1, b"abc:\r\n") or b"x")
            except OSError:
                wire.close()
                self.slow.remove(wire)
        while len(self.slow) > 60:
            self.slow.pop(0).close()
        for _ in range(self.random.randint(1, 6)):
            wire = self.server.connect()
            wire.setblocking(False)
            wire.send(self.request("GET", "/api/overview", [self.bearer()])[:self.random.randint(0, 40)])
            self.slow.append(wire)
        return b"", True

    def slow_reader(self):
        with self.server.connect() as wire:
            wire.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1024)
            wire.sendall(self.request("GET", "/school.mjs", close=False) * 20)
            wire.recv(10)
        return b"", True

    def pipeline(self):
        wanted = self.random.randint(2, 30)
        raw = b"".join(self.request("GET", self.one("/", *PAGE), close=n == wanted - 1) for n in range(wanted))
        got = self.say(raw, self.random.randint(1, 20))
        if len(answers(got)) != wanted:
            raise Fault(f"{wanted} requests, {len(answers(got))} answers")
        return got, False

    def smuggle(self):
        inner = self.request("GET", "/api/overview", self.one([], [self.bearer("0" * 64)]))
        te = self.one("Transfer-Encoding: chunked", "Transfer-Encoding:\tchunked", "Transfer-Encoding : chunked",
                      "Transfer-Encoding: xchunked", "Transfer-encoding: identity, chunked", "X: y\r\n Transfer-Encoding: chunked",
                      "Transfer-Encoding: chunked\r\nTransfer-Encoding: x", "Transfer-Encoding\x0b: chunked", "Transfer-Encoding: \x00chunked")
        length = self.one("Content-Length: 4", "Content-Length: 0", f"Content-Length: {len(inner)}", "Content-Length: 4\r\nContent-Length: 0",
                          "Content-Length: 0, 4", "Content-Length: +4", "")
        ends = self.one("\r\n", "\n", "\r\n")
        lines = [f"{self.one('GET', 'POST', 'HEAD')} {self.one('/', '/api/x')} HTTP/1.1", f"Host: {self.own}", te, length]
        if self.random.random() < 0.5:
            lines[2:] = reversed(lines[2:])
        head = ends.join(line for line in lines if line) + ends + ends
        body = self.one(b"0\r\n\r\n", b"0;x=y\r\n\r\n", b"5\r\nhello\r\n0\r\n\r\n", b"ffffffffffffffff\r\n", b"1\r\nZ\r\nQ\r\n\r\n", b"-1\r\n\r\n", b"0x0\r\n\r\n")
        return self.say(head.encode("latin1") + body + inner), False

    def head_flood(self):
        n = self.random.randint(50, 3000)
        fields = [(f"X-{i}" if self.random.random() < 0.9 else "X-1", "y") for i in range(n)]
        return self.say(self.request("GET", "/api/overview", fields)), False

    def odd_values(self):
        text = self.one(*MARKUPS)
        name = self.one("id", "case", text)
        target = f"/api/{self.one('cohort', 'learner', 'session')}?" + "&".join(
            f"{urllib.parse.quote(name, safe='')}={urllib.parse.quote(self.one(text, text * 20, 'heron-1000'), safe='')}"
            for _ in range(self.random.randint(1, 5)))
        return self.say(self.request("GET", target, [self.bearer()])), True

    def rubbish(self):
        kind = self.random.randrange(4)
        if kind == 0:
            raw = self.noise(2000)
        elif kind == 1:  # a good one with some bytes changed
            good = bytearray(self.request("GET", "/api/overview", [self.bearer("1" * 64)]))
            for _ in range(self.random.randint(1, 8)):
                good[self.random.randrange(len(good))] = self.random.randrange(256)
            raw = bytes(good)
        elif kind == 2:
            raw = b"\x16\x03\x01" + self.noise(400)  # TLS at a server without it
        else:
            raw = self.one(b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", b"GET /\r\n\r\n", b"GET / HTTP/0.9\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"\r\n" * 400,
                           b"CONNECT evil.example:80 HTTP/1.1\r\n\r\n", b"OPTIONS * HTTP/1.1\r\nHost: " + self.own.encode() + b"\r\n\r\n",
                           b"TRACE / HTTP/1.1\r\nHost: " + self.own.encode() + b"\r\n\r\n")
        return self.say(raw, self.random.randint(1, 4)), False

    def kinds(self):
        return [self.no_token, self.origin, self.host, self.path, self.oversized, self.torn, self.slow_client, self.slow_reader,
                self.pipeline, self.smuggle, self.head_flood, self.odd_values, self.rubbish]

    def end(self):
        for wire in self.slow:
            wire.close()


def looked_at(raw, had_token, page):
    """Status words of the answers; Fault where one must not be."""
    out = []
    for status, fields, body in answers(raw) if raw else []:
        out.append(status)
        if "content-security-policy" not in fields or "access-control-allow-origin" in fields or "set-cookie" in fields:
            raise Fault(f"fields of the head: {fields}")
        if CANARY.encode() in body or b"root:" in body or b"SQLite format" in body or b"PATH=" in body:
            raise Fault(f"a file from elsewhere, or a name: {body[:200]!r}")
        if status // 100 == 2 and not had_token and body and body not in page:
            raise Fault(f"data without a token: {body[:200]!r}")
        if status >= 500:
            raise Fault(f"{status}: {body[:200]!r}")
    return out


def owner(server, path):
    """What its owner gets."""
    for attempt in range(200):  # all places may be taken by slow ones for a while
        with server.connect() as wire:
            try:
                wire.sendall(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nAuthorization: Bearer {server.token}\r\n"
                             "Connection: close\r\n\r\n".encode())
            except OSError:
                pass
            raw = received(wire)
        if raw:
            status, _, body = answers(raw)[0]
            if status != 200:
                raise Fault(f"the owner got {status}: {body[:200]!r}")
            return body
        time.sleep(0.1)
    raise Fault("the owner got nothing for 20 s")


def main():
    wanted = argparse.ArgumentParser()
    wanted.add_argument("burr")
    wanted.add_argument("--seconds", type=float, default=60)
    wanted.add_argument("--seed", type=int, default=1)
    wanted.add_argument("--rate", type=float, default=40)
    given = wanted.parse_args()
    counts, statuses, faults = collections.Counter(), collections.Counter(), []
    with tempfile.TemporaryDirectory() as folder:
        server = Server(pathlib.Path(given.burr).resolve(), pathlib.Path(folder))
        attacks = Attacks(server, given.seed)
        try:
            page = {owner(server, path) for path in PAGE}
            overview = owner(server, "/api/overview")
            memory, after_warm_up, begin, n = [], None, time.monotonic(), 0
            while (now := time.monotonic() - begin) < given.seconds and len(faults) < 20:
                kind = attacks.random.choice(attacks.kinds())
                try:
                    raw, had_token = kind()
                    statuses.update(looked_at(raw, had_token, page))
                    if server.process.poll() is not None:
                        raise Fault(f"burr serve ended with {server.process.returncode}")
                    if n % 20 == 0 and owner(server, "/api/overview") != overview:
                        raise Fault("the overview changed")
                except (Fault, OSError) as fault:
                    faults.append(f"attack {n} ({kind.__name__}): {fault}")
                    if server.process.poll() is not None:
                        break
                counts[kind.__name__] += 1
                n += 1
                if n % 200 == 0:
                    memory.append(server.memory())
                    if after_warm_up is None and now > min(60, given.seconds / 4):
                        after_warm_up = memory[-1]
                time.sleep(max(0, n / given.rate - (time.monotonic() - begin)))
            attacks.end()
            handles = None
            if server.process.poll() is None:
                deadline = time.monotonic() + 40  # slow ones are let go after 15 s
                while (handles := server.handles()) > 16 and time.monotonic() < deadline:
                    time.sleep(1)
                owner(server, "/api/overview")
                if handles > 16:
                    faults.append(f"{handles} files and connections are still open")
            grown = memory[-1] - after_warm_up if after_warm_up else 0
            if grown > 8192:
                faults.append(f"the memory grew by {grown} KiB")
            if server.content() != server.before:
                faults.append("the store was changed")
            print(json.dumps({"seconds": round(time.monotonic() - begin), "seed": given.seed, "attacks": n, "kinds": dict(sorted(counts.items())),
                              "answers": dict(sorted(statuses.items())), "memory_kib": [after_warm_up, memory[-1] if memory else None],
                              "most_memory_kib": max(memory, default=None), "open_at_the_end": handles, "faults": faults}))
        finally:
            server.process.send_signal(signal.SIGTERM)
            server.process.wait(20)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
