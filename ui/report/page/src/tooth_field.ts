// The tooth as a smooth field over time: the share of solid tissue in each cell, lightly blurred so that its level 0.5 is a smooth surface.
// Only the cells that the exam changed are computed again when the time moves.
import { type ReportData, type Vec3, unpack } from "./data.ts";
import type { Field, Region } from "./surface_nets.ts";

/** Cells that the blur reaches on each side. */
export const k_blur_cells = 2;
export const k_level = 0.5;
const k_never = 65535;

/** A box of the lattice, filled in the same order as the whole. */
export interface Block {
  low: Vec3;
  size: Vec3;
}

export class ToothField implements Field {
  readonly size: Vec3;
  readonly cell_mm: number;
  readonly origin_mm: Vec3;
  /** Blurred share of solid tissue now, of all cells. */
  readonly values: Float32Array;
  /** The same before the exam. */
  readonly untouched: Float32Array;
  readonly tissue: Uint8Array;
  readonly box: Block;
  /** Signed distance to the target's walls and floor, 0.02 mm, + = outside the target; of the box. */
  readonly distance: Int8Array;
  readonly heat: Int8Array | null;
  /** Where `values` change with the time; null when they never do. */
  readonly moving: Block | null = null;
  /** Counts up with every change of `values`. */
  version = 0;

  private readonly before: Uint8Array;
  private readonly duration_s: number;
  // of `padded`, the moving block and what the blur reads around it
  private readonly padded: Block | null = null;
  private readonly start_share: Uint8Array = new Uint8Array(0);
  private readonly end_share: Uint8Array = new Uint8Array(0);
  private readonly first: Uint16Array = new Uint16Array(0);
  private readonly last: Uint16Array = new Uint16Array(0);
  private readonly share: Float32Array = new Float32Array(0); // as it is now, before the blur
  private readonly work: [Float32Array, Float32Array] = [new Float32Array(0), new Float32Array(0)];
  private share_at = 0;

  constructor(data: ReportData) {
    const grid = data.grid;
    this.size = grid.size;
    this.cell_mm = grid.cell_mm;
    this.origin_mm = grid.origin_mm;
    this.box = grid.box;
    this.duration_s = data.duration_s ?? 0;
    this.before = unpack(grid.before) as Uint8Array;
    this.tissue = unpack(grid.tissue) as Uint8Array;
    this.distance = unpack(grid.distance) as Int8Array;
    this.heat = grid.heat ? (unpack(grid.heat) as Int8Array) : null;
    const after = unpack(grid.after) as Uint8Array;
    const cells = grid.size[0] * grid.size[1] * grid.size[2];
    const box_cells = grid.box.size[0] * grid.box.size[1] * grid.box.size[2];
    if (
      this.before.length !== cells ||
      this.tissue.length !== cells ||
      after.length !== box_cells ||
      this.distance.length !== box_cells
    )
      throw new Error("the tooth's fields do not have the size of its grid");

    const whole: Block = { low: [0, 0, 0], size: grid.size };
    const share = shares(this.before);
    const scratch = new Float32Array(cells);
    blur(share, scratch, grid.size);
    this.untouched = share;
    if (!grid.first || !grid.last) {
      this.values = shares(this.before);
      for_each_row(whole, this.box, (at, inner, n) => {
        for (let i = 0; i < n; ++i) this.values[at + i] = after[inner + i] * (1 / 255);
      });
      blur(this.values, scratch, grid.size);
      return;
    }
    this.values = share.slice();
    const first = unpack(grid.first) as Uint16Array;
    const last = unpack(grid.last) as Uint16Array;
    const changed = bounds(
      this.box,
      (i, at) => first[i] !== k_never || after[i] !== this.before[at],
      grid.size,
    );
    if (!changed) return;
    this.moving = grown(changed, k_blur_cells, grid.size);
    this.padded = grown(changed, 2 * k_blur_cells, grid.size);
    const n = this.padded.size[0] * this.padded.size[1] * this.padded.size[2];
    this.start_share = new Uint8Array(n);
    this.end_share = new Uint8Array(n);
    this.first = new Uint16Array(n).fill(k_never);
    this.last = new Uint16Array(n).fill(k_never);
    this.work = [new Float32Array(n), new Float32Array(n)];
    for_each_row(whole, this.padded, (at, inner, count) =>
      this.start_share.set(this.before.subarray(at, at + count), inner),
    );
    this.end_share.set(this.start_share);
    this.share = shares(this.start_share);
    const shared = overlap(this.padded, this.box);
    if (shared)
      for_each_row(this.box, shared, (at, _inner, count, x, y, z) => {
        const to = offset(this.padded!, x, y, z);
        this.end_share.set(after.subarray(at, at + count), to);
        this.first.set(first.subarray(at, at + count), to);
        this.last.set(last.subarray(at, at + count), to);
      });
  }

