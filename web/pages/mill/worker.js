// The worker of the page: the bone, its surface and the tick, 1000 times a second of its time.
//
// All ticks that are due are computed together, every 4 ms or so: a mouse has no motors, so nobody
// feels that. Where a machine is busy, the surface waits first; then what is due is made up for, as far as that takes kCatchUpMs;
// the ticks beyond are left out and counted.
//
//     page -> worker   start {compiled, voxel, bone, own, work, hidden, task, kept, redo}, next {aim}, command {what, value}, back {what},
//                      press, take_back, pause {on}, hashes, rows {port}, note {kind, what, where, value}, changed, save {declared},
//                      leave, shape, measure
//     worker -> page   shaped {voxel, tissues}, redone {share}, parted {tick}, skin {patches}, skin_done, soft {parts}, ready,
//                      state {row, patches, ...}, hashes, went_back {what, did, whole}, changed {bytes}, saved {file, complete} or {why},
//                      shape {triangles}, unkept {why}, left, broken {text, why, parts}
//
// The page answers every state with `next`; until then none is sent, so none waits in a queue. A second `start` begins
// anew with another bone: the worker stays, so nothing is fetched again. Each bone has a number, `work`, and each message
// carries it, so that the page can leave what came of the bone before.
//
// The recording goes to the browser's storage as it is made (common/store.js). `redo` is a port to the worker that reads recordings: a
// session that was interrupted is computed again, tick by tick, with undo and all, and goes on.
import {start, trouble} from '../common/burr.js';
import {Skin, surface, tissues} from '../common/skin.js';
import {begin_kept, forget_kept} from '../common/store.js';
import {GoBack} from './go_back.js';

const kMostTicks = 50, kMostOfAll = 250;  // in one beat: always; where they take no longer than kCatchUpMs
const kCatchUpMs = 25;
const kLate = 12;         // ticks due in a beat that came late: the surface waits
const kSkinMs = 4;        // for the surface, in each beat
const kSkinWaits = 100;   // no longer than this [ms]
const kBrick = 1028;      // bytes; web::ChangedBrick
const kNoteEvery = 500;   // of what is known of the session [ms]
const kFile = '/burr.mcap', kCopy = '/copy.mcap';  // PageRecorder

let burr = null, skin = null;
let watcher = null, watches = false;  // who looks at rows (watch_worker.js), and whether it is busy with one
let paused = false, wanted = true, running = false;
let work = 0;            // number of the bone
let timer = 0;           // of the next beat; there is never more than one
let begun = 0, done = 0, left_out = 0;
let each_ms = 0.1;       // of a tick, lately
let skinned = 0;         // when the surface was made last [ms]
let kept = null, facts = null;   // the session in the browser's storage; what is known of it
let streamed = 0, noted = 0;     // bytes of the recording that are there; when the facts were written
let back = null;                 // undo, redo, reset
const took = new Map();  // microseconds of a tick -> how many
let timed = 0;           // ticks in it

self.onmessage = ({data}) => {
  try {
    take(data);
  } catch (trouble) {
    broken(trouble);
  }
};

self.postMessage({kind: 'here'});  // its scripts are loaded

function tell(message, transfer = []) {
  self.postMessage({...message, work}, transfer);
}
function broken(what) {
  running = false;
  tell({kind: 'broken', text: String(what?.message ?? what), why: what?.why, parts: what?.parts});
}

function take(data) {
  if (data.kind === 'start') return void open(data).catch(broken);
  if (data.kind === 'pause') return pause(data.on);  // the bone may still be on its way
  if (data.kind === 'rows') {
    watcher = data.port;
    watcher.onmessage = () => { watches = false; };
    return;
  }
  if (data.kind === 'leave') return void leave();
  if (!running) return;
  if (data.kind === 'next') {
    wanted = true;
    back.hand_moved();
    if (data.aim) {
      burr.bytes(burr.core_aim(), data.aim.length).set(data.aim);
      burr.core_aimed();
    }
  } else if (data.kind === 'command') {
    burr.core_command(data.what, data.value);
  } else if (data.kind === 'back') {
    back.ask(data.what);
  } else if (data.kind === 'press') {
    back.press();
  } else if (data.kind === 'take_back') {
    back.take_back();
  } else if (data.kind === 'shape') {
    shape();
  } else if (data.kind === 'hashes') {
    const [tick, bone] = burr.text(burr.core_hashes()).split(' ');
    tell({kind: 'hashes', tick, bone, ticks: done});
  } else if (data.kind === 'measure') {
    clear_times();
  } else if (data.kind === 'note') {
    note(data.what);
  } else if (data.kind === 'changed') {
    const at = burr.core_changed();
    const bytes = burr.bytes(at, burr.core_changed_count() * kBrick).slice();
    tell({kind: 'changed', bytes}, [bytes.buffer]);
  } else if (data.kind === 'save') {
    save(data.declared);
  }
}

