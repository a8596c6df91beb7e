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

// A Given that is no patch.
export const surface = {
  vertices: (burr, pointer) => copy(burr, pointer, kVertex),  // surface::Vertex
  skin: (burr, pointer) => copy(burr, pointer, kSkinVertex),  // render::SkinVertex
};

// The tissues of the bone, for view_tissue().
export function tissues(burr) {
  const all = [];
  for (let n = 0;; ++n) {
    const at = burr.core_tissue(n);
    if (at === 0) return all;
    all.push({name: burr.text(burr.core_tissue_name(n)), look: [...burr.numbers(at, 5)]});
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

// What a recording's hand holds at a moment, of its worker's message.
function show_held(view, one) {
  if (one.look !== undefined) {
    const {cuts, rubs} = one;
    view.with_bytes([cuts.vertices, cuts.triangles, rubs.vertices, rubs.triangles], (cv, ct, rv, rt) =>
      view.view_tool_look(one.look, cv, cuts.count, ct, cuts.indices, rv, rubs.count, rt, rubs.indices));
  } else if (one.shape !== undefined) {
    const {skin} = one;
    view.with_bytes([skin.vertices, skin.triangles], (vertices, triangles) =>
      view.view_piece_shape(one.shape, vertices, skin.count, triangles, skin.indices));
  } else if (one.tool !== undefined) {
    view.view_tool(one.tool);
  } else {
    view.with_bytes([new Uint8Array(new Float64Array(one.pose).buffer)], (pose) => view.view_piece(one.piece, pose));
  }
}

// Gives a patch, a part of a soft structure, a row of the ticks, or what the hand holds to the view.
export function show(view, one) {
  if (one.held) {
    one.held.forEach((part) => show_held(view, part));
    return;
  }
  if (one.row) {
    view.with_bytes([one.row], (row) => view.view_row(row));
    return;
  }
  const call = one.soft ? view.view_soft : view.view_patch;
  view.with_bytes([one.vertices, one.triangles],
                  (vertices, triangles) => call(one.number, vertices, one.count, triangles, one.indices));
}

// Another bone than the page's: its tissues, from tissues(). mouse: the tool follows a mouse, and is drawn as a hand would hold it.
export function begin_bone(view, all, voxel_mm, rate, mouse) {
  for (const {name, look} of all)
    view.with_bytes([new TextEncoder().encode(name + '\0')], (text) => view.view_tissue(text, ...look));
  view.view_other_bone(voxel_mm, rate, mouse ? 1 : 0);
}
