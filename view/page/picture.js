// The picture: the walk in a fragment shader into a texture of floats, and from there to the
// screen. Coarse while something moves; in strips at full resolution when nothing does, and then
// more rays a pixel, so that edges become smooth.

const WIDTH = 2048;    // of the tables' textures [texel]
const MOST_RAYS = 16;  // a pixel of a picture at rest
const FRAME_MS = 40;   // that a frame in motion may take
const STRIP_MS = 60;   // and a strip of one at rest
const UNIFORMS = [
  'zones',      'nodes',        'walls',        'patches', 'pieces', 'rows',
  'eye',        'forward',      'right',        'up',      'size',   'shift',
  'hull_min',   'hull_max',     'environment',  'layers',  'medium', 'clip',
  'clip_plane', 'clip_colours', 'colour_scale', 'inside',  'start'
];

function compile(gl, vertex, fragment, defines) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, `#version 300 es\n${defines}\n${source}`);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
      throw new Error(`The shader cannot be compiled: ${gl.getShaderInfoLog(shader)}`);
    gl.attachShader(program, shader);
  }
  gl.bindAttribLocation(program, 0, 'corner');
  gl.bindAttribLocation(program, 1, 'zone');
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS))
    throw new Error(`The shaders cannot be linked: ${gl.getProgramInfoLog(program)}`);
  return program;
}

const locations = (gl, program, names) =>
    Object.fromEntries(names.map((name) => [name, gl.getUniformLocation(program, name)]));

