// render/gl/shaders.h - the programs for the GPU, in the common part of GLSL 3.30 and GLSL ES 3.00.
//
//     mesh     tool and marks -> colour and kind, normal, depth ("G-buffer"); bone: gl/skin_shaders.h
//     hollow   normal, depth -> ambient occlusion, at full or half resolution
//     soften   ambient occlusion -> the same without noise, smoothed within each surface
//     shadow   a tool of any shape -> what it covers, as the key light sees it, and how deep
//     light    all of these -> the picture
//     sky      the background
//     through  blends what is behind the bone with the bone
//     shrink   n x n samples -> one pixel
//     flat     overlay: text and bars
//     inset    overlay: a picture
//
// Light is linear in between; colours go in and out as sRGB. For use of this room only.
#pragma once

namespace burr::render::gl {

inline constexpr const char* kMeshVertex = R"(
layout(location = 0) in vec3 at_p;
layout(location = 1) in vec3 at_n;
layout(location = 2) in vec3 at_colour;
uniform mat4 clip_from_model;
uniform mat3 view_from_model_n;
out vec3 n;
out vec3 colour;
void main() {
  gl_Position = clip_from_model * vec4(at_p, 1.0);
  n = normalize(view_from_model_n * at_n);
  colour = at_colour;
}
)";

// Into the map of gl/tool_shadow.h: covered, depth along the light 0..1.
inline constexpr const char* kShadowVertex = R"(
layout(location = 0) in vec3 at_p;
uniform mat4 clip_from_model;
void main() { gl_Position = clip_from_model * vec4(at_p, 1.0); }
)";
inline constexpr const char* kShadowFragment = R"(
layout(location = 0) out vec4 covers;
void main() { covers = vec4(1.0, gl_FragCoord.z, 0.0, 1.0); }
)";

// For tool and marks; kind as in gl/skin_shaders.h.
inline constexpr const char* kMeshFragment = R"(
in vec3 n;
in vec3 colour;
uniform vec4 tint_kind;
layout(location = 0) out vec4 out_colour;
layout(location = 1) out vec4 out_n;
void main() {
  out_colour = vec4(colour * tint_kind.rgb, tint_kind.a);
  out_n = vec4(n * 0.5 + 0.5, 1.0);
}
)";

// one triangle that covers the whole screen
inline constexpr const char* kScreenVertex = R"(
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1);
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";

// The "scalable ambient obscurance" estimator (McGuire, Mara, Luebke 2012) on full-resolution
// depth, with true normals. The sample directions rotate in a 4 x 4 pattern, which `soften`
// averages out.
inline constexpr const char* kOcclusionFragment = R"(
uniform sampler2D depth_map;
uniform sampler2D colour_map;
uniform sampler2D normal_map;
uniform vec4 ray;            // view xy per depth = uv * ray.xy + ray.zw
uniform vec2 planes;         // near, far
uniform ivec2 size;          // of the full maps
uniform int stride;          // 1, or 2 for half resolution
uniform float reach;         // [m]
uniform float pixels_per_m;  // at depth 1 m
uniform float most_pixels;
uniform int samples;
uniform vec2 spiral[48];
out vec4 result;             // openness, depth in two bytes

float view_depth(ivec2 at) {
  float d = texelFetch(depth_map, at, 0).r;
  return planes.x * planes.y / (planes.y - d * (planes.y - planes.x));
}
vec3 position(ivec2 at, float z) {
  vec2 uv = (vec2(at) + 0.5) / vec2(size);
  return vec3((uv * ray.xy + ray.zw) * z, -z);
}
vec3 normal_at(ivec2 at) { return normalize(texelFetch(normal_map, at, 0).rgb - 0.5); }
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 at = min(here * stride, size - 1);
  float kind = texelFetch(colour_map, at, 0).a;
  if (kind < 0.4) {
    result = vec4(1.0);
    return;
  }
  float z = view_depth(at);
  vec3 p = position(at, z);
  vec3 n = normal_at(at);

  int turn = ((here.x & 3) * 4 + (here.y & 3)) * 7 & 15;
  float angle = float(turn) * 0.392699;
  vec2 spin = vec2(cos(angle), sin(angle));
  float radius = min(reach * pixels_per_m / z, most_pixels);

  float sum = 0.0;
  float r2 = reach * reach;
  for (int s = 0; s < samples; ++s) {
    vec2 o = spiral[s];
    ivec2 to = at + ivec2(round(vec2(o.x * spin.x - o.y * spin.y, o.x * spin.y + o.y * spin.x) * radius));
    to = clamp(to, ivec2(0), size - 1);
    vec3 v = position(to, view_depth(to)) - p;
    float vv = dot(v, v);
    float vn = dot(v, n) - 0.02 * reach;
    float f = max(1.0 - vv / r2, 0.0);
    sum += f * max(vn / (reach * 0.05 + sqrt(vv)), 0.0);
  }
  float open = max(0.0, 1.0 - 6.0 * sum / float(samples));
  float key = clamp((z - planes.x) / (planes.y - planes.x), 0.0, 1.0) * 255.0;
  result = vec4(open, floor(key) / 255.0, fract(key), 1.0);
}
)";