  /** The lattice edges whose surface moves with the time; vertices and normals of all others see only samples that never change. */
  moving_edges(): Region | null {
    if (!this.moving) return null;
    const { low, size } = this.moving;
    return { low: low.map((v) => v - 2) as Vec3, high: low.map((v, a) => v + size[a] + 2) as Vec3 };
  }

  whole_edges(): Region {
    return { low: [0, 0, 0], high: this.size };
  }

  /** Moves `values` to `t_s`; true when they may have changed. */
  set_time(t_s: number): boolean {
    if (!this.moving || !this.padded) return false;
    const at =
      this.duration_s > 0 ? Math.min(Math.max(t_s / this.duration_s, 0), 1) * 65535 : 65535;
    if (at === this.share_at && this.version > 0) return false;
    this.share_at = at;
    const { first, last, start_share, end_share, share } = this;
    const [nx, ny, nz] = this.padded.size;
    const low: Vec3 = [nx, ny, nz];
    const high: Vec3 = [-1, -1, -1];
    for (let z = 0, i = 0; z < nz; ++z)
      for (let y = 0; y < ny; ++y) {
        let from_x = nx;
        let to_x = -1;
        for (let x = 0; x < nx; ++x, ++i) {
          const from = first[i];
          if (from === k_never) continue;
          let v = start_share[i];
          if (at > from || (at === from && from === last[i])) {
            const to = last[i];
            v = at >= to ? end_share[i] : v + ((end_share[i] - v) * (at - from)) / (to - from);
          }
          v = Math.fround(v * (1 / 255));
          if (v === share[i]) continue;
          share[i] = v;
          if (x < from_x) from_x = x;
          to_x = x;
        }
        if (to_x < 0) continue;
        low[0] = Math.min(low[0], from_x);
        high[0] = Math.max(high[0], to_x);
        low[1] = Math.min(low[1], y);
        high[1] = Math.max(high[1], y);
        low[2] = Math.min(low[2], z);
        high[2] = Math.max(high[2], z);
      }
    if (high[0] < 0 && this.version > 0) return false;
    if (high[0] >= 0)
      this.blur_again({
        low,
        size: [high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1],
      });
    ++this.version;
    return true;
  }

  /** Blurs again what changed cells reach; `changed` counts its cells from the padded block's first. */
  private blur_again(changed: Block): void {
    const padded = this.padded!;
    const local: Block = { low: [0, 0, 0], size: padded.size };
    const read = grown(changed, 2 * k_blur_cells, padded.size);
    const written = grown(changed, k_blur_cells, padded.size);
    const [share, scratch] = this.work;
    for_each_row(local, read, (from, to, n) => share.set(this.share.subarray(from, from + n), to));
    blur(share.subarray(0, read.size[0] * read.size[1] * read.size[2]), scratch, read.size);
    for_each_row(read, written, (from, _inner, n, x, y, z) => {
      const [lx, ly, lz] = padded.low;
      this.values.set(
        share.subarray(from, from + n),
        ((lz + z) * this.size[1] + ly + y) * this.size[0] + lx + x,
      );
    });
  }

  /** When the tissue that lay at a place (in cells) went for good, up to now: the latest of the removed cells around it, s; null when none was. */
  removed_at_s(p: Vec3): number | null {
    if (!this.padded) return null;
    const { low, size } = this.padded;
    let latest = -1;
    const base = p.map((v) => Math.floor(v));
    for (let c = 0; c < 8; ++c) {
      const [x, y, z] = [base[0] + (c & 1), base[1] + ((c >> 1) & 1), base[2] + (c >> 2)];
      if (
        x < low[0] ||
        y < low[1] ||
        z < low[2] ||
        x >= low[0] + size[0] ||
        y >= low[1] + size[1] ||
        z >= low[2] + size[2]
      )
        continue;
      const i = offset(this.padded, x, y, z);
      if (this.first[i] === k_never) continue;
      const at = Math.min(this.last[i], this.share_at);
      if (this.first[i] <= this.share_at && at > latest) latest = at;
    }
    return latest < 0 ? null : (latest / 65535) * this.duration_s;
  }
}

