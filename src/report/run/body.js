/* The moving body: turned by dragging, played over time, coloured by a field. */

/* Colours from low to high, and about a centre; both are told apart in grey and by most eyes. */
const RISING = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129],
                [92, 200, 99], [170, 220, 50], [253, 231, 37]];
const PARTING = [[33, 102, 172], [103, 169, 207], [209, 229, 240], [247, 247, 247], [253, 219, 199],
                 [239, 138, 98], [178, 24, 43]];

function colourTable(stops) {
  const table = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; i++) {
    const at = i / 255 * (stops.length - 1), k = Math.min(stops.length - 2, Math.floor(at));
    for (let c = 0; c < 3; c++) table[4 * i + c] = Math.round(stops[k][c] + (at - k) * (stops[k + 1][c] - stops[k][c]));
    table[4 * i + 3] = 255;
  }
  return table;
}

class Body {
  constructor(figure, data) {
    this.figure = figure;
    this.nodes = data.nodes;
    this.faces = new Faces(data.corners, data.middles);
    this.rest = Float64Array.from(data.rest);
    this.t = doubles(data.t);
    this.moved = [data.ux, data.uy, data.uz].map((u) => this.open(u, true));
    this.fields = [this.displacement(), ...data.fields.map((f) => ({ ...f, ...this.open(f.data, f.nodal) }))];
    this.fields.forEach((f) => this.findRange(f));
    this.name = data.clock;
    this.frame = 0, this.exaggeration = 1, this.drawn = 0, this.playing = false;
    this.points = new Float32Array(9 * this.faces.triangles);
    this.values = new Float64Array(3 * this.faces.triangles);
    this.levels = new Float32Array(3 * this.faces.triangles);
    this.position = new Float32Array(3 * this.nodes);
    this.camera = new Camera(...this.bounds());
    this.restLines = this.faces.outline(this.rest);
    this.build(data);
    this.choose(Math.max(0, this.fields.findIndex((f) => f.name === 'von Mises stress')));
    this.show(this.furthest());
    timeline.listeners.push((t) => this.show(nearest(this.t, t)));
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
  }

  open(data, nodal) {
    const { count, middles } = this.faces; /* what is a tet's has one value a face, or one a corner */
    return { low: data.low, step: data.step, q: words(data.q), count: nodal ? this.nodes : middles ? 3 * count : count };
  }

  /* Its size follows from what is there. */
  displacement() {
    const n = this.nodes, [x, y, z] = this.moved, values = new Float32Array(n * this.t.length);
    for (let i = 0; i < values.length; i++)
      values[i] = Math.hypot(x.low + x.step * x.q[i], y.low + y.step * y.q[i], z.low + z.step * z.q[i]);
    return { name: 'displacement', unit: 'm', nodal: true, centre: null, low: 0, step: 1, q: values, count: n };
  }

  /* The frame of the largest displacement, where the page opens; the first, if there are several. */
  furthest() {
    const { q, count } = this.fields[0];
    let best = 0;
    for (let i = 0; i < q.length; i++) if (q[i] > q[best]) best = i;
    return Math.floor(best / count);
  }

  /* [low, high] over the frames from `first` to before `end`. */
  extent(f, first, end) {
    let low = Infinity, high = -Infinity;
    for (let i = first * f.count; i < end * f.count; i++) {
      if (f.q[i] < low) low = f.q[i];
      if (f.q[i] > high) high = f.q[i];
    }
    return [f.low + f.step * low, f.low + f.step * high];
  }

  findRange(f) { f.range = this.spread(f, this.extent(f, 0, this.t.length)); }

  spread(f, [low, high]) {
    if (f.centre === null) return [Math.min(0, low), high > low ? high : low + 1];
    const most = Math.max(high - f.centre, f.centre - low) || 1;
    return [f.centre - most, f.centre + most];
  }