inline constexpr const char* kSoftenFragment = R"(
uniform sampler2D occlusion_map;
uniform ivec2 size;    // of this map
uniform float strict;  // 1 / (depth difference that separates two surfaces), in depth keys
out vec4 result;
float key(vec4 t) { return t.g + t.b / 255.0; }
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  vec4 mine = texelFetch(occlusion_map, here, 0);
  float z = key(mine), sum = 0.0, weights = 0.0;
  for (int y = -1; y <= 2; ++y)
    for (int x = -1; x <= 2; ++x) {
      vec4 t = texelFetch(occlusion_map, clamp(here + ivec2(x, y), ivec2(0), size - 1), 0);
      float w = max(0.001, 1.0 - abs(key(t) - z) * strict);
      sum += w * t.r;
      weights += w;
    }
  result = vec4(sum / weights, mine.gba);
}
)";

// sRGB to linear light and back (IEC 61966-2-1), with powers replaced by square roots: in
// software rendering, one power costs as much as the rest of a pixel. Fitted coefficients; the error
// is at most 0.01 and 0.2 of 255.
inline constexpr const char* kColourFunctions = R"(
vec3 linear(vec3 c) {
  return mix(c / 12.92, 0.000769 + c * (0.040096 + c * (0.323391 + 0.635813 * sqrt(c))), step(0.04045, c));
}
vec3 srgb(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  vec3 s = sqrt(c);
  vec3 bright = -0.0370168 + s * (1.4480358 + s * (-0.9453218 + s * (0.8433921 - 0.3098380 * s)));
  return mix(c * 12.92, bright, step(0.0031308, c));
}
)";

// Placed after kColourFunctions, with PLAIN, or with HOLLOWS (and HALF: at half resolution), SHADOW
// (of a round burr) or SHADOW_MAP (of another tool), and OTHERS (than bone: tool and marks) as requested. Software
// rendering runs both branches of every `if`, so code that is not needed must be left out.
inline constexpr const char* kLightFragment = R"(
uniform sampler2D colour_map;
uniform sampler2D normal_map;
uniform sampler2D depth_map;
uniform sampler2D occlusion_map;
uniform vec4 ray;
uniform vec2 planes;
uniform ivec2 size;
uniform ivec2 occlusion_size;
uniform float strict;
uniform vec2 sky;          // height in the whole picture = y * sky.x + sky.y
uniform vec3 sky_top;      // sRGB
uniform vec3 sky_bottom;
uniform vec3 key_towards;  // unit, view
uniform vec3 key_light;    // linear
uniform vec3 fill_towards;
uniform vec3 fill_light;
uniform float ambient;
uniform float gloss;
uniform float occlusion;
uniform vec4 ball;         // burr head: centre in view, radius
uniform vec3 shaft;        // unit, from the centre along the shaft, in view
uniform vec2 shaft_size;   // radius, length
uniform float shadow_reach;
out vec4 result;

vec3 normal_at(ivec2 at) { return normalize(texelFetch(normal_map, at, 0).rgb - 0.5); }
float key(vec4 t) { return t.g + t.b / 255.0; }

#ifndef HOLLOWS
float openness(ivec2 at, float z) { return 1.0; }
#elif defined(HALF)
// mean of the nearest four values; those of another surface have a very small weight
float openness(ivec2 at, float z) {
  float mine = clamp((z - planes.x) / (planes.y - planes.x), 0.0, 1.0);
  ivec2 low = at / 2;
  vec2 part = vec2(at - low * 2) * 0.5;
  float sum = 0.0, weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 o = ivec2(i & 1, i >> 1);
    vec4 t = texelFetch(occlusion_map, min(low + o, occlusion_size - 1), 0);
    vec2 b = mix(1.0 - part, part, vec2(o));
    float w = b.x * b.y * max(0.001, 1.0 - abs(key(t) - mine) * strict) + 1e-6;
    sum += w * t.r;
    weights += w;
  }
  return sum / weights;
}
#else
float openness(ivec2 at, float z) { return texelFetch(occlusion_map, at, 0).r; }
#endif