/** Index in a block's arrays of the lattice's cell x, y, z. */
export function offset(block: Block, x: number, y: number, z: number): number {
  return (
    ((z - block.low[2]) * block.size[1] + (y - block.low[1])) * block.size[0] + (x - block.low[0])
  );
}

function shares(bytes: Uint8Array): Float32Array {
  const values = new Float32Array(bytes.length);
  for (let i = 0; i < bytes.length; ++i) values[i] = bytes[i] * (1 / 255);
  return values;
}

function grown(block: Block, by: number, size: Vec3): Block {
  const low = block.low.map((v) => Math.max(v - by, 0)) as Vec3;
  return {
    low,
    size: [0, 1, 2].map(
      (a) => Math.min(block.low[a] + block.size[a] + by, size[a]) - low[a],
    ) as Vec3,
  };
}

function overlap(a: Block, b: Block): Block | null {
  const low = [0, 1, 2].map((i) => Math.max(a.low[i], b.low[i])) as Vec3;
  const size = [0, 1, 2].map(
    (i) => Math.min(a.low[i] + a.size[i], b.low[i] + b.size[i]) - low[i],
  ) as Vec3;
  return size.every((v) => v > 0) ? { low, size } : null;
}

/** Each row in x of `inner`: its index in the arrays of `outer` and of `inner`, its length, and the lattice's cell it begins with. */
function for_each_row(
  outer: Block,
  inner: Block,
  row: (at: number, inner_at: number, n: number, x: number, y: number, z: number) => void,
): void {
  const [x, y0, z0] = inner.low;
  const [nx, ny, nz] = inner.size;
  for (let z = z0; z < z0 + nz; ++z)
    for (let y = y0; y < y0 + ny; ++y)
      row(offset(outer, x, y, z), offset(inner, x, y, z), nx, x, y, z);
}

/** The smallest block within `box` that holds every cell for which `wanted` (index in the box, index in the lattice) is true. */
export function bounds(
  box: Block,
  wanted: (i: number, at: number) => boolean,
  size: Vec3,
): Block | null {
  const low: Vec3 = [Infinity, Infinity, Infinity];
  const high: Vec3 = [-1, -1, -1];
  let i = 0;
  for (let z = box.low[2]; z < box.low[2] + box.size[2]; ++z)
    for (let y = box.low[1]; y < box.low[1] + box.size[1]; ++y)
      for (let x = box.low[0]; x < box.low[0] + box.size[0]; ++x, ++i)
        if (wanted(i, (z * size[1] + y) * size[0] + x)) {
          if (x < low[0]) low[0] = x;
          if (y < low[1]) low[1] = y;
          if (z < low[2]) low[2] = z;
          if (x > high[0]) high[0] = x;
          if (y > high[1]) high[1] = y;
          if (z > high[2]) high[2] = z;
        }
  return high[0] < 0
    ? null
    : { low, size: [high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1] };
}

/** Binomial blur 1 4 6 4 1 along each axis, in place; beyond the border the outermost value goes on. */
export function blur(values: Float32Array, scratch: Float32Array, size: Vec3): void {
  const [nx, ny, nz] = size;
  blur_axis(values, scratch, nx, 1, ny * nz, nx, 1, 0);
  blur_axis(scratch, values, ny, nx, nz, nx * ny, nx, 1);
  blur_axis(values, scratch, nz, nx * ny, 1, 0, nx * ny, 1);
  values.set(scratch.subarray(0, values.length));
}

/** Blurs lines of `n` samples `stride` apart; `outer` groups of `inner` neighbouring lines. */
function blur_axis(
  from: Float32Array,
  to: Float32Array,
  n: number,
  stride: number,
  outer: number,
  outer_stride: number,
  inner: number,
  inner_stride: number,
): void {
  for (let o = 0; o < outer; ++o)
    for (let k = 0; k < n; ++k) {
      const row = o * outer_stride;
      const m2 = row + Math.max(k - 2, 0) * stride;
      const m1 = row + Math.max(k - 1, 0) * stride;
      const at = row + k * stride;
      const p1 = row + Math.min(k + 1, n - 1) * stride;
      const p2 = row + Math.min(k + 2, n - 1) * stride;
      if (inner_stride === 0)
        to[at] = (from[m2] + from[p2] + 4 * (from[m1] + from[p1]) + 6 * from[at]) * 0.0625;
      else
        for (let i = 0; i < inner; ++i)
          to[at + i] =
            (from[m2 + i] + from[p2 + i] + 4 * (from[m1 + i] + from[p1 + i]) + 6 * from[at + i]) *
            0.0625;
    }
}
