// The codecs of others that the modules call, each loaded when a file needs it (web/codecs/take.py put them into ../codecs/).
// The C++ finds them as Module.codecs (web/packed_web.cpp, web/import/codecs_web.cpp).
//
// What they get may be damaged or made to do harm: each has a memory of its own, is asked for no more than the picture or block
// that was announced, and gives null for anything else.

import {unzstd} from './zstd.mjs';

// A WebAssembly.Module of the site.
export async function compiled(file) {
  const answer = await fetch(new URL(`../${file}`, import.meta.url));
  if (!answer.ok) throw new Error(`${file}: ${answer.status}`);
  return WebAssembly.compile(await answer.arrayBuffer());
}

const zstd = async () => unzstd(await compiled('codecs/zstd.wasm'));

// What a picture says of itself, before a codec takes memory for it.
function head_jpeg_ls(view) {
  for (let at = 2; at + 10 <= view.byteLength;) {
    if (view.getUint8(at) !== 0xFF) return null;
    const mark = view.getUint8(at + 1);
    if (mark === 0xF7) return {rows: view.getUint16(at + 5), columns: view.getUint16(at + 7), parts: view.getUint8(at + 9)};
    at += mark === 0xFF ? 1 : 2 + view.getUint16(at + 2);
  }
  return null;
}
function head_jpeg_2000(view) {
  if (view.byteLength < 45 || view.getUint32(0) !== 0xFF4FFF51) return null;
  const number = (at) => view.getUint32(at), fine = view.getUint8(43) === 1 && view.getUint8(44) === 1;
  return fine && {columns: number(8) - number(16), rows: number(12) - number(20), parts: view.getUint16(40)};
}

// A codec of pictures: (bytes, columns, rows) -> their values from the top, as numbers, or null. decoder: its class in the package.
async function pictures(name, decoder, head) {
  const [{default: make}, module] = await Promise.all([import(`../codecs/${name}.mjs`), compiled(`codecs/${name}.wasm`)]);
  // Compiled already, so it is there at once; what it would print is its own talk.
  const fresh = () => {
    const codec = {print() {}, printErr() {}, instantiateWasm(imports, done) {
      done(new WebAssembly.Instance(module, imports), module);
      return {};
    }};
    make(codec);
    return codec;
  };
  let codec = null, one = null;
  return (bytes, columns, rows) => {
    // of one channel and at most 16 bits; a codec that has failed says 0 x 0
    const good = ({width, height, componentCount, bitsPerSample}) =>
      width === columns && height === rows && componentCount === 1 && bitsPerSample >= 1 && bitsPerSample <= 16;
    const stated = head(new DataView(bytes.buffer, bytes.byteOffset, bytes.length));
    if (stated?.columns !== columns || stated.rows !== rows || stated.parts !== 1) return null;
    try {
      one?.delete();
      one = null;
      codec ??= fresh();
      one = new codec[decoder]();
      one.getEncodedBuffer(bytes.length).set(bytes);
      one.decode();
      if (!good(one.getFrameInfo())) return null;
      const {bitsPerSample, isSigned} = one.getFrameInfo(), values = one.getDecodedBuffer();
      const width = bitsPerSample <= 8 ? 1 : 2;
      if (values.length !== columns * rows * width) return null;
      const kind = width === 1 ? (isSigned ? Int8Array : Uint8Array) : (isSigned ? Int16Array : Uint16Array);
      return new kind(values.buffer, values.byteOffset, columns * rows);  // of `one`, which stays until the next call
    } catch {
      one = codec = null;  // what is thrown leaves the codec's stack as it was, so no more of it is used
      return null;
    }
  };
}

const kLoad = {
  zlib: () => import('../codecs/pako.mjs'),
  zstd,
  jpeg_ls: () => pictures('charls', 'JpegLSDecoder', head_jpeg_ls),
  jpeg_2000: () => pictures('openjpeg', 'J2KDecoder', head_jpeg_2000),
};

// Those that are named, for Module.codecs.
export async function load_codecs(...names) {
  return Object.fromEntries(await Promise.all(names.map(async (name) => [name, await kLoad[name]()])));
}
