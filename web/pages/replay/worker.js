// The worker of the page: reads a recording, and makes bone and row of any moment. The file stays in this worker.
//
//     page -> worker   open {compiled, file, bone, work}, seek {time}; bone: of a recording that holds none, as bytes
//     worker -> page   here, opened {seconds, rate, voxel, tissues}, skin {patches}, skin_done, soft {parts}, ready,
//                      moment {time, row, patches}, refused {why, parts}, broken {text, why, parts}
//
// Each file has a number, `work`, and each message carries it, so that the page can leave what came of the file before.
import {start} from '../common/burr.js';
import {Skin} from '../common/skin.js';

let burr = null, skin = null;
let work = 0;  // number of the file

self.onmessage = async ({data}) => {
  try {
    if (data.kind === 'open') await open(data);
    else if (data.work === work) seek(data.time);
  } catch (what) {
    tell({kind: 'broken', text: String(what?.message ?? what), why: what?.why, parts: what?.parts});
  }
};
self.postMessage({kind: 'here'});

function tell(message) {
  self.postMessage({...message, work});
}

async function open({compiled, file, bone, work: mine}) {
  work = mine;
  burr = skin = null;  // an older file gives its memory back
  const [fresh, bytes] = await Promise.all([start(compiled), file.arrayBuffer()]);
  if (work !== mine) return;  // another one was chosen meanwhile
  burr = fresh;
  burr.module.FS.writeFile('/burr.mcap', new Uint8Array(bytes), {canOwn: true});
  if (bone) burr.module.FS.writeFile('/burr.bone', bone, {canOwn: true});
  if (burr.core_open() === 0) {
    tell({kind: 'refused', why: 'not_opened', parts: [file.name, burr.text(burr.core_why()).replace('/burr.mcap: ', '')]});
    return;
  }
  const tissues = [];
  for (let n = 0;; ++n) {
    const at = burr.core_tissue(n);
    if (at === 0) break;
    tissues.push({name: burr.text(burr.core_tissue_name(n)), told: [...burr.numbers(at, 5)]});
  }
  tell({kind: 'opened', seconds: burr.core_seconds(), rate: burr.core_rate(), voxel: burr.core_voxel_mm(), tissues});
  skin = new Skin(burr, work);
  await skin.send_whole(() => work === mine);
  if (work === mine) tell({kind: 'ready'});
}

function seek(time) {
  if (burr.core_seek(time) === 0) {
    tell({kind: 'refused', why: 'no_moment', parts: [burr.text(burr.core_why())]});
    return;
  }
  skin.make_all();
  const [, bone] = burr.text(burr.core_hashes()).split(' ');
  skin.send({kind: 'moment', time, bone, row: burr.bytes(burr.core_row(), burr.core_row_size()).slice()});
}
