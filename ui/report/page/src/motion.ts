// The recorded motion, unpacked into the units that the page shows, and read at any time.
import { type Motion, unpack, type Vec3 } from "./data.ts";

export interface Sample {
  tip_mm: Vec3;
  axis: Vec3;
  force_n: number;
  depth_mm: number;
  rpm: number;
  tip_mm_s: number;
}

function scaled(values: ArrayLike<number>, by: number): Float64Array {
  return Float64Array.from(values, (v) => v * by);
}

export class Recording {
  readonly dt_s: number;
  readonly n: number;
  readonly t_s: Float64Array;
  readonly force_n: Float64Array;
  readonly depth_mm: Float64Array;
  readonly rpm: Float64Array;
  readonly tip_mm_s: Float64Array;
  private readonly tip: [Float64Array, Float64Array, Float64Array];
  private readonly axis: [Float64Array, Float64Array, Float64Array];

  constructor(motion: Motion) {
    this.dt_s = motion.dt_s;
    this.n = motion.n;
    this.t_s = Float64Array.from({ length: motion.n }, (_, i) => i * motion.dt_s);
    this.tip = [
      scaled(unpack(motion.x_um), 1e-3),
      scaled(unpack(motion.y_um), 1e-3),
      scaled(unpack(motion.z_um), 1e-3),
    ];
    this.axis = [
      scaled(unpack(motion.ax), 1 / 127),
      scaled(unpack(motion.ay), 1 / 127),
      scaled(unpack(motion.az), 1 / 127),
    ];
    this.force_n = scaled(unpack(motion.force_cn), 0.01);
    this.depth_mm = scaled(unpack(motion.depth_um), 1e-3);
    this.rpm = scaled(unpack(motion.rpm10), 10);
    this.tip_mm_s = scaled(unpack(motion.tip_50um_s), 0.05);
    for (const column of [
      ...this.tip,
      ...this.axis,
      this.force_n,
      this.depth_mm,
      this.rpm,
      this.tip_mm_s,
    ])
      if (column.length !== this.n) throw new Error("the motion's columns differ in length");
  }

  index(t_s: number): number {
    return Math.min(Math.max(Math.round(t_s / this.dt_s), 0), this.n - 1);
  }

  /** Between two samples the pose runs straight on; the measured values are those of the nearest one. */
  at(t_s: number): Sample {
    const u = Math.min(Math.max(t_s / this.dt_s, 0), this.n - 1);
    const i = Math.floor(u);
    const j = Math.min(i + 1, this.n - 1);
    const mix = (column: Float64Array): number => column[i] + (column[j] - column[i]) * (u - i);
    const near = this.index(t_s);
    return {
      tip_mm: this.tip.map(mix) as Vec3,
      axis: this.axis.map(mix) as Vec3,
      force_n: this.force_n[near],
      depth_mm: this.depth_mm[near],
      rpm: this.rpm[near],
      tip_mm_s: this.tip_mm_s[near],
    };
  }
}
