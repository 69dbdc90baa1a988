// The tooth's surface with what is shown on it: two meshes that share their border vertex for vertex, one of what never changes and one of what
// the exam changed; for each vertex the tissue's colour, the signed distance to the target, and how much was removed there.
import type { ReportData, Vec3 } from "./data.ts";
import { type Mesh, SurfaceNets } from "./surface_nets.ts";
import { k_level, offset, type ToothField } from "./tooth_field.ts";

/** Beyond the box lies nothing within 1 mm of the target; this stands for all of it, beyond what a packed distance can say. */
export const k_no_distance_mm = 2.625;
const k_distance_unit_mm = 0.02;
const k_min_heat_percent = 5;

export interface Surface extends Mesh {
  /** Tissue's colour of each vertex, red green blue 0..255. */
  colours: Uint8Array;
  /** Signed distance to the target, mm (+ = outside the target), and the share of the place that was removed (0 = natural surface). */
  marks: Float32Array;
}

export class ToothSurface {
  private readonly nets: SurfaceNets;
  private readonly palette: Uint8Array;
  private readonly fills: Uint8Array; // 1 for pulp, which fills a space without being solid

  constructor(
    private readonly field: ToothField,
    data: ReportData,
  ) {
    this.nets = new SurfaceNets(field.size);
    this.palette = new Uint8Array(256 * 3).fill(200);
    this.fills = new Uint8Array(256);
    data.tissues.forEach((tissue, id) => {
      const rgb = parseInt(tissue.colour.slice(1), 16);
      this.palette.set([rgb >> 16, (rgb >> 8) & 255, rgb & 255], 3 * id);
      this.fills[id] = tissue.pulp ? 1 : 0;
    });
  }

  /** What no time changes. */
  still(): Surface {
    return kept(
      this.dressed(
        this.nets.mesh(
          this.field,
          k_level,
          this.field.whole_edges(),
          this.field.moving_edges() ?? undefined,
        ),
      ),
    );
  }

  /** What the present time of the field shows in the part that changes; its arrays live until the next call. */
  moving(): Surface | null {
    const edges = this.field.moving_edges();
    return edges ? this.dressed(this.nets.mesh(this.field, k_level, edges)) : null;
  }

  /** Where pulp lies open on the outside, as on the sides of a layered block; empty for a tooth, which encloses it. */
  open_pulp(): Surface {
    const { field, fills } = this;
    const values = field.untouched.slice();
    if (this.fill_pulp(values) === 0)
      return {
        positions: new Float32Array(0),
        normals: new Float32Array(0),
        cubes: new Uint32Array(0),
        triangles: new Uint32Array(0),
        colours: new Uint8Array(0),
        marks: new Float32Array(0),
      };
    const mesh = this.dressed(
      this.nets.mesh({ size: field.size, values }, k_level, field.whole_edges()),
    );
    const [nx, ny] = field.size;
    const step = [0, 1, nx, nx + 1, nx * ny, nx * ny + 1, nx * ny + nx, nx * ny + nx + 1];
    const of_pulp = Array.from(mesh.cubes, (cube) => {
      let [pulp, outside] = [0, 0];
      for (const by of step) {
        if (fills[field.tissue[cube + by]] === 1) ++pulp;
        else if (field.untouched[cube + by] <= k_level) ++outside;
      }
      return pulp > 0 && outside > 0;
    });
    const triangles = mesh.triangles.filter((_, i, all) =>
      [0, 1, 2].every((k) => of_pulp[all[i - (i % 3) + k]]),
    );
    return kept({ ...mesh, triangles });
  }

  /** Makes pulp as full as solid tissue, and counts its cells that have neither tissue nor pulp beside them. */
  private fill_pulp(values: Float32Array): number {
    const { tissue, size } = this.field;
    const [nx, ny] = size;
    let open = 0;
    for (let i = nx * ny; i < tissue.length - nx * ny; ++i) {
      if (this.fills[tissue[i]] !== 1) continue;
      values[i] = 1;
      for (const by of [1, -1, nx, -nx, nx * ny, -nx * ny])
        if (this.fills[tissue[i + by]] !== 1 && this.field.untouched[i + by] < 0.1) ++open;
    }
    return open;
  }

  /** For a class: marks of a surface where each place shows the share of the class (-1..1) that deviated there by more than `deeper_mm`. */
  heat_marks(surface: Surface, deeper_mm: number): Float32Array {
    const { field } = this;
    const marks = new Float32Array(2 * surface.cubes.length);
    for (let i = 0; i < surface.cubes.length; ++i) {
      const at = [0, 1, 2].map(
        (a) => field.origin_mm[a] + surface.positions[3 * i + a] * field.cell_mm,
      ) as Vec3;
      const heat = heat_at(
        field,
        at,
        [surface.normals[3 * i], surface.normals[3 * i + 1], surface.normals[3 * i + 2]],
        deeper_mm,
      );
      if (heat === null) continue;
      marks[2 * i] = heat / 100;
      marks[2 * i + 1] = Math.abs(heat) >= k_min_heat_percent ? 1 : surface.marks[2 * i + 1];
    }
    return marks;
  }

