// The tooth of formulae as the page builds it from packed data: closed at every time, of the right volume, with the right distances, and read
// rightly along a line of sight.
import assert from "node:assert/strict";
import { test } from "node:test";
import { probe } from "../src/probe.ts";
import { thinned } from "../src/thinned_surface.ts";
import { ToothField } from "../src/tooth_field.ts";
import { heat_at, k_no_distance_mm, target_surface, ToothSurface } from "../src/tooth_surface.ts";
import type { ReportData } from "../src/data.ts";
import {
  distance_mm,
  drilled_mm3,
  fixture,
  front_mm,
  k_cut,
  k_duration_s,
  k_target,
  pack,
  whole_mm3,
} from "./fixture.ts";
import { new_seed, random_of, unbalanced_edges, volume } from "./mesh_checks.ts";

const data = fixture();
const field = new ToothField(data);
const surface = new ToothSurface(field, data);
const still = surface.still();
const cell = field.cell_mm;
const mm = (positions: ArrayLike<number>, i: number): [number, number, number] =>
  [0, 1, 2].map((a) => field.origin_mm[a] + positions[3 * i + a] * cell) as [
    number,
    number,
    number,
  ];

test("still and moving part together are one closed surface of the tooth's volume, at any time", (t) => {
  const seed = new_seed();
  t.diagnostic(`CAVUM_TEST_SEED=${seed}`);
  const random = random_of(seed);
  for (const t_s of [0, k_duration_s, 20 * random(), 3 + 15 * random(), 3 + 15 * random()]) {
    field.set_time(t_s);
    const moving = surface.moving()!;
    // balanced, not two triangles each: where a surface touches itself in a cube's diagonal, surface nets let four triangles meet at an edge
    assert.equal(unbalanced_edges(still, moving), 0, `at ${t_s} s`);
    assert.ok(
      unbalanced_edges(still) > 0 && unbalanced_edges(moving) > 0,
      "there is a seam at all",
    );
    const measured = volume(still, moving) * cell ** 3;
    const exact = whole_mm3() - drilled_mm3(t_s);
    t.diagnostic(`at ${t_s.toFixed(2)} s: ${measured.toFixed(2)} mm³ for ${exact.toFixed(2)} mm³`);
    // leaves half a cell wide and a blur of one cell: a third of a per cent
    assert.ok(Math.abs(measured - exact) < 0.0033 * exact, `at ${t_s} s: ${measured} for ${exact}`);
  }
});

test("what was drilled away by a time is what the surface lost", () => {
  const at = (t_s: number): number => {
    field.set_time(t_s);
    return volume(still, surface.moving()!) * cell ** 3;
  };
  const start = at(0);
  for (const t_s of [6, 10, 14, 18, 20]) {
    const lost = start - at(t_s);
    const exact = drilled_mm3(t_s);
    assert.ok(Math.abs(lost - exact) < 0.15 + 0.02 * exact, `at ${t_s} s: ${lost} for ${exact}`);
  }
});

test("going back in time gives back the same surface", () => {
  field.set_time(7.3);
  const there = surface.moving()!.positions.slice();
  field.set_time(16);
  assert.notDeepEqual(surface.moving()!.positions, there);
  field.set_time(7.3);
  assert.deepEqual(surface.moving()!.positions.slice(), there);
});

test("the cut surface carries its distance to the target, also beside the opening", () => {
  field.set_time(k_duration_s);
  const moving = surface.moving()!;
  let checked = 0;
  let off = 0;
  for (let i = 0; i < moving.cubes.length; ++i) {
    if (moving.marks[2 * i + 1] < 0.35) continue; // the cut surface away from its rim, where the tooth's own surface joins
    const [x, y, z] = mm(moving.positions, i);
    const error = Math.abs(moving.marks[2 * i] - distance_mm(x, y, z));
    assert.ok(
      error < 0.08,
      `at ${x}, ${y}, ${z}: ${moving.marks[2 * i]} for ${distance_mm(x, y, z)}`,
    );
    if (error > 0.03) ++off;
    ++checked;
  }
  assert.ok(checked > 2000, `${checked} vertices`);
  assert.ok(off < 0.1 * checked, `${off} of ${checked} are off by more than 0.03 mm`);
});

