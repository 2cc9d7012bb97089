// The scene in WebGL 2: one call for the shadows, one for the picture.

import { box, lookAt, multiply } from "./matrices.js";
import { FLOATS_PER_VERTEX } from "./scene.js";
import { FLOOR, PLAIN, SHADOW_FRAGMENT, SHADOW_VERTEX, TABLE, VERTEX } from "./shaders.js";

const SHADOW_PX = { true: 1024, false: 512 };
const LAMP = multiply(box(0.72, 0.62, 0.2, 3.4), lookAt([0.4, 1.05, 1.75], [-0.05, 0.07, 0.1], [0, 0, 1]));
const ATTRIBUTES = { place: [3, 0], normal: [3, 3], body: [1, 6], kind: [1, 7], colour: [3, 8], gloss: [3, 11] };

const SOFTWARE = /swiftshader|llvmpipe|softpipe|software/i;

/** WebGL 2 on a canvas, as { gl, fine }, where `fine` is whether a card draws; null if there is none. */
export function context(canvas) {
  const fine = drawnByCard();
  const gl = canvas.getContext("webgl2", { antialias: fine, alpha: false, powerPreference: "high-performance" });
  return gl && { gl, fine };
}

/** Whether something else than the processor draws. */
function drawnByCard() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const told = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = told ? gl.getParameter(told.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return !SOFTWARE.test(name);
}

/** A drawing of a scene; `fine` is whether there is time for soft edges. */
export function drawing(gl, { head, vertices, triangles, rows }, fine) {
  const shadowProgram = program(gl, SHADOW_VERTEX, SHADOW_FRAGMENT);
  const programs = [PLAIN, TABLE, FLOOR].map((fragment) => program(gl, VERTEX, fragment));
  const mesh = buffers(gl, vertices, triangles, [shadowProgram, ...programs]);
  const bodies = texture(gl, gl.RGBA32F, 2, head.bodies + 1, gl.RGBA, gl.FLOAT, gl.NEAREST);
  const shadows = shadowMap(gl, SHADOW_PX[fine]);
  const poses = new Float32Array(8 * (head.bodies + 1));
  poses[4] = 1; // what nothing moves is not turned
  gl.enable(gl.DEPTH_TEST);
  return { gl, head, rows, mesh, bodies, shadows, poses, shadowProgram, programs, ranges: ranges(head), fine, shaded: true };
}

/** Draw a moment as the eye sees it. */
export function draw(self, moment, look, width, height) {
  const { gl, poses, head } = self;
  for (let body = 0; body < head.bodies; body++) {
    const from = 7 * body;
    poses.set(moment.poses.subarray(from, from + 3), 8 * (body + 1));
    poses.set(moment.poses.subarray(from + 3, from + 7), 8 * (body + 1) + 4);
  }
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, self.bodies);
  gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 2, head.bodies + 1, gl.RGBA, gl.FLOAT, poses);
  if (self.shaded) drawShadows(self);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.viewport(0, 0, width, height);
  gl.clearColor(0.93, 0.94, 0.945, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.activeTexture(gl.TEXTURE1);
  gl.bindTexture(gl.TEXTURE_2D, self.shadows.map);
  self.programs.forEach((each, number) => {
    gl.useProgram(each.program);
    tell(self, each.at, moment, look);
    gl.bindVertexArray(self.mesh.arrays[number + 1]);
    const [first, count] = self.ranges[number];
    gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 4 * first);
  });
}

/** Tell a program all that it may ask for; of what it does not know it takes no notice. */
function tell({ gl, head, rows, fine, shaded }, at, moment, look) {
  const { plane } = head;
  const joint = polar(moment.alpha, plane.s1);
  gl.uniformMatrix4fv(at("camera"), false, look.matrix);
  gl.uniformMatrix4fv(at("lamp"), false, LAMP);
  gl.uniform3fv(at("viewer"), look.place);
  gl.uniform1i(at("touched"), moment.touched);
  gl.uniform1i(at("shaded"), shaded ? 1 : 0);
  gl.uniform1i(at("fine"), fine ? 1 : 0);
  gl.uniform1i(at("bodies"), 0);
  gl.uniform1i(at("shadows"), 1);
  gl.uniform1f(at("scale"), plane.scale);
  gl.uniform2fv(at("joint"), joint);
  gl.uniform2fv(at("tip"), polar(moment.alpha + moment.beta, plane.s2, joint));
  gl.uniform2fv(at("way"), polar(moment.alpha, 1));
  const [middle, all] = plane.view.map((degrees) => polar(degrees, 1)[0] ** 2);
  gl.uniform4f(at("lens"), plane.cameraRange, middle, all, plane.cameraAtEnd ? 1 : 0);
  const rings = rows.flatMap((row, k) => {
    const [x, y] = moment.poses.subarray(7 * row, 7 * row + 2);
    return [x / plane.scale, y / plane.scale, (moment.touched >> k) & 1 ? plane.ring : 0];
  });
  gl.uniform3fv(at("rings"), rings);
}

/** First index and how many, of what every program draws: all but the table, the table, floor and wall. */
function ranges({ parts, triangles }) {
  const start = (kind) => 3 * parts.find((part) => part.kind === kind).first;
  const [table, floor] = [start("table"), start("floor")];
  return [[0, table], [table, floor - table], [floor, 3 * triangles - floor]];
}

/** The point at a bearing [deg] and a distance from another. */
function polar(degrees, far, [x, y] = [0, 0]) {
  const angle = (degrees * Math.PI) / 180;
  return [x + far * Math.cos(angle), y + far * Math.sin(angle)];
}

/** What the lamp does not reach. */
function drawShadows({ gl, shadows, shadowProgram, mesh }) {
  gl.activeTexture(gl.TEXTURE1);
  gl.bindTexture(gl.TEXTURE_2D, null);
  gl.bindFramebuffer(gl.FRAMEBUFFER, shadows.frame);
  gl.viewport(0, 0, shadows.size, shadows.size);
  gl.clear(gl.DEPTH_BUFFER_BIT);
  gl.useProgram(shadowProgram.program);
  gl.uniform1i(shadowProgram.at("bodies"), 0);
  gl.uniformMatrix4fv(shadowProgram.at("lamp"), false, LAMP);
  gl.bindVertexArray(mesh.arrays[0]);
  gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
}

/** Vertices and triangles on the card, with one list of attributes for each program. */
function buffers(gl, vertices, triangles, programs) {
  const data = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, data);
  gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.STATIC_DRAW);
  const indices = gl.createBuffer();
  const arrays = programs.map(({ program: used }, number) => {
    const list = gl.createVertexArray();
    gl.bindVertexArray(list);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
    if (number === 0) gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
    for (const [name, [size, offset]] of Object.entries(ATTRIBUTES)) {
      const place = gl.getAttribLocation(used, name);
      if (place < 0) continue;
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 4 * FLOATS_PER_VERTEX, 4 * offset);
    }
    return list;
  });
  return { arrays, count: triangles.length };
}

function shadowMap(gl, size) {
  const map = texture(gl, gl.DEPTH_COMPONENT24, size, size, gl.DEPTH_COMPONENT, gl.UNSIGNED_INT, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  const frame = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, map, 0);
  return { map, frame, size };
}

function texture(gl, inner, width, height, format, type, filter) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texImage2D(gl.TEXTURE_2D, 0, inner, width, height, 0, format, type, null);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  return made;
}

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  const places = new Map();
  const at = (name) => {
    if (!places.has(name)) places.set(name, gl.getUniformLocation(made, name));
    return places.get(name);
  };
  return { program: made, at };
}
