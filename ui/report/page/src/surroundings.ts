// How much tissue lies around a place, coarsely: what darkens hollows in the view.
import type { Vec3 } from "./data.ts";
import { blur, type ToothField } from "./tooth_field.ts";

const k_per_cell = 4;
const k_margin = 3; // empty coarse cells around, as far as the blur reaches and the view looks

export class Surroundings {
  readonly size: Vec3;
  readonly cell_mm: number;
  /** Lowest corner. */
  readonly low_mm: Vec3;
  readonly bytes: Uint8Array;
  private readonly mean: Float32Array;
  private readonly smooth: Float32Array;
  private readonly scratch: Float32Array;

  constructor(private readonly field: ToothField) {
    this.size = field.size.map((n) => Math.ceil(n / k_per_cell) + 2 * k_margin) as Vec3;
    this.low_mm = field.origin_mm.map(
      (o) => o - field.cell_mm * (0.5 + k_margin * k_per_cell),
    ) as Vec3;
    this.cell_mm = field.cell_mm * k_per_cell;
    const n = this.size[0] * this.size[1] * this.size[2];
    this.bytes = new Uint8Array(n);
    this.mean = new Float32Array(n);
    this.smooth = new Float32Array(n);
    this.scratch = new Float32Array(n);
    this.average([0, 0, 0], field.size.map((n) => Math.ceil(n / k_per_cell)) as Vec3);
    this.spread();
  }

  /** Follows the field where it moves. */
  update(): void {
    const moving = this.field.moving;
    if (!moving) return;
    const low = moving.low.map((v) => Math.floor(v / k_per_cell)) as Vec3;
    const high = moving.low.map(
      (v, a) => Math.floor((v + moving.size[a] - 1) / k_per_cell) + 1,
    ) as Vec3;
    this.average(low, high);
    this.spread();
  }

  /** Of coarse cells counted from the field's first. */
  private average(low: Vec3, high: Vec3): void {
    const [nx, ny, nz] = this.field.size;
    const values = this.field.values;
    for (let z = low[2]; z < high[2]; ++z)
      for (let y = low[1]; y < high[1]; ++y)
        for (let x = low[0]; x < high[0]; ++x) {
          let sum = 0;
          for (let k = z * k_per_cell; k < Math.min((z + 1) * k_per_cell, nz); ++k)
            for (let j = y * k_per_cell; j < Math.min((y + 1) * k_per_cell, ny); ++j) {
              const row = (k * ny + j) * nx;
              for (let i = x * k_per_cell; i < Math.min((x + 1) * k_per_cell, nx); ++i)
                sum += values[row + i];
            }
          this.mean[((z + k_margin) * this.size[1] + y + k_margin) * this.size[0] + x + k_margin] =
            sum / k_per_cell ** 3;
        }
  }

  private spread(): void {
    this.smooth.set(this.mean);
    blur(this.smooth, this.scratch, this.size);
    for (let i = 0; i < this.bytes.length; ++i) this.bytes[i] = this.smooth[i] * 255 + 0.5;
  }
}
