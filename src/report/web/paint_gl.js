/* Paints triangles with WebGL 2. */

const VERTEX_SHADER = `#version 300 es
in vec3 point, place;
in float colour;
uniform mat3 axes;
uniform vec3 center;
uniform vec2 pan;
uniform vec3 lens;   /* distance, focus, aspect */
uniform vec2 depth;  /* near, far */
out vec3 seen, corner;
out float level;
void main() {
  vec3 p = (point - center) * axes;  /* from the left: by the rows of axes */
  p.xy += pan;
  float away = lens.x - p.z;
  float d = (away * (depth.y + depth.x) - 2.0 * depth.y * depth.x) / (depth.y - depth.x);
  gl_Position = vec4(lens.y * p.x / lens.z, lens.y * p.y, d, away);
  seen = p;
  corner = place;
  level = colour;
}`;

const FRAGMENT_SHADER = `#version 300 es
precision highp float;
in vec3 seen, corner;
in float level;
uniform sampler2D map;
uniform vec4 flat_colour;  /* of lines; alpha 0: a face, by level */
uniform float edge;        /* 1: edges are drawn */
out vec4 result;
void main() {
  if (flat_colour.a > 0.0) { result = flat_colour; return; }
  vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
  float light = 0.55 + 0.45 * abs(dot(normal, normalize(vec3(0.25, 0.35, 1.0))));
  vec3 c = texture(map, vec2(level, 0.5)).rgb * light;
  vec3 width = fwidth(corner);
  vec3 near = smoothstep(vec3(0.0), 1.2 * width, corner);
  c = mix(c * 0.68, c, mix(1.0, min(near.x, min(near.y, near.z)), edge));
  result = vec4(c, 1.0);
}`;

class PaintGl {
  /* Throws where there is no WebGL 2. */
  constructor(canvas) {
    const gl = canvas.getContext('webgl2', { antialias: true, alpha: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error('no WebGL 2');
    this.gl = gl;
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX_SHADER], [gl.FRAGMENT_SHADER, FRAGMENT_SHADER]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, 'point');
    gl.bindAttribLocation(program, 1, 'colour');
    gl.bindAttribLocation(program, 2, 'place');
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    this.at = (name) => gl.getUniformLocation(program, name);
    this.buffers = [0, 1, 2, 3].map(() => gl.createBuffer());
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, 0);
  }

  setColours(colours) {
    const gl = this.gl;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, colours);
  }

  /* Of each corner, three numbers: where it is in its face, of which a side is an edge where one of
     them is 0 at both ends. */
  setPlaces(places) { this.places = places; }

  feed(index, buffer, data, size) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[buffer]);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(index);
    gl.vertexAttribPointer(index, size, gl.FLOAT, false, 0, 0);
  }

  /* points: three numbers a corner, levels: one from 0 to 1; lines (or null): six numbers each. */
  draw(look, points, levels, lines, edges, ink) {
    const gl = this.gl;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix3fv(this.at('axes'), false, look.axes);
    gl.uniform3fv(this.at('center'), look.center);
    gl.uniform2fv(this.at('pan'), look.pan);
    gl.uniform3f(this.at('lens'), look.distance, look.focus, look.aspect);
    gl.uniform2f(this.at('depth'), look.near, look.far);
    gl.uniform1f(this.at('edge'), edges ? 1 : 0);
    gl.uniform4f(this.at('flat_colour'), 0, 0, 0, 0);
    this.feed(0, 0, points, 3);
    this.feed(1, 1, levels, 1);
    if (this.places) this.feed(2, 3, this.places, 3);
    this.places = null; /* they stay in their buffer */
    gl.enableVertexAttribArray(2);
    gl.drawArrays(gl.TRIANGLES, 0, levels.length);
    if (!lines) return;
    gl.uniform4f(this.at('flat_colour'), ...ink.map((c) => c / 255 * 0.5), 0.5);
    this.feed(0, 2, lines, 3);
    gl.disableVertexAttribArray(1);
    gl.disableVertexAttribArray(2);
    gl.drawArrays(gl.LINES, 0, lines.length / 3);
  }
}
