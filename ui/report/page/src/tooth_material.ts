// How the tooth is painted: light from the eye, soft darkening in hollows, tissue colours where the surface is natural, the deviation's bands with
// their lines and patterns where it was cut; and the flat section where the tooth is cut away.
import * as THREE from "three";
import { k_bands, k_over, k_under, k_within, rgb_of } from "./deviation.ts";

const k_vertex = /* glsl */ `
attribute vec3 tissue_colour;
attribute vec2 marks;
varying vec3 v_world, v_normal, v_view_normal, v_view, v_tissue;
centroid varying vec2 v_marks;  // never beyond the values at the corners
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vec4 view = viewMatrix * world;
  v_world = world.xyz;
  v_normal = normal;
  v_view_normal = mat3(viewMatrix) * normal;
  v_view = view.xyz;
  v_tissue = tissue_colour;
  v_marks = marks;
  gl_Position = projectionMatrix * view;
}`;

const k_common = /* glsl */ `
precision highp float;
precision highp sampler3D;
uniform vec4 clip;            // world: gone where dot(xyz, p) > w
uniform vec3 over_colour[${k_bands}], under_colour[${k_bands}], within_colour;
uniform float edge[${k_bands}], whole;
uniform bool by_deviation;

// stripes and dots lie in the plane that the surface faces most
vec2 flat_on(vec3 p, vec3 n) {
  vec3 a = abs(n);
  return a.z >= a.x && a.z >= a.y ? p.xy : a.x >= a.y ? p.yz : p.zx;
}
float stripes(vec2 p, float period, float share) {
  float s = (p.x + p.y) / period, w = fwidth(s);
  float d = abs(fract(s) - 0.5);
  return (1.0 - smoothstep(share * 0.5 - w, share * 0.5 + w, d)) * (1.0 - smoothstep(0.3, 0.8, w));
}
float dots(vec2 p, float period, float radius) {
  vec2 s = p / period; float w = max(fwidth(s.x), fwidth(s.y));
  float d = length(fract(s) - 0.5);
  return (1.0 - smoothstep(radius - w, radius + w, d)) * (1.0 - smoothstep(0.3, 0.8, w));
}
vec3 deviation_colour(float value, vec2 p, bool untouched) {
  float a = abs(value) / whole;
  vec3 colour = within_colour;
  for (int i = 0; i < ${k_bands}; ++i) if (a >= edge[i]) colour = value > 0.0 ? over_colour[i] : under_colour[i];
  float lines = 0.0, w = fwidth(a);
  for (int i = 0; i < ${k_bands}; ++i) lines = max(lines, 1.0 - smoothstep(0.0, 1.3, abs(a - edge[i]) / max(w, 1e-5)));
  lines *= 1.0 - smoothstep(0.03, 0.12, w);  // none where bands are thinner than a line
  if (a >= edge[0]) {
    if (value > 0.0) colour *= 1.0 - 0.30 * stripes(p, 0.22, 0.30);
    else if (untouched) colour = mix(colour, vec3(1.0), 0.55 * stripes(vec2(p.x, -p.y), 0.34, 0.5));
    else colour *= 1.0 - 0.34 * dots(p, 0.2, 0.20);
  }
  return mix(colour, vec3(0.12), 0.45 * lines);
}`;

const k_fragment = /* glsl */ `
${k_common}
uniform sampler3D density;    // share of tissue in the surroundings, for the darkening in hollows
uniform vec3 density_low, density_size;
uniform vec3 back_colour;
varying vec3 v_world, v_normal, v_view_normal, v_view, v_tissue;
centroid varying vec2 v_marks;  // never beyond the values at the corners

float around(float mm) { return texture(density, (v_world + normalize(v_normal) * mm - density_low) / density_size).r; }

void main() {
  if (dot(clip.xyz, v_world) > clip.w) discard;
  if (!gl_FrontFacing) { gl_FragColor = vec4(back_colour, 1.0); return; }
  float value = v_marks.x, removed = v_marks.y;
  float cut = smoothstep(0.06, 0.10, removed);
  vec3 colour = v_tissue;
  float gloss = 1.0 - cut;
  vec2 p = flat_on(v_world, v_normal);
  if (by_deviation) {
    vec3 natural = mix(v_tissue, vec3(dot(v_tissue, vec3(0.33))), 0.35);
    vec3 cut_colour = deviation_colour(value, p, false);
    vec3 standing = deviation_colour(value, p, true);
    float left = value < -edge[0] * whole ? 1.0 : 0.0;
    colour = mix(mix(natural, standing, left), cut_colour, cut);
    gloss *= 1.0 - left;
  } else {
    colour = mix(colour, colour * 0.93, cut);
  }
  // the border of what was cut
  float edge_width = fwidth(removed);
  colour *= 1.0 - 0.35 * (1.0 - smoothstep(0.0, 1.2, abs(removed - 0.08) / max(edge_width, 1e-5))) * (1.0 - smoothstep(0.1, 0.3, edge_width));

  vec3 n = normalize(v_view_normal), eye = normalize(-v_view);
  float hollow = 0.6 * around(0.9) + 0.4 * around(0.35);
  // where colours are to be read the light is flatter
  float flat_light = by_deviation ? max(cut, value < -edge[0] * whole ? 1.0 : 0.0) : 0.0;
  float open = clamp(1.16 - mix(0.95, 0.5, flat_light) * hollow, 0.3, 1.0);
  vec3 key = normalize(vec3(-0.45, 0.65, 0.75)), fill = normalize(vec3(0.7, -0.1, 0.6));
  float light = mix(0.54 + 0.40 * max(dot(n, key), 0.0) + 0.24 * max(dot(n, fill), 0.0), 0.72 + 0.22 * max(dot(n, key), 0.0) + 0.12 * max(dot(n, fill), 0.0), flat_light);
  float shine = pow(max(dot(n, normalize(key + eye)), 0.0), 48.0) * 0.28 * gloss;
  float rim = pow(1.0 - max(dot(n, eye), 0.0), 3.0) * 0.18;
  gl_FragColor = vec4(colour * (light * open) * (1.0 - rim * (1.0 - 0.7 * flat_light)) + shine, 1.0);
}`;

