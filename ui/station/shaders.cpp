#include "ui/station/shaders.h"

namespace cavum::station {

namespace {

// What a place is made of, by its two tissues.
constexpr const char* k_tissue_part = R"(
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 light;
layout(location = 3) in vec4 tissue;
uniform vec3 colours[16];
float share_of(float which) {
  float second = tissue.z / 255.0;
  return (tissue.x == which ? 1.0 - second : 0.0) + (tissue.y == which ? second : 0.0);
}
vec3 own_colour() {
  vec3 c = mix(colours[int(tissue.x + 0.5)], colours[int(tissue.y + 0.5)], tissue.z / 255.0);
  return mix(c, colours[3], 0.45 * tissue.w / 255.0);
}
)";

constexpr const char* k_light_part = R"(
uniform vec3 eye_mm, lamp, lamp_colour, background;
uniform vec2 far_mm;  // where things begin to sink into the background, and over how much
uniform mat3 to_room;
uniform sampler2D room;
vec3 mirrored(vec3 w, float which) {
#ifdef REFLECTIONS
  w /= abs(w.x) + abs(w.y) + abs(w.z);
  vec2 p = w.z >= 0.0 ? w.xy : (1.0 - abs(w.yx)) * vec2(w.x < 0.0 ? -1.0 : 1.0, w.y < 0.0 ? -1.0 : 1.0);
  p = clamp(0.5 * p + 0.5, 0.5 / 32.0, 31.5 / 32.0);
  return texture(room, vec2((p.x + which) / 3.0, p.y)).rgb;
#else
  return mix(vec3(0.14, 0.12, 0.11), vec3(0.40, 0.44, 0.50), clamp(0.5 + 0.5 * w.z, 0.0, 1.0));
#endif
}
vec4 finished(vec3 c, float opacity) {
  c = mix(c, background, clamp((distance(eye_mm, place) - far_mm.x) * far_mm.y, 0.0, 0.5));
  c = c * (1.0 + 0.25 * c) / (1.0 + 0.45 * c);  // highlights keep their colour
  return vec4(sqrt(c), opacity);
}
)";

constexpr const char* k_shadow_part = R"(
uniform sampler2DShadow shadow;
uniform float shadow_px;
float lit_at(vec3 p) {
#if TAPS == 1
  return texture(shadow, p);
#elif TAPS == 4
  float s = 1.1 * shadow_px;
  return 0.25 * (texture(shadow, p + vec3(-0.5 * s, -s, 0.0)) + texture(shadow, p + vec3(s, -0.5 * s, 0.0)) +
                 texture(shadow, p + vec3(0.5 * s, s, 0.0)) + texture(shadow, p + vec3(-s, 0.5 * s, 0.0)));
#else
  float s = 1.6 * shadow_px, lit = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) lit += texture(shadow, p + vec3(float(x) * s, float(y) * s, 0.0));
  return lit / 9.0;
#endif
}
)";

}  // namespace

std::string tooth_vertex() {
  return std::string() + k_tissue_part + R"(
uniform mat4 to_picture, to_lamp, to_tool;
uniform mat3 to_room;
uniform vec3 falling[9];
uniform float away_mm;  // along the normal, before the lamp's shadow is looked up
uniform float plain;    // 1 = tissues told apart by their colours alone
out vec3 place, facing, tint, around, in_lamp, in_tool;
out vec3 nature;  // enamel, pulp, open
void main() {
  place = at;
  facing = normal;
  vec3 n = to_room * normal;
  vec3 all = falling[0] + falling[1] * n.y + falling[2] * n.z + falling[3] * n.x + falling[4] * (n.x * n.y) + falling[5] * (n.y * n.z) +
             falling[6] * (3.0 * n.z * n.z - 1.0) + falling[7] * (n.x * n.z) + falling[8] * (n.x * n.x - n.y * n.y);
  float enamel = share_of(1.0), pulp = share_of(3.0), open = light.x;
  tint = own_colour();
  // thin enamel is bluish and lets light through; dentin below warms it
  vec3 thin = tint * vec3(0.93, 0.98, 1.02), thick = tint * vec3(1.02, 0.955, 0.83);
  tint = mix(tint, mix(thin, thick, light.y), enamel * (1.0 - plain));
  // light that bounces between walls keeps their colour
  around = max(all, vec3(0.0)) * open * mix(vec3(1.0), sqrt(tint), 0.6 * (1.0 - open));
  nature = vec3(enamel, pulp, open);
  vec4 l = to_lamp * vec4(at + away_mm * normal, 1.0);
  in_lamp = 0.5 * l.xyz + 0.5;
  in_tool = (to_tool * vec4(at, 1.0)).xyz;
  gl_Position = to_picture * vec4(at, 1.0);
})";
}

std::string tooth_fragment() {
  return std::string() + R"(
in vec3 place, facing, tint, around, in_lamp, in_tool;
in vec3 nature;
out vec4 pixel;
)" + k_light_part +
         k_shadow_part + R"(
