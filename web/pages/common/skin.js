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

export class Skin {
  constructor(burr) {
    this.burr = burr;
    this.fresh = [];  // patches that the page does not have yet
  }
  // Makes the next patch that has changed. False: none has.
  make_one() {
    const given = this.burr.core_patch();
    if (given === 0) return false;
    this.fresh.push(copy(this.burr, given, kVertex));
    return true;
  }
  make_all() {
    while (this.make_one()) { /* the next */ }
  }
  send(message) {
    const patches = this.fresh;
    this.fresh = [];
    self.postMessage({...message, patches}, transfer(patches));
  }
  // The whole surface, what is near the work first, then the soft structures.
  async send_whole() {
    for (let more = true; more;) {
      const until = performance.now() + kFirstMs;
      while (more && performance.now() < until) more = this.make_one();
      this.send({kind: 'skin'});
      await turn();
    }
    self.postMessage({kind: 'skin_done'});
    const parts = [];
    for (let given = this.burr.core_soft(); given !== 0; given = this.burr.core_soft())
      parts.push(copy(this.burr, given, kSkinVertex));
    self.postMessage({kind: 'soft', parts}, transfer(parts));
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
