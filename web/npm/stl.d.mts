import type {Mesh} from './index.mjs';

/** A mesh as a binary STL file, in millimetres. */
export function stl(mesh: Pick<Mesh, 'points' | 'triangles'>): Uint8Array;
