#!/usr/bin/env python3
"""Serves the published page to this computer, with the heads that its file `_headers` names.

    web/serve.py FOLDER [PORT]      FOLDER: what `burr web --out` wrote; PORT: 8080, or 0 for any that is free
"""
import fnmatch
import functools
import http.server
import pathlib
import sys


def heads_of(folder):
    """The rules of `_headers`: [(pattern, name, value)]. None where there is no such file."""
    rules, pattern = [], ""
    file = pathlib.Path(folder) / "_headers"
    for line in file.read_text().splitlines() if file.exists() else []:
        if line.startswith("/"):
            pattern = line.strip()
        elif ":" in line:
            name, value = line.strip().split(": ", 1)
            rules.append((pattern, name, value))
    return rules


class Handler(http.server.SimpleHTTPRequestHandler):
    rules = []
    extensions_map = http.server.SimpleHTTPRequestHandler.extensions_map | {
        ".mjs": "text/javascript", ".js": "text/javascript", ".wasm": "application/wasm"}

    def end_headers(self):
        path = self.path.split("?")[0]
        for pattern, name, value in self.rules:
            if fnmatch.fnmatchcase(path, pattern):
                self.send_header(name, value)
        super().end_headers()

    def log_message(self, *_):
        pass


def main():
    folder, port = sys.argv[1], int((sys.argv[2:] or ["8080"])[0])
    Handler.rules = heads_of(folder)
    try:
        server = http.server.ThreadingHTTPServer(("127.0.0.1", port), functools.partial(Handler, directory=folder))
    except OSError as trouble:
        sys.exit(f"burr: port {port} of this computer cannot be used ({trouble.strerror}); name another: ./run --web 9000")
    print(f"burr: open http://127.0.0.1:{server.server_address[1]}/ in a browser; Ctrl-C ends it", file=sys.stderr, flush=True)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
