#!/usr/bin/env python3
"""Puts the codecs of others into a folder for the site: what web/package-lock.json names, and their licences.

    web/codecs/take.py FETCHED OUT      FETCHED: a folder of the build that keeps the packages; OUT: the site's folder codecs

npm fetches the packages once, and compares each with the lock's hash; it runs nothing of theirs. While the lock stays as it
is, nothing is fetched again, so a second build needs no network.
"""
import base64
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys

WEB = pathlib.Path(__file__).resolve().parents[1]


def fetch(folder, where=WEB):
    """The folder node_modules of the lock that lies in `where`."""
    lock = b"".join((where / name).read_bytes() for name in ("package.json", "package-lock.json"))
    mark, wanted = folder / "fetched", hashlib.sha256(lock).hexdigest()
    if mark.exists() and mark.read_text() == wanted:
        return folder / "node_modules"
    npm = shutil.which("npm")
    if npm is None:
        sys.exit("burr: the page needs npm, which fetches what others made, and that is missing: apt-get install npm")
    folder.mkdir(parents=True, exist_ok=True)
    mark.unlink(missing_ok=True)
    for name in ("package.json", "package-lock.json"):
        shutil.copy(where / name, folder / name)
    done = subprocess.run([npm, "ci", "--ignore-scripts", "--omit=dev", "--omit=optional", "--no-audit", "--no-fund",
                           "--fetch-retries=3", "--no-update-notifier"], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        said = [line.split(" ", 2)[-1] for line in done.stderr.splitlines() if re.match(r"npm (error|ERR!) .*\w", line)]
        sys.exit(f"burr: npm could not fetch the packages of {where.relative_to(WEB.parent)}/package-lock.json from its registry; "
                 f"is there a network? npm says: {(said or ['nothing'])[0]}")
    mark.write_text(wanted)
    return folder / "node_modules"


def only(what, found):
    """The one thing that was looked for: another version of a package may hold it elsewhere."""
    if len(found) != 1:
        sys.exit(f"burr: {what} is not where web/codecs/take.py looks for it; does web/package.json name another version?")
    return found[0]


def main():
    fetched, out = (pathlib.Path(one) for one in sys.argv[1:])
    packages = fetch(fetched)
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)

    def text(path):
        only(path, [packages / path] if (packages / path).is_file() else [])
        return re.sub(r"\n//# sourceMappingURL=\S+\s*$", "\n", (packages / path).read_text())

    (out / "pako.mjs").write_text(text("pako/dist/browser/pako.esm.min.mjs"))
    for name, start in (("charls", "CharLSWASM"), ("openjpeg", "OpenJPEGWASM")):
        where = f"@cornerstonejs/codec-{name}/dist/{name}wasm_decode"
        only(start, re.findall(rf"^var {start} = ", text(f"{where}.js"), re.MULTILINE))
        (out / f"{name}.mjs").write_text(text(f"{where}.js") + f"\nexport default {start};\n")
        shutil.copy(packages / f"{where}.wasm", out / f"{name}.wasm")
    # zstddec starts its module by a fetch that the policy of the page forbids; the module itself is what is wanted
    module = only("the module of zstddec", re.findall(r"const wasm\s*=\s*['\"]([A-Za-z0-9+/=]+)['\"]", text("zstddec/dist/zstddec.mjs")))
    (out / "zstd.wasm").write_bytes(base64.b64decode(module))
    shutil.copy(WEB.parent / "packaging/copyright", out / "licences.txt")


if __name__ == "__main__":
    main()
