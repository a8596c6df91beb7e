// Loads the program. It is compiled once, while it arrives, and then started as often as it is wanted:
// in the page, where it draws, and in the worker, where it ticks.
import make from '../burr_page.mjs';

const at = new URL('../burr_page.wasm', import.meta.url);

// A WebAssembly.Module.
export async function compile() {
  const answer = await fetch(at);
  if (!answer.ok) throw new Error(`${at.pathname}: ${answer.status}`);
  // a host that does not know .wasm gives it another type, and a browser then refuses to stream it
  if ((answer.headers.get('content-type') ?? '').startsWith('application/wasm'))
    return WebAssembly.compileStreaming(answer);
  return WebAssembly.compile(await answer.arrayBuffer());
}

// Starts it; gives its functions without their underscore, and memory.
export async function start(compiled) {
  const module = await make({
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(compiled, imports).then((instance) => done(instance, compiled));
      return {};
    },
  });
  const calls = {module};
  for (const name of Object.keys(module))
    if (/^_(core|view)_/.test(name)) calls[name.slice(1)] = module[name];
  calls.text = (pointer) => module.UTF8ToString(pointer);
  // memory may grow at each call, so views of it are made anew
  calls.bytes = (pointer, length) => new Uint8Array(module.HEAPU8.buffer, pointer, length);
  calls.numbers = (pointer, count) => new Float64Array(module.HEAPU8.buffer, pointer, count);
  // Copies into its memory, calls, and frees again.
  calls.with_bytes = (arrays, call) => {
    const pointers = arrays.map((array) => {
      const pointer = module._malloc(Math.max(1, array.byteLength));
      module.HEAPU8.set(array, pointer);
      return pointer;
    });
    const answer = call(...pointers);
    pointers.forEach((pointer) => module._free(pointer));
    return answer;
  };
  return calls;
}
