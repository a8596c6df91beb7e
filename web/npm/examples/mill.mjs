// Mills a groove into a tooth, records it, and writes what is left as STL.
//
//     node examples/mill.mjs [FOLDER]         then: burr replay FOLDER/groove.mcap --check
import {writeFile} from 'node:fs/promises';
import {load} from 'burr-core';
import {stl} from 'burr-core/stl';

const folder = process.argv[2] ?? '.';
const burr = await load();
const tooth = burr.phantom('tooth', {voxel_mm: 0.3});
const {points} = tooth.mesh();
let top = 0;                                              // the highest point of the crown
for (let n = 0; n < points.length; n += 3) if (points[n + 2] > points[top + 2]) top = n;
const [x, y, z] = points.subarray(top, top + 3);

const session = burr.session(tooth, {burr_mm: 2, rpm: 80000, irrigated: true}, {record: true, rows: true});
session.hand([x - 2e-3, y, z + 2e-3], [1, 0, 0, 0], {pedal: 1});
session.step(600);
for (let pass = 0; pass < 4; ++pass) {
  session.hand([x + (pass % 2 === 0 ? 2e-3 : -2e-3), y, z + 0.8e-3 - 0.2e-3 * pass], null, {ticks: 500});
  session.step(500);
}
const rows = session.rows();
let most = 0;
for (let n = 0; n < rows.tick.length; ++n) most = Math.max(most, Math.hypot(...rows.force_n.subarray(3 * n, 3 * n + 3)));
const left = session.bone();
console.log(`${rows.tick.length} ticks, ${(1e9 * session.row.removed_m3).toFixed(3)} mm3 removed, at most ${most.toFixed(2)} N`);
console.log(`tick ${session.hash}, bone ${left.hash}`);
await writeFile(`${folder}/groove.mcap`, session.recording());
await writeFile(`${folder}/tooth.stl`, stl(left.mesh()));
