// The mesher on shapes of known volume, on random fields, and in parts.
import assert from "node:assert/strict";
import { test } from "node:test";
import { type Field, type Region, SurfaceNets } from "../src/surface_nets.ts";
import {
  new_seed,
  open_edges,
  random_of,
  triangle_names,
  unbalanced_edges,
  volume,
} from "./mesh_checks.ts";

function field(n: number, value: (x: number, y: number, z: number) => number): Field {
  const values = new Float32Array(n ** 3);
  for (let z = 0; z < n; ++z)
    for (let y = 0; y < n; ++y)
      for (let x = 0; x < n; ++x) values[(z * n + y) * n + x] = value(x, y, z);
  return { size: [n, n, n], values };
}
const whole = (n: number): Region => ({ low: [0, 0, 0], high: [n, n, n] });

test("a sphere is closed, has its volume, and normals that point out of it", (t) => {
  const seed = new_seed();
  t.diagnostic(`CAVUM_TEST_SEED=${seed}`);
  const random = random_of(seed);
  for (let trial = 0; trial < 5; ++trial) {
    const n = 40;
    const r = 6 + 9 * random();
    const c = [0, 1, 2].map(() => 19 + random());
    const mesh = new SurfaceNets([n, n, n]).mesh(
      field(n, (x, y, z) => r - Math.hypot(x - c[0], y - c[1], z - c[2])),
      0,
      whole(n),
    );
    assert.equal(open_edges(mesh), 0);
    // a vertex is a mean of points on the sphere, so it lies inside, by at most the sagitta of a cube's diagonal
    const exact = (4 / 3) * Math.PI * r ** 3;
    assert.ok(
      volume(mesh) < exact && volume(mesh) > exact * (1 - 1.5 / r ** 2),
      `radius ${r}: ${volume(mesh)} for ${exact}`,
    );
    for (let i = 0; i < mesh.cubes.length; ++i) {
      const out = [0, 1, 2].map((a) => mesh.positions[3 * i + a] - c[a]);
      const along =
        out.reduce((sum, v, a) => sum + v * mesh.normals[3 * i + a], 0) / Math.hypot(...out);
      assert.ok(along > 0.98, `normal ${along}`);
    }
  }
});

test("any field that is empty at its border gives a closed surface, whole or in parts, and the parts are the whole", (t) => {
  const seed = new_seed();
  t.diagnostic(`CAVUM_TEST_SEED=${seed}`);
  const random = random_of(seed);
  const n = 24;
  for (let trial = 0; trial < 6; ++trial) {
    const rough = field(n, (x, y, z) =>
      Math.min(x, y, z) < 2 || Math.max(x, y, z) > n - 3 ? 0 : random(),
    );
    const nets = new SurfaceNets([n, n, n]);
    const copy = (mesh: ReturnType<SurfaceNets["mesh"]>) => ({
      positions: mesh.positions.slice(),
      triangles: mesh.triangles.slice(),
    });
    const all = copy(nets.mesh(rough, 0.5, whole(n)));
    assert.ok(all.triangles.length > 3000);
    assert.equal(unbalanced_edges(all), 0);
    const low = [0, 1, 2].map(() => 2 + Math.floor(6 * random())) as [number, number, number];
    const part: Region = {
      low,
      high: low.map((v) => v + 3 + Math.floor(10 * random())) as [number, number, number],
    };
    const outer = copy(nets.mesh(rough, 0.5, whole(n), part));
    const inner = copy(nets.mesh(rough, 0.5, part));
    assert.ok(inner.triangles.length > 0 && outer.triangles.length > 0);
    assert.ok(unbalanced_edges(outer) > 0, "a part alone is open");
    assert.deepEqual(triangle_names(outer, inner), triangle_names(all));
  }
});

test("refused edges leave their quads out and nothing else", () => {
  const n = 20;
  const half = field(n, (x, y, z) => (x < 9.4 ? 6 - Math.hypot(x - 9.4, y - 10, z - 10) : -8));
  const nets = new SurfaceNets([n, n, n]);
  const bowl = nets.mesh(half, 0, whole(n), undefined, (a, b) => Math.abs(a - b) < 2);
  // the flat lid, where the field jumps, is missing: no triangle faces +x squarely beyond the jump
  for (let i = 0; i < bowl.triangles.length; ++i)
    assert.ok(bowl.positions[3 * bowl.triangles[i]] < 9.4);
  assert.ok(unbalanced_edges(bowl) > 20);
});