const k_cap_vertex = /* glsl */ `
varying vec3 v_world;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  v_world = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const k_cap_fragment = /* glsl */ `
${k_common}
uniform sampler3D still_share, moving_share, tissue, distance_box;
uniform vec3 low, cells, moving_low, moving_cells, box_low, box_cells;
uniform float cell;
uniform vec3 palette[16];
uniform int kind[16];          // 1 solid, 2 pulp, 3 what surrounds the tooth, 0 air
uniform vec3 axis;
uniform bool with_target;
varying vec3 v_world;
bool in_block(vec3 i, vec3 from, vec3 n) { return all(greaterThanEqual(i, from)) && all(lessThanEqual(i, from + n - 1.0)); }
void main() {
  vec3 i = (v_world - low) / cell;  // in cells, centre of the first at 0
  if (!in_block(i, vec3(0.0), cells)) discard;
  float before = texture(still_share, (i + 0.5) / cells).r;
  float now = moving_cells.x > 0.0 && in_block(i, moving_low, moving_cells) ? texture(moving_share, (i - moving_low + 0.5) / moving_cells).r : before;
  bool solid = now > 0.5;
  if (!solid && before > 0.5) discard;  // drilled away
  // of the tissues around the place that are solid (or that fill a space, where it is one) the nearest: borders run between the cells, not along them
  int ids[8]; float weights[8];
  vec3 base = clamp(floor(i), vec3(0.0), cells - 2.0), f = i - base;
  for (int c = 0; c < 8; ++c) {
    vec3 o = vec3(c & 1, (c >> 1) & 1, c >> 2);
    ids[c] = min(int(texelFetch(tissue, ivec3(base + o), 0).r * 255.0 + 0.5), 15);
    vec3 w = mix(1.0 - f, f, o);
    weights[c] = w.x * w.y * w.z;
  }
  int id = -1; float most = 0.0;
  for (int a = 0; a < 8; ++a) {
    if (solid ? kind[ids[a]] != 1 : kind[ids[a]] < 2) continue;
    float sum = 0.0;
    for (int b = 0; b < 8; ++b) if (ids[b] == ids[a]) sum += weights[b];
    if (sum > most) { most = sum; id = ids[a]; }
  }
  if (id < 0) discard;
  bool known = in_block(i, box_low, box_cells);
  float value = known ? (texture(distance_box, (i - box_low + 0.5) / box_cells).r * 255.0 - 128.0) * 0.02 : 9.0;
  vec3 colour = palette[id];
  colour = mix(colour, vec3(1.0), kind[id] == 3 ? 0.5 : 0.08);
  if (by_deviation && solid && value < 0.0 && before > 0.5) colour = mix(colour, under_colour[2], 0.75);
  if (with_target && known) {
    float w = fwidth(value);
    float line = (1.0 - smoothstep(1.0, 2.0, abs(value) / max(w, 1e-5))) * (1.0 - step(0.25, w));
    colour = mix(colour, vec3(0.0, 0.30, 0.45), line);
  }
  float border = fwidth(now);
  colour *= 1.0 - 0.55 * (solid ? 1.0 - smoothstep(0.0, 1.5, (now - 0.5) / max(border, 1e-5)) : 0.0);
  gl_FragColor = vec4(colour, 1.0);
}`;

export interface SharedUniforms {
  [name: string]: THREE.IUniform;
}

/** Uniforms that tooth and section have in common, so that one assignment changes both. */
export function shared_uniforms(edges: readonly number[], whole: number): SharedUniforms {
  const colours = (list: string[]): THREE.Vector3[] =>
    list.map((c) => new THREE.Vector3(...rgb_of(c)));
  return {
    clip: { value: new THREE.Vector4(0, 0, 0, 1) },
    over_colour: { value: colours(k_over) },
    under_colour: { value: colours(k_under) },
    within_colour: { value: new THREE.Vector3(...rgb_of(k_within)) },
    edge: { value: [...edges] },
    whole: { value: whole },
    by_deviation: { value: true },
  };
}

export function tooth_material(shared: SharedUniforms, own: SharedUniforms): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    vertexShader: k_vertex,
    fragmentShader: k_fragment,
    uniforms: { ...shared, ...own },
    side: THREE.DoubleSide,
  });
}

export function section_material(
  shared: SharedUniforms,
  own: SharedUniforms,
): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    vertexShader: k_cap_vertex,
    fragmentShader: k_cap_fragment,
    uniforms: { ...shared, ...own },
    side: THREE.DoubleSide,
  });
}
