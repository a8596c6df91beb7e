// The surface of a bone on its way from a worker, which makes it, to the page, which draws it.
const kVertex = 28, kSkinVertex = 20;  // bytes; surface::Vertex, render::SkinVertex
const kFirstMs = 40;                   // of work before a message goes out, while the whole surface is made

const transfer = (list) => list.flatMap((one) => [one.vertices.buffer, one.triangles.buffer]);

const turn = () => new Promise((go) => {
  const channel = new MessageChannel();
  channel.port1.onmessage = go;
  channel.port2.postMessage(0);
});

// ---- in the worker

// A Given of core_api.cpp, copied out of the module's memory.
function copy(burr, pointer, size) {
  const [number, vertices, count, triangles, indices] = new Int32Array(burr.module.HEAPU8.buffer, pointer, 5);
  return {
    number,
    count,
    indices,
    vertices: burr.bytes(vertices, count * size).slice(),
    triangles: burr.bytes(triangles, 4 * indices).slice(),
  };
}

// The tissues of the bone, for view_tissue().
export function tissues(burr) {
  const all = [];
  for (let n = 0;; ++n) {
    const at = burr.core_tissue(n);
    if (at === 0) return all;
    all.push({name: burr.text(burr.core_tissue_name(n)), told: [...burr.numbers(at, 5)]});
  }
}

export class Skin {
  // work: the number of the bone, which each message carries
  constructor(burr, work) {
    this.burr = burr;
    this.work = work;
    this.fresh = [];  // patches that the page does not have yet
  }
  // Makes the next patch that has changed. False: none has.
  make_one() {
    const given = this.burr.core_patch();
    if (given === 0) return false;
    const patch = copy(this.burr, given, kVertex);
    if (patch.number >= 0) this.fresh.push(patch);  // otherwise it looks as before
    return true;
  }
  make_all() {
    while (this.make_one()) { /* the next */ }
  }
  send(message) {
    const patches = this.fresh;
    this.fresh = [];
    self.postMessage({...message, work: this.work, patches}, transfer(patches));
  }
  // The whole surface, what is near the work first, then the soft structures. It stops when `wanted` says no.
  async send_whole(wanted) {
    for (let more = true; more;) {
      const until = performance.now() + kFirstMs;
      while (more && performance.now() < until) more = this.make_one();
      this.send({kind: 'skin'});
      await turn();
      if (!wanted()) return;
    }
    self.postMessage({kind: 'skin_done', work: this.work});
    const parts = [];
    for (let given = this.burr.core_soft(); given !== 0; given = this.burr.core_soft())
      parts.push(copy(this.burr, given, kSkinVertex));
    self.postMessage({kind: 'soft', work: this.work, parts}, transfer(parts));
  }
}

// ---- in the page

// Gives a patch, a part of a soft structure, or a row of the ticks to the view.
export function show(view, one) {
  if (one.row) {
    view.with_bytes([one.row], (row) => view.view_row(row));
    return;
  }
  const call = one.soft ? view.view_soft : view.view_patch;
  view.with_bytes([one.vertices, one.triangles],
                  (vertices, triangles) => call(one.number, vertices, one.count, triangles, one.indices));
}

// Another bone than the page's: its tissues, from tissues().
export function begin_bone(view, all, voxel_mm, rate) {
  for (const {name, told} of all)
    view.with_bytes([new TextEncoder().encode(name + '\0')], (text) => view.view_tissue(text, ...told));
  view.view_other_bone(voxel_mm, rate);
}
