"""A small page made as burr's is made, for what does not depend on bone: how it is published, kept and bound.

It loads a part at once and another one when it is asked, and starts a worker that tries what no worker may do.
"""
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PUBLISH = ROOT / "web/publish/publish.py"

# What a worker may not: each is tried, and what came of it is told. {elsewhere}: another host.
TRY = """async (elsewhere) => {
  const tried = {};
  const attempt = async (name, call) => {
    try { tried[name] = `worked: ${await call()}`; } catch (what) { tried[name] = `${what.name}`; }
  };
  await attempt('fetch', async () => (await fetch(elsewhere, {mode: 'no-cors'})).type);
  await attempt('request', () => new Promise((go, no) => {
    const asks = new XMLHttpRequest();
    asks.onload = () => go('came');
    asks.onerror = () => no(new TypeError('refused'));
    asks.open('GET', elsewhere);
    asks.send();
  }));
  await attempt('socket', () => new Promise((go, no) => {
    const socket = new WebSocket(elsewhere.replace('http', 'ws') + 'socket');
    socket.onopen = () => go('open');
    socket.onerror = () => no(new TypeError('refused'));
  }));
  await attempt('import', async () => Object.keys(await import(elsewhere + 'code.mjs')));
  await attempt('eval', () => (0, eval)('1 + 1'));
  await attempt('Function', () => new Function('return 1 + 1')());
  await attempt('timer', () => new Promise((go, no) => {
    globalThis.by_text = false;
    setTimeout('globalThis.by_text = true', 0);
    setTimeout(() => (globalThis.by_text ? go('ran') : no(new EvalError('refused'))), 200);
  }));
  await attempt('wasm', async () => (await WebAssembly.compile(new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]))).constructor.name);
  return tried;
}"""
MAY = {"wasm"}  # the page is WebAssembly

MILL = """import {bound_worker} from '../common/bound_worker.js';
import {version} from '../common/first.mjs';
const burr = window.burr = {version, worker: new URL('worker.js', import.meta.url)};
burr.late = async () => (await import('../common/late.mjs')).late;
burr.page = %s;
const ask = (worker, elsewhere) => new Promise((go, no) => {
  worker.onmessage = ({data}) => go(data);
  worker.onerror = (what) => no(new Error(what.message || 'worker'));
  worker.postMessage(elsewhere);
});
burr.bound = (elsewhere) => ask(bound_worker(burr.worker), elsewhere);
burr.loose = (elsewhere) => ask(new Worker(burr.worker, {type: 'module'}), elsewhere);
document.body.textContent = version;
burr.loaded = true;
""" % TRY
WORKER = "const attempt = %s;\nself.onmessage = async ({data}) => self.postMessage(await attempt(data));\n" % TRY


def policy():
    """That of the pages."""
    return re.search(r'Content-Security-Policy" content="([^"]+)"', (ROOT / "web/pages/mill/index.html").read_text())[1]


def make(folder, version):
    """Publishes it into `folder`; the files that depend on the version say so."""
    site = pathlib.Path(str(folder) + "_site")
    shutil.rmtree(site, ignore_errors=True)
    head = f'<meta charset="utf-8"><meta http-equiv="Content-Security-Policy" content="{policy()}">'
    files = {
        "index.html": '<!doctype html>\n<meta charset="utf-8"><meta http-equiv="refresh" content="0; url=mill/"><a href="mill/">mill</a>\n',
        "mill/index.html": f'<!doctype html>\n<html lang="en"><head>{head}<title>small</title><link rel="icon" href="data:,">\n'
                           '<script type="module" src="mill.js"></script>\n</head><body></body></html>\n',
        "mill/mill.js": MILL, "mill/worker.js": WORKER,
        "common/bound_worker.js": (ROOT / "web/pages/common/bound_worker.js").read_text(),
        "common/first.mjs": f"export const version = '{version}';\n",
        "common/late.mjs": f"export const late = 'late of {version}';\n",
        "common/same.mjs": "// the same in each version\n" * 50,
        "codecs/licences.txt": "none\n" * 100,
    }
    for path, text in files.items():
        (site / path).parent.mkdir(parents=True, exist_ok=True)
        (site / path).write_text(text)
    subprocess.run([sys.executable, PUBLISH, site, folder, "1.0"], check=True)
    return folder