  private dressed(mesh: Mesh): Surface {
    const n = mesh.cubes.length;
    const colours = new Uint8Array(3 * n);
    const marks = new Float32Array(2 * n);
    const { field, palette, fills } = this;
    const [nx, ny] = field.size;
    const layer = nx * ny;
    const step = [0, 1, nx, nx + 1, layer, layer + 1, layer + nx, layer + nx + 1];
    const weight = new Float64Array(8);
    for (let i = 0; i < n; ++i) {
      const cube = mesh.cubes[i];
      const cx = cube % nx;
      const cy = Math.floor(cube / nx) % ny;
      const cz = Math.floor(cube / layer);
      const fx = mesh.positions[3 * i] - cx;
      const fy = mesh.positions[3 * i + 1] - cy;
      const fz = mesh.positions[3 * i + 2] - cz;
      let removed = 0;
      let most = -1;
      let solid_id = 0;
      let filled_id = -1;
      let filled = 0;
      let empty = 0;
      for (let c = 0; c < 8; ++c) {
        const at = cube + step[c];
        const w = (c & 1 ? fx : 1 - fx) * (c & 2 ? fy : 1 - fy) * (c & 4 ? fz : 1 - fz);
        weight[c] = w;
        const v = field.values[at];
        removed += w * (field.untouched[at] - v);
        const id = field.tissue[at];
        if (v > most && fills[id] === 0) {
          most = v;
          solid_id = id;
        }
        if (v <= k_level) {
          ++empty;
          if (fills[id] === 1) {
            filled_id = id;
            ++filled;
          }
        }
      }
      // a wall towards the pulp shows the pulp
      const id = filled > 0 && filled * 2 >= empty ? filled_id : solid_id;
      colours[3 * i] = palette[3 * id];
      colours[3 * i + 1] = palette[3 * id + 1];
      colours[3 * i + 2] = palette[3 * id + 2];
      marks[2 * i] = this.distance_mm(cx, cy, cz, cube, step, weight);
      marks[2 * i + 1] = removed;
    }
    return { ...mesh, colours, marks };
  }

  /** Between the eight cells around a vertex; where the target's opening lies between them, of the solid ones alone. */
  private distance_mm(
    cx: number,
    cy: number,
    cz: number,
    cube: number,
    step: number[],
    weight: Float64Array,
  ): number {
    const { box, distance, values, cell_mm } = this.field;
    const [lx, ly, lz] = box.low;
    const [bx, by, bz] = box.size;
    if (
      cx < lx ||
      cy < ly ||
      cz < lz ||
      cx + 1 >= lx + bx ||
      cy + 1 >= ly + by ||
      cz + 1 >= lz + bz
    )
      return k_no_distance_mm;
    const first = offset(box, cx, cy, cz);
    let low = 127;
    let high = -127;
    let mean = 0;
    let solid_mean = 0;
    let solid_weight = 0;
    for (let c = 0; c < 8; ++c) {
      const d = distance[first + (c & 1) + ((c >> 1) & 1) * bx + (c >> 2) * bx * by];
      if (d < low) low = d;
      if (d > high) high = d;
      mean += weight[c] * d;
      const v = values[cube + step[c]];
      if (v > k_level) {
        solid_mean += v * d;
        solid_weight += v;
      }
    }
    const smooth = high - low <= (1.8 * cell_mm) / k_distance_unit_mm + 2;
    return (smooth || solid_weight === 0 ? mean : solid_mean / solid_weight) * k_distance_unit_mm;
  }
}

/**
 * Share of the class, per cent, that deviated from the target at a place of its surface by more than `deeper_mm`: + overcut (tissue below the surface
 * was removed), − left standing (tissue above it was not), whichever is more. Null outside the box.
 */
export function heat_at(
  field: ToothField,
  place_mm: Vec3,
  normal: Vec3,
  deeper_mm: number,
): number | null {
  if (!field.heat || heat_beside(field, place_mm, normal, 0) === null) return null;
  const over = Math.max(heat_beside(field, place_mm, normal, -deeper_mm) ?? 0, 0);
  const under = Math.min(heat_beside(field, place_mm, normal, deeper_mm) ?? 0, 0);
  return over >= -under ? over : under;
}

function heat_beside(
  field: ToothField,
  place_mm: Vec3,
  normal: Vec3,
  by_mm: number,
): number | null {
  const { low, size } = field.box;
  const i = [0, 1, 2].map(
    (a) =>
      Math.round((place_mm[a] + normal[a] * by_mm - field.origin_mm[a]) / field.cell_mm) - low[a],
  );
  if (i.some((v, a) => v < 0 || v >= size[a])) return null;
  return field.heat![(i[2] * size[1] + i[1]) * size[0] + i[0]];
}

/** A surface with arrays of its own, which the next meshing leaves alone. */
function kept(surface: Surface): Surface {
  return {
    ...surface,
    positions: surface.positions.slice(),
    normals: surface.normals.slice(),
    cubes: surface.cubes.slice(),
    triangles: surface.triangles.slice(),
  };
}

/** The target's walls and floor: where the distance passes zero, without the jumps at its opening. In cells of the box. */
export function target_surface(field: ToothField): Mesh {
  const size = field.box.size;
  const values = new Float32Array(field.distance.length);
  for (let i = 0; i < values.length; ++i) values[i] = -field.distance[i] * k_distance_unit_mm;
  const most = 1.05 * field.cell_mm + 1.5 * k_distance_unit_mm; // neighbours of a true distance differ by a cell at most
  return new SurfaceNets(size).mesh(
    { size, values },
    0,
    { low: [0, 0, 0], high: size },
    undefined,
    (a, b) => Math.abs(a - b) < most,
  );
}
