#!/usr/bin/env python3
"""The npm package burr-core: packed, installed and used as somebody else would, in Node and in Chromium.

    web/tests/npm_test.py PACKAGE BUILD [PICTURES]      PACKAGE: build/web/burr-core; BUILD: with the program and its Python module

What it gives is compared with a formula, with the program and with Python.
"""
import hashlib
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "codecs"))
import take
from chromium import Chromium, Site
from common import WAIT, bad, check

PACKAGE, BUILD = (pathlib.Path(one).resolve() for one in sys.argv[1:3])
PICTURES = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
HERE = pathlib.Path(__file__).resolve().parent


def run(words, folder, **more):
    done = subprocess.run([str(one) for one in words], cwd=folder, capture_output=True, text=True, timeout=600, **more)
    check(done.returncode == 0, f"{' '.join(pathlib.Path(str(one)).name for one in words[:3] if chr(10) not in str(one))} ends well {(done.stdout + done.stderr)[-400:] if done.returncode else ''}")
    return done.stdout


def install(folder):
    """As npm packs it, and as it comes to somebody else; nothing is fetched."""
    packed = json.loads(run(["npm", "pack", PACKAGE, "--json", "--offline"], folder))[0]
    files = {one["path"] for one in packed["files"]}
    wanted = {"package.json", "index.mjs", "index.d.mts", "burr_core.wasm", "zstd.wasm", "README.md", "LICENSE", "licences.txt", "examples/mill.mjs"}
    check(wanted <= files, f"{packed['filename']}: {len(files)} files, {packed['size'] / 1e6:.2f} MB {wanted - files}")
    (folder / "package.json").write_text('{"type": "module", "private": true}')
    run(["npm", "install", "--offline", "--ignore-scripts", "--no-audit", "--no-fund", folder / packed["filename"]], folder)
    return folder / "node_modules/burr-core"


def node(folder, script):
    (folder / "now.mjs").write_text("import {load} from 'burr-core';\nconst burr = await load();\n" + script)
    return run(["node", "now.mjs"], folder)


def printed(folder, package):
    """The session that README.md and docs/use/npm.md show: it touches and mills."""
    texts = [re.search(r"```js\n(.*?)```", path.read_text(), re.DOTALL)[1] for path in (package / "README.md", HERE.parents[1] / "docs/use/npm.md")]
    for text in texts:
        (folder / "printed.mjs").write_text(text + "\nconsole.log(Math.hypot(...session.row.force_n) > 0.1, session.row.removed_m3 > 1e-10, session.recording().length > 1000);\n")
        said = run(["node", "printed.mjs"], folder).strip().split("\n")
        check(said[-1] == "true true true", f"the session that is printed touches and mills: {said[-1]}")


def touched(folder, package):
    """A spring of 1000 N/m: the force is as deep as the hand is, whatever the bone."""
    said = run(["node", package / "examples/touch.mjs"], folder)
    found = [(float(d), float(f)) for d, f in re.findall(r"([\d.]+) mm deep: ([\d.]+) N", said)]
    check(len(found) == 5 and all(abs(f - d) <= 0.005 + 0.005 * d for d, f in found), f"force over depth: {found}")
    volume = float(re.search(r"a plate of ([\d.]+) mm3", said)[1])
    # whole voxels of 0.2 mm: 64 x 64, from the lower face of the first to the surface, half a voxel above the 32nd
    check(abs(volume - 12.8 * 12.8 * 6.4) < 0.01 * volume, f"the plate's volume by its sides: {volume} of {12.8 * 12.8 * 6.4:.1f} mm3")


PYTHON = """
import sys
sys.path.insert(0, sys.argv[1])
import numpy as np, burr
tooth = burr.Bone.load("phantom:tooth", voxel_mm=0.3)
points = tooth.surface().points
x, y, z = points[np.argmax(points[:, 2])]
scene = burr.Scene(tooth, burr_mm=2)
scene.rpm, scene.irrigated = 80000, True
session = scene.session()
session.hand((x - 2e-3, y, z + 2e-3), (1, 0, 0, 0), pedal=1, ticks=0)
session.step(600)
for n in range(4):
    session.hand((x + (2e-3 if n % 2 == 0 else -2e-3), y, z + 0.8e-3 - 0.2e-3 * n), ticks=500)
    session.step(500)
print("bone", tooth.hash, session.bone().hash, session.row["removed_m3"], tooth.volume_mm3(), session.row["hash"])
"""


