// The colour map of the signed distance to the target: discrete bands, orange with stripes where too much went (+), blue with dots where target was
// left standing (−), told apart without colour too. The same numbers colour the tooth and its key.
import type { Tissue } from "./data.ts";
import { fixed, tr } from "./words.ts";

export const k_bands = 5;
export const k_over = ["#fdd9b5", "#fdb777", "#f58f3d", "#dd6410", "#9c3a02"];
export const k_under = ["#cfe1f2", "#9fc8e6", "#63a5d6", "#2b78bd", "#0b4488"];
export const k_within = "#f2f1ec";

/** Lower edges of the bands in units of the whole: below the first everything counts as on target. */
export const k_distance_edges = [0.2, 0.4, 0.6, 0.8, 1];
/** Of the class's tooth, in shares of the class: those of the sections (scenarios/review/picture_colours.cpp). */
export const k_heat_edges = [0.05, 0.2, 0.4, 0.6, 0.8];

export function rgb_of(colour: string): [number, number, number] {
  const v = parseInt(colour.slice(1), 16);
  return [(v >> 16) / 255, ((v >> 8) & 255) / 255, (v & 255) / 255];
}

/** `+0.32 mm overcut`, `−0.15 mm left standing`, in words for the value under the pointer. */
export function distance_text(
  mm: number,
  saturates_mm: number,
  edges: readonly number[] = k_distance_edges,
): string {
  const value = `${mm < 0 ? "−" : "+"}${fixed(Math.abs(mm), 2)} mm`;
  if (Math.abs(mm) < edges[0] * saturates_mm) return tr("{}, on target", value);
  return mm > 0 ? tr("{} overcut", value) : tr("{} left standing", value);
}

function swatch(kind: "over" | "under" | "within", colour: string): HTMLElement {
  const element = document.createElement("span");
  element.className = `swatch ${kind}`;
  element.style.backgroundColor = colour;
  return element;
}

/** The key: the bands from overcut to left standing, with the edges' numbers and their signs. */
export function key_element(
  edges: readonly number[],
  whole: number,
  unit: string,
  digits: number,
  title: string,
  words: { over: string; under: string },
): HTMLElement {
  const key = document.createElement("figure");
  key.className = "key";
  const caption = document.createElement("figcaption");
  caption.textContent = `${title}, ${unit}`;
  const row = document.createElement("div");
  row.className = "bands";
  const text = (v: number): string => fixed(v * whole, digits);
  const band = (kind: "over" | "under" | "within", colour: string, label: string): void => {
    const cell = document.createElement("div");
    const number = document.createElement("span");
    number.textContent = label;
    cell.append(swatch(kind, colour), number);
    row.append(cell);
  };
  for (let i = k_bands - 1; i >= 0; --i)
    band("over", k_over[i], i === k_bands - 1 ? `> +${text(edges[i])}` : `+${text(edges[i])}`);
  band("within", k_within, `±${text(edges[0])}`);
  for (let i = 0; i < k_bands; ++i)
    band("under", k_under[i], i === k_bands - 1 ? `< −${text(edges[i])}` : `−${text(edges[i])}`);
  const end = (kind: string, word: string): HTMLElement => {
    const element = document.createElement("span");
    element.className = `end ${kind}`;
    element.textContent = word;
    return element;
  };
  key.append(caption, end("over", `+ ${words.over}`), row, end("under", `− ${words.under}`));
  return key;
}

/** The key to the tissues' own colours. */
export function tissue_key(tissues: readonly Tissue[]): HTMLElement {
  const key = document.createElement("ul");
  key.className = "tissues";
  key.setAttribute("aria-label", tr("Colours of tissues"));
  for (const t of tissues) {
    const item = document.createElement("li");
    const colour = document.createElement("span");
    colour.className = "swatch tissue";
    colour.style.backgroundColor = t.colour;
    item.append(colour, t.words ?? "");
    key.append(item);
  }
  return key;
}
