// The scene as it is sent, see mujoco_port/live/scene.py: triangles, and for each vertex its body and its looks.

export const OBJECTS = ["blue", "green", "red"];
// What the shaders know a part as; objects follow.
const KINDS = ["plain", "table", "floor", ...OBJECTS];
export const FLOATS_PER_VERTEX = 14; // place 3, normal 3, body, kind, colour 3, gloss 3

/** { head, vertices, triangles, rows } of the bytes; `rows` are the bodies of the objects among the poses. */
export function readScene(bytes) {
  const length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const count = head.vertices;
  const places = new Float32Array(bytes, 4 + length, 3 * count);
  const normals = new Float32Array(bytes, 4 + length + 12 * count, 3 * count);
  const triangles = new Uint32Array(bytes, 4 + length + 24 * count, 3 * head.triangles);
  const vertices = new Float32Array(FLOATS_PER_VERTEX * count);
  for (const { body, kind, material, first, count: faces } of head.parts) {
    const looks = [body + 1, KINDS.indexOf(kind), ...material];
    for (let k = 3 * first; k < 3 * (first + faces); k++) {
      const vertex = triangles[k];
      const at = FLOATS_PER_VERTEX * vertex;
      for (let axis = 0; axis < 3; axis++) {
        vertices[at + axis] = places[3 * vertex + axis];
        vertices[at + 3 + axis] = normals[3 * vertex + axis];
      }
      vertices.set(looks, at + 6);
    }
  }
  const rows = OBJECTS.map((name) => head.parts.find(({ kind }) => kind === name).body);
  return { head, vertices, triangles, rows };
}

/** One moment as it is sent: { seconds, alpha, beta, touched, poses }. */
export function readMoment(bytes) {
  const [seconds, alpha, beta, touched] = new Float32Array(bytes, 0, 4);
  return { seconds, alpha, beta, touched, poses: new Float32Array(bytes, 16) };
}

/** Whether two moments look the same. */
export function alike(one, other) {
  return ["seconds", "alpha", "beta", "touched"].every((name) => one[name] === other[name])
    && one.poses.every((each, k) => each === other.poses[k]);
}

/** A moment on the way from one to another, `part` from 0 to 1; what jumps is not led through the air. */
export function between(before, after, part) {
  if (!before || part >= 1 || before.poses.length !== after.poses.length) return after;
  const poses = new Float32Array(after.poses.length);
  for (let k = 0; k < poses.length; k += 7) {
    const a = before.poses.subarray(k, k + 7);
    const b = after.poses.subarray(k, k + 7);
    const same = a[3] * b[3] + a[4] * b[4] + a[5] * b[5] + a[6] * b[6] < 0 ? -1 : 1;
    for (let n = 0; n < 3; n++) poses[k + n] = a[n] + (b[n] - a[n]) * part;
    let length = 0;
    for (let n = 3; n < 7; n++) {
      poses[k + n] = a[n] + (same * b[n] - a[n]) * part;
      length += poses[k + n] ** 2;
    }
    for (let n = 3; n < 7; n++) poses[k + n] /= Math.sqrt(length);
  }
  const mix = (name) => before[name] + (after[name] - before[name]) * part;
  return { ...after, seconds: mix("seconds"), alpha: mix("alpha"), beta: mix("beta"), poses };
}
