// The worker of the page: reads a recording, and makes bone and row of any moment. The file stays in this worker.
//
//     page -> worker   open {file, bone, work}, seek {time}, hash; bone: of a recording that holds none, as bytes
//     worker -> page   here, opened {seconds, rate, voxel, tissues, mouse}, skin {patches}, skin_done, soft {parts}, ready,
//                      moment {time, row, patches, held}, hash {bone}, refused {why, parts}, broken {text, why, parts}
//
// Each file has a number, `work`, and each message carries it, so that the page can leave what came of the file before.
import make from '../burr_replay.mjs';
import {compile, start} from '../common/burr.js';
import {load_codecs} from '../common/codecs.mjs';
import {Skin, surface, tissues} from '../common/skin.js';

const kPath = '/in/burr.mcap';

const reader = Promise.all([compile('burr_replay.wasm'), load_codecs('zstd')]);
let burr = null, skin = null;
let work = 0;  // number of the file
let sent = new Set();  // tools and pieces whose surface the page has

self.onmessage = async ({data}) => {
  try {
    if (data.kind === 'open') await open(data);
    else if (data.work !== work || !skin) return;
    else if (data.kind === 'hash') hash();
    else seek(data.time);
  } catch (what) {
    tell({kind: 'broken', text: String(what?.message ?? what), why: what?.why, parts: what?.parts});
  }
};
reader.then(() => self.postMessage({kind: 'here'}), (what) => tell({kind: 'broken', text: String(what?.message ?? what)}));

function tell(message) {
  self.postMessage({...message, work});
}

async function open({file, bone, work: mine}) {
  work = mine;
  burr = skin = null;  // an older file gives its memory back
  sent = new Set();
  const [compiled, codecs] = await reader;
  const fresh = await start(compiled, make, codecs);
  if (work !== mine) return;  // another one was chosen meanwhile
  burr = fresh;
  // the file stays where it is: of it only what a moment needs is read (File.slice)
  const {FS, WORKERFS} = burr.module;
  FS.mkdir('/in');
  FS.mount(WORKERFS, {blobs: [{name: 'burr.mcap', data: file}]}, '/in');
  if (bone) FS.writeFile('/burr.bone', bone, {canOwn: true});
  const path = new TextEncoder().encode(kPath + '\0');
  if (burr.with_bytes([path], (at) => burr.core_open(at)) === 0) {
    tell({kind: 'refused', why: 'not_opened', parts: [file.name, reason()]});
    return;
  }
  tell({kind: 'opened', seconds: burr.core_seconds(), rate: burr.core_rate(), voxel: burr.core_voxel_mm(), tissues: tissues(burr),
        mouse: burr.core_mouse() !== 0});
  skin = new Skin(burr, work);
  await skin.send_whole(() => work === mine);
  if (work === mine) tell({kind: 'ready'});
}

function seek(time) {
  if (burr.core_seek(time) === 0) {
    tell({kind: 'refused', why: 'no_moment', parts: [reason()]});
    return;
  }
  skin.make_all();
  skin.send({kind: 'moment', time, row: burr.bytes(burr.core_row(), burr.core_row_size()).slice(), held: held()});
}

// What is in the hand: a tool of the rack, a piece of bone. A surface goes to the page once.
function held() {
  const fresh = (name) => !sent.has(name) && Boolean(sent.add(name));
  const all = [], tool = burr.core_tool();
  if (tool >= 0 && fresh(`tool ${tool}`)) {
    const [cuts, rubs] = [0, 1].map((part) => surface.vertices(burr, burr.core_tool_part(part)));
    all.push({look: tool, cuts, rubs});
  }
  all.push({tool});
  const [piece, ...pose] = burr.numbers(burr.core_piece(), 8);
  if (piece > 0 && fresh(`piece ${piece}`)) all.push({shape: piece, skin: surface.skin(burr, burr.core_piece_skin())});
  all.push({piece, pose});
  return all;
}

// Of the bone as it is shown: for those who want to compare.
function hash() {
  const [, bone] = burr.text(burr.core_hashes()).split(' ');
  tell({kind: 'hash', bone});
}

// Why the last call failed, without the name that the file has in the module.
const reason = () => burr.text(burr.core_why()).replaceAll(`${kPath}: `, '');
