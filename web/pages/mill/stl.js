// A surface as a binary STL file: triangles of nine floats [mm], in some parts.
export function stl(parts) {
  const count = parts.reduce((sum, one) => sum + one.length / 9, 0);
  const bytes = new Uint8Array(84 + 50 * count), out = new DataView(bytes.buffer);
  bytes.set(new TextEncoder().encode('burr: surface of a bone, mm, LPS'));
  out.setUint32(80, count, true);
  let at = 84;
  for (const one of parts)
    for (let n = 0; n < one.length; n += 9, at += 50) {
      const [ax, ay, az, bx, by, bz] = [3, 4, 5, 6, 7, 8].map((m) => one[n + m] - one[n + m % 3]);
      const normal = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], long = Math.hypot(...normal) || 1;
      normal.forEach((value, axis) => out.setFloat32(at + 4 * axis, value / long, true));
      for (let m = 0; m < 9; ++m) out.setFloat32(at + 12 + 4 * m, one[n + m], true);
    }
  return bytes;
}
