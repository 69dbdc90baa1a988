// What the report's program hands to the page: one JSON object with packed arrays. Names, units and meanings are those of ui/report/README.md.
import { decompress } from "fzstd";

export type Vec3 = [number, number, number];

/** An array as it stands in the JSON: little-endian, zstd, base64; with `delta` each value is the difference from the one before. */
export interface Packed {
  type: "u8" | "i8" | "u16" | "i16";
  n: number;
  delta: boolean;
  zstd: string;
}

export interface Tissue {
  name: string;
  colour: string;
  solid: boolean;
  /** Of a tissue; air and what is none have no words. */
  words?: string;
  pulp?: boolean;
  /** It stands beside the tooth. */
  beside?: boolean;
}

export interface Grid {
  cell_mm: number;
  origin_mm: Vec3;
  size: Vec3;
  before: Packed;
  tissue: Packed;
  box: { low: Vec3; size: Vec3 };
  after: Packed;
  first?: Packed;
  last?: Packed;
  distance: Packed;
  heat?: Packed;
}

export interface Motion {
  dt_s: number;
  n: number;
  x_um: Packed;
  y_um: Packed;
  z_um: Packed;
  ax: Packed;
  ay: Packed;
  az: Packed;
  force_cn: Packed;
  depth_um: Packed;
  rpm10: Packed;
  tip_50um_s: Packed;
}

export interface Instrument {
  from_s: number;
  name: string;
  profile_mm: [number, number][];
}

export interface ExamEvent {
  t_s: number;
  kind: string;
  text: string;
  site_mm: Vec3 | null;
}

/** Where points went. */
export interface Moment {
  criterion: string;
  t_s: number | null;
  to_t_s: number | null;
  site_mm: Vec3 | null;
  what: string;
  points_lost: number | null;
}

/** Another session of the same exam. */
export interface Beside {
  name: string;
  duration_s: number;
  grid: Omit<Grid, "before" | "tissue"> & Partial<Pick<Grid, "before" | "tissue">>;
  motion: Motion;
  instruments: Instrument[];
  events: ExamEvent[];
  moments: Moment[];
  steps_s: number[];
}

export interface ReportData {
  schema: number;
  kind: "session" | "scan" | "class";
  title: string;
  duration_s?: number;
  high_contrast?: boolean;
  tissues: Tissue[];
  grid: Grid;
  /** The page's messages in the report's language; none in English. */
  words?: { [english: string]: string };
  decimal_sign?: string;
  scale_mm?: number;
  motion?: Motion;
  instruments?: Instrument[];
  events?: ExamEvent[];
  moments?: Moment[];
  /** When each step was completed. */
  steps_s?: number[];
  beside?: Beside;
}

export type Numbers = Uint8Array | Int8Array | Uint16Array | Int16Array;

function bytes_of(base64: string): Uint8Array {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** The numbers of a packed array. Throws when their count is not the one stated. */
export function unpack(packed: Packed): Numbers {
  const raw = packed.n === 0 ? new Uint8Array(0) : decompress(bytes_of(packed.zstd));
  const width = packed.type.endsWith("16") ? 2 : 1;
  if (raw.length !== packed.n * width)
    throw new Error(`${packed.n} values of ${packed.type} announced, ${raw.length} bytes found`);
  const aligned = raw.byteOffset % width === 0 ? raw : raw.slice();
  const array = { u8: Uint8Array, i8: Int8Array, u16: Uint16Array, i16: Int16Array }[packed.type];
  const values = new array(aligned.buffer as ArrayBuffer, aligned.byteOffset, packed.n);
  if (packed.delta) for (let i = 1; i < values.length; ++i) values[i] += values[i - 1]; // the array's type keeps it modulo 2^bits
  return values;
}

/** The report's data, read from its element of the document. */
export function read_data(root: Document): ReportData {
  const element = root.getElementById("cavum-data");
  if (!element) throw new Error("the report has no data");
  const data = JSON.parse(element.textContent ?? "") as ReportData;
  if (data.schema !== 1)
    throw new Error(`the report's data are of schema ${data.schema}, this page reads 1`);
  return data;
}
