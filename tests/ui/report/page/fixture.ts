// A report of a tooth whose every measure is known: an ellipsoid of enamel over dentin over pulp, drilled from above by a cylinder, with another
// cylinder as the target. Written independently of the program that writes real reports.
import type { Packed, ReportData, Vec3 } from "../src/data.ts";

export const k_duration_s = 20;
const k_cell_mm = 0.1;
const k_semi_mm: Vec3 = [4.2, 3.8, 3.4]; // the tooth
const k_pulp_mm: Vec3 = [1.6, 1.4, 0.7];
const k_pulp_z_mm = -0.8;
const k_enamel_mm = 0.9;
export const k_cut = { radius_mm: 1.5, floor_mm: 0.9 }; // about the z axis
export const k_target = { x_mm: 0.2, radius_mm: 1.4, floor_mm: 0.65 };
const k_from_s = 2;
const k_to_s = 18;
const k_top_mm = 3.6;

/** Height of the drilling's front. */
export function front_mm(t_s: number): number {
  const share = Math.min(Math.max((t_s - k_from_s) / (k_to_s - k_from_s), 0), 1);
  return k_top_mm + (k_cut.floor_mm - k_top_mm) * share;
}

/** Volume of the tooth without pulp. */
export function whole_mm3(): number {
  return (
    (4 / 3) *
    Math.PI *
    (k_semi_mm[0] * k_semi_mm[1] * k_semi_mm[2] - k_pulp_mm[0] * k_pulp_mm[1] * k_pulp_mm[2])
  );
}

/** Volume drilled away at a time: the part of the cylinder between the front and the ellipsoid, by polar quadrature. */
export function drilled_mm3(t_s: number): number {
  const front = front_mm(t_s);
  let sum = 0;
  const [rings, spokes] = [400, 400];
  for (let i = 0; i < rings; ++i) {
    const r = ((i + 0.5) / rings) * k_cut.radius_mm;
    for (let j = 0; j < spokes; ++j) {
      const a = ((j + 0.5) / spokes) * 2 * Math.PI;
      const q =
        1 - ((r * Math.cos(a)) / k_semi_mm[0]) ** 2 - ((r * Math.sin(a)) / k_semi_mm[1]) ** 2;
      sum += Math.max(k_semi_mm[2] * Math.sqrt(q) - front, 0) * r;
    }
  }
  return sum * (k_cut.radius_mm / rings) * ((2 * Math.PI) / spokes);
}

/** Signed distance to the target's wall and floor, + = outside the target. */
export function distance_mm(x: number, y: number, z: number): number {
  const side = Math.hypot(x - k_target.x_mm, y) - k_target.radius_mm;
  const floor = k_target.floor_mm - z;
  return side > 0 && floor > 0 ? Math.hypot(side, floor) : Math.max(side, floor);
}

function within(semi: Vec3, x: number, y: number, z: number): boolean {
  return (x / semi[0]) ** 2 + (y / semi[1]) ** 2 + (z / semi[2]) ** 2 <= 1;
}

/** Zstandard without compression: a frame of raw blocks, as RFC 8878 has it. */
export function zstd_raw(bytes: Uint8Array): Uint8Array {
  const k_block = 1 << 16;
  const blocks = Math.max(Math.ceil(bytes.length / k_block), 1);
  const frame = new Uint8Array(9 + bytes.length + 3 * blocks);
  const view = new DataView(frame.buffer);
  view.setUint32(0, 0xfd2fb528, true);
  frame[4] = 0xa0; // single segment, content size in four bytes
  view.setUint32(5, bytes.length, true);
  let to = 9;
  for (let i = 0; i < blocks; ++i) {
    const part = bytes.subarray(i * k_block, (i + 1) * k_block);
    const header = (part.length << 3) | (i === blocks - 1 ? 1 : 0);
    frame.set([header & 255, (header >> 8) & 255, header >> 16], to);
    frame.set(part, to + 3);
    to += 3 + part.length;
  }
  return frame;
}

