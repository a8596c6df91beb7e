// Calls the codecs of the page as its modules do, for tests/web/page_codecs.h.
//
//     node page_codecs.mjs SITE ASKED ANSWERED
//
// ASKED: for each, four numbers of 32 bits (codec, columns, rows, bytes) and the bytes. ANSWERED: for each, the size, and what came of it;
// -1: it was refused.
import fs from 'node:fs';
import {createRequire} from 'node:module';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const [site, asked, answered] = process.argv.slice(2);
// what a browser has, and what emscripten's JavaScript looks for where it finds node
globalThis.fetch = async (url) => new Response(fs.readFileSync(url));
globalThis.require = createRequire(import.meta.url);
globalThis.__dirname = '/';

const names = ['zstd', 'jpeg_ls', 'jpeg_2000'];
const {load_codecs} = await import(pathToFileURL(path.resolve(site, 'common/codecs.mjs')));
const codecs = await load_codecs(...names);

const input = fs.readFileSync(asked), out = fs.openSync(answered, 'w');
for (let at = 0; at < input.length;) {
  const [codec, columns, rows, size] = [0, 4, 8, 12].map((n) => input.readUInt32LE(at + n));
  const bytes = new Uint8Array(input.subarray(at + 16, at + 16 + size));
  at += 16 + size;
  const got = names[codec] === 'zstd' ? codecs.zstd(bytes, columns, (view) => view.slice()) :
      codecs[names[codec]](bytes, columns, rows);
  const answer = got === null ? null : names[codec] === 'zstd' ? got : new Uint8Array(Int32Array.from(got).buffer);
  fs.writeSync(out, new Uint8Array(Int32Array.of(answer === null ? -1 : answer.length).buffer));
  if (answer !== null) fs.writeSync(out, answer);
}
