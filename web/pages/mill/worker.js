// The worker of the page: the bone, its surface and the tick, 1000 times a second of its time.
//
// All ticks that are due are computed together, every 4 ms or so: a mouse has no motors, so nobody
// feels that. Ticks that a busy machine has missed are left out and counted, never made up for.
//
//     page -> worker   start {compiled, voxel, own, work, hidden, task}, next {aim}, command {what, value}, pause {on}, hashes, rows {port},
//                      note {kind, what, where, value}, changed, save {declared}, measure
//     worker -> page   shaped {voxel, tissues}, skin {patches}, skin_done, soft {parts}, ready, state {row, patches, ...}, hashes,
//                      changed {bytes}, saved {file} or {why}, broken {text, why, parts}
//
// The page answers every state with `next`; until then none is sent, so none waits in a queue. A second `start` begins
// anew with another bone: the worker stays, so nothing is fetched again. Each bone has a number, `work`, and each message
// carries it, so that the page can leave what came of the bone before.
import {start, trouble} from '../common/burr.js';
import {load_codecs} from '../common/codecs.mjs';
import {Skin, tissues} from '../common/skin.js';

const kMostTicks = 50;    // in one beat
const kSkinMs = 4;        // for the surface, in each beat
const kBrick = 1028;      // bytes; web::ChangedBrick

let burr = null, skin = null;
let watcher = null, watches = false;  // who looks at rows (watch_worker.js), and whether it is busy with one
let paused = false, wanted = true, running = false;
let work = 0;            // number of the bone
let timer = 0;           // of the next beat; there is never more than one
let begun = 0, done = 0, left_out = 0;
const took = new Map();  // microseconds of a tick -> how many
let timed = 0;           // ticks in it

self.onmessage = ({data}) => {
  try {
    take(data);
  } catch (trouble) {
    broken(trouble);
  }
};

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
  if (!running) return;
  if (data.kind === 'next') {
    wanted = true;
    if (data.aim) {
      burr.bytes(burr.core_aim(), data.aim.length).set(data.aim);
      burr.core_aimed();
    }
  } else if (data.kind === 'command') {
    burr.core_command(data.what, data.value);
  } else if (data.kind === 'hashes') {
    const [tick, bone] = burr.text(burr.core_hashes()).split(' ');
    tell({kind: 'hashes', tick, bone, ticks: done});
  } else if (data.kind === 'measure') {
    clear_times();
  } else if (data.kind === 'note') {
    burr.with_texts([data.what.kind, data.what.what, data.what.where, data.what.value], burr.core_note);
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

// Completes the recording, which lies in the module's own memory, and hands it over.
function save(declared) {
  // the work is done: nothing is cut any more
  if (declared) running = false;
  if (burr.core_finish_recording(declared ? 1 : 0) === 0) {
    tell({kind: 'saved', why: burr.text(burr.core_why())});
    return;
  }
  const {FS} = burr.module;
  const file = FS.readFile('/burr.mcap');
  FS.unlink('/burr.mcap');
  tell({kind: 'saved', file}, [file.buffer]);
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
  const mine = await start(from.compiled, undefined, from.own ? await load_codecs('zstd') : {});
  if (work !== from.work) return;  // another one was asked for meanwhile
  burr = mine;
  if (from.own) {
    if (!burr.with_bytes([from.own], (at) => burr.core_take(at, from.own.length))) throw trouble('no_memory');
    from.own = null;
    tell({kind: 'shaped', voxel: burr.core_voxel_mm(), tissues: tissues(burr)});
  } else {
    if (!burr.core_make(from.voxel)) throw trouble('no_memory');
    tell({kind: 'shaped', voxel: from.voxel});
  }
  skin = new Skin(burr, work);
  await skin.send_whole(() => work === from.work);
  if (work !== from.work) return;
  begin_task(from.task);
  burr.core_begin();
  running = true;
  begin_clock();
  tell({kind: 'ready'});
  beat();
}

// What the recording says about the session.
function begin_task({about, mode}) {
  burr.with_texts([about.text, about.rubric_hash, mode], burr.core_task);
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
    if (due > kMostTicks) {
      left_out += due - kMostTicks;
      due = kMostTicks;
    }
    if (due > 0) {
      burr.core_step(due);
      done += due;
      const each = Math.round(1e3 * (performance.now() - now) / due);
      took.set(each, (took.get(each) ?? 0) + due);
      timed += due;
      if (watcher && !watches) {
        watches = true;
        watcher.postMessage({bytes: burr.bytes(burr.core_row(), burr.core_row_size()).slice(), work});
      }
    }
    const until = performance.now() + kSkinMs;
    while (performance.now() < until && skin.make_one()) { /* the next */ }
    if (wanted) {
      wanted = false;
      const row = burr.bytes(burr.core_row(), burr.core_row_size()).slice();
      skin.send({kind: 'state', row, ticks: done, left_out, ...shares()});
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