test("before the exam nothing is cut, and the target's opening is marked as inside", () => {
  field.set_time(0);
  const moving = surface.moving()!;
  let inside = 0;
  for (let i = 0; i < moving.cubes.length; ++i) {
    assert.ok(Math.abs(moving.marks[2 * i + 1]) < 1e-6);
    const [x, y, z] = mm(moving.positions, i);
    const side = Math.hypot(x - k_target.x_mm, y) - k_target.radius_mm;
    if (z > 2.5 && side < -0.2) {
      ++inside;
      assert.ok(moving.marks[2 * i] < 0, `at ${x}, ${y}, ${z}: ${moving.marks[2 * i]}`);
    } else if (z > 2.5 && side > 0.15) assert.ok(moving.marks[2 * i] > 0);
  }
  assert.ok(inside > 300);
  assert.ok(
    [...still.marks].filter((_, i) => i % 2 === 0).some((d) => d === k_no_distance_mm),
    "beyond the box nothing is known",
  );
});

test("a line of sight reads place, distance, tissue and the time of the cut", () => {
  field.set_time(k_duration_s);
  const floor = probe(field, [0, 0, 20], [0, 0, -1], null)!;
  assert.ok(Math.abs(floor.place_mm[2] - k_cut.floor_mm) < 0.03);
  assert.ok(floor.cut && Math.abs(floor.distance_mm! - -0.25) < 0.03, String(floor.distance_mm));
  assert.equal(data.tissues[floor.tissue].name, "dentin");
  assert.ok(Math.abs(floor.cut_at_s! - 18) < 0.4);
  // a wall in the middle of its height, seen from inside
  const wall = probe(field, [0, 0, 2.05], [-1, 0, 0], null)!;
  assert.ok(Math.abs(wall.place_mm[0] + 1.5) < 0.03);
  assert.ok(Math.abs(wall.distance_mm! - 0.3) < 0.03, String(wall.distance_mm));
  assert.ok(Math.abs(front_mm(wall.cut_at_s!) - 2.05) < 0.2, String(wall.cut_at_s));
  // the same wall before the drill came so deep: tissue fills the place
  field.set_time(6);
  assert.ok(front_mm(6) > 2.5);
  assert.equal(probe(field, [0, 0, 20], [0, 0, -1], null)!.distance_mm! < -0.25, true);
  field.set_time(k_duration_s);
  // cut away in the middle: the line ends on the section, in dentin beside the cavity and in the pulp's void goes on
  const section = probe(field, [2.4, 20, 1.5], [0, -1, 0], { normal: [0, 1, 0], offset_mm: 0 })!;
  assert.ok(section.section && Math.abs(section.place_mm[1]) < 1e-5);
  const whole = probe(field, [2.4, 20, 1.5], [0, -1, 0], null)!;
  assert.ok(!whole.section && !whole.cut && whole.cut_at_s === null && whole.place_mm[1] > 2);
  assert.equal(data.tissues[whole.tissue].name, "enamel");
  assert.equal(probe(field, [0, 20, 9], [0, -1, 0], null), null);
});

test("the target's outline lies on its walls and floor and has no lid", () => {
  const outline = target_surface(field);
  assert.ok(outline.cubes.length > 2000);
  let highest = -9;
  for (let i = 0; i < outline.cubes.length; ++i) {
    const p = [0, 1, 2].map(
      (a) => field.origin_mm[a] + (field.box.low[a] + outline.positions[3 * i + a]) * cell,
    );
    // at the opening, where the field jumps from inside to outside, it may end in a lip of one cell
    assert.ok(Math.abs(distance_mm(p[0], p[1], p[2])) < (p[2] < 2.9 ? 0.06 : 0.13), `at ${p}`);
    highest = Math.max(highest, p[2]);
  }
  assert.ok(highest > 2.9 && highest < 3.6, `up to ${highest}, where the tooth ends`);
});

test("with fewer triangles it is closed with the same moving part, and nearly of the same volume", () => {
  const fewer = {
    positions: still.positions,
    triangles: thinned(still, field.size, field.moving_edges()),
  };
  assert.ok(
    fewer.triangles.length < 0.5 * still.triangles.length,
    `${fewer.triangles.length / 3} of ${still.triangles.length / 3} triangles`,
  );
  for (const t_s of [0, 0.6 * k_duration_s, k_duration_s]) {
    field.set_time(t_s);
    const moving = surface.moving()!;
    assert.equal(unbalanced_edges(fewer, moving), 0, `at ${t_s} s`);
    const whole = volume(still, moving);
    assert.ok(
      Math.abs(volume(fewer, moving) - whole) < 0.05 * whole,
      `${volume(fewer, moving)} of ${whole}`,
    );
  }
});

