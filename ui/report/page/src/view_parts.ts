// Parts of the 3D view: how far it looks, the target's outline, the mark at a place, what a tissue counts as.
import * as THREE from "three";
import type { Tissue, Vec3 } from "./data.ts";
import { bounds, type ToothField } from "./tooth_field.ts";
import type { SharedUniforms } from "./tooth_material.ts";

/** 1 for a solid tissue, 2 for pulp, 3 for what else surrounds the tooth, 0 for air and what is no tissue. */
export function tissue_kind(tissue: Tissue | undefined): number {
  if (tissue === undefined || tissue.name === "air") return 0;
  return tissue.solid ? 1 : tissue.pulp ? 2 : 3;
}

/** The sphere around all solid tissue, and the one that the view begins with: the tooth's breadth around the height of what was to be done. */
export function spheres(field: ToothField): {
  whole: { centre: THREE.Vector3; radius: number };
  home: { centre: THREE.Vector3; radius: number };
} {
  const tooth = bounds(
    { low: [0, 0, 0], size: field.size },
    (i) => field.untouched[i] > 0.5,
    field.size,
  )!;
  const low = tooth.low;
  const high = low.map((v, a) => v + tooth.size[a] - 1);
  const span = [0, 1, 2].map((a) => (high[a] - low[a]) * field.cell_mm);
  const mm = (cells: number[]): THREE.Vector3 =>
    new THREE.Vector3(...(cells.map((v, a) => field.origin_mm[a] + v * field.cell_mm) as Vec3));
  const middle = [0, 1, 2].map((a) => (low[a] + high[a]) / 2);
  const worked = field.box.low[2] + field.box.size[2] / 2;
  const breadth = Math.hypot(span[0], span[1]) / 2;
  const radius = Math.hypot(...span) / 2;
  const height = Math.min(
    Math.max(worked, low[2] + breadth / field.cell_mm),
    Math.max(high[2] - (0.75 * breadth) / field.cell_mm, middle[2]),
  );
  return {
    whole: { centre: mm(middle), radius },
    home: { centre: mm([middle[0], middle[1], height]), radius: Math.min(radius, 1.08 * breadth) },
  };
}

export function outline_material(
  shared: SharedUniforms,
  opacity: number,
  through: boolean,
): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    uniforms: { clip: shared.clip, opacity: { value: opacity } },
    vertexShader: /* glsl */ `
varying vec3 v_world, v_normal, v_view;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vec4 view = viewMatrix * world;
  v_world = world.xyz; v_normal = mat3(viewMatrix) * normal; v_view = view.xyz;
  gl_Position = projectionMatrix * view;
}`,
    fragmentShader: /* glsl */ `
uniform vec4 clip; uniform float opacity;
varying vec3 v_world, v_normal, v_view;
void main() {
  if (dot(clip.xyz, v_world) > clip.w) discard;
  float s = v_world.z / 0.5, w = fwidth(s);
  float line = 1.0 - smoothstep(0.5, 1.5, abs(fract(s + 0.5) - 0.5) / max(w, 1e-5));
  line *= 1.0 - smoothstep(0.2, 0.6, w);
  float facing = abs(dot(normalize(v_normal), normalize(v_view)));
  gl_FragColor = vec4(0.0, 0.36, 0.40, opacity * (0.45 + 0.55 * (1.0 - facing) + 0.9 * line));
}`,
    transparent: true,
    depthWrite: false,
    depthTest: !through,
    side: THREE.DoubleSide,
  });
}

/** A ring with a point, of one size on the screen, seen through everything. */
export function marker_of(): THREE.Group {
  const group = new THREE.Group();
  const part = (geometry: THREE.BufferGeometry, colour: number, order: number): void => {
    const mesh = new THREE.Mesh(
      geometry,
      new THREE.MeshBasicMaterial({
        color: colour,
        depthTest: false,
        depthWrite: false,
        transparent: true,
      }),
    );
    mesh.renderOrder = order;
    group.add(mesh);
  };
  part(new THREE.RingGeometry(0.78, 1.22, 48), 0xffffff, 5);
  part(new THREE.RingGeometry(0.86, 1.14, 48), 0x8a0064, 6);
  part(new THREE.CircleGeometry(0.3, 24), 0xffffff, 5);
  part(new THREE.CircleGeometry(0.22, 24), 0x8a0064, 6);
  group.visible = false;
  return group;
}

/** No graphics card draws here: the browser does it itself, or a driver that is a program. */
export function drawn_by_processor(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return false;
  const name = gl.getExtension("WEBGL_debug_renderer_info")
    ? String(gl.getParameter(0x9246))
    : String(gl.getParameter(gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
