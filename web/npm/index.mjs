// burr-core: bone that is felt and milled tick by tick. README.md begins; index.d.mts says what each call takes and gives.
import make from './burr_core.mjs';
import {unzstd} from './zstd.mjs';

const kNode = typeof process === 'object' && process.versions?.node !== undefined && typeof window === 'undefined';

async function bytes_of(file) {
  const at = new URL(file, import.meta.url);
  if (kNode && at.protocol === 'file:') {
    const {readFile} = await import('node:fs/promises');
    return readFile(at);
  }
  const answer = await fetch(at);
  if (!answer.ok) throw new Error(`${at.pathname}: ${answer.status}`);
  return answer.arrayBuffer();
}

const zstd = async () => unzstd(await WebAssembly.compile(await bytes_of('zstd.wasm')));

// Compiled once; each call starts a program of its own, with a memory of its own.
let parts = null;
export async function load() {
  parts ??= Promise.all([bytes_of('burr_core.wasm').then((bytes) => WebAssembly.compile(bytes)), zstd()]);
  const [compiled, unpack] = await parts;
  const module = await make({
    codecs: {zstd: unpack},
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(compiled, imports).then((instance) => done(instance, compiled));
      return {};
    },
  });
  return new Burr(module);
}

// Points, normals and tissues of surface::Vertex, and triangles: copies, which stay.
function mesh_of(module, size, vertices, count, triangles, triangle_count) {
  const floats = new Float32Array(module.HEAPU8.buffer, vertices, size / 4 * count), step = size / 4;
  const points = new Float32Array(3 * count), normals = new Float32Array(3 * count), tissues = new Uint8Array(count);
  const bytes = new Uint8Array(module.HEAPU8.buffer, vertices, size * count);
  for (let n = 0; n < count; ++n) {
    points.set(floats.subarray(n * step, n * step + 3), 3 * n);
    normals.set(floats.subarray(n * step + 3, n * step + 6), 3 * n);
    tissues[n] = bytes[n * size + 24];
  }
  return {points, normals, tissues, triangles: new Uint32Array(module.HEAPU8.buffer, triangles, 3 * triangle_count).slice()};
}

