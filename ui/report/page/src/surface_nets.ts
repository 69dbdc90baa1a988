// Naive surface nets: the closed surface where a sampled field passes its level, one vertex for each cube of eight samples that it crosses, one
// quad (two triangles) around each crossed edge of the lattice. Edges are chosen by a region, so that two parts meshed apart share the very same
// vertices on their border: a vertex is a function of the eight samples around it alone, its normal of those and their neighbours.

/** Samples on a lattice, x fastest, then y, then z. */
export interface Field {
  size: readonly [number, number, number];
  values: Float32Array;
}

/** Lattice edges that begin at samples low <= i < high in each axis. */
export interface Region {
  low: readonly [number, number, number];
  high: readonly [number, number, number];
}

export interface Mesh {
  /** In samples of the field: x, y, z of each vertex. */
  positions: Float32Array;
  /** Unit vectors out of the part above the level. */
  normals: Float32Array;
  /** Index of the first of the eight samples around each vertex. */
  cubes: Uint32Array;
  triangles: Uint32Array;
}

class Growing {
  data: Float32Array;
  count = 0;
  constructor(capacity: number) {
    this.data = new Float32Array(capacity);
  }
  reserve(more: number): void {
    if (this.count + more <= this.data.length) return;
    const bigger = new Float32Array(Math.max(this.count + more, this.data.length * 2));
    bigger.set(this.data);
    this.data = bigger;
  }
}

class GrowingIndex {
  data: Uint32Array;
  count = 0;
  constructor(capacity: number) {
    this.data = new Uint32Array(capacity);
  }
  reserve(more: number): void {
    if (this.count + more <= this.data.length) return;
    const bigger = new Uint32Array(Math.max(this.count + more, this.data.length * 2));
    bigger.set(this.data);
    this.data = bigger;
  }
}

const k_corner_pairs = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];

/** Meshes edges one region at a time; keeps its tables, so that meshing again and again allocates only the result. */
export class SurfaceNets {
  private readonly vertex_of: Int32Array; // for each cube its vertex + 1, valid where stamp is the present one
  private readonly touched: GrowingIndex = new GrowingIndex(1024);
  private readonly positions = new Growing(3072);
  private readonly normals = new Growing(3072);
  private readonly cubes = new GrowingIndex(1024);
  private readonly triangles = new GrowingIndex(6144);
  private readonly corner = new Float32Array(8);

  constructor(private readonly size: readonly [number, number, number]) {
    this.vertex_of = new Int32Array(size[0] * size[1] * size[2]);
  }

  /**
   * The surface at `level` of the edges in `inside`, without those in `outside`. `accept` (two sample values) may refuse an edge.
   * Edges on the lattice's outermost samples have no cube beyond them and are left out: keep the field empty there.
   */
  mesh(
    field: Field,
    level: number,
    inside: Region,
    outside?: Region,
    accept?: (a: number, b: number) => boolean,
  ): Mesh {
    const [nx, ny, nz] = this.size;
    const values = field.values;
    const step = [1, nx, nx * ny];
    for (let i = 0; i < this.touched.count; ++i) this.vertex_of[this.touched.data[i]] = 0;
    this.touched.count =
      this.positions.count =
      this.normals.count =
      this.cubes.count =
      this.triangles.count =
        0;

    const low = [
      Math.max(inside.low[0], 0),
      Math.max(inside.low[1], 0),
      Math.max(inside.low[2], 0),
    ];
    const high = [
      Math.min(inside.high[0], nx),
      Math.min(inside.high[1], ny),
      Math.min(inside.high[2], nz),
    ];
    for (let z = low[2]; z < high[2]; ++z) {
      for (let y = low[1]; y < high[1]; ++y) {
        const within_zy =
          outside !== undefined &&
          z >= outside.low[2] &&
          z < outside.high[2] &&
          y >= outside.low[1] &&
          y < outside.high[1];
        let at = (z * ny + y) * nx + low[0];
        for (let x = low[0]; x < high[0]; ++x, ++at) {
          if (within_zy && x >= outside.low[0] && x < outside.high[0]) {
            at += outside.high[0] - x - 1;
            x = outside.high[0] - 1;
            continue;
          }
          const a = values[at];
          const solid = a > level;
          // x edge, between cubes that differ in y and z
          if (
            x + 1 < nx &&
            y > 0 &&
            z > 0 &&
            y + 1 < ny &&
            z + 1 < nz &&
            values[at + 1] > level !== solid &&
            (!accept || accept(a, values[at + 1]))
          )
            this.quad(field, level, at, at - nx, at - step[2] - nx, at - step[2], solid);
          if (
            y + 1 < ny &&
            x > 0 &&
            z > 0 &&
            x + 1 < nx &&
            z + 1 < nz &&
            values[at + nx] > level !== solid &&
            (!accept || accept(a, values[at + nx]))
          )
            this.quad(field, level, at, at - step[2], at - step[2] - 1, at - 1, solid);
          if (
            z + 1 < nz &&
            x > 0 &&
            y > 0 &&
            x + 1 < nx &&
            y + 1 < ny &&
            values[at + step[2]] > level !== solid &&
            (!accept || accept(a, values[at + step[2]]))
          )
            this.quad(field, level, at, at - 1, at - 1 - nx, at - nx, solid);
        }
      }
    }
    return {
      positions: this.positions.data.subarray(0, this.positions.count),
      normals: this.normals.data.subarray(0, this.normals.count),
      cubes: this.cubes.data.subarray(0, this.cubes.count),
      triangles: this.triangles.data.subarray(0, this.triangles.count),
    };
  }

