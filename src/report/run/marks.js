/* Supports and loads, drawn over the body: crosses along the components that are held, diamonds on
   supports that move, arrows of the loads as they are at the moment that is shown. */

const LOAD_COLOURS = ['--c1', '--c3', '--c6', '--c2', '--c4'];
const SUPPORT_COLOURS = ['--ink', '--c5'];
/* Arrows are at most so long, in radii of the body; that of a load on the whole body is in its
   middle, and longer to be seen there. */
const ARROW = 0.28, WHOLE_ARROW = 0.5;

class Marks {
  constructor(stage, after, data, body) {
    this.body = body;
    this.supports = data.supports || [], this.loads = data.loads || [];
    this.loads.forEach((l) => { l.most = Math.max(...(l.factor || [1]).map(Math.abs)) || 1; });
    this.canvas = element('canvas', { class: 'overlay', 'aria-hidden': 'true' }, stage);
    this.findTriangles();
    this.buildKey(after);
  }

  /* Of each node with a mark, the faces that have it: their numbers in `corners`. */
  findTriangles() {
    const { corners, middles } = this.body.faces;
    this.around = new Map();
    for (const s of [...this.supports.map((s) => s.nodes), ...this.loads.map((l) => l.at)])
      for (const node of s) this.around.set(node, []);
    const enter = (node, i) => { if (this.around.has(node)) this.around.get(node).push(3 * Math.floor(i / 3)); };
    corners.forEach(enter);
    if (middles) middles.forEach(enter);
  }

  buildKey(after) {
    this.key = element('ul', { class: 'key conditions', id: 'conditions' }, after);
    const entry = (text, colour, icon) => {
      const item = element('li', {}, this.key);
      const key = svgElement('svg', { width: 22, height: 14, viewBox: '-11 -7 22 14' }, item);
      svgElement('path', { d: icon, style: `stroke:var(${colour});fill:${icon.endsWith('z') ? `var(${colour})` : 'none'}` }, key);
      item.append(text);
      return element('span', {}, item);
    };
    this.supports.forEach((s) => entry(s.text, SUPPORT_COLOURS[+s.moving],
                                       s.moving ? 'M0-5L5 0L0 5L-5 0z' : 'M-5 0H5M0-5V5M-3.5 3.5L3.5-3.5'));
    this.factors = this.loads.map((l, k) => entry(l.text, LOAD_COLOURS[k % 5], 'M-10-.5H3V-4L10 0L3 4V.5H-10z'));
    if (!this.key.childElementCount) element('li', {}, this.key, 'no supports, no loads');
  }

  /* The normal of the face that begins at corner i, flat between its corners, of the length of twice its area. */
  normal(i) {
    const { faces: { corners }, position } = this.body, p = [0, 1, 2].map((k) => 3 * corners[i + k]);
    const a = [0, 1, 2].map((c) => position[p[1] + c] - position[p[0] + c]);
    const b = [0, 1, 2].map((c) => position[p[2] + c] - position[p[0] + c]);
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  }

  /* The mean normal about some nodes, and whether any of their triangles faces the eye. */
  facing(nodes) {
    const towards = this.look.axes.slice(6), sum = [0, 0, 0];
    let seen = false;
    for (const node of nodes) {
      for (const i of this.around.get(node)) {
        const n = this.normal(i);
        if (n.reduce((s, x, c) => s + x * towards[c], 0) > 0) seen = true;
        n.forEach((x, c) => { sum[c] += x; });
      }
    }
    const size = Math.hypot(...sum) || 1;
    return { seen, normal: sum.map((x) => x / size) };
  }

  /* Of a node, or of the face with these three. */
  middle(nodes) {
    const { faces, position } = this.body, has = (i, node) => faces.corners.subarray(i, i + 3).includes(node);
    const face = nodes.length < 3 ? undefined
      : this.around.get(nodes[0]).find((i) => nodes.every((node) => has(i, node)));
    if (face !== undefined) return faces.middle(position, face);
    return [0, 1, 2].map((c) => nodes.reduce((s, n) => s + position[3 * n + c], 0) / nodes.length);
  }

  factor(load) { return load.factor ? load.factor[this.body.frame] : 1; }