class Burr {
  #module;
  #fields;
  #recordings = 0;
  #forget;
  constructor(module) {
    this.#module = module;
    this.#fields = this.text(module._npm_row_fields()).split(' ').map((one) => one.split(':')).map(([name, count]) => [name, Number(count)]);
    // memory of this program is freed by forget(), or some time after nobody has the object any more
    this.#forget = new FinalizationRegistry(({pointer, call}) => call(pointer));
  }
  get version() { return this.text(this.#module._npm_version()); }
  phantoms() { return JSON.parse(this.text(this.#module._npm_phantoms())); }
  settings() { return JSON.parse(this.text(this.#module._npm_settings())); }

  phantom(name, {voxel_mm = 0} = {}) {
    return this.#bone(this.with([text(name)], (at) => this.#module._npm_phantom(at, voxel_mm)));
  }
  bone(file) {
    return this.#bone(this.with([new Uint8Array(file)], (at) => this.#module._npm_blob(at, file.byteLength)));
  }
  bone_of({size, voxel_mm, field, labels = null, tissues = null, origin_mm = [0, 0, 0]}) {
    const [x, y, z] = size, all = x * y * z;
    if (!(field instanceof Uint16Array) || field.length !== all) throw new Error(`field: must be a Uint16Array of ${all} numbers, x fastest`);
    if (labels !== null && (!(labels instanceof Uint8Array) || labels.length !== all)) throw new Error(`labels: must be a Uint8Array of ${all} numbers, x fastest`);
    const given = [field, Float64Array.from(origin_mm), text(tissues === null ? '' : JSON.stringify(tissues)), ...(labels === null ? [] : [labels])];
    return this.#bone(this.with(given, (values, origin, table, numbers = 0) =>
      this.#module._npm_field(values, numbers, x, y, z, voxel_mm, origin, table)));
  }
  session(bone, settings = {}, {record = false, rows = false} = {}) {
    for (const [name, value] of Object.entries(settings)) if (typeof value === 'number' && !Number.isFinite(value)) throw new Error(`${name}: must be a number, not ${value}`);
    const file = `/${++this.#recordings}.mcap`;
    const pointer = this.with([text(JSON.stringify(settings)), text(file)], (json, name) =>
      this.#module._npm_session(bone.pointer(), json, record ? 1 : 0, rows ? 1 : 0, name));
    if (pointer === 0) throw this.trouble();
    return this.#own(new Session(this, this.#module, this.#fields, pointer, record ? file : null), (one) => this.#module._npm_forget_session(one));
  }
  // For this file alone.
  bone_at(pointer) { return this.#bone(pointer); }
  #bone(pointer) {
    if (pointer === 0) throw this.trouble();
    return this.#own(new Bone(this, this.#module, pointer), (one) => this.#module._npm_forget_bone(one));
  }
  #own(object, call) {
    const held = {pointer: object.pointer(), call};
    this.#forget.register(object, held, object);
    object.when_forgotten(() => {
      this.#forget.unregister(object);
      call(held.pointer);
    });
    return object;
  }
  trouble() { return new Error(this.text(this.#module._npm_why())); }
  text(pointer) { return this.#module.UTF8ToString(pointer); }
  // Copies into its memory, calls, and frees again.
  with(arrays, call) {
    const module = this.#module, pointers = [];
    try {
      for (const array of arrays) {
        const pointer = module._malloc(Math.max(8, array.byteLength));
        if (pointer === 0) throw new Error('there is not enough memory');
        pointers.push(pointer);
        module.HEAPU8.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), pointer);
      }
      return call(...pointers);
    } finally {
      pointers.forEach((pointer) => module._free(pointer));
    }
  }
}
const text = (what) => new TextEncoder().encode(`${what}\0`);

class Held {
  #pointer;
  #end = null;
  constructor(pointer) { this.#pointer = pointer; }
  pointer() {
    if (this.#pointer === 0) throw new Error('it is forgotten: forget() was called');
    return this.#pointer;
  }
  when_forgotten(end) { this.#end = end; }
  forget() {
    if (this.#pointer === 0) return;
    this.#pointer = 0;
    this.#end();
  }
}

class Bone extends Held {
  #burr;
  #module;
  #about;
  constructor(burr, module, pointer) {
    super(pointer);
    this.#burr = burr;
    this.#module = module;
    this.#about = JSON.parse(burr.text(module._npm_bone_about(pointer)));
  }
  get size() { return this.#about.size; }
  get voxel_mm() { return this.#about.voxel_mm; }
  get origin_mm() { return this.#about.origin_mm; }
  get tissues() { return this.#about.tissues; }
  get hash() { return this.#about.hash; }
  get source() { return this.#about.source; }
  volume_mm3() { return 1e9 * this.#module._npm_volume(this.pointer()); }
  field() { return this.#all(this.#module._npm_bone_field(this.pointer()), Uint16Array); }
  labels() { return this.#all(this.#module._npm_bone_labels(this.pointer()), Uint8Array); }
  #all(at, Kind) {
    const [x, y, z] = this.size;
    return new Kind(this.#module.HEAPU8.buffer, at, x * y * z).slice();
  }
  mesh() {
    const module = this.#module, pointer = this.pointer(), count = module._npm_mesh(pointer);
    if (count < 0) throw this.#burr.trouble();
    return mesh_of(module, module._npm_vertex_size(), module._npm_mesh_vertices(pointer), count, module._npm_mesh_triangles(pointer),
        module._npm_mesh_triangle_count(pointer));
  }
  file() {
    const at = this.#module._npm_bone_blob(this.pointer());
    return new Uint8Array(this.#module.HEAPU8.buffer, at, this.#module._npm_bone_blob_size(this.pointer())).slice();
  }
}

class Session extends Held {
  #burr;
  #module;
  #fields;
  #file;
  #width;
  constructor(burr, module, fields, pointer, file) {
    super(pointer);
    this.#burr = burr;
    this.#module = module;
    this.#fields = fields;
    this.#file = file;
    this.#width = fields.reduce((sum, [, count]) => sum + count, 0);
  }
  hand(p, q = null, {pedal = null, ticks = 0} = {}) {
    this.#q = q ?? this.#q;
    this.#pedal = pedal ?? this.#pedal;
    if (this.#module._npm_hand(this.pointer(), ...p, ...this.#q, this.#pedal, ticks) === 0) throw this.#burr.trouble();
  }
  #q = [1, 0, 0, 0];
  #pedal = 0;
  step(ticks = 1) {
    if (!Number.isInteger(ticks) || ticks < 0) throw new Error(`step: must be a whole number of ticks, not ${ticks}`);
    if (this.#module._npm_step(this.pointer(), ticks) < ticks) throw this.#burr.trouble();
  }
  command(name, value = 0) {
    if (this.with_name(name, value) === 0) throw this.#burr.trouble();
  }
  with_name(name, value) { return this.#burr.with([text(name)], (at) => this.#module._npm_command(this.pointer(), at, value)); }
  get row() {
    const numbers = new Float64Array(this.#module.HEAPU8.buffer, this.#module._npm_row(this.pointer()), this.#width);
    const row = {};
    let at = 0;
    for (const [name, count] of this.#fields) {
      row[name] = count === 1 ? numbers[at] : Array.from(numbers.subarray(at, at + count));
      at += count;
    }
    return row;
  }
  rows() {
    const pointer = this.pointer(), count = this.#module._npm_rows(pointer), width = this.#width;
    const all = new Float64Array(this.#module.HEAPU8.buffer, this.#module._npm_rows_data(pointer), width * count);
    const columns = {};
    let at = 0;
    for (const [name, each] of this.#fields) {
      const column = columns[name] = new Float64Array(each * count);
      for (let n = 0; n < count; ++n)
        for (let k = 0; k < each; ++k) column[each * n + k] = all[width * n + at + k];
      at += each;
    }
    return columns;
  }
  get hash() { return this.#burr.text(this.#module._npm_hash(this.pointer())); }
  bone() { return this.#burr.bone_at(this.#module._npm_session_bone(this.pointer())); }
  // The parts of the surface that have changed since the last call; at first all.
  * changed() {
    const module = this.#module;
    for (let number = module._npm_patch(this.pointer()); number >= 0; number = module._npm_patch(this.pointer())) {
      const pointer = this.pointer();
      yield {number, ...mesh_of(module, module._npm_vertex_size(), module._npm_patch_vertices(pointer), module._npm_patch_vertex_count(pointer),
          module._npm_patch_triangles(pointer), module._npm_patch_triangle_count(pointer))};
    }
  }
  recording() {
    if (this.#module._npm_recording(this.pointer()) === 0) throw this.#burr.trouble();
    const {FS} = this.#module, kCopy = '/copy.mcap';
    const bytes = FS.readFile(kCopy);
    FS.unlink(kCopy);
    return bytes;
  }
  forget() {
    super.forget();
    if (this.#file !== null) this.#module.FS.unlink(this.#file);
    this.#file = null;
  }
}
