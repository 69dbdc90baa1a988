// Which way is mesial, buccal and occlusal in the present view.
import * as THREE from "three";
import { noop, tr } from "./words.ts";

const k_axes: [string, THREE.Vector3][] = [
  [noop("mesial"), new THREE.Vector3(1, 0, 0)],
  [noop("buccal"), new THREE.Vector3(0, 1, 0)],
  [noop("occlusal"), new THREE.Vector3(0, 0, 1)],
];
const k_centre = [70, 46];
const k_length_px = 22;
const k_svg = "http://www.w3.org/2000/svg";

export class Compass {
  readonly element: SVGSVGElement;
  private readonly arms: { line: SVGElement; text: SVGElement; axis: THREE.Vector3 }[];

  constructor() {
    this.element = document.createElementNS(k_svg, "svg") as SVGSVGElement;
    this.element.setAttribute("class", "compass");
    this.element.setAttribute("viewBox", "0 0 140 92");
    this.element.setAttribute("aria-hidden", "true");
    this.arms = k_axes.map(([name, axis]) => {
      const line = document.createElementNS(k_svg, "line");
      const text = document.createElementNS(k_svg, "text");
      text.textContent = tr(name);
      this.element.append(line, text);
      return { line, text, axis };
    });
  }

  follow(camera: THREE.Camera): void {
    const turn = camera.quaternion.clone().invert();
    for (const { line, text, axis } of this.arms) {
      const d = axis.clone().applyQuaternion(turn);
      const flat = Math.hypot(d.x, d.y);
      const [x, y] = [k_centre[0] + d.x * k_length_px, k_centre[1] - d.y * k_length_px];
      for (const [name, value] of Object.entries({
        x1: k_centre[0],
        y1: k_centre[1],
        x2: x,
        y2: y,
      }))
        line.setAttribute(name, value.toFixed(1));
      // beyond the arm's end; none where the arm points at the eye or away from it
      const beyond = (Math.abs(d.x) > 0.5 * flat ? 5 : 11) / Math.max(flat, 0.2);
      text.setAttribute(
        "text-anchor",
        Math.abs(d.x) <= 0.5 * flat ? "middle" : d.x > 0 ? "start" : "end",
      );
      text.setAttribute("x", (x + d.x * beyond).toFixed(1));
      text.setAttribute("y", (y - d.y * beyond + 4).toFixed(1));
      text.style.display = flat < 0.25 ? "none" : "";
    }
  }
}