  private quad(
    field: Field,
    level: number,
    c0: number,
    c1: number,
    c2: number,
    c3: number,
    solid: boolean,
  ): void {
    const a = this.vertex(field, level, c0);
    const b = this.vertex(field, level, c1);
    const c = this.vertex(field, level, c2);
    const d = this.vertex(field, level, c3);
    this.triangles.reserve(6);
    const t = this.triangles.data;
    let n = this.triangles.count;
    // split along the shorter diagonal; the same choice from either side of a seam, as it depends on the vertices alone
    if (this.distance2(a, c) <= this.distance2(b, d)) {
      t[n++] = a;
      t[n++] = solid ? b : c;
      t[n++] = solid ? c : b;
      t[n++] = a;
      t[n++] = solid ? c : d;
      t[n++] = solid ? d : c;
    } else {
      t[n++] = b;
      t[n++] = solid ? c : d;
      t[n++] = solid ? d : c;
      t[n++] = b;
      t[n++] = solid ? d : a;
      t[n++] = solid ? a : d;
    }
    this.triangles.count = n;
  }

  private distance2(a: number, b: number): number {
    const p = this.positions.data;
    const x = p[3 * a] - p[3 * b];
    const y = p[3 * a + 1] - p[3 * b + 1];
    const z = p[3 * a + 2] - p[3 * b + 2];
    return x * x + y * y + z * z;
  }

  /** The vertex of the cube whose first sample is `cube`: the mean of the points where the surface crosses the cube's edges. */
  private vertex(field: Field, level: number, cube: number): number {
    const known = this.vertex_of[cube];
    if (known !== 0) return known - 1;
    const [nx, ny] = this.size;
    const layer = nx * ny;
    const v = field.values;
    const c = this.corner;
    c[0] = v[cube] - level;
    c[1] = v[cube + 1] - level;
    c[2] = v[cube + nx] - level;
    c[3] = v[cube + nx + 1] - level;
    c[4] = v[cube + layer] - level;
    c[5] = v[cube + layer + 1] - level;
    c[6] = v[cube + layer + nx] - level;
    c[7] = v[cube + layer + nx + 1] - level;
    let x = 0;
    let y = 0;
    let z = 0;
    let crossed = 0;
    for (let e = 0; e < 24; e += 2) {
      const i = k_corner_pairs[e];
      const j = k_corner_pairs[e + 1];
      if (c[i] > 0 === c[j] > 0) continue;
      const s = c[i] / (c[i] - c[j]);
      x += (i & 1) + (e < 8 ? s : 0);
      y += ((i >> 1) & 1) + (e >= 8 && e < 16 ? s : 0);
      z += (i >> 2) + (e >= 16 ? s : 0);
      ++crossed;
    }
    x /= crossed;
    y /= crossed;
    z /= crossed;
    // central differences at the eight corners, blended at the vertex: smooth across cells
    const cx = cube % nx;
    const cy = Math.floor(cube / nx) % ny;
    const cz = Math.floor(cube / layer);
    let gx = 0;
    let gy = 0;
    let gz = 0;
    if (cx > 0 && cy > 0 && cz > 0 && cx + 2 < nx && cy + 2 < ny && cz + 2 < this.size[2]) {
      for (let i = 0; i < 8; ++i) {
        const at = cube + (i & 1) + ((i >> 1) & 1) * nx + (i >> 2) * layer;
        const w = (i & 1 ? x : 1 - x) * (i & 2 ? y : 1 - y) * (i & 4 ? z : 1 - z);
        gx += w * (v[at + 1] - v[at - 1]);
        gy += w * (v[at + nx] - v[at - nx]);
        gz += w * (v[at + layer] - v[at - layer]);
      }
    } else {
      gx = lerp2(c[1] - c[0], c[3] - c[2], c[5] - c[4], c[7] - c[6], y, z);
      gy = lerp2(c[2] - c[0], c[3] - c[1], c[6] - c[4], c[7] - c[5], x, z);
      gz = lerp2(c[4] - c[0], c[5] - c[1], c[6] - c[2], c[7] - c[3], x, y);
    }
    const length = Math.sqrt(gx * gx + gy * gy + gz * gz) || 1;
    this.positions.reserve(3);
    this.normals.reserve(3);
    this.cubes.reserve(1);
    this.touched.reserve(1);
    const p = this.positions.count;
    this.positions.data[p] = cx + x;
    this.positions.data[p + 1] = cy + y;
    this.positions.data[p + 2] = cz + z;
    this.normals.data[p] = -gx / length;
    this.normals.data[p + 1] = -gy / length;
    this.normals.data[p + 2] = -gz / length;
    this.positions.count = this.normals.count = p + 3;
    this.cubes.data[this.cubes.count++] = cube;
    this.touched.data[this.touched.count++] = cube;
    this.vertex_of[cube] = p / 3 + 1;
    return p / 3;
  }
}

function lerp2(a: number, b: number, c: number, d: number, s: number, t: number): number {
  return (a + (b - a) * s) * (1 - t) + (c + (d - c) * s) * t;
}
