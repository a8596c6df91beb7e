// render/gl/skin_shaders.h - the program for the GPU that draws bone and soft structures into the G-buffer: colour and kind,
// normal, depth. The other programs: gl/shaders.h. For use of this room only.
#pragma once

namespace burr::render::gl {

// What milling leaves on bone, on its colour and wetness: fresh, wet, dust, blood. cloud, speck: of
// the noise; 0.5 where it is not drawn.
inline constexpr const char* kStainFunction = R"(
#ifdef STAINED
void stain_on(inout vec3 c, inout float wet, vec4 stain, float ridges, float cloud, float speck) {
  wet *= 1.0 - max(stain.x, 0.8 * ridges);  // the lining was cut away
  c = mix(c, vec3(0.97, 0.95, 0.90), 0.38 * stain.x);
  // a film of water: uneven at its edge, closed inside
  float film = smoothstep(0.0, 0.7, stain.y * (1.6 - 0.6 * cloud) - 0.12 * cloud);
  c *= 1.0 - 0.24 * film;
  // dust lies in soft heaps; in water it is a smooth paste
  float heaps = mix(1.9 * stain.z - 0.9 * cloud + 0.12 * (speck - 0.5), stain.z, 0.6 * film);
  float lies = smoothstep(0.0, 0.75, heaps);
  c = mix(c, mix(vec3(0.95, 0.93, 0.88), vec3(0.80, 0.76, 0.69), film) * (0.94 + 0.12 * speck), 0.88 * lies);
  wet = max(wet * (1.0 - lies), film * (1.0 - 0.5 * lies));
  // blood: a thin layer is bright, a thick one dark
  float thick = stain.w, red = smoothstep(0.0, 0.45, thick * (1.25 - 0.5 * cloud));
  c = mix(c, mix(vec3(0.62, 0.10, 0.07), vec3(0.34, 0.02, 0.02), thick), 0.93 * red);
  wet = max(wet, 0.9 * red);
}
#endif
)";

// For bone and soft structures: normal, tissue and what shines through it, in 64 bits
// (render/skin_mesh.h). STAINED: with what milling left; GRAIN: with the fine grain of materials;
// CLIP: cut open.
inline constexpr const char* kSkinVertex = R"(
layout(location = 0) in vec3 at_p;
layout(location = 1) in uvec2 at_rest;
uniform mat4 clip_from_model;
uniform mat3 view_from_model_n;
uniform sampler2D tissue_colours;  // colour, gloss; below it grain, pores, milk, 0 if it is not shown
out vec3 n;
out vec4 colour;  // and gloss
#ifdef GRAIN
uniform float noises_per_m;
out vec3 place;
out vec3 grain;
#endif
#ifdef STAINED
layout(location = 2) in vec4 at_stain;
layout(location = 3) in uint at_ridges;
#ifdef GRAIN
uniform float turns_per_step;  // phase of the ridges  [rad]
out vec4 stain;                // fresh, wet, dust, blood
out vec2 ridge;                // phase, height
#endif
#endif
#ifdef CLIP
uniform vec4 plane;  // hidden where dot(plane, (p, 1)) > 0; world
out float beyond;
#endif
void main() {
  gl_Position = clip_from_model * vec4(at_p, 1.0);
#ifdef CLIP
  beyond = dot(plane, vec4(at_p, 1.0));
#endif
  vec2 f = vec2(float(at_rest.x >> 8u & 4095u), float(at_rest.x >> 20u)) / 2047.0 - 1.0;
  vec3 m = vec3(f, 1.0 - abs(f.x) - abs(f.y));
  float t = max(-m.z, 0.0);
  m.xy += vec2(m.x >= 0.0 ? -t : t, m.y >= 0.0 ? -t : t);
  n = view_from_model_n * normalize(m);
  int tissue = int(at_rest.x & 255u), beneath = int(at_rest.y & 255u);
  colour = texelFetch(tissue_colours, ivec2(tissue, 0), 0);
  vec3 under = texelFetch(tissue_colours, ivec2(beneath, 0), 0).rgb;
  float seen = texelFetch(tissue_colours, ivec2(beneath, 1), 0).a;
  // the wall of a hollow has less of it: what fills the hollow has a surface of its own
  float wall = float(at_rest.y >> 16u & 255u) / 255.0;
  float through = seen * float(at_rest.y >> 8u & 255u) / 255.0;
  colour.rgb = mix(colour.rgb, under, through * (1.0 - 0.5 * wall));
#ifdef GRAIN
  // turned, so that no plane of the bone shows that the noise repeats
  place = mat3(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6) * at_p * noises_per_m;
  grain = texelFetch(tissue_colours, ivec2(tissue, 1), 0).rgb;
#endif
#ifdef STAINED
  float height = float(at_ridges & 255u) / 255.0;
#ifdef GRAIN
  stain = at_stain;
  // the length begins again after some thousands of ridges, while single precision holds it
  ridge = vec2(float((at_ridges >> 8u) % 286720u) * turns_per_step, height);
#else
  stain_on(colour.rgb, colour.a, at_stain, height, 0.5, 0.5);  // no finer than the surface
#endif
#endif
}
)";

