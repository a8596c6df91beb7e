// The worker of the page: reads a recording, and makes bone and row of any moment. The file stays in this worker.
//
//     page -> worker   open {compiled, file}, seek {time}
//     worker -> page   opened {seconds, voxel, tissues}, skin {patches}, skin_done, soft {parts}, ready,
//                      moment {time, row, patches}, refused {why}, broken {text}
import {start} from '../common/burr.js';
import {Skin} from '../common/skin.js';

let burr = null, skin = null;

self.onmessage = async ({data}) => {
  try {
    if (data.kind === 'open') await open(data);
    else seek(data.time);
  } catch (trouble) {
    self.postMessage({kind: 'broken', text: String(trouble?.message ?? trouble)});
  }
};

async function open({compiled, file}) {
  burr = await start(compiled);
  burr.module.FS.writeFile('/burr.mcap', new Uint8Array(await file.arrayBuffer()), {canOwn: true});
  if (burr.core_open() === 0) {
    self.postMessage({kind: 'refused', why: burr.text(burr.core_why()).replaceAll('/burr.mcap', file.name)});
    return;
  }
  const tissues = [];
  for (let n = 0;; ++n) {
    const at = burr.core_tissue(n);
    if (at === 0) break;
    tissues.push({name: burr.text(burr.core_tissue_name(n)), told: [...burr.numbers(at, 5)]});
  }
  self.postMessage({kind: 'opened', seconds: burr.core_seconds(), voxel: burr.core_voxel_mm(), tissues});
  skin = new Skin(burr);
  await skin.send_whole();
  self.postMessage({kind: 'ready'});
}

function seek(time) {
  if (burr.core_seek(time) === 0) {
    self.postMessage({kind: 'refused', why: burr.text(burr.core_why())});
    return;
  }
  skin.make_all();
  const [, bone] = burr.text(burr.core_hashes()).split(' ');
  skin.send({kind: 'moment', time, bone, row: burr.bytes(burr.core_row(), burr.core_row_size()).slice()});
}
