#!/usr/bin/env python3
"""Says what is wrong with a page that burr wrote: not well formed, a script, an address of the net, an id that occurs twice.

    scripts/checks/page_is_sound.py PAGE.html
"""
import re
import sys
import xml.etree.ElementTree as xml


def faults(text):
    body = text.split("\n", 1)[1] if text.startswith("<!DOCTYPE html>") else ""
    if not body:
        return ["does not begin with <!DOCTYPE html>"]
    try:
        root = xml.fromstring(body)
    except xml.ParseError as trouble:
        return [f"is not well formed: {trouble}"]
    found = [f"holds <{node.tag}>" for node in root.iter() if node.tag in ("script", "link", "iframe", "object", "form")]
    seen = set()
    for node in root.iter():
        for name, value in node.attrib.items():
            if name.startswith("on"):
                found.append(f"holds a handler {name}")
            if name in ("src", "href") and not re.match(r"data:image/png;base64,[A-Za-z0-9+/]+=*$|#", value):
                found.append(f"{name} leads out of the page: {value[:60]}")
            if name == "id" and value in seen:
                found.append(f"the id {value} occurs twice")
            if name == "id":
                seen.add(value)
    # addresses in texts and styles; names of XML are not among them
    found += [f"holds an address: {address}" for address in re.findall(r"https?://[^\s\"<]*|url\([^)]*\)", re.sub(r"base64,[^\"]*", "", text))]
    return found


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    with open(sys.argv[1], encoding="utf-8") as file:
        found = faults(file.read())
    for one in found[:10]:
        print(f"{sys.argv[1]} {one}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
