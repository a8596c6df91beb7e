// burr-core. Units: SI where the name says nothing else; frame: world, LPS (x to the left, y to the back, z to the head).
// One thread: calls of one Burr belong to the thread that loaded it; a page loads it in a worker. Errors are thrown, as sentences.

export type Vec3 = readonly [number, number, number];
/** w, x, y, z */
export type Quaternion = readonly [number, number, number, number];

/** Starts the program, with a memory of its own. */
export function load(): Promise<Burr>;

export interface Burr {
  readonly version: string;
  /** The bones by formula, and the voxel that suits each. */
  phantoms(): {name: string; voxel_mm: number}[];
  /** What session() takes, with unit, range and usual value; the names are those of Python. */
  settings(): Setting[];
  /** A bone by formula: "tooth", "temporal-bone?bone=7". */
  phantom(name: string, options?: {voxel_mm?: number}): Bone;
  /** A .bone file, as `bone.file()`, `burr export` and Python write it. */
  bone(file: ArrayBuffer | Uint8Array): Bone;
  /** A bone of numbers of your own. */
  bone_of(voxels: Voxels): Bone;
  /** A session on a copy of the bone. */
  session(bone: Bone, settings?: Record<string, number | boolean | string>, options?: {
    /** recording() can be asked for; false where it is left out */
    record?: boolean;
    /** rows() keeps every tick; false where it is left out */
    rows?: boolean;
  }): Session;
}

export interface Setting {
  name: string;
  unit: string;
  range: string;
  help: string;
  usual: number | boolean | string;
}

export interface Voxels {
  size: Vec3;
  voxel_mm: number;
  /** x fastest: 0 air, 32768 the surface, 65535 solid; 16384 for each voxel of depth */
  field: Uint16Array;
  /** the number of a tissue for each voxel */
  labels?: Uint8Array | null;
  /** of the labels, from 0, which is air */
  tissues?: Tissue[] | null;
  /** the middle of the first voxel */
  origin_mm?: Vec3;
}

export interface Tissue {
  name: string;
  kind?: 'air' | 'soft' | 'solid';
  /** sRGB, 0 to 1 */
  colour?: Vec3;
  friction?: number;
  cutting_energy_j_per_m3?: number;
}

/** It never changes: a session cuts a copy of it. */
export interface Bone {
  readonly size: Vec3;
  readonly voxel_mm: number;
  readonly origin_mm: Vec3;
  readonly tissues: Tissue[];
  /** Of the content; the same in C++, in Python and here. */
  readonly hash: string;
  /** "phantom:tooth", or "" */
  readonly source: string;
  volume_mm3(): number;
  /** x fastest */
  field(): Uint16Array;
  labels(): Uint8Array;
  mesh(): Mesh;
  /** As a .bone file. */
  file(): Uint8Array;
  /** Frees its memory. */
  forget(): void;
}

/** Triangles, counter-clockwise seen from the air. */
export interface Mesh {
  /** x, y, z of each [m] */
  points: Float32Array;
  /** out of the bone */
  normals: Float32Array;
  /** the tissue of each point */
  tissues: Uint8Array;
  triangles: Uint32Array;
}

export interface Session {
  /**
   * Where the tip is after `ticks` ticks; it goes there straight and evenly. 0: it is there at once, at rest. What is left out stays
   * as it was; at first the handle points along +z and the pedal is up.
   */
  hand(p: Vec3, q?: Quaternion | null, options?: {pedal?: number | null; ticks?: number}): void;
  /** Makes ticks. Between two calls time stands still. */
  step(ticks?: number): void;
  /** A command of a user, by its name in recordings ("spindle_speed", "irrigation", "undo"), its value in SI. */
  command(name: string, value?: number): void;
  /** Of the last tick; units stand in the names. */
  readonly row: Row;
  /** Of all ticks since the last call, a column each; three or four numbers of a vector one after the other. Needs rows: true. */
  rows(): Record<keyof Row, Float64Array>;
  /** Of the last tick and all before it; the same in C++ and Python for the same session. */
  readonly hash: string;
  /** The bone as it is now. */
  bone(): Bone;
  /** Those parts of the surface that have changed since the last call; at first all of them. A part without triangles is gone. */
  changed(): IterableIterator<Mesh & {number: number}>;
  /** A complete .mcap file of everything so far; the session goes on. Needs record: true. `burr replay` and `burr score` read it. */
  recording(): Uint8Array;
  /** Frees its memory. */
  forget(): void;
}

export interface Row {
  tick: number;
  hand_m: number[];
  hand_q: number[];
  hand_v_m_per_s: number[];
  pedal: number;
  /** where the tool is: on the bone when the hand is in it */
  proxy_m: number[];
  normal: number[];
  force_n: number[];
  torque_nm: number[];
  depth_m: number;
  touching: number;
  flags: number;
  asked_m3: number;
  removed_m3: number;
  debt_m3: number;
  added_m3: number;
  undone_m3: number;
  cutting_energy_j: number;
  spindle_rad_per_s: number;
  cutting_torque_nm: number;
  cutting_power_w: number;
  tool_radius_m: number;
  coolant: number;
}
