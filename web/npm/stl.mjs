// A mesh as a binary STL file, in millimetres.
export function stl({points, triangles}) {
  const count = triangles.length / 3, bytes = new Uint8Array(84 + 50 * count), view = new DataView(bytes.buffer);
  bytes.set(new TextEncoder().encode('burr, millimetres'));
  view.setUint32(80, count, true);
  const corner = (n) => [0, 1, 2].map((axis) => 1e3 * points[3 * triangles[n] + axis]);
  for (let n = 0; n < count; ++n) {
    const [a, b, c] = [corner(3 * n), corner(3 * n + 1), corner(3 * n + 2)];
    const u = b.map((one, k) => one - a[k]), v = c.map((one, k) => one - a[k]);
    const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const length = Math.hypot(...normal) || 1;
    [...normal.map((one) => one / length), ...a, ...b, ...c].forEach((one, k) => view.setFloat32(84 + 50 * n + 4 * k, one, true));
  }
  return bytes;
}
