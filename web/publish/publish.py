#!/usr/bin/env python3
"""Makes the page ready for a host: what the build left in SITE becomes a folder that is copied as it is.

    web/publish/publish.py SITE OUT VERSION

OUT holds the pages under the addresses that people know, everything else in a folder that its hash names (v-HASH), all of it also
packed (.gz, .br), the service worker, the files that tell hosts which head to send, and version.json with the hash of each
file. The same SITE gives the same OUT to the byte. Needs node, for brotli.
"""
import base64
import gzip
import hashlib
import json
import pathlib
import posixpath
import re
import shutil
import subprocess
import sys

from host_files import FENCES, TYPES, host_files

HERE = pathlib.Path(__file__).resolve().parent
LEAST = 256  # bytes; what is smaller is not packed


def files_of(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def policy_of(pages):
    """The policy that the pages carry, with what only a header can say. All that load something have the same one."""
    found = {}
    for path, text in pages.items():
        said = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]+)"', text)
        if said or re.search(r"<(script|link)\b", text):
            found[path] = said
    every = {tuple(said) for said in found.values()}
    if len(every) != 1 or len(every.copy().pop()) != 1:
        sys.exit(f"web/publish: the pages need one Content-Security-Policy, the same in all: {found}")
    return every.pop()[0] + "; frame-ancestors 'self'"


def moved(path, text, parts, files):
    """The text of a page in which each address of a part names the folder of the version."""
    def put(match):
        before, address, after = match.groups()
        whole = posixpath.normpath(posixpath.join(posixpath.dirname(path), address))
        if re.match(r"[a-z]+:|#|/", address) or whole not in files or whole.endswith(".html"):
            return match[0]
        return before + posixpath.relpath(f"{parts}/{whole}", posixpath.dirname(path) or ".") + after
    return re.sub(r'(\b(?:href|src)=")([^"]+)(")', put, text)


def with_offline(path, text, parts):
    """The page also starts offline.js, if it loads anything."""
    if "<script" not in text:
        return text
    address = posixpath.relpath(f"{parts}/common/offline.js", posixpath.dirname(path) or ".")
    return text.replace("</head>", f'<script type="module" src="{address}"></script>\n</head>', 1)


def packed(out):
    wanted = [path for path in sorted(out.rglob("*")) if path.suffix in TYPES and path.stat().st_size >= LEAST]
    for path in wanted:
        data = gzip.compress(path.read_bytes(), 9, mtime=0)
        path.with_name(path.name + ".gz").write_bytes(data)
    subprocess.run(["node", HERE / "brotli.mjs", *wanted], check=True)


def main():
    site, out, version = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    files = files_of(site)
    templates = {name: (HERE / name).read_text() for name in ("sw.js", "offline.js", "publish.py", "host_files.py")}
    whole = hashlib.sha256(version.encode())
    for path, data in [*files.items(), *((name, text.encode()) for name, text in templates.items())]:
        whole.update(path.encode() + b"\0" + hashlib.sha256(data).digest())
    parts = "v-" + whole.hexdigest()[:16]

    pages = {path: data.decode() for path, data in files.items() if path.endswith(".html")}
    fences = {"Content-Security-Policy": policy_of(pages), **FENCES}
    result = {path: with_offline(path, moved(path, text, parts, files), parts).encode() for path, text in pages.items()}
    result |= {f"{parts}/{path}": data for path, data in files.items() if path not in pages}
    result[f"{parts}/common/offline.js"] = templates["offline.js"].encode()

    def integrity(data):
        return "sha256-" + base64.b64encode(hashlib.sha256(data).digest()).decode()
    kept = {path: integrity(data) for path, data in sorted(result.items()) if not path.endswith(".txt")}
    worker = templates["sw.js"]
    for gap, value in (("@FILES@", kept), ("@FENCES@", fences), ("@TYPES@", TYPES)):
        worker = worker.replace(gap, json.dumps(value, indent=1))
    result["sw.js"] = worker.replace("@PARTS@", parts).encode()
    result |= {path: text.encode() for path, text in host_files(fences, parts).items()}

    shutil.rmtree(out, ignore_errors=True)
    for path, data in result.items():
        (out / path).parent.mkdir(parents=True, exist_ok=True)
        (out / path).write_bytes(data)
    packed(out)
    hashes = {path: hashlib.sha256(data).hexdigest() for path, data in files_of(out).items()}
    (out / "version.json").write_text(json.dumps({"burr": version, "parts": parts, "files": hashes}, indent=1) + "\n")


if __name__ == "__main__":
    main()