uniform sampler2D tool_mm;    // distance from the instrument by radius and height
uniform vec4 tool_table;      // of radius: scale; of height: scale, offset; how much it touches, 0..1
uniform vec4 foot;            // ring below the head: its radius; lowest height where it shows; how much of it shows, 0..1
uniform vec3 tool_axis;       // from the tip to the hand
void main() {
  vec3 n = normalize(facing), v = normalize(eye_mm - place);
  float nv = dot(n, v);
  n = normalize(n + v * max(0.05 - nv, 0.0));  // a normal between two corners may look away from who sees it
  nv = max(nv, 0.05);
  float nl = dot(n, lamp);
  float lit = lit_at(in_lamp) * smoothstep(-0.25, 0.1, nl);
  float near = 1.0, ring = 1.0, line = 0.0;
#ifdef TOOL
  vec2 where = vec2(length(in_tool.xy) * tool_table.x, in_tool.z * tool_table.y + tool_table.z);
  float mm = texture(tool_mm, where).r;
  near = 1.0 - 0.55 * exp2(-3.5 * max(mm, 0.0));
  ring = 1.0 - 0.90 * tool_table.w * (1.0 - smoothstep(0.02, 0.50, mm));
  // on tissue that looks up to the head, not on walls
  float wide = length(in_tool.xy);
  line = foot.z * (1.0 - smoothstep(0.5, 1.0, abs(wide - foot.x) / max(0.10, 1.3 * fwidth(wide)))) * smoothstep(0.25, 0.45, dot(n, tool_axis)) *
         smoothstep(foot.y, foot.y + 0.3, in_tool.z) * (1.0 - smoothstep(0.2, 0.6, in_tool.z));
#endif
  float enamel = nature.x, pulp = nature.y, open = nature.z;
  float soft = mix(0.30, 0.18, enamel);  // light wanders in tissue
  float from_lamp = max((nl + soft) / (1.0 + soft), 0.0) * lit;
  float from_eye = 0.25 * nv * (0.35 + 0.65 * open);
  float rim = enamel * (1.0 - nv) * (1.0 - nv);
  vec3 c = tint * ((around + from_eye) * near + lamp_colour * from_lamp);
  c = mix(c, vec3(0.80, 0.86, 0.92) * (0.35 * around + 0.5 * lamp_colour * lit), 0.38 * rim * open);  // the paler edge of enamel
  // wet: a clear coat over what lies below
  float glance = 1.0 - nv, f = 0.04 + 0.62 * glance * glance * glance * glance * glance;
  float wet = mix(mix(0.35, 1.0, enamel), 1.0, pulp);
  float level = enamel > 0.5 || pulp > 0.5 ? 0.0 : 1.0;
  c += wet * f * open * near * mirrored(to_room * reflect(-v, n), level);
  float nh = max(dot(n, normalize(lamp + v)), 0.0);
  float sharp = mix(40.0, 260.0, max(enamel, pulp));
  c += lamp_colour * wet * lit * f * 0.09 * sharp * exp2(1.44 * sharp * (nh - 1.0)) * step(0.0, nl);
  pixel = finished(c * ring * mix(vec3(1.0), vec3(0.04, 0.42, 0.55), line), 1.0);
})";
}

std::string metal_vertex() {
  return std::string() + R"(
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 shade;
uniform mat4 model, to_picture, to_lamp;
uniform mat3 to_room;
uniform vec3 falling[9];
out vec3 place, facing, tint, around, in_lamp;
out float polish;
void main() {
  vec4 p = model * vec4(at, 1.0);
  place = p.xyz;
  facing = mat3(model) * normal;
  vec3 n = to_room * facing;
  vec3 all = falling[0] + falling[1] * n.y + falling[2] * n.z + falling[3] * n.x + falling[4] * (n.x * n.y) + falling[5] * (n.y * n.z) +
             falling[6] * (3.0 * n.z * n.z - 1.0) + falling[7] * (n.x * n.z) + falling[8] * (n.x * n.x - n.y * n.y);
  around = max(all, vec3(0.0));
  tint = shade.rgb * shade.rgb;
  polish = shade.a;
  vec4 l = to_lamp * p;
  in_lamp = 0.5 * l.xyz + 0.5;
  gl_Position = to_picture * p;
})";
}

// The opacity of a corner says how polished it is: 1 = steel, less = diamond grit.
std::string metal_fragment() {
  return std::string() + R"(
in vec3 place, facing, tint, around, in_lamp;
in float polish;
uniform float opacity;
out vec4 pixel;
)" + k_light_part +
         k_shadow_part + R"(
void main() {
  vec3 n = normalize(facing), v = normalize(eye_mm - place);
  if (dot(n, v) < 0.0) n = -n;
  float nv = max(dot(n, v), 0.05), nl = max(dot(n, lamp), 0.0);
  float lit = lit_at(in_lamp);
  float glance = 1.0 - nv, f = glance * glance * glance * glance;
  vec3 from_room = mirrored(to_room * reflect(-v, n), polish > 0.7 ? 1.0 : 2.0);
  vec3 c = tint * mix(1.0, 0.42, polish) * (0.8 * around + 0.25 * nv + 0.9 * lamp_colour * nl * lit);
  c += mix(tint, vec3(1.0), f) * from_room * mix(0.25, 0.75, polish);
  float nh = max(dot(n, normalize(lamp + v)), 0.0), sharp = mix(14.0, 120.0, polish);
  c += lamp_colour * tint * lit * mix(0.25, 1.2, polish) * exp2(1.44 * sharp * (nh - 1.0));
  pixel = finished(c, opacity);
})";
}

