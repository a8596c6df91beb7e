// Loads the program. It is compiled once, while it arrives, and then started as often as it is wanted:
// in the page, where it draws, and in the worker, where it ticks.
import make_page from '../burr_page.mjs';

// A WebAssembly.Module.
export async function compile(file = 'burr_page.wasm') {
  const at = new URL(`../${file}`, import.meta.url);
  const answer = await fetch(at);
  if (!answer.ok) throw new Error(`${at.pathname}: ${answer.status}`);
  // a host that does not know .wasm gives it another type, and a browser then refuses to stream it
  if ((answer.headers.get('content-type') ?? '').startsWith('application/wasm'))
    return WebAssembly.compileStreaming(answer);
  return WebAssembly.compile(await answer.arrayBuffer());
}

// What went wrong, by the key of its sentence (web/words): the worker has no words.
export function trouble(why, ...parts) {
  return Object.assign(new Error([why, ...parts].join(' ')), {why, parts});
}

// Starts it; gives its functions without their underscore, and memory. make: of another module than the page's; codecs: what it
// calls (codecs.mjs).
export async function start(compiled, make = make_page, codecs = {}) {
  const module = await make({
    codecs,
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(compiled, imports).then((instance) => done(instance, compiled));
      return {};
    },
  });
  const calls = {module};
  for (const name of Object.keys(module))
    if (/^_(core|view|score|watch|redo)_/.test(name)) calls[name.slice(1)] = module[name];
  calls.text = (pointer) => module.UTF8ToString(pointer);
  // memory may grow at each call, so views of it are made anew
  calls.bytes = (pointer, length) => new Uint8Array(module.HEAPU8.buffer, pointer, length);
  calls.numbers = (pointer, count) => new Float64Array(module.HEAPU8.buffer, pointer, count);
  // Calls with texts.
  calls.with_texts = (texts, call) => calls.with_bytes(texts.map((one) => new TextEncoder().encode(`${one}\0`)), call);
  // Copies into its memory, calls, and frees again.
  calls.with_bytes = (arrays, call) => {
    const pointers = [];
    try {
      for (const array of arrays) {
        const pointer = module._malloc(Math.max(1, array.byteLength));
        if (pointer === 0) throw trouble('no_memory');  // at 0 lies the module's own data
        pointers.push(pointer);
        module.HEAPU8.set(array, pointer);
      }
      return call(...pointers);
    } finally {
      pointers.forEach((pointer) => module._free(pointer));
    }
  };
  return calls;
}