def milled(folder, package):
    said = run(["node", package / "examples/mill.mjs", folder], folder)
    tick, bone = re.search(r"tick (\w{18}), bone (\w{18})", said).groups()
    recorded = folder / "groove.mcap"
    replayed = run([BUILD / "burr", "--quiet", "replay", recorded, "--check", "--json"], folder)
    told = json.loads(replayed[replayed.index("{"):])
    check(told["ticks"] == 2600, f"burr replays {told['ticks']} ticks of it to the bit")
    triangles = struct.unpack_from("<I", (folder / "tooth.stl").read_bytes(), 80)[0]
    check(triangles > 10000 and (folder / "tooth.stl").stat().st_size == 84 + 50 * triangles, f"the STL file has {triangles} triangles")
    if not (BUILD / "python/burr").is_dir():
        print("left out: the Python module is not built")
        return
    python = run(["/usr/bin/python3", "-c", PYTHON, BUILD / "python"], folder).split()  # Debian's, for which the module is built
    check(python[2] == bone, f"Python mills the same bone to the bit: {python[2]}, here {bone}")
    there = node(folder, "const tooth = burr.phantom('tooth', {voxel_mm: 0.3}); console.log(tooth.hash, tooth.volume_mm3());").split()
    check(there[0] == python[1] and abs(float(there[1]) / float(python[4]) - 1) < 1e-12, f"and has the same tooth: {there}")
    check(f"0x{int(python[5]):016x}" == tick, f"and every tick is the same: {python[5]}, here {tick}")


def round_trips(folder):
    """A .bone file of Python's, one of the package's, and the parts of the surface."""
    said = node(folder, """
const block = burr.phantom('block', {voxel_mm: 0.5}), again = burr.bone(block.file());
console.log(block.hash === again.hash, again.tissues[1].name);
const {size} = block, field = block.field(), same = burr.bone_of({size, voxel_mm: 0.5, field, labels: block.labels(), tissues: block.tissues, origin_mm: block.origin_mm});
console.log(same.field().every((one, n) => one === field[n]), same.volume_mm3() === block.volume_mm3());
const session = burr.session(block, {burr_mm: 4, rpm: 40000});
const first = [...session.changed()], whole = block.mesh();
console.log(first.reduce((sum, one) => sum + one.triangles.length, 0) === whole.triangles.length, [...session.changed()].length);
let top = 0;
for (let n = 0; n < whole.points.length; n += 3) if (whole.points[n + 2] > whole.points[top + 2]) top = n;
const z = whole.points[top + 2];
session.hand([0, 0, z + 4e-3], null, {pedal: 1});
session.step(600);
session.hand([0, 0, z + 1e-3], null, {ticks: 500});
session.step(800);
const parts = [...session.changed()];
console.log(session.row.removed_m3 > 0, parts.length > 0 && parts.length < first.length, session.bone().volume_mm3() < block.volume_mm3());
session.command('undo');
session.step(300);
console.log(session.row.undone_m3 > 0, burr.settings().length, burr.phantoms().length);
session.forget();
block.forget();
""").split("\n")
    check(said[0] == "true bone", f"a .bone file holds the bone to the bit: {said[0]}")
    check(said[1] == "true true", "an array of numbers as well")
    check(said[2] == "true 0", "the parts of the surface are the whole surface, once")
    check(said[3] == "true true true", "milling changes some of them")
    check(said[4].startswith("true"), f"a command is obeyed; settings, phantoms: {said[4]}")


