// Reading the tooth at a place: where a line of sight meets the surface as it is now, and what is known of that place.
import type { Vec3 } from "./data.ts";
import { k_level, type ToothField } from "./tooth_field.ts";

export interface Clip {
  /** Gone where normal · p > offset_mm. */
  normal: Vec3;
  offset_mm: number;
}

export interface Reading {
  place_mm: Vec3;
  /** On the flat of the cut-away section instead of the tooth's own surface. */
  section: boolean;
  /** Signed distance to the target, null outside the box. */
  distance_mm: number | null;
  cut: boolean;
  tissue: number;
  /** When the place came to light, s; null on natural surface. */
  cut_at_s: number | null;
}

/** In cells, the first cell's centre at 0. */
function to_cells(field: ToothField, p: Vec3): Vec3 {
  return [0, 1, 2].map((a) => (p[a] - field.origin_mm[a]) / field.cell_mm) as Vec3;
}

function blend(values: ArrayLike<number>, size: Vec3, p: Vec3): number {
  const i = p.map((v, a) => Math.min(Math.max(Math.floor(v), 0), size[a] - 2)) as Vec3;
  const f = p.map((v, a) => Math.min(Math.max(v - i[a], 0), 1)) as Vec3;
  const at = (i[2] * size[1] + i[1]) * size[0] + i[0];
  const layer = size[0] * size[1];
  let sum = 0;
  for (let c = 0; c < 8; ++c) {
    const w = (c & 1 ? f[0] : 1 - f[0]) * (c & 2 ? f[1] : 1 - f[1]) * (c & 4 ? f[2] : 1 - f[2]);
    sum += w * values[at + (c & 1) + ((c >> 1) & 1) * size[0] + (c >> 2) * layer];
  }
  return sum;
}

/** Share of solid tissue now at a place, 0 outside the lattice. */
export function share_at(field: ToothField, p_mm: Vec3): number {
  const p = to_cells(field, p_mm);
  if (p.some((v, a) => v < 0 || v > field.size[a] - 1)) return 0;
  return blend(field.values, field.size, p);
}

/** Signed distance to the target, mm; null outside the box. */
function distance_at(field: ToothField, p_mm: Vec3): number | null {
  const p = to_cells(field, p_mm).map((v, a) => v - field.box.low[a]) as Vec3;
  if (p.some((v, a) => v < 0 || v > field.box.size[a] - 1)) return null;
  return blend(field.distance, field.box.size, p) * 0.02;
}

/** What a line from `from_mm` along the unit vector `along` meets first; null when it misses the tooth. */
export function probe(
  field: ToothField,
  from_mm: Vec3,
  along: Vec3,
  clip: Clip | null,
): Reading | null {
  // where the line runs through the lattice and what the cut leaves of it
  let near = 0;
  let far = Infinity;
  for (let a = 0; a < 3; ++a) {
    const low = field.origin_mm[a];
    const high = low + (field.size[a] - 1) * field.cell_mm;
    if (Math.abs(along[a]) < 1e-9) {
      if (from_mm[a] < low || from_mm[a] > high) return null;
      continue;
    }
    const s = (low - from_mm[a]) / along[a];
    const e = (high - from_mm[a]) / along[a];
    near = Math.max(near, Math.min(s, e));
    far = Math.min(far, Math.max(s, e));
  }
  let section = false;
  if (clip) {
    const rate = dot(clip.normal, along);
    const over = dot(clip.normal, from_mm) - clip.offset_mm;
    if (over + rate * near > 0) {
      if (rate >= 0) return null;
      near = -over / rate;
      section = true;
    } else if (rate > 0) far = Math.min(far, -over / rate);
  }
  if (near >= far) return null;
  const point = (s: number): Vec3 => [0, 1, 2].map((a) => from_mm[a] + along[a] * s) as Vec3;
  if (section && share_at(field, point(near + 1e-6)) > k_level)
    return reading(field, point(near), along, true);
  const step = field.cell_mm * 0.5;
  for (let s = near; s <= far; s += step) {
    if (share_at(field, point(s)) <= k_level) continue;
    let low = Math.max(s - step, near);
    let high = s;
    for (let i = 0; i < 12; ++i) {
      const middle = (low + high) / 2;
      if (share_at(field, point(middle)) > k_level) high = middle;
      else low = middle;
    }
    return reading(field, point(high), along, false);
  }
  return null;
}

function reading(field: ToothField, at: Vec3, along: Vec3, section: boolean): Reading {
  const cells = to_cells(field, at);
  const removed = section ? 0 : blend(field.untouched, field.size, cells) - share_at(field, at);
  const cut = removed > 0.08;
  // the tissue just below the surface
  const below = to_cells(field, at.map((v, a) => v + along[a] * field.cell_mm * 0.7) as Vec3).map(
    (v, a) => Math.min(Math.max(Math.round(v), 0), field.size[a] - 1),
  ) as Vec3;
  const tissue = field.tissue[(below[2] * field.size[1] + below[1]) * field.size[0] + below[0]];
  return {
    place_mm: at,
    section,
    distance_mm: distance_at(field, at),
    cut,
    tissue,
    cut_at_s: cut ? field.removed_at_s(cells) : null,
  };
}

/** Unit vector out of the tissue at a place. */
export function outward_at(field: ToothField, p_mm: Vec3): Vec3 {
  const slope = [0, 1, 2].map((a) => {
    const [low, high] = [-1, 1].map((s) =>
      share_at(field, p_mm.map((v, b) => (a === b ? v + s * field.cell_mm : v)) as Vec3),
    );
    return low - high;
  });
  const length = Math.hypot(...slope) || 1;
  return slope.map((v) => v / length) as Vec3;
}

/** True when nothing stands between a place and the eye in direction `towards`. */
export function in_sight(field: ToothField, place_mm: Vec3, towards: Vec3): boolean {
  const step = field.cell_mm * 0.5;
  const reach = field.cell_mm * Math.max(...field.size);
  for (let s = 4 * field.cell_mm; s < reach; s += step)
    if (share_at(field, [0, 1, 2].map((a) => place_mm[a] + towards[a] * s) as Vec3) > k_level)
      return false;
  return true;
}

function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
