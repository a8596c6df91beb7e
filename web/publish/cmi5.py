#!/usr/bin/env python3
"""Makes the page a course of cmi5: a zip that a learning management system takes in, with the page, a unit for each case, cmi5.xml.

    web/publish/cmi5.py ROOT PUBLISHED OUT.zip      PUBLISHED: what publish.py made

The same page gives the same zip to the byte.
"""
import pathlib
import sys
import tomllib
import zipfile
from xml.sax.saxutils import escape

CASES = ["temporal-bone", "jaw", "spine", "tooth", "block"]
BASE = "https://w3id.org/burr/cmi5/"
COURSE = {"en": "Bone work with burr", "de": "Knochenarbeit mit burr", "sv": "Benarbete med burr"}
WHAT = {"en": "Mill a bone by the steps of a case, in the browser.", "de": "Einen Knochen nach den Schritten eines Falls fräsen, im Browser.",
        "sv": "Fräs ett ben enligt fallets steg, i webbläsaren."}


def texts(kind, words):
    return f"<{kind}>" + "".join(f'<langstring lang="{code}">{escape(text)}</langstring>' for code, text in words.items()) + f"</{kind}>"


def structure(root):
    units = ""
    for name in CASES:
        case = tomllib.loads((root / f"cases/{name.replace('-', '_')}.toml").read_text())
        title = case["title"] if isinstance(case["title"], dict) else {"en": case["title"]}
        units += f"""  <au id="{BASE}{name}" moveOn="Completed" launchMethod="AnyWindow">
    {texts("title", title)}
    {texts("description", WHAT)}
    <url>cmi5/index.html?case={name}&amp;mode=practise</url>
  </au>
"""
    return f"""<?xml version="1.0" encoding="utf-8"?>
<courseStructure xmlns="https://w3id.org/xapi/profiles/cmi5/v1/CourseStructure.xsd">
  <course id="{BASE}course">
    {texts("title", COURSE)}
    {texts("description", WHAT)}
  </course>
{units}</courseStructure>
"""


def main():
    root, published, out = (pathlib.Path(one) for one in sys.argv[1:])
    files = {path.relative_to(published).as_posix(): path.read_bytes() for path in sorted(published.rglob("*")) if path.is_file()}
    # files for hosts and packed copies: a learning management system is a host of its own
    files = {name: data for name, data in files.items() if not name.endswith((".gz", ".br")) and not name.startswith(("hosting/", "_", "."))}
    files |= {f"cmi5/{path.name}": path.read_bytes() for path in sorted((root / "web/cmi5").iterdir())}
    files["cmi5.xml"] = structure(root).encode()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as zipped:
        for name, data in sorted(files.items()):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            zipped.writestr(entry, data)


main()