def refused(folder):
    """One true sentence each, and the program goes on."""
    said = node(folder, """
const bone = burr.phantom('block', {voxel_mm: 0.5});
const session = burr.session(bone, {burr_mm: 4});
for (const call of [() => burr.phantom('foot'), () => burr.session(bone, {burr_mm: 1}), () => burr.session(bone, {rpm: NaN}),
    () => burr.session(bone, {speed: 3}), () => burr.session(bone, {burr_mm: 'wide'}), () => burr.bone(new Uint8Array(100)),
    () => burr.bone_of({size: [2, 2, 2], voxel_mm: 0.2, field: new Uint16Array(7)}),
    () => burr.bone_of({size: [2, 2, 2], voxel_mm: 0, field: new Uint16Array(8)}),
    () => burr.bone_of({size: [2, 2, 2], voxel_mm: 0.2, field: new Uint16Array(8), tissues: [{name: 'bone'}]}),
    () => session.hand([NaN, 0, 0]), () => session.command('jump'), () => session.step(0.5), () => session.recording(),
    () => { bone.forget(); bone.field(); }]) {
  try {
    call();
    console.log('worked');
  } catch (what) {
    console.log(what.message);
  }
}
session.step(10);
console.log(session.row.tick);
""").strip().split("\n")
    for line in said[:-1]:
        print(f"  {line}")
    check(len(said) == 15 and "worked" not in said, f"{len(said) - 1} faults are refused")
    words = ["foot", "4 voxels", "rpm", "speed", "burr_mm", "bone", "field", "voxel_mm", "tissues", "hand", "jump", "step", "record", "forgotten"]
    check(all(word in line for word, line in zip(words, said)), f"each by name {[(word, line) for word, line in zip(words, said) if word not in line]}")
    check(said[-1] == "9", f"and the session goes on: tick {said[-1]}")


def types(folder):
    """TypeScript takes the types, and refuses what is wrong."""
    tools = take.fetch(PACKAGE.parent / "axe", HERE / "npm")
    good = """import {load, type Session} from 'burr-core';
import {stl} from 'burr-core/stl';
const burr = await load();
const bone = burr.phantom('tooth', {voxel_mm: 0.3});
const session: Session = burr.session(bone, {rpm: 1000, irrigated: true}, {record: true});
session.hand([0, 0, 1], null, {ticks: 4});
session.step();
const force: number = session.row.force_n[0];
const file: Uint8Array = session.recording(), shape: Uint8Array = stl(bone.mesh());
for (const part of session.changed()) console.log(part.number, part.points.length, force, file, shape, session.rows().tick[0]);
"""
    words = ["--noEmit", "--strict", "--target", "es2022", "--module", "nodenext", "--moduleResolution", "nodenext", "--skipLibCheck", "false"]
    (folder / "good.mts").write_text(good)
    run(["node", tools / "typescript/bin/tsc", *words, "good.mts"], folder)
    (folder / "wrong.mts").write_text(good.replace("voxel_mm: 0.3", "voxel_mm: 'fine'").replace("force_n[0]", "force"))
    wrong = subprocess.run(["node", str(tools / "typescript/bin/tsc"), *words, "wrong.mts"], cwd=folder, capture_output=True, text=True)
    check(wrong.returncode != 0 and wrong.stdout.count("error TS") == 2, f"and refuses two mistakes: {wrong.stdout.count('error TS')}")


def in_a_page(package):
    """The example of a page: a worker ticks, the slice shows what the mouse mills."""
    with Site(package) as site, Chromium(700, 640) as browser:
        page = browser.open(site.url + "examples/page.html")
        page.wait("window.shown > 3", WAIT)
        for n in range(30):
            page.send("Input.dispatchMouseEvent", {"type": "mousePressed" if n == 0 else "mouseMoved", "x": 60 + 6 * n, "y": 300, "button": "left",
                                                   "buttons": 1, "clickCount": 1})
            time.sleep(0.05)
        page.wait("parseFloat(document.getElementById('said').textContent.split(', ')[1]) > 1", WAIT)
        check(True, f"in a page: {page.run('document.getElementById(`said`).textContent')}")
        page.picture(PICTURES and PICTURES / "npm_page.png")
        check(not page.troubles, f"no errors on the console {page.troubles}")
        page.close()


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        os.environ["npm_config_cache"] = str(folder / "cache")
        package = install(folder)
        if not package.is_dir():
            sys.exit("\n".join(bad))
        printed(folder, package)
        touched(folder, package)
        milled(folder, package)
        round_trips(folder)
        refused(folder)
        types(folder)
        in_a_page(package)
    print(f"burr_core.wasm: {(PACKAGE / 'burr_core.wasm').stat().st_size / 1e6:.2f} MB, {hashlib.sha256((PACKAGE / 'burr_core.wasm').read_bytes()).hexdigest()[:16]}")
    if bad:
        sys.exit("\n".join(bad))


main()
