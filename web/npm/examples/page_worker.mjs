// Of page.html: a block of bone, cut in half; the burr lies in the middle of the slice.
import {load} from '../index.mjs';

const burr = await load();
const size = 128, thick = 48, voxel_mm = 0.25;
const field = new Uint16Array(size * size * thick);
for (let n = 0; n < field.length; ++n) {
  const x = n % size, y = Math.floor(n / size) % size, z = Math.floor(n / size / size);
  const deep = Math.min(x - 16, size - 17 - x, y - 16, size - 17 - y, z - 3, thick - 4 - z);
  field[n] = Math.max(0, Math.min(65535, 32768 + (deep + 0.5) * 16384));
}
const block = burr.bone_of({size: [size, size, thick], voxel_mm, field});
const session = burr.session(block, {burr_mm: 4, rpm: 40000});
const middle = 0.5e-3 * voxel_mm * (thick - 1);
const place = ([u, v]) => [1e-3 * voxel_mm * u * (size - 1), 1e-3 * voxel_mm * v * (size - 1), middle];

session.hand(place([0, 0]));
session.step(600);                       // forces begin slowly
show();
onmessage = ({data}) => {
  session.hand(place(data.at), null, {pedal: data.down ? 1 : 0, ticks: 16});
  session.step(16);
  show();
};

function show() {
  const now = session.bone(), slice = now.field().subarray(size * size * (thick >> 1), size * size * ((thick >> 1) + 1));
  now.forget();
  const pixels = new Uint8ClampedArray(4 * size * size), [px, py] = session.row.proxy_m, radius = session.row.tool_radius_m;
  for (let n = 0; n < slice.length; ++n) {
    const far = Math.hypot(1e-3 * voxel_mm * (n % size) - px, 1e-3 * voxel_mm * Math.floor(n / size) - py);
    const bone = slice[n] / 65535;
    pixels.set(far < radius ? [86, 180, 233, 255] : [30 + 200 * bone, 32 + 190 * bone, 38 + 150 * bone, 255], 4 * n);
  }
  postMessage({pixels, width: size, height: size, force: Math.hypot(...session.row.force_n), removed: 1e9 * session.row.removed_m3}, [pixels.buffer]);
}
