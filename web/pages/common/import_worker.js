// Reads a scan of the user's and makes bone of it. It lives for one scan: whatever a damaged file does to it, the page
// goes on. The files stay where they are, and are read as they are needed.
//
//     page -> worker   read {files}, plan {recipe}, make {recipe}
//     worker -> page   plan {plan}, bone {blob, plan}, refused {text} or {why, parts}
import load from '../burr_import.mjs';
import {compiled, load_codecs} from './codecs.mjs';

let module = null;

self.onmessage = async ({data}) => {
  try {
    if (data.kind === 'read') await read(data.files, data.recipe);
    else if (data.kind === 'plan') plan(data.recipe);
    else if (data.kind === 'make') make(data.recipe);
  } catch (what) {
    // burr's own sentence, or the end of the module: it had no memory, or the file was damaged beyond what burr foresees
    const short = /memory|allocation|OOM|Aborted/i.test(String(what?.message ?? what));
    self.postMessage({kind: 'refused', why: what?.why ?? (short ? 'scan_memory' : 'scan_broken'), parts: what?.parts ?? []});
  }
};

function with_text(text, call) {
  const bytes = new TextEncoder().encode(text + '\0');
  const at = module._malloc(bytes.length);
  module.HEAPU8.set(bytes, at);
  const value = call(at);
  module._free(at);
  return value;
}
const refuse = () => self.postMessage({kind: 'refused', text: module.UTF8ToString(module._import_why())});

async function read(files, recipe) {
  const names = new Set();
  const blobs = files.map((data, n) => {
    let name = data.name.replaceAll('/', '_');  // of several folders, two files may have one name
    if (names.has(name)) name = `${n}_${name}`;
    names.add(name);
    return {name, data};
  });
  const path = blobs.length === 1 ? `/scan/${blobs[0].name}` : '/scan';
  // A codec is loaded when a file needs it; the module has ended there, so a new one reads from the start. There are few.
  const reader = await compiled('burr_import.wasm');
  for (const codecs = {};;) {
    module = await load({codecs, instantiateWasm(imports, done) {
      WebAssembly.instantiate(reader, imports).then((instance) => done(instance, reader));
      return {};
    }});
    module.FS.mkdir('/scan');
    module.FS.mount(module.WORKERFS, {blobs}, '/scan');
    try {
      if (with_text(path, module._import_read) === 0) return refuse();
      break;
    } catch (what) {
      if (!what?.codec || what.codec in codecs) throw what;
      Object.assign(codecs, await load_codecs(what.codec));
    }
  }
  plan(recipe);
}

function plan(recipe) {
  const text = module.UTF8ToString(with_text(JSON.stringify(recipe), module._import_plan));
  if (text === '') return refuse();
  self.postMessage({kind: 'plan', plan: JSON.parse(text)});
}

function make(recipe) {
  const text = module.UTF8ToString(with_text(JSON.stringify(recipe), module._import_make));
  if (text === '') return refuse();
  const at = module._import_bone(), size = module._import_bone_size();
  const blob = module.HEAPU8.slice(at, at + size);
  self.postMessage({kind: 'bone', blob, plan: JSON.parse(text)}, [blob.buffer]);
}