  draw(look, shown) {
    const { canvas, body } = this, context = canvas.getContext('2d');
    this.key.hidden = canvas.hidden = !shown;
    if (!shown) return;
    canvas.width = body.canvas.width, canvas.height = body.canvas.height;
    this.look = look, this.context = context;
    this.fine = canvas.width / body.canvas.clientWidth;
    const style = getComputedStyle(body.canvas);
    this.colour = (name) => style.getPropertyValue(name);
    context.lineCap = context.lineJoin = 'round';
    for (const s of this.supports) for (const node of s.nodes) this.drawSupport(s, node);
    this.loads.forEach((load, k) => this.drawLoad(load, LOAD_COLOURS[k % 5]));
    this.loads.forEach((load, k) => {
      this.factors[k].textContent = load.factor && new Set(load.factor).size > 1
        ? `, × ${plain(+this.factor(load).toPrecision(3))} now` : '';
    });
  }

  /* To pixels of the canvas, and the distance. */
  place(p) {
    const { canvas } = this, half = canvas.height / 2, [x, y, away] = project(this.look, ...p);
    return [canvas.width / 2 + half * x, half - half * y, away];
  }

  /* A path with a rim of the paper's colour, so that it is seen on any colour; faint: behind. */
  stroke(colour, seen, filled) {
    const { context, fine } = this;
    context.globalAlpha = seen ? 1 : 0.25;
    context.strokeStyle = this.colour('--paper');
    context.lineWidth = 4 * fine;
    context.stroke();
    context.strokeStyle = context.fillStyle = this.colour(colour);
    context.lineWidth = 1.8 * fine;
    context.stroke();
    if (filled) context.fill();
    context.globalAlpha = 1;
  }

  drawSupport(support, node) {
    const { context, fine, look, canvas } = this, p = this.middle([node]), [x, y, away] = this.place(p);
    const size = 6 * fine, { seen } = this.facing([node]);
    context.beginPath();
    if (support.moving) {
      for (const [dx, dy] of [[0, -1], [1, 0], [0, 1], [-1, 0]]) context.lineTo(x + 0.8 * size * dx, y + 0.8 * size * dy);
      context.closePath();
    } else {
      const length = size * 2 * away / (look.focus * canvas.height);
      support.held.forEach((held, c) => {
        if (!held) return;
        for (const sign of [-1, 1]) {
          const [ex, ey] = this.place(p.map((v, i) => v + (i === c ? sign * length : 0)));
          if (sign < 0) context.moveTo(ex, ey);
          else context.lineTo(ex, ey);
        }
      });
    }
    this.stroke(SUPPORT_COLOURS[+support.moving], seen, support.moving);
  }

  drawLoad(load, colour) {
    const factor = this.factor(load) / load.most, { radius } = this.body.camera;
    if (load.whole) {
      const all = this.body.position, n = all.length / 3, from = [0, 0, 0];
      for (let i = 0; i < all.length; i++) from[i % 3] += all[i] / n;
      this.drawArrow(from, load.vector, WHOLE_ARROW * radius * factor, false, colour, true);
    }
    for (let i = 0; i < load.at.length; i += 3) {
      const nodes = [...new Set(load.at.slice(i, i + 3))], { seen, normal } = this.facing(nodes);
      const along = load.vector === 'in' ? normal.map((x) => -x) : load.vector === 'out' ? normal : load.vector;
      const inward = factor * along.reduce((s, x, c) => s + x * normal[c], 0) < 0;
      this.drawArrow(this.middle(nodes), along, ARROW * radius * factor, inward, colour, seen);
    }
  }

  /* From a point, or to it, `length` along a direction; without length a dot. */
  drawArrow(point, direction, length, ends, colour, seen) {
    const { context, fine } = this, size = Math.hypot(...direction) || 1;
    const other = point.map((x, c) => x + (ends ? -1 : 1) * length * direction[c] / size);
    const [from, to] = (ends ? [other, point] : [point, other]).map((p) => this.place(p));
    const dx = to[0] - from[0], dy = to[1] - from[1], reach = Math.hypot(dx, dy);
    context.beginPath();
    if (reach < 3 * fine) {
      context.arc(from[0], from[1], 2 * fine, 0, 7);
      this.stroke(colour, seen, true);
      return;
    }
    const head = Math.min(9 * fine, 0.6 * reach), ux = dx / reach, uy = dy / reach;
    const neck = [to[0] - head * ux, to[1] - head * uy];
    context.moveTo(from[0], from[1]);
    context.lineTo(...neck);
    context.moveTo(to[0], to[1]);
    context.lineTo(neck[0] - 0.45 * head * uy, neck[1] + 0.45 * head * ux);
    context.lineTo(neck[0] + 0.45 * head * uy, neck[1] - 0.45 * head * ux);
    context.closePath();
    this.stroke(colour, seen, true);
  }
}