// kind, in the alpha of the colour: 0 nothing, 1 bone (wet down to 0.82), 2/3 tool, 1/3 mark.
// Normals are written unfolded, at 3 x 10 bit: to fold them here and unfold them in each later step
// cost a tenth of a picture's time with software rendering.
inline constexpr const char* kSkinFragment = R"(
in vec3 n;
in vec4 colour;
layout(location = 0) out vec4 out_colour;
layout(location = 1) out vec4 out_n;
#ifdef GRAIN
in vec3 place;
in vec3 grain;            // grain, pores, milk
uniform sampler3D noise;  // gl/noise.h
#endif
#if defined(STAINED) && defined(GRAIN)
in vec4 stain;
in vec2 ridge;
#endif
#ifdef CLIP
in float beyond;
uniform vec3 plane_n;  // view
#endif
void main() {
  vec3 k = n, c = colour.rgb;
  float wet = colour.a;
#ifdef CLIP
  if (beyond > 0.0) discard;
  // a back face can be seen only through the section plane: it is drawn as the section's surface
  if (!gl_FrontFacing) {
    k = plane_n;
    c = mix(c, vec3(0.80, 0.55, 0.45), 0.5);
    wet = 0.0;
  }
#endif
#ifdef GRAIN
  vec4 near = texture(noise, place), wide = texture(noise, place * 0.371 + 0.13);
  float cloud = near.r, speck = near.b;
  // blotches, warmer where they are darker, and a fine grain
  float blotch = wide.r - 0.5;
  c *= 1.0 + grain.x * (0.20 * (cloud - 0.5) + 0.12 * (speck - 0.5) + blotch * vec3(0.12, 0.16, 0.26));
  // where vessels enter; and the spaces of spongy bone, which hold marrow
  float hole = near.g, marrow = max(2.0 * grain.y - 1.0, 0.0) * smoothstep(0.48, 0.66, cloud);
  c = mix(c, vec3(0.56, 0.29, 0.21), 0.55 * marrow);
  c *= 1.0 - 0.9 * min(grain.y, 0.5) * hole * vec3(0.8, 0.95, 1.0);
  k += 0.16 * grain.x * (vec3(speck, near.a, wide.b) - 0.5);
  // edges of what light passes through are bluish
  float edge = 1.0 - abs(n.z);
  c = mix(c, vec3(0.70, 0.79, 0.90), grain.z * (0.12 + 0.45 * edge * edge));
#ifdef STAINED
  // fine ridges across the way of a fluted burr; none where a pixel holds several of them
  vec2 way = vec2(dFdx(ridge.x), dFdy(ridge.x));
  float per_pixel = length(way), seen = ridge.y * (1.0 - smoothstep(0.8, 1.8, per_pixel));
  k.xy += 0.13 * seen * sin(ridge.x) * way / max(per_pixel, 1e-4);
  c *= 1.0 - 0.035 * seen * (0.5 - 0.5 * cos(ridge.x));
  stain_on(c, wet, stain, ridge.y, cloud, speck);
#endif
#endif
  out_colour = vec4(c, 1.0 - 0.18 * clamp(wet, 0.0, 1.0));  // the lighting step reads the wetness
  out_n = vec4(clamp(k, -1.0, 1.0) * 0.5 + 0.5, 1.0);
}
)";

}  // namespace burr::render::gl