  bounds() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let k = 0; k < this.t.length; k++) {
      for (let i = 0; i < this.nodes; i++) {
        for (let c = 0; c < 3; c++) {
          const u = this.moved[c], x = this.rest[3 * i + c] + u.low + u.step * u.q[k * this.nodes + i];
          if (x < low[c]) low[c] = x;
          if (x > high[c]) high[c] = x;
        }
      }
    }
    return [low, high];
  }

  build(data) {
    const bar = element('div', { class: 'controls' }, this.figure);
    const label = element('label', {}, bar, 'Colour: ');
    this.select = element('select', { id: 'field' }, label);
    this.fields.forEach((f, k) => element('option', { value: k }, this.select, f.name));
    this.select.onchange = () => this.choose(+this.select.value);
    const box = (text, checked) => {
      const holder = element('label', {}, bar);
      const input = element('input', { type: 'checkbox' }, holder);
      input.checked = checked;
      holder.append(' ' + text);
      input.onchange = () => this.draw();
      return input;
    };
    this.edges = box('edges', true);
    this.still = box('shape at rest', false);
    this.own = box("scale by frame", false);
    this.marked = data.supports || data.loads ? box('supports and loads', true) : null;
    this.exaggerate = element('select', { id: 'exaggeration' }, element('label', {}, bar, 'Motion: '));
    for (const factor of [1, 2, 5, 10, 100, 1000]) element('option', { value: factor }, this.exaggerate, '× ' + factor);
    this.exaggerate.onchange = () => { this.exaggeration = +this.exaggerate.value; this.show(this.frame); };
    this.buildView(data);
    this.buildPlayer();
  }

  buildView(data) {
    const stage = element('div', { class: 'stage' }, this.figure);
    this.canvas = element('canvas', { tabindex: 0, role: 'img', 'aria-label':
      'the body; arrow keys turn it, + and - scale it, space plays' }, stage);
    this.marks = this.marked ? new Marks(stage, this.figure, data, this) : null;
    this.triad = svgElement('svg', { class: 'triad', viewBox: '-30 -30 60 60', width: 60, height: 60 }, stage);
    this.scale = element('div', { class: 'scale' }, stage);
    this.tip = element('div', { class: 'tip', hidden: '' }, stage);
    const home = element('button', { type: 'button', class: 'reset' }, stage, 'reset view');
    home.onclick = () => { this.camera.reset(); this.draw(); };
    try {
      this.paint = new PaintGl(this.canvas);
    } catch (error) {
      this.paint = new Paint2d(this.canvas);
    }
    this.paint.setPlaces(this.faces.places, this.faces.cuts > 1);
    this.listen();
  }

  buildPlayer() {
    const bar = element('div', { class: 'player' }, this.figure);
    this.button = element('button', { type: 'button', id: 'play' }, bar, '▶ play');
    this.button.onclick = () => this.play(!this.playing);
    this.button.hidden = this.name !== 't' || this.t.length < 2;
    this.slider = element('input', { type: 'range', id: 'frame', min: 0, max: this.t.length - 1, value: 0,
                                     'aria-label': 'frame' }, bar);
    this.slider.hidden = this.t.length < (this.name === 't' ? 2 : 3); /* of one load step */
    this.slider.oninput = () => { this.play(false); this.show(+this.slider.value); };
    this.clock = element('output', {}, bar);
    /* at forty frames a second, but not over in no time; in its own time if that is about it */
    const length = this.t[this.t.length - 1] - this.t[0];
    this.rate = length / Math.max(3, this.t.length / 40);
    if (this.rate > 0.8 && this.rate < 1.25) this.rate = 1;
    this.pace = this.rate === 1 ? '' : ` (× ${+this.rate.toPrecision(2)})`;
  }

  choose(k) {
    this.select.value = k;
    this.field = this.fields[k];
    const table = colourTable(this.field.centre === null ? RISING : PARTING);
    this.paint.setColours(table);
    this.gradient = [0, 36, 73, 109, 146, 182, 219, 255].map((i) => `rgb(${table.subarray(4 * i, 4 * i + 3)})`);
    this.draw();
  }

  drawScale([low, high]) {
    const axis = new Axis(low, high, false), { name, unit } = this.field;
    const key = [name, low, high].join();
    if (key === this.scaleKey) return;
    this.scaleKey = key;
    this.scale.textContent = '';
    element('div', {}, this.scale, unit === '1' ? name : `${name} [${unit}]`);
    const strip = element('div', { class: 'strip' }, this.scale);
    strip.style.background = `linear-gradient(to right, ${this.gradient})`;
    const marks = element('div', { class: 'marks' }, this.scale);
    for (const tick of axis.ticks(4))
      element('span', {}, marks, tick.label).style.left = 100 * axis.place(tick.at) + '%';
  }

  show(frame) {
    this.frame = frame;
    this.slider.value = frame;
    this.clock.textContent = this.name === 't' ? `t = ${plain(this.t[frame])} s${this.playing ? this.pace : ''}`
                                               : `${this.name} = ${plain(this.t[frame])}`;
    const n = this.nodes, k = frame * n, more = this.exaggeration;
    for (let c = 0; c < 3; c++) {
      const { low, step, q } = this.moved[c];
      for (let i = 0; i < n; i++) this.position[3 * i + c] = this.rest[3 * i + c] + more * (low + step * q[k + i]);
    }
    const { faces, position, points } = this;
    for (let c = 0; c < 3; c++)
      faces.spread((i, x) => { points[3 * i + c] = x; },
                   (face, at) => faces.nodal(face, at, (node) => position[3 * node + c]));
    this.draw();
    timeline.show(this.t[frame]);
  }

  /* The field's values at the corners to paint. */
  evaluate() {
    const { faces, values } = this, { low, step, q, count, nodal } = this.field, from = this.frame * count;
    const of = (i) => low + step * q[from + i];
    faces.spread((i, x) => { values[i] = x; },
                 nodal ? (face, at) => faces.nodal(face, at, of)
                       : faces.middles ? (face, at) => faces.linear(face, at, of) : of);
  }

  draw() {
    const { canvas } = this, width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !this.field) return;
    const fine = Math.min(2, devicePixelRatio || 1);
    if (canvas.width !== Math.round(width * fine)) canvas.width = Math.round(width * fine);
    if (canvas.height !== Math.round(height * fine)) canvas.height = Math.round(height * fine);
    const range = this.own.checked ? this.spread(this.field, this.extent(this.field, this.frame, this.frame + 1))
                                   : this.field.range;
    this.evaluate();
    for (let i = 0; i < this.levels.length; i++) this.levels[i] = (this.values[i] - range[0]) / (range[1] - range[0]);
    const look = this.look = this.camera.look(width, height);
    const ink = getComputedStyle(canvas).color.match(/\d+/g).slice(0, 3).map(Number);
    this.paint.draw(look, this.points, this.levels, this.still.checked ? this.restLines : null,
                    this.edges.checked, ink);
    if (this.marks) this.marks.draw(look, this.marked.checked);
    this.drawScale(range);
    this.drawTriad(look.axes);
    this.drawn++;
  }

  drawTriad(a) {
    this.triad.textContent = '';
    ['x', 'y', 'z'].forEach((name, i) => {
      const x = 20 * a[i], y = -20 * a[3 + i];
      svgElement('path', { d: `M0 0L${x.toFixed(1)} ${y.toFixed(1)}` }, this.triad);
      svgElement('text', { x: (1.3 * x).toFixed(1), y: (1.3 * y + 4).toFixed(1), 'text-anchor': 'middle' }, this.triad, name);
    });
  }

  play(on) {
    this.playing = on;
    this.button.textContent = on ? '❚❚ pause' : '▶ play';
    if (!on) return;
    const end = this.t[this.t.length - 1];
    const from = this.frame === this.t.length - 1 ? this.t[0] : this.t[this.frame];
    let began = null;
    const step = (now) => {
      if (!this.playing) return;
      if (began === null) began = now;
      const t = from + this.rate * (now - began) / 1000;
      const frame = nearest(this.t, Math.min(t, end));
      if (frame !== this.frame) this.show(frame);
      if (t >= end) this.play(false);
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  listen() {
    const { canvas, camera } = this, pointers = new Map();
    canvas.onpointerdown = (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
    };
    canvas.onpointermove = (event) => {
      const before = pointers.get(event.pointerId), now = [event.clientX, event.clientY];
      if (!before) return this.point(event);
      const size = canvas.clientHeight, dx = (now[0] - before[0]) / size, dy = (now[1] - before[1]) / size;
      pointers.set(event.pointerId, now);
      if (pointers.size === 2) {
        const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
        const span = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
        camera.scale(span(now) / span(before));
      }
      if (pointers.size === 2 || event.shiftKey || event.buttons & 6) {
        camera.pan[0] += 2.2 * dx / camera.zoom, camera.pan[1] -= 2.2 * dy / camera.zoom;
      } else camera.turn(-4 * dx, 4 * dy);
      this.draw();
    };
    canvas.onpointerup = canvas.onpointercancel = (event) => pointers.delete(event.pointerId);
    canvas.onpointerleave = () => { this.tip.hidden = true; };
    canvas.oncontextmenu = (event) => event.preventDefault();
    canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && document.activeElement !== canvas) return; /* the page scrolls */
      event.preventDefault();
      camera.scale(Math.pow(1.001, -event.deltaY));
      this.draw();
    }, { passive: false });
    canvas.onkeydown = (event) => {
      const act = {
        ArrowLeft: () => camera.turn(0.1, 0), ArrowRight: () => camera.turn(-0.1, 0),
        ArrowUp: () => camera.turn(0, 0.1), ArrowDown: () => camera.turn(0, -0.1),
        '+': () => camera.scale(1.2), '-': () => camera.scale(1 / 1.2), 0: () => camera.reset(),
        ' ': () => this.play(!this.playing && this.name === 't'),
      }[event.key];
      if (!act) return;
      event.preventDefault();
      act();
      this.draw();
    };
  }

  /* The field's value under the pointer: of the nearest triangle there. */
  point(event) {
    const box = this.canvas.getBoundingClientRect();
    const px = event.clientX - box.left, py = event.clientY - box.top;
    const x = (2 * px - box.width) / box.height, y = 1 - 2 * py / box.height;
    let best = -1, depth = Infinity;
    for (let i = 0; i < this.levels.length; i += 3) {
      const away = this.hit(i, x, y);
      if (away < depth) depth = away, best = i;
    }
    this.tip.hidden = best < 0;
    if (best < 0) return;
    const f = this.field, mean = (this.values[best] + this.values[best + 1] + this.values[best + 2]) / 3;
    this.tip.textContent = `${f.name} ${plain(+mean.toPrecision(4))}${f.unit === '1' ? '' : ' ' + f.unit}`;
    this.tip.style.left = Math.min(px + 12, box.width - this.tip.offsetWidth) + 'px';
    this.tip.style.top = Math.max(0, py - 30) + 'px';
  }

  /* How far away triangle i is where the pointer is; Infinity: elsewhere. */
  hit(i, x, y) {
    const p = [];
    for (let k = 3 * i; k < 3 * i + 9; k += 3)
      p.push(project(this.look, this.points[k], this.points[k + 1], this.points[k + 2]));
    const side = (a, b) => (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    const s = [side(p[0], p[1]), side(p[1], p[2]), side(p[2], p[0])];
    if (!(s.every((v) => v >= 0) || s.every((v) => v <= 0))) return Infinity;
    return (p[0][2] + p[1][2] + p[2][2]) / 3;
  }
}