#ifdef SHADOW
// The share of the key light that is not blocked by head and shaft, from the distance between the
// light's ray and the ball or the axis. The edge of the shadow is softer where the object is
// farther away.
float passes(vec3 p, vec3 to) {
  vec3 c = ball.xyz - p;
  float along = dot(c, to);
  float off = length(c - along * to);
  float soft = 0.12 * max(along, 0.0) + 0.1 * ball.w;
  float open = along > 0.0 ? smoothstep(-soft, soft, off - ball.w) : 1.0;
  open = max(open, smoothstep(0.5, 1.0, along / shadow_reach));

  // nearest points of the light's ray and the shaft's axis
  float b = dot(to, shaft), d = dot(to, -c), e = dot(shaft, -c);
  float den = max(1.0 - b * b, 1e-4);
  float s = clamp((e - b * d) / den, 0.0, shaft_size.y);
  float t = dot(c + shaft * s, to);
  float away = length(c + shaft * s - max(t, 0.0) * to);
  soft = 0.12 * max(t, 0.0) + 0.1 * shaft_size.x;
  float rod = t > 0.0 ? smoothstep(-soft, soft, away - shaft_size.x) : 1.0;
  rod = max(rod, smoothstep(0.5, 1.0, t / shadow_reach));
  return min(open, rod);
}
#elif defined(SHADOW_MAP)
uniform sampler2D shadow_map;
uniform mat4 map_from_view;
uniform vec3 map_size;  // [m]
// The same for a tool of any shape. The level of the map is chosen by how soft the edge is, which depends on the distance to
// the tool along the light.
float passes(vec3 p, vec3 to) {
  vec3 at = (map_from_view * vec4(p, 1.0)).xyz;
  float texel = max(map_size.x, map_size.y) / float(textureSize(shadow_map, 0).x);  // [m]
  vec4 around = textureLod(shadow_map, at.xy, log2(4e-3 / texel));
  float along = max(at.z * around.r - around.g, 0.0) / max(around.r, 0.03) * map_size.z;
  float soft = 0.12 * along + 0.1e-3;
  vec4 here = textureLod(shadow_map, at.xy, log2(max(soft / texel, 1.0)));
  float behind = smoothstep(0.0, 0.4e-3, at.z * here.r * map_size.z - here.g * map_size.z);
  vec2 inside = smoothstep(vec2(0.0), vec2(0.06), at.xy) * smoothstep(vec2(0.0), vec2(0.06), 1.0 - at.xy);
  float open = 1.0 - here.r * behind * inside.x * inside.y;
  return max(open, smoothstep(0.5, 1.0, along / shadow_reach));
}
#else
float passes(vec3 p, vec3 to) { return 1.0; }
#endif

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 c = texelFetch(colour_map, at, 0);
  vec3 n = normal_at(at);
  vec3 albedo = linear(c.rgb);
#ifdef PLAIN
  vec3 colour = albedo * max(n.z, 0.0);
#else
  vec2 uv = (vec2(at) + 0.5) / vec2(size);
  vec3 along = vec3(uv * ray.xy + ray.zw, -1.0);
  vec3 eye = normalize(-along);
  float z = 0.0;
#if defined(SHADOW) || defined(SHADOW_MAP) || defined(HALF)
  float d = texelFetch(depth_map, at, 0).r;
  z = planes.x * planes.y / (planes.y - d * (planes.y - planes.x));
#endif
#ifdef OTHERS
  bool bone = c.a > 0.8;
#else
  const bool bone = true;
#endif
  float open = bone ? mix(1.0, openness(at, z), occlusion) : 1.0;  // for bone only

  float lit = max(dot(n, key_towards), 0.0);
  if (bone) lit *= passes(along * z, key_towards);
  float side = max(dot(n, fill_towards), 0.0);
  vec3 direct = key_light * lit + fill_light * side;
  float around = ambient * (0.8 + 0.2 * n.y);
  // in hollows all of the ambient light and a part of the lamps' light is blocked
  vec3 light = direct * (0.4 + 0.6 * open) + around * open;

  // water stands in hollows, with a calmer face that turns to the eye
  float wet = bone ? (1.0 - c.a) / 0.18 : 0.0;
  float pool = wet * (1.0 - open);
  vec3 face = normalize(n + (0.8 * pool) * eye);
  // the exponent of the highlight is 28 for bone, 60 for steel; water has one of 60 around one of 240
  float x = max(dot(face, normalize(key_towards + eye)), 0.0);
  float x4 = x * x * x * x, x12 = x4 * x4 * x4, x28 = x12 * x12 * x4;
  float shine = bone ? x28 : x28 * x28 * x4;
  float own = bone ? gloss : 0.45;
  float x60 = x28 * x28 * x4, x120 = x60 * x60;
  own += 0.6 * wet;
  shine = mix(shine, 0.4 * x60 + x120 * x120, wet);
  vec3 colour = albedo * light * (1.0 - 0.35 * pool) + key_light * (own * shine * step(1e-4, lit) * open);
  // a film mirrors the room where it is seen edge-on (Schlick 1994)
  float grazing = 1.0 - max(dot(face, eye), 0.0), g2 = grazing * grazing;
  colour += vec3(0.55, 0.62, 0.70) * (wet * (0.02 + 0.45 * g2 * g2 * grazing) * (0.35 + 0.65 * open));
