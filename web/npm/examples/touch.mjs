// Presses a burr that stands still into a plate, and prints how the force grows: the spring of the hand, 1 N for each millimetre at 1000 N/m.
//
//     node examples/touch.mjs
import {load} from 'burr-core';

const burr = await load();

// a plate of 12.8 mm, 6.4 mm thick: each voxel of depth is 16384
const [x, y, z] = [64, 64, 48], field = new Uint16Array(x * y * z);
for (let n = 0; n < field.length; ++n) {
  const height = Math.floor(n / (x * y));
  field[n] = Math.max(0, Math.min(65535, 32768 + (31.5 - height) * 16384));
}
const plate = burr.bone_of({size: [x, y, z], voxel_mm: 0.2, field, origin_mm: [-6.3, -6.3, -6.3]});
console.log(`a plate of ${plate.volume_mm3().toFixed(1)} mm3, ${plate.hash}`);

const session = burr.session(plate, {burr_mm: 4, stiffness_n_per_m: 1000});
session.hand([0, 0, 4e-3]);
session.step(600);                                        // forces begin slowly
for (let depth = 0; depth <= 1; depth += 0.25) {
  session.hand([0, 0, 2e-3 - 1e-3 * depth], null, {ticks: 200});
  session.step(400);
  const {force_n, touching} = session.row;
  console.log(`${depth.toFixed(2)} mm deep: ${Math.hypot(...force_n).toFixed(3)} N${touching ? '' : ', free'}`);
}
