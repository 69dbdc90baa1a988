// What is true of any closed surface, checked by corners' exact positions and not by their numbers, so that meshes made apart are checked together.

export interface Triangles {
  positions: ArrayLike<number>;
  triangles: ArrayLike<number>;
}

function corner(mesh: Triangles, i: number): string {
  const v = 3 * mesh.triangles[i];
  return `${mesh.positions[v]} ${mesh.positions[v + 1]} ${mesh.positions[v + 2]}`;
}

/** Of each edge, how often it is passed one way and the other, over all meshes together. */
function passages(meshes: Triangles[]): [number, number][] {
  const numbers = new Map<string, number>();
  const edges = new Map<number, [number, number]>();
  for (const mesh of meshes) {
    const p = mesh.positions;
    const number: number[] = [];
    for (let v = 0; 3 * v < p.length; ++v) {
      const name = `${p[3 * v]} ${p[3 * v + 1]} ${p[3 * v + 2]}`;
      let known = numbers.get(name);
      if (known === undefined) numbers.set(name, (known = numbers.size));
      number.push(known);
    }
    for (let t = 0; t < mesh.triangles.length; t += 3)
      for (let e = 0; e < 3; ++e) {
        const a = number[mesh.triangles[t + e]];
        const b = number[mesh.triangles[t + ((e + 1) % 3)]];
        const key = Math.min(a, b) * 2 ** 26 + Math.max(a, b);
        let counts = edges.get(key);
        if (!counts) edges.set(key, (counts = [0, 0]));
        ++counts[a < b ? 0 : 1];
      }
  }
  return [...edges.values()];
}

/** Edges that are not passed exactly once each way: 0 for a closed surface of which every edge lies in exactly two triangles. */
export function open_edges(...meshes: Triangles[]): number {
  return passages(meshes).filter(([there, back]) => there !== 1 || back !== 1).length;
}

/** Edges passed unequally often in their two directions: 0 for every closed surface, also where four triangles meet at an edge. */
export function unbalanced_edges(...meshes: Triangles[]): number {
  return passages(meshes).filter(([there, back]) => there !== back).length;
}

/** Enclosed volume in cubes of the lattice, by the divergence theorem; positive when triangles wind counter-clockwise seen from outside. */
export function volume(...meshes: Triangles[]): number {
  let six = 0;
  for (const { positions: p, triangles: t } of meshes)
    for (let i = 0; i < t.length; i += 3) {
      const [a, b, c] = [3 * t[i], 3 * t[i + 1], 3 * t[i + 2]];
      six +=
        p[a] * (p[b + 1] * p[c + 2] - p[b + 2] * p[c + 1]) +
        p[a + 1] * (p[b + 2] * p[c] - p[b] * p[c + 2]) +
        p[a + 2] * (p[b] * p[c + 1] - p[b + 1] * p[c]);
    }
  return six / 6;
}

/** Triangles as a sorted list of their corners' positions, each from its least corner on. */
export function triangle_names(...meshes: Triangles[]): string[] {
  return meshes
    .flatMap((mesh) =>
      Array.from({ length: mesh.triangles.length / 3 }, (_, i) => {
        const corners = [corner(mesh, 3 * i), corner(mesh, 3 * i + 1), corner(mesh, 3 * i + 2)];
        const least = corners.indexOf([...corners].sort()[0]);
        return [0, 1, 2].map((k) => corners[(least + k) % 3]).join("|");
      }),
    )
    .sort();
}

/** Random numbers in [0, 1) that a printed seed brings back. */
export function random_of(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let v = Math.imul(state ^ (state >>> 15), state | 1);
    v ^= v + Math.imul(v ^ (v >>> 7), v | 61);
    return ((v ^ (v >>> 14)) >>> 0) / 4294967296;
  };
}

/** A new seed each run, or the one of CAVUM_TEST_SEED. */
export function new_seed(): number {
  return process.env.CAVUM_TEST_SEED
    ? Number(process.env.CAVUM_TEST_SEED)
    : Math.floor(Math.random() * 4294967296);
}