class Picture {
  constructor(canvas, tables, meta, sources) {
    const gl = this.gl = canvas.getContext(
        'webgl2', {alpha: false, antialias: false, depth: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error('This browser has no WebGL2.');
    this.float = gl.getExtension('EXT_color_buffer_float') !== null;
    if (!this.float)
      throw new Error('This graphics driver cannot draw into floating-point pictures.');
    this.adds = gl.getExtension('EXT_float_blend') !== null;
    this.canvas = canvas;
    this.meta = meta;
    this.walker = new Walker(tables, meta.environment);
    const defines = `#define BANDS ${tables.bands}\n#define VARYING ${tables.varying ? 1 : 0}\n` +
        `#define WIDTH ${WIDTH}`;
    this.walk = compile(gl, sources.walk_vert, sources.walk_frag, defines);
    this.walkAt = locations(gl, this.walk, UNIFORMS);
    this.display = compile(gl, sources.walk_vert, sources.display_frag, '');
    this.displayAt = locations(
        gl, this.display, ['inside', 'light', 'elements', 'scale', 'per_white', 'curve', 'edges']);
    this.uploadTables(tables);
    this.uploadHull(tables);
    this.perMs = 100;  // pixels that are drawn in a millisecond, as measured; few, to begin with
    this.targets = {};
  }

  table(values) {
    const gl = this.gl, texels = values.length / 4, rows = Math.ceil(texels / WIDTH);
    if (rows > gl.getParameter(gl.MAX_TEXTURE_SIZE))
      throw new Error('The solution has more elements than this graphics driver can hold.');
    const whole = new Float32Array(4 * rows * WIDTH);
    whole.set(values);
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, WIDTH, rows, 0, gl.RGBA, gl.FLOAT, whole);
    this.nearest();
    return texture;
  }

  nearest() {
    const gl = this.gl;
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T])
      gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
  }

  uploadTables(tables) {
    const gl = this.gl;
    gl.useProgram(this.walk);
    this.tables = ['zones', 'nodes', 'walls', 'patches', 'pieces', 'rows'].map((name, unit) => {
      gl.uniform1i(this.walkAt[name], unit);
      return this.table(tables[name]);
    });
  }

  // What changes with the mesh that is shown (Tables.showMesh).
  uploadMesh(tables) {
    for (const [name, unit] of [['zones', 0], ['pieces', 4]]) {
      this.gl.deleteTexture(this.tables[unit]);
      this.gl.activeTexture(this.gl.TEXTURE0 + unit);
      this.tables[unit] = this.table(tables[name]);
    }
  }

  uploadHull(tables) {
    const gl = this.gl;
    this.hull = gl.createVertexArray();
    this.hullCount = tables.hullCorners.length / 3;
    gl.bindVertexArray(this.hull);
    const zones =
        new Float32Array(this.hullCount).map((_, i) => tables.hullZones[Math.floor(i / 3)]);
    [[tables.hullCorners, 3], [zones, 1]].forEach(([values, size], place) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 0);
    });
  }

  // A picture of floats, and one of elements' numbers; made anew if the size changes.
  target(name, width, height) {
    const gl = this.gl, old = this.targets[name];
    if (old && old.width === width && old.height === height) return old;
    if (old) [old.light, old.elements].forEach((texture) => gl.deleteTexture(texture));
    const made = {width, height, frame: gl.createFramebuffer(), more: gl.createFramebuffer()};
    const texture = (format) => {
      const made = gl.createTexture();
      gl.activeTexture(gl.TEXTURE6);
      gl.bindTexture(gl.TEXTURE_2D, made);
      gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
      this.nearest();
      return made;
    };
    made.light = texture(gl.RGBA32F);
    made.elements = texture(gl.R32UI);
    gl.bindFramebuffer(gl.FRAMEBUFFER, made.frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, made.light, 0);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT1, gl.TEXTURE_2D, made.elements, 0);
    gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, made.more);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, made.light, 0);
    return this.targets[name] = made;
  }

  isInside(eye) {
    const {hull_min: low, hull_max: high} = this.meta;
    return eye.every((x, k) => x > low[k] && x < high[k]);
  }

  setUniforms(frame, look, width, height) {
    const gl = this.gl, u = this.walkAt, bands = this.meta.bands;
    const inside = this.isInside(frame.eye);
    for (const name of ['eye', 'forward', 'right', 'up']) gl.uniform3fv(u[name], frame[name]);
    gl.uniform2f(u.size, width, height);
    gl.uniform3fv(u.hull_min, this.meta.hull_min);
    gl.uniform3fv(u.hull_max, this.meta.hull_max);
    gl.uniform1fv(u.environment, this.meta.environment.slice(0, bands));
    gl.uniform1fv(u.layers, look.layers);
    gl.uniform1i(u.medium, look.medium);
    gl.uniform1i(u.clip, look.clip !== null);
    gl.uniform4fv(u.clip_plane, look.clip || [0, 0, 0, 0]);
    gl.uniform1i(u.clip_colours, look.colours);
    gl.uniform3fv(u.colour_scale, look.scale);
    gl.uniform1i(u.inside, inside);
    gl.uniform1i(u.start, inside ? this.walker.zoneAt(frame.eye) : -1);
    return inside;
  }

  // Rows `from` to `to`, counted from the bottom, of a picture; `sample`: which of its rays.
  draw(target, frame, look, sample = 0, from = 0, to = target.height) {
    const gl = this.gl;
    gl.useProgram(this.walk);
    this.tables.forEach((texture, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
    });
    const inside = this.setUniforms(frame, look, target.width, target.height);
    const spread = (k) => (0.5 + sample * k) % 1 - 0.5;
    gl.uniform2f(this.walkAt.shift, sample && spread(0.7548776662), sample && spread(0.5698402910));
    gl.bindFramebuffer(gl.FRAMEBUFFER, sample ? target.more : target.frame);
    gl.viewport(0, 0, target.width, target.height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, from, target.width, to - from);
    if (sample) {
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE);
    }
    gl.bindVertexArray(this.hull);
    if (inside) {
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    } else {
      this.drawAround();
      gl.enable(gl.CULL_FACE);
      gl.drawArrays(gl.TRIANGLES, 0, this.hullCount);
      gl.disable(gl.CULL_FACE);
    }
    gl.disable(gl.BLEND);
    gl.disable(gl.SCISSOR_TEST);
  }

  // What is seen beside the hull: the environment. Where the hull is in front it is not counted.
  drawAround() {
    const gl = this.gl;
    if (gl.isEnabled(gl.BLEND)) return;
    const mean = this.meta.environment.reduce((a, b) => a + b, 0) / this.meta.bands;
    const seen = this.meta.bands === 3 ? this.meta.environment : [mean, mean, mean];
    gl.clearBufferfv(gl.COLOR, 0, [...seen, 1]);
    gl.clearBufferuiv(gl.COLOR, 1, [0, 0, 0, 0]);
  }

  // Waits until the GPU is done, and says how long that took [ms].
  finish(began) {
    const gl = this.gl;
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.FLOAT, new Float32Array(4));
    return Math.max(0.2, performance.now() - began);
  }

  timed(pixels, work) {
    const began = performance.now();
    work();
    const speed = pixels / this.finish(began);
    this.perMs = 0.5 * this.perMs + 0.5 * speed;
  }

  // Onto the screen; rows from `above` on, counted from the bottom.
  show(target, look, above = 0) {
    const gl = this.gl, {width, height} = this.canvas;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.useProgram(this.display);
    gl.activeTexture(gl.TEXTURE6);
    gl.bindTexture(gl.TEXTURE_2D, target.light);
    gl.activeTexture(gl.TEXTURE7);
    gl.bindTexture(gl.TEXTURE_2D, target.elements);
    const u = this.displayAt;
    gl.uniform1i(u.inside, 1);
    gl.uniform1i(u.light, 6);
    gl.uniform1i(u.elements, 7);
    gl.uniform2f(u.scale, target.width / width, target.height / height);
    gl.uniform1f(u.per_white, 1 / look.white);
    gl.uniform1i(u.curve, look.curve);
    gl.uniform1i(u.edges, look.edges);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, above, width, height - above);
    gl.bindVertexArray(this.hull);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.disable(gl.SCISSOR_TEST);
  }

  // A picture in motion: as coarse as it must be.
  drawMoving(frame, look) {
    const {width, height} = this.canvas;
    const fit = Math.sqrt(FRAME_MS * this.perMs / (width * height));
    const part = fit >= 1 ? 1 : Math.max(1 / 8, Math.floor(8 * fit) / 8);
    const target = this.target('coarse', Math.ceil(part * width), Math.ceil(part * height));
    this.timed(target.width * target.height, () => this.draw(target, frame, look));
    this.show(target, look);
    this.rest = {sample: 0, row: height};
    if (part < 1) return;
    this.targets = {coarse: this.targets.full, full: target};
    this.rest.sample = 1;
  }

  // The next strip of a picture at rest, from the top; false: it is as good as it gets.
  drawStrip(frame, look) {
    const {width, height} = this.canvas, rest = this.rest;
    const most = this.adds ? look.rays : 1;
    if (!rest || rest.sample >= most) return false;
    const target = this.target('full', width, height);
    const rows = Math.max(4, Math.floor(STRIP_MS * this.perMs / width));
    const from = Math.max(0, rest.row - rows);
    this.timed(
        width * (rest.row - from),
        () => this.draw(target, frame, look, rest.sample, from, rest.row));
    rest.row = from;
    if (rest.sample === 0) this.show(target, look, from);
    if (from > 0) return true;
    this.show(target, look);
    rest.row = height;
    return ++rest.sample < most;
  }

  // The same numbers in another dress: exposure, curve, edges.
  showAgain(look) {
    if (!this.rest) return;
    if (this.rest.sample > 0) return this.show(this.targets.full, look);
    this.show(this.targets.coarse, look);
    if (this.rest.row < this.canvas.height) this.show(this.targets.full, look, this.rest.row);
  }

  // The numbers of a picture, from the bottom.
  read(target) {
    const gl = this.gl, values = new Float32Array(4 * target.width * target.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    gl.readPixels(0, 0, target.width, target.height, gl.RGBA, gl.FLOAT, values);
    return values;
  }
}