export function pack(type: Packed["type"], values: ArrayLike<number>, delta = false): Packed {
  const width = type.endsWith("16") ? 2 : 1;
  const bytes = new Uint8Array(values.length * width);
  let before = 0;
  for (let i = 0; i < values.length; ++i) {
    const v = (delta ? values[i] - before : values[i]) & (width === 2 ? 0xffff : 0xff);
    bytes[i * width] = v & 255;
    if (width === 2) bytes[2 * i + 1] = v >> 8;
    before = values[i];
  }
  return { type, n: values.length, delta, zstd: Buffer.from(zstd_raw(bytes)).toString("base64") };
}

/** The report's data; for a class with the heat of one that overcuts mesially and leaves the floor. */
export function fixture(kind: "session" | "class" = "session"): ReportData {
  const margin = 3;
  const half = k_semi_mm.map((s) => Math.ceil(s / k_cell_mm) + margin) as Vec3;
  const size = half.map((h) => 2 * h) as Vec3;
  const origin_mm = half.map((h) => (-h + 0.5) * k_cell_mm) as Vec3;
  const centre = (i: number, a: number): number => origin_mm[a] + i * k_cell_mm;
  const n = size[0] * size[1] * size[2];
  const before = new Uint8Array(n);
  const tissue = new Uint8Array(n);
  const box_low: Vec3 = [half[0] - 25, half[1] - 25, half[2] - 4];
  const box_size: Vec3 = [52, 50, half[2] + 3];
  const box_n = box_size[0] * box_size[1] * box_size[2];
  const after = new Uint8Array(box_n);
  const first = new Uint16Array(box_n).fill(65535);
  const last = new Uint16Array(box_n).fill(65535);
  const distance = new Int8Array(box_n);
  const heat = new Int8Array(box_n);
  const sub = 2; // as a tooth of leaves half a cell wide
  const stamp = (z: number): number => {
    const share = Math.min(Math.max((k_top_mm - z) / (k_top_mm - k_cut.floor_mm), 0), 1);
    return Math.round(((k_from_s + share * (k_to_s - k_from_s)) / k_duration_s) * 65535);
  };
  let at = 0;
  for (let k = 0; k < size[2]; ++k)
    for (let j = 0; j < size[1]; ++j)
      for (let i = 0; i < size[0]; ++i, ++at) {
        const [x, y, z] = [centre(i, 0), centre(j, 1), centre(k, 2)];
        const pulp = within(k_pulp_mm, x, y, z - k_pulp_z_mm);
        const outside = !within(k_semi_mm, x, y, z);
        tissue[at] = outside
          ? 0
          : pulp
            ? 3
            : within(k_semi_mm.map((s) => s - k_enamel_mm) as Vec3, x, y, z)
              ? 2
              : 1;
        const b = [i - box_low[0], j - box_low[1], k - box_low[2]];
        const in_box = b.every((v, a) => v >= 0 && v < box_size[a]);
        const near =
          Math.abs(
            (x / k_semi_mm[0]) ** 2 + (y / k_semi_mm[1]) ** 2 + (z / k_semi_mm[2]) ** 2 - 1,
          ) < 0.15 ||
          Math.abs(
            (x / k_pulp_mm[0]) ** 2 +
              (y / k_pulp_mm[1]) ** 2 +
              ((z - k_pulp_z_mm) / k_pulp_mm[2]) ** 2 -
              1,
          ) < 0.6;
        let [solid, kept] = [0, 0];
        if (!near && !in_box) {
          before[at] = outside || pulp ? 0 : 255;
          continue;
        }
        for (let s = 0; s < sub ** 3; ++s) {
          const p = [s % sub, Math.floor(s / sub) % sub, Math.floor(s / sub ** 2)].map(
            (v, a) => [x, y, z][a] + ((v + 0.5) / sub - 0.5) * k_cell_mm,
          );
          if (
            !within(k_semi_mm, p[0], p[1], p[2]) ||
            within(k_pulp_mm, p[0], p[1], p[2] - k_pulp_z_mm)
          )
            continue;
          ++solid;
          const gone =
            kind === "session"
              ? Math.hypot(p[0], p[1]) < k_cut.radius_mm && p[2] > k_cut.floor_mm
              : distance_mm(p[0], p[1], p[2]) < 0;
          if (!gone) ++kept;
        }
        before[at] = Math.round((255 * solid) / sub ** 3);
        if (solid > 0 && tissue[at] === 0) tissue[at] = 1;
        if (!in_box) continue;
        const c = (b[2] * box_size[1] + b[1]) * box_size[0] + b[0];
        after[c] = Math.round((255 * kept) / sub ** 3);
        // the target ends at the tooth's surface: in the air above its opening everything is outside, at the distance of its walls
        const d = outside ? Math.abs(distance_mm(x, y, z)) : distance_mm(x, y, z);
        distance[c] = Math.max(-127, Math.min(127, Math.round(d / 0.02)));
        if (after[c] !== before[at]) {
          first[c] = stamp(z + k_cell_mm / 2);
          last[c] = stamp(Math.max(z - k_cell_mm / 2, k_cut.floor_mm));
        }
        if (d >= 0 && x > 0.5) heat[c] = Math.round(90 * Math.exp(-d / 0.3));
        else if (d < 0 && z < k_target.floor_mm + 0.8)
          heat[c] = -Math.round(70 * Math.exp(d / 0.25));
      }

  const data: ReportData = {
    schema: 1,
    kind,
    title: "A cylinder in an ellipsoid",
    tissues: [
      { name: "air", colour: "#ffffff", solid: false },
      { name: "enamel", words: "enamel", colour: "#ece5d3", solid: true },
      { name: "dentin", words: "dentin", colour: "#d9b98a", solid: true },
      { name: "pulp", words: "pulp", colour: "#b5403a", solid: false, pulp: true },
    ],
    grid: {
      cell_mm: k_cell_mm,
      origin_mm,
      size,
      before: pack("u8", before),
      tissue: pack("u8", tissue),
      box: { low: box_low, size: box_size },
      after: pack("u8", after),
      distance: pack("i8", distance),
    },
    scale_mm: 0.5,
  };
  if (kind === "class") {
    data.grid.heat = pack("i8", heat);
    return data;
  }
  data.grid.first = pack("u16", first);
  data.grid.last = pack("u16", last);
  data.duration_s = k_duration_s;
  data.high_contrast = false;
  const dt_s = 0.02;
  const samples = k_duration_s / dt_s + 1;
  const column = (value: (t_s: number) => number): number[] =>
    Array.from({ length: samples }, (_, i) => Math.round(value(i * dt_s)));
  const turning = (t: number): boolean => t > k_from_s && t < k_to_s && !(t > 9 && t < 10);
  const axis = [0.17, -0.1, Math.sqrt(1 - 0.17 ** 2 - 0.1 ** 2)];
  data.motion = {
    dt_s,
    n: samples,
    x_um: pack(
      "i16",
      column((t) => 800 * Math.cos(2.4 * t)),
      true,
    ),
    y_um: pack(
      "i16",
      column((t) => 800 * Math.sin(2.4 * t)),
      true,
    ),
    z_um: pack(
      "i16",
      column((t) => 1000 * front_mm(t) + 20),
      true,
    ),
    ax: pack(
      "i8",
      column(() => 127 * axis[0]),
    ),
    ay: pack(
      "i8",
      column(() => 127 * axis[1]),
    ),
    az: pack(
      "i8",
      column(() => 127 * axis[2]),
    ),
    force_cn: pack(
      "u16",
      column((t) => (turning(t) ? 90 + 50 * Math.sin(3 * t) + 20 * Math.sin(17 * t) : 0)),
    ),
    depth_um: pack(
      "i16",
      column((t) => Math.max(3400 - 1000 * front_mm(t), 0)),
      true,
    ),
    rpm10: pack(
      "u16",
      column((t) => (turning(t) ? 20000 - 600 * Math.sin(5 * t) : 0)),
    ),
    tip_50um_s: pack(
      "u16",
      column((t) => 38 + 6 * Math.sin(11 * t)),
    ),
  };
  data.instruments = [
    {
      from_s: 0,
      name: "round 1.4",
      profile_mm: [
        [0, 0],
        [0.05, 0.26],
        [0.2, 0.49],
        [0.45, 0.66],
        [0.7, 0.7],
        [0.95, 0.66],
        [1.2, 0.49],
        [1.35, 0.3],
      ],
    },
  ];
  data.events = [
    { t_s: 2, kind: "step", text: "Outline begun", site_mm: [0, 0, 3.4] },
    { t_s: 9, kind: "pause", text: "Pause of 1.0 s", site_mm: null },
    { t_s: 12.5, kind: "limit", text: "Force above 1.5 N", site_mm: [-1.5, 0, 1.8] },
    { t_s: 18, kind: "step", text: "Floor reached", site_mm: [0, 0, 0.9] },
  ];
  data.moments = [
    {
      criterion: "Overcut, walls",
      t_s: 11,
      to_t_s: 14.5,
      site_mm: [-1.5, 0, 1.8],
      what: "0.30 mm beyond the distal wall",
      points_lost: 28.5,
    },
    {
      criterion: "Idle",
      t_s: 9,
      to_t_s: 10,
      site_mm: null,
      what: "nothing was done",
      points_lost: null,
    },
    {
      criterion: "Floor",
      t_s: 17,
      to_t_s: null,
      site_mm: [0, 0, 0.9],
      what: "0.10 mm too deep",
      points_lost: 2,
    },
  ];
  return data;
}