#ifdef OTHERS
  // steel reflects the room: bright above, dark below
  float mirrored = smoothstep(-0.2, 0.9, 2.0 * dot(n, eye) * n.y - eye.y);
  colour += bone ? vec3(0.0) : albedo * (0.35 * mirrored * open);
  // marks are shaded to be readable, not realistic
  colour = c.a < 0.5 ? albedo * (0.55 + 0.45 * max(n.z, 0.0)) : colour;
#endif
#endif
  vec3 back = mix(sky_bottom, sky_top, clamp(gl_FragCoord.y * sky.x + sky.y, 0.0, 1.0));
  result = vec4(c.a < 0.1 ? back : srgb(colour), 1.0);
}
)";

// Blends what is behind the bone with the bone. Where the bone is seen edge-on it stays opaque, so
// that its shape can be seen; a bone of opacity 0 is invisible.
inline constexpr const char* kThroughFragment = R"(
uniform sampler2D colour_map;    // the bone in front
uniform sampler2D normal_map;
uniform sampler2D behind;        // the picture behind it, with light
uniform vec4 ray;
uniform ivec2 size;
uniform float opacity;
out vec4 result;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (texelFetch(colour_map, at, 0).a < 0.8) discard;
  vec3 n = texelFetch(normal_map, at, 0).rgb - 0.5;
  vec2 uv = (vec2(at) + 0.5) / vec2(size);
  vec3 eye = normalize(vec3(-(uv * ray.xy + ray.zw), 1.0));
  float facing = clamp(dot(normalize(n), eye), 0.0, 1.0);
  result = vec4(texelFetch(behind, at, 0).rgb, (1.0 - opacity) * mix(1.0, facing, opacity));
}
)";

// Placed after kColourFunctions.
inline constexpr const char* kShrinkFragment = R"(
uniform sampler2D picture;
uniform int factor;
uniform ivec2 from;
out vec4 result;
void main() {
  ivec2 at = from + ivec2(gl_FragCoord.xy) * factor;
  vec3 sum = vec3(0.0);
  for (int y = 0; y < factor; ++y)
    for (int x = 0; x < factor; ++x) sum += linear(texelFetch(picture, at + ivec2(x, y), 0).rgb);
  result = vec4(srgb(sum / float(factor * factor)), 1.0);
}
)";

// The background.
inline constexpr const char* kSkyFragment = R"(
uniform vec2 sky;          // height in the whole picture = y * sky.x + sky.y
uniform vec3 sky_top;      // sRGB
uniform vec3 sky_bottom;
out vec4 result;
void main() {
  result = vec4(mix(sky_bottom, sky_top, clamp(gl_FragCoord.y * sky.x + sky.y, 0.0, 1.0)), 1.0);
}
)";

inline constexpr const char* kFlatVertex = R"(
layout(location = 0) in vec2 at_p;   // pixel of the whole picture, y down
uniform vec4 clip_from_pixel;        // scale, offset
out vec2 pixel;
void main() {
  pixel = at_p;
  gl_Position = vec4(at_p * clip_from_pixel.xy + clip_from_pixel.zw, 0.0, 1.0);
}
)";
inline constexpr const char* kInsetFragment = R"(
in vec2 pixel;
uniform sampler2D picture;
uniform vec4 place;  // left, top, width, height  [pixel]
out vec4 result;
void main() { result = vec4(texture(picture, (pixel - place.xy) / place.zw).rgb, 1.0); }
)";
// Darker with the distance from the middle, computed for each pixel: rings of one shade each were seen
// as stripes on large, even faces.
inline constexpr const char* kVignetteFragment = R"(
in vec2 pixel;
uniform vec2 middle, reach;  // where it begins, where it is darkest  [pixel]
uniform float darkest;       // 0..1
out vec4 result;
void main() {
  float part = clamp((distance(pixel, middle) - reach.x) / (reach.y - reach.x), 0.0, 1.0);
  result = vec4(0.0, 0.0, 0.0, darkest * part * part * (3.0 - 2.0 * part));
}
)";
inline constexpr const char* kFlatFragment = R"(
uniform vec4 colour;
out vec4 result;
void main() { result = colour; }
)";

}  // namespace burr::render::gl