function pause(on) {
  if (paused === on) return;
  paused = on;
  if (paused || !running) return;
  begin_clock();
  beat();
}

// Hands a recording over: declared: the work is done, and the recording complete; otherwise a copy, and the session goes on.
function save(declared) {
  if (declared) running = false;  // nothing is cut any more
  if ((declared ? burr.core_finish_recording(1) : burr.core_copy_recording()) === 0) {
    tell({kind: 'saved', why: burr.text(burr.core_why())});
    return;
  }
  stream();
  if (declared) {
    note_facts('done');
    kept?.close();
    kept = null;
  }
  const {FS} = burr.module, name = declared ? kFile : kCopy;
  const file = FS.readFile(name);
  FS.unlink(name);
  tell({kind: 'saved', file, complete: declared}, [file.buffer]);
}

// ---- the browser's storage

async function begin_to_keep(from) {
  streamed = noted = 0;
  facts = {...from.kept, ticks: 0, removed: 0, state: 'open'};
  const mine = await begin_kept(facts.id, facts, (why) => tell({kind: 'unkept', why}));
  if (work !== from.work) {
    await mine?.close();
    if (from.kept) await forget_kept(from.kept.id);
    return false;
  }
  kept = mine;
  stream();
  return true;
}
// What the recording has got since the last call.
function stream() {
  if (!kept) return;
  const {node} = burr.module.FS.lookupPath(kFile);
  if (node.usedBytes === streamed) return;
  kept.append(node.contents.subarray(streamed, node.usedBytes));
  streamed = node.usedBytes;
  if (performance.now() - noted > kNoteEvery) note_facts('open');
}
function note_facts(state) {
  noted = performance.now();
  Object.assign(facts, {ticks: done, removed: burr.core_removed(), at: Date.now(), state});
  kept?.note(facts);
}
// The user has ended the session: it is kept, and not offered by itself.
async function leave() {
  running = false;
  const [was, of] = [kept, facts];
  if (was) {
    if (burr && of.state === 'open') {
      burr.core_copy_recording();  // writes what waits
      stream();
      note_facts('left');
    }
    kept = null;
    await was.close();
    if (!(of.most > 0)) await forget_kept(of.id);
  }
  tell({kind: 'left'});
}

// The session of a recording once more.
async function redo(from) {
  const port = from.redo;
  const next = () => new Promise((go) => {
    port.onmessage = ({data}) => go(data);
    port.postMessage(0);
  });
  for (;;) {
    const part = await next();
    if (work !== from.work) return false;
    const same = part.count === 0 ? 0 : burr.with_bytes([part.ticks, part.commands], (ticks, commands) =>
      burr.core_redo(ticks, part.count, commands, part.command_count));
    done += part.count;
    if (same < part.count) {
      tell({kind: 'parted', tick: burr.core_tick()});
      done = burr.core_tick() + 1;
      break;
    }
    for (const one of part.notes) note(one);
    stream();
    tell({kind: 'redone', share: part.share});
    if (part.last) break;
  }
  burr.core_redone();
  port.close();
  return true;
}
const note = (what) => burr.with_texts([what.kind, what.what, what.where, what.value], burr.core_note);

// The surface as it is now, as triangles of nine floats [mm].
function shape() {
  burr.core_again();
  const parts = [];
  for (let given = burr.core_patch(); given !== 0; given = burr.core_patch()) {
    const one = surface.vertices(burr, given);
    if (one.number < 0) continue;
    const from = new DataView(one.vertices.buffer), at = new Uint32Array(one.triangles.buffer);
    const out = new Float32Array(9 * (at.length / 3));
    at.forEach((vertex, n) => { for (let axis = 0; axis < 3; ++axis) out[3 * n + axis] = 1e3 * from.getFloat32(28 * vertex + 4 * axis, true); });
    parts.push(out);
  }
  tell({kind: 'shape', parts}, parts.map((one) => one.buffer));
}