test("pulp that the tooth encloses has no surface of its own", () => {
  assert.equal(surface.open_pulp().triangles.length, 0);
});

test("a class shows at each place of the ideal cavity the share that overcut it or left it standing", () => {
  const of_class = fixture("class");
  const class_field = new ToothField(of_class);
  const class_surface = new ToothSurface(class_field, of_class);
  const ideal = class_surface.still();
  assert.equal(class_surface.moving(), null);
  assert.equal(unbalanced_edges(ideal), 0);
  const wall: [number, number, number] = [k_target.x_mm + k_target.radius_mm, 0, 2];
  for (const deeper_mm of [0.1, 0.3]) {
    const over = heat_at(class_field, wall, [-1, 0, 0], deeper_mm)!;
    assert.ok(
      Math.abs(over - 90 * Math.exp(-deeper_mm / 0.3)) < 16,
      `overcut by more than ${deeper_mm} mm: ${over} %`,
    );
    const under = heat_at(class_field, [0.2, 0, k_target.floor_mm], [0, 0, 1], deeper_mm)!;
    assert.ok(
      Math.abs(under + 70 * Math.exp(-deeper_mm / 0.25)) < 16,
      `left more than ${deeper_mm} mm: ${under} %`,
    );
  }
  const marks = class_surface.heat_marks(ideal, 0.1);
  assert.ok(
    [...marks].filter((_, i) => i % 2 === 0).some((v) => v > 0.4) &&
      [...marks].some((v) => v < -0.3),
  );
});

test("meshing again is quick enough to follow the scrubber", (t) => {
  // a box of 80 x 80 x 80 cells that all change: a ball grows away from within
  const n = 120;
  const size: [number, number, number] = [n, n, n];
  const low: [number, number, number] = [20, 20, 20];
  const inside = (x: number, y: number, z: number): boolean =>
    Math.max(Math.abs(x - 59.5), Math.abs(y - 59.5), Math.abs(z - 59.5)) < 56;
  const before = Uint8Array.from({ length: n ** 3 }, (_, i) =>
    inside(i % n, Math.floor(i / n) % n, Math.floor(i / n ** 2)) ? 255 : 0,
  );
  const stamps = Uint16Array.from({ length: 80 ** 3 }, (_, i) =>
    Math.min(
      1600 *
        Math.hypot((i % 80) - 39.5, (Math.floor(i / 80) % 80) - 39.5, Math.floor(i / 6400) - 39.5),
      65000,
    ),
  );
  const big: ReportData = {
    schema: 1,
    kind: "session",
    title: "",
    duration_s: 10,
    tissues: data.tissues,
    grid: {
      cell_mm: 0.1,
      origin_mm: [0, 0, 0],
      size,
      before: pack("u8", before),
      tissue: pack(
        "u8",
        before.map((v) => (v ? 2 : 0)),
      ),
      box: { low, size: [80, 80, 80] },
      after: pack("u8", new Uint8Array(80 ** 3)),
      first: pack("u16", stamps),
      last: pack("u16", stamps),
      distance: pack("i8", new Int8Array(80 ** 3).fill(127)),
    },
  };
  const big_field = new ToothField(big);
  const big_surface = new ToothSurface(big_field, big);
  big_surface.still();
  const times = [];
  let vertices = 0;
  for (let i = 1; i <= 30; ++i) {
    const begin = performance.now();
    big_field.set_time(10 * (i / 31));
    vertices = Math.max(vertices, big_surface.moving()!.cubes.length);
    times.push(performance.now() - begin);
  }
  times.sort((a, b) => a - b);
  t.diagnostic(
    `80 x 80 x 80 cells: median ${times[15].toFixed(1)} ms, slowest ${times[29].toFixed(1)} ms, up to ${vertices} vertices`,
  );
  assert.ok(times[15] < 1000, "a loaded machine is slow, but not by that much");
});
