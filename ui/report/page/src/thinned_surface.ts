// A surface with fewer triangles, for pictures that change while the processor draws them. It has the vertices of the whole one.
import type { Region } from "./surface_nets.ts";
import type { Surface } from "./tooth_surface.ts";

const k_cells = 2; // along each edge of a block whose vertices go together

/**
 * Triangles of `surface`, a field of `size` samples, with all vertices of a block of cells in one place when they face the same way. Vertices in and
 * around `whole` stay, so that what is meshed apart there still fits.
 */
export function thinned(
  surface: Surface,
  size: readonly [number, number, number],
  whole: Region | null,
): Uint32Array {
  const [nx, ny] = size;
  const across = [Math.ceil(nx / k_cells), Math.ceil(ny / k_cells)];
  const first_of = new Map<number, number>();
  const to = new Uint32Array(surface.cubes.length);
  for (let i = 0; i < to.length; ++i) {
    const cube = surface.cubes[i];
    const at = [cube % nx, Math.floor(cube / nx) % ny, Math.floor(cube / (nx * ny))];
    if (whole && at.every((v, a) => v >= whole.low[a] - 2 && v <= whole.high[a] + 1)) {
      to[i] = i;
      continue;
    }
    const [x, y, z] = at.map((v) => Math.floor(v / k_cells));
    let facing = 0;
    for (let a = 0; a < 3; ++a) if (surface.normals[3 * i + a] > 0) facing |= 1 << a;
    const block = ((z * across[1] + y) * across[0] + x) * 8 + facing;
    const first = first_of.get(block);
    if (first === undefined) first_of.set(block, i);
    to[i] = first ?? i;
  }
  const triangles = new Uint32Array(surface.triangles.length);
  let n = 0;
  for (let t = 0; t < surface.triangles.length; t += 3) {
    const [a, b, c] = [
      to[surface.triangles[t]],
      to[surface.triangles[t + 1]],
      to[surface.triangles[t + 2]],
    ];
    if (a === b || b === c || c === a) continue;
    triangles[n++] = a;
    triangles[n++] = b;
    triangles[n++] = c;
  }
  return triangles.slice(0, n);
}