async function open(from) {
  work = from.work;
  paused = from.hidden;
  running = false;
  wanted = true;
  done = left_out = 0;
  clear_times();
  burr = skin = null;  // an older bone gives its memory back
  // a bone of the user's own scan comes packed
  const mine = await start(from.compiled, undefined, from.bone ? await (await import('../common/codecs.mjs')).load_codecs('zstd') : {});
  if (work !== from.work) return;  // another one was asked for meanwhile
  burr = mine;
  if (from.bone) {
    if (!burr.with_bytes([from.bone], (at) => burr.core_take(at, from.bone.length, from.own ? 1 : 0))) throw trouble('no_memory');
    from.bone = null;
    tell({kind: 'shaped', voxel: burr.core_voxel_mm(), tissues: tissues(burr)});
  } else {
    if (!burr.core_make(from.voxel)) throw trouble('no_memory');
    tell({kind: 'shaped', voxel: from.voxel});
  }
  skin = new Skin(burr, work);
  back = new GoBack(burr, tell);
  begin_task(from.task);
  if (!from.redo) {  // who waits sees the bone first
    await skin.send_whole(() => work === from.work);
    if (work !== from.work) return;
  }
  burr.core_begin();
  if (!await begin_to_keep(from)) return;
  if (from.redo) {
    if (!await redo(from)) return;
    await skin.send_whole(() => work === from.work);
    if (work !== from.work) return;
  }
  running = true;
  begin_clock();
  tell({kind: 'ready'});
  beat();
}

// What the recording says about the session.
function begin_task({about, mode}) {
  burr.core_burr(0.5e-3 * about.burr_mm, about.diamond ? 1 : 0, about.rpm);
  burr.with_texts([about.name, about.text, about.rubric_hash, mode, about.phantom], burr.core_task);
  for (const one of about.spare) burr.with_texts([one], burr.core_spare);
  for (const one of about.targets)
    burr.with_texts([one.tissue, one.goal], (tissue, goal) => burr.core_target(tissue, goal, one.share));
}

function begin_clock() {
  begun = performance.now() - done - left_out;
}

function clear_times() {
  took.clear();
  timed = 0;
}

function beat() {
  clearTimeout(timer);
  if (paused || !running) return;
  try {
    const now = performance.now();
    let due = Math.floor(now - begun) - done - left_out;
    const late = due > kLate, most = Math.min(kMostOfAll, Math.max(kMostTicks, Math.floor(kCatchUpMs / each_ms)));
    if (due > most) {
      left_out += due - most;
      due = most;
    }
    if (due > 0) {
      burr.core_step(due);
      done += due;
      done += back.step();
      facts.most = Math.max(facts.most ?? 0, burr.core_removed());
      stream();
      each_ms += 0.1 * ((performance.now() - now) / due - each_ms);
      const each = Math.round(1e3 * (performance.now() - now) / due);
      took.set(each, (took.get(each) ?? 0) + due);
      timed += due;
      if (watcher && !watches) {
        watches = true;
        watcher.postMessage({bytes: burr.bytes(burr.core_row(), burr.core_row_size()).slice(), work});
      }
    }
    const until = performance.now() + kSkinMs;
    if (!late || until - skinned > kSkinWaits) {
      skinned = until;
      while (performance.now() < until && skin.make_one()) { /* the next */ }
    }
    if (wanted) {
      wanted = false;
      const row = burr.bytes(burr.core_row(), burr.core_row_size()).slice();
      skin.send({kind: 'state', row, ticks: done, left_out, behind: burr.core_patches_due(), ...shares()});
    }
    timer = setTimeout(beat, 2);
  } catch (trouble) {
    broken(trouble);
  }
}

// The middle tick and the slowest of a hundred [us], since the start or `measure`; a beat's ticks are timed together.
function shares() {
  const all = [...took].sort((a, b) => a[0] - b[0]);
  const share = (part) => {
    let left = part * timed;
    for (const [each, count] of all)
      if ((left -= count) <= 0) return each;
    return all.at(-1)?.[0] ?? 0;
  };
  return {p50: share(0.5), p99: share(0.99)};
}
