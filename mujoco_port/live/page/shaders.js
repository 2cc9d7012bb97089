// How things look: one surface for all, with the planar world as light on the table.

// Every vertex knows its body; where the bodies are stands in a texture of two texels a body.
const BODIES = `#version 300 es
precision highp float;
uniform highp sampler2D bodies;
in vec3 place, normal;
in float body;
vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.yzw, cross(q.yzw, v) + q.x * v); }
vec3 inWorld(vec3 v, out vec3 outward) {
  vec4 where = texelFetch(bodies, ivec2(0, int(body)), 0), turn = texelFetch(bodies, ivec2(1, int(body)), 0);
  outward = turned(turn, normal);
  return turned(turn, v) + where.xyz;
}`;

export const SHADOW_VERTEX = `${BODIES}
uniform mat4 lamp;
void main() { vec3 outward; gl_Position = lamp * vec4(inWorld(place, outward), 1.0); }`;

export const SHADOW_FRAGMENT = `#version 300 es
precision lowp float;
void main() {}`;

export const VERTEX = `${BODIES}
uniform mat4 camera, lamp;
in vec3 colour, gloss;
in float kind;
out vec3 at, outward, tint, shine, shadow;
flat out int sort;
void main() {
  at = inWorld(place, outward);
  tint = colour;
  shine = gloss;
  sort = int(kind);
  vec4 lit = lamp * vec4(at + 0.004 * outward, 1.0);
  shadow = 0.5 * lit.xyz + 0.5;
  gl_Position = camera * vec4(at, 1.0);
}`;

const SEEN = `#version 300 es
precision highp float;
precision highp sampler2DShadow;
in vec3 at, outward, tint, shine, shadow;
flat in int sort;
uniform sampler2DShadow shadows;
uniform bool shaded, fine;
uniform vec3 viewer;
uniform int touched;
out vec4 pixel;

float lit() {
  if (!shaded || any(lessThan(shadow, vec3(0.0))) || any(greaterThan(shadow, vec3(1.0)))) return 1.0;
  if (!fine) return texture(shadows, vec3(shadow.xy, shadow.z - 0.003));
  float by = 1.1 / float(textureSize(shadows, 0).x), sum = 0.0;
  for (int k = 0; k < 4; k++) {
    vec2 off = by * vec2(k % 2 == 0 ? -1.0 : 1.0, k < 2 ? -0.6 : 0.6);
    sum += texture(shadows, vec3(shadow.xy + off, shadow.z - 0.002));
  }
  return 0.25 * sum;
}

const vec3 key = vec3(0.225, 0.539, 0.811), fill = vec3(-0.749, 0.468, 0.468), rim = vec3(0.0, -0.832, 0.555);
vec3 daylight(vec3 n, float open) {
  vec3 light = mix(vec3(0.34, 0.33, 0.32), vec3(0.55, 0.57, 0.60), 0.5 + 0.5 * n.z);
  light += vec3(0.46, 0.45, 0.43) * max(dot(n, key), 0.0) * open;
  return light + vec3(0.14, 0.15, 0.17) * max(dot(n, fill), 0.0) + vec3(0.12) * max(dot(n, rim), 0.0);
}
`;

/** The robot, the objects, everything but what follows. */
export const PLAIN = `${SEEN}
// How bright a mirror of some roughness gleams; in place of a power, which a processor takes its time for.
float gleam(float cosine, float power) { float c = max(cosine, 0.0); return c / (power - power * c + c); }

void main() {
  vec3 n = normalize(outward), v = normalize(viewer - at);
  n *= sign(dot(n, v));
  float open = lit();
  vec3 colour = tint * daylight(n, open) + shine.z * tint;
  colour += 0.4 * shine.x * gleam(dot(n, normalize(v + key)), 12.0 + 90.0 * shine.y) * open;
  if (sort >= 3 && (touched >> (sort - 3) & 1) == 1) colour += 0.25 * tint + 0.05;
  pixel = vec4(colour, 1.0);
}`;

/** Floor and wall: seldom looked at, and half of the picture. */
export const FLOOR = `${SEEN}
void main() {
  vec3 plain = tint * mix(0.93, 0.80, outward.z);
  pixel = vec4(mix(plain, vec3(0.93, 0.94, 0.945), smoothstep(0.9, 3.4, length(at.xy)) * 0.85), 1.0);
}`;

/** The table, and what moves of the planar world as light on it. */
export const TABLE = `${SEEN}
uniform float scale;
uniform vec2 joint, tip, way;  // end of S1 and of S2 [cm], S1's direction
uniform vec4 lens;             // range [cm], squared cosines of the field's middle and all of it, 1 if at S1's end
uniform vec3 rings[3];         // centre and radius [cm]; a radius of 0 is none
const vec3 glow = vec3(0.98, 0.84, 0.34);

// The square of how far p is from the line from a to a + along.
float from2(vec2 p, vec2 a, vec2 along) {
  vec2 off = p - a;
  off -= clamp(dot(off, along) / dot(along, along), 0.0, 1.0) * along;
  return dot(off, off);
}
float fading(float off) { float t = 1.0 / (1.0 + off / 14.0); t *= t; return t * t; }

float field(vec2 off) {
  float along = dot(off, way), away2 = dot(off, off);
  if (along <= 0.0 || along * along < lens.z * away2 || away2 > lens.x * lens.x) return 0.0;
  float away = sqrt(away2), strength = along * along > lens.y * away2 ? 0.42 : 0.22;
  return strength * (1.0 - 0.55 * away / lens.x) * min(1.0, (lens.x - away) / 20.0);
}

void main() {
  vec3 colour = tint * daylight(outward, lit());
  vec2 p = at.xy / scale, elbow = p - joint;
  float soft = max(0.6, fwidth(p.x) + fwidth(p.y));
  colour = mix(colour, glow, field(p - lens.w * joint));
  float segment = sqrt(min(from2(p, vec2(0.0), joint), from2(p, joint, tip - joint)));
  float gap = min(segment - 1.7, sqrt(min(dot(p, p), dot(elbow, elbow))) - 4.2);
  colour = mix(colour, vec3(1.0, 0.98, 0.92), max(clamp(0.5 - gap / soft, 0.0, 1.0), 0.26 * fading(max(gap, 0.0))));
  for (int k = 0; k < 3; k++) {
    if (rings[k].z == 0.0) continue;
    float rim = length(p - rings[k].xy) - rings[k].z;
    colour = mix(colour, glow, rim > 0.0 ? fading(3.0 * rim) : 0.0);
  }
  pixel = vec4(outward.z > 0.5 ? colour : tint * daylight(outward, 1.0), 1.0);
}`;