std::string depth_vertex() {
  return std::string() + R"(
layout(location = 0) in vec3 at;
uniform mat4 model, to_lamp;
void main() { gl_Position = to_lamp * (model * vec4(at, 1.0)); }
)";
}
std::string depth_fragment() {
  return std::string() + R"(
void main() {})";
}

std::string plain_vertex() {
  return std::string() + R"(
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 shade;
uniform mat4 to_picture;
uniform float opacity;
out vec3 place, facing;
out vec4 colour;
void main() {
  place = at;
  facing = normal;
  colour = vec4(shade.rgb, shade.a * opacity);
  gl_Position = to_picture * vec4(at, 1.0);
})";
}

std::string glass_vertex() {
  return std::string() + k_tissue_part + R"(
uniform mat4 to_picture;
uniform float opacity;
out vec3 place, facing;
out vec4 colour;
void main() {
  place = at;
  facing = normal;
  colour = vec4(sqrt(own_colour()), opacity);
  gl_Position = to_picture * vec4(at, 1.0);
})";
}

std::string plain_fragment() {
  return std::string() + R"(
in vec3 place, facing;
in vec4 colour;
uniform vec3 eye_mm, lamp, background;
uniform vec2 far_mm;
uniform float flat_light, glass;
out vec4 pixel;
void main() {
  vec3 n = normalize(facing), v = normalize(eye_mm - place);
  if (dot(n, v) < 0.0) n = -n;
  float head = max(dot(n, v), 0.0), side = max(dot(n, lamp), 0.0);
  float lit = mix(0.17 + 0.42 * head + 0.27 * side + 0.05 * (1.0 + n.z), 0.55 + 0.45 * head, flat_light);
  float edge = 1.0 - head;  // glass is seen at its edges
  float opacity = mix(colour.a, colour.a * (0.30 + 1.5 * edge), glass);
  float away = clamp((distance(eye_mm, place) - far_mm.x) * far_mm.y, 0.0, 0.5);
  pixel = vec4(mix(colour.rgb * lit + vec3(0.05 * edge * edge * edge), sqrt(background), away), min(opacity, 1.0));
})";
}

std::string drop_vertex() {
  return std::string() + R"(
layout(location = 0) in vec4 at;  // and how wide
layout(location = 1) in vec4 shade;
uniform mat4 model, to_picture;
uniform float pixels;  // that a mm is wide at a distance of 1
out vec4 colour;
void main() {
  gl_Position = to_picture * (model * vec4(at.xyz, 1.0));
  float wide = pixels * at.w / max(gl_Position.w, 0.1);
  gl_PointSize = clamp(wide, 1.0, 64.0);
  colour = vec4(shade.rgb, shade.a * min(1.0, wide * wide));  // what is smaller than a pixel covers less of it
})";
}

std::string drop_fragment() {
  return std::string() + R"(
in vec4 colour;
out vec4 pixel;
void main() {
  float away = length(2.0 * gl_PointCoord - 1.0);
  pixel = vec4(colour.rgb * (1.08 - 0.45 * gl_PointCoord.y), colour.a * (1.0 - smoothstep(0.3, 1.0, away)));
})";
}

std::string smooth_fragment() {
  return std::string() + R"(
in vec2 over_all;
uniform sampler2D drawn;
uniform vec2 pixel_size;
out vec4 pixel;
float bright(vec3 c) { return dot(c, vec3(0.3, 0.6, 0.1)); }
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 here = texelFetch(drawn, p, 0).rgb;
  float m = bright(here);
  float n = bright(texelFetch(drawn, p + ivec2(0, 1), 0).rgb), s = bright(texelFetch(drawn, p - ivec2(0, 1), 0).rgb);
  float e = bright(texelFetch(drawn, p + ivec2(1, 0), 0).rgb), w = bright(texelFetch(drawn, p - ivec2(1, 0), 0).rgb);
  float most = max(max(n, s), max(max(e, w), m)), least = min(min(n, s), min(min(e, w), m)), jump = most - least;
  // along the edge: across the way in which the brightness changes
  vec2 way = vec2(n - s, w - e);
  float size = max(abs(way.x), abs(way.y));
  way *= pixel_size * (size > 0.0 ? 0.9 / size : 0.0);
  vec3 along = 0.5 * (texture(drawn, over_all + way).rgb + texture(drawn, over_all - way).rgb);
  float share = smoothstep(0.03, 0.10, jump) * 0.75;
  pixel = vec4(mix(here, along, share), 1.0);
})";
}

}  // namespace cavum::station