/** A whole document around the data, as a report is built. */
export function document_of(data: unknown, script: string, style: string): string {
  const json = JSON.stringify(data).replaceAll("<", "\\u003c");
  return `<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width,initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:">
<title>A cylinder in an ellipsoid</title><style>${style}</style></head><body>
<header><h1>A cylinder in an ellipsoid</h1><p>Candidate A17, a tooth of formulae</p></header>
<main><section class="verdict review"><b>review</b><br>71.5 of 100.0 points</section>
<section><h2>Criteria</h2><div class="wide" tabindex="0" role="region" aria-label="Criteria"><table><thead><tr><th>Criterion</th><th class="n">Value</th><th class="n">Points</th><th>Why</th><th>When</th></tr></thead>
<tr><td>Target removed</td><td class="n">93.1 %</td><td class="n">20.0 / 20.0</td><td>above 90 %</td><td></td></tr>
<tr class="lost"><td>Overcut, walls</td><td class="n">0.31 mm</td><td class="n">11.5 / 40.0</td><td>over 0.20 mm</td>
<td><button class="jump" type="button" data-t="12.5" data-x="-1.5" data-y="0" data-z="1.8">0:12.5</button></td></tr>
<tr class="lost"><td>Idle</td><td class="n">1.0 s</td><td class="n">40.0 / 40.0</td><td>a pause</td><td><button class="jump" type="button" data-t="9">0:09.0</button></td></tr>
</table></div></section>
<section id="tooth-3d"><h2>The tooth</h2><p class="fallback">The tooth in 3D needs a browser that runs scripts.</p></section>
<section id="charts"><h2>Force, depth and speed</h2></section></main>
<footer><p>Tooth e3b0c44298fc1c14</p></footer>
<script type="application/json" id="cavum-data">${json}</script>
<script>${script}</script></body></html>
`;
}
