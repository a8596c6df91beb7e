// The worker of the page: the bone, its surface and the tick, 1000 times a second of its time.
//
// All ticks that are due are computed together, every 4 ms or so: a mouse has no motors, so nobody
// feels that. Ticks that a busy machine has missed are left out and counted, never made up for.
//
//     page -> worker   start {compiled, voxel}, next {aim}, command {what, value}, pause {on}, hashes, save, measure
//     worker -> page   shaped, skin {patches}, skin_done, soft {parts}, ready, state {row, patches, ...}, hashes,
//                      saved {file} or {why}, broken {text}
//
// The page answers every state with `next`; until then none is sent, so none waits in a queue.
import {start} from '../common/burr.js';
import {Skin} from '../common/skin.js';

const kMostTicks = 50;    // in one beat
const kSkinMs = 4;        // for the surface, in each beat

let burr = null, skin = null;
let paused = false, wanted = true, running = false;
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

function broken(trouble) {
  running = false;
  self.postMessage({kind: 'broken', text: String(trouble?.message ?? trouble)});
}

function take(data) {
  if (data.kind === 'start') return void open(data).catch(broken);
  if (!running) return;
  if (data.kind === 'next') {
    wanted = true;
    if (data.aim) {
      burr.bytes(burr.core_aim(), data.aim.length).set(data.aim);
      burr.core_aimed();
    }
  } else if (data.kind === 'command') {
    burr.core_command(data.what, data.value);
  } else if (data.kind === 'pause') {
    if (paused === data.on) return;
    paused = data.on;
    if (!paused) {
      begin_clock();
      beat();
    }
  } else if (data.kind === 'hashes') {
    const [tick, bone] = burr.text(burr.core_hashes()).split(' ');
    self.postMessage({kind: 'hashes', tick, bone, ticks: done});
  } else if (data.kind === 'measure') {
    took.clear();
    timed = 0;
  } else if (data.kind === 'save') {
    save();
  }
}

// Completes the recording, which lies in the module's own memory, and hands it over.
function save() {
  if (burr.core_finish_recording() === 0) {
    self.postMessage({kind: 'saved', why: burr.text(burr.core_why())});
    return;
  }
  const {FS} = burr.module;
  const file = FS.readFile('/burr.mcap');
  FS.unlink('/burr.mcap');
  self.postMessage({kind: 'saved', file}, [file.buffer]);
}

async function open({compiled, voxel}) {
  burr = await start(compiled);
  if (!burr.core_make(voxel)) throw new Error('not enough memory');
  self.postMessage({kind: 'shaped', voxel});
  skin = new Skin(burr);
  await skin.send_whole();
  burr.core_begin();
  running = true;
  begin_clock();
  self.postMessage({kind: 'ready'});
  beat();
}

function begin_clock() {
  begun = performance.now() - done - left_out;
}

function beat() {
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
    }
    const until = performance.now() + kSkinMs;
    while (performance.now() < until && skin.make_one()) { /* the next */ }
    if (wanted) {
      wanted = false;
      const row = burr.bytes(burr.core_row(), burr.core_row_size()).slice();
      skin.send({kind: 'state', row, ticks: done, left_out, ...shares()});
    }
    setTimeout(beat, 2);
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
