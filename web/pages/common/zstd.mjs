// What unpacks a block of zstd, of its module: (bytes, size, take) -> take(the `size` bytes that they unpack to), or null.
const kMostKept = 64 << 20;  // of its memory [bytes]

export function unzstd(module) {
  const fresh = () => new WebAssembly.Instance(module, {env: {emscripten_notify_memory_growth() {}}}).exports;
  let wasm = fresh();
  return (bytes, size, take) => {
    const from = wasm.malloc(bytes.length), to = wasm.malloc(Math.max(1, size));
    try {
      if (from === 0 || to === 0) return null;
      new Uint8Array(wasm.memory.buffer).set(bytes, from);
      if (wasm.ZSTD_decompress(to, size, from, bytes.length) !== size) return null;
      return take(new Uint8Array(wasm.memory.buffer, to, size));
    } finally {
      wasm.free(from);
      wasm.free(to);
      if (wasm.memory.buffer.byteLength > kMostKept) wasm = fresh();  // a memory never shrinks
    }
  };
}
