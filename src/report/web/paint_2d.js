/* Paints triangles without WebGL, from the farthest to the nearest: for browsers on machines
   without graphics. */

class Paint2d {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
  }

  setColours(colours) { this.colours = colours; }

  /* See PaintGl; `cut`: not every side of a triangle is an edge. */
  setPlaces(places, cut) { this.places = cut ? places : null; }

  /* See PaintGl. */
  draw(look, points, levels, lines, edges, ink) {
    const { canvas, context } = this, n = levels.length / 3;
    const half = canvas.height / 2, middle = canvas.width / 2;
    const seen = new Float32Array(points.length), depth = new Float32Array(n), order = new Uint32Array(n);
    for (let i = 0; i < points.length; i += 3) {
      const [x, y, away] = project(look, points[i], points[i + 1], points[i + 2]);
      seen[i] = middle + half * x, seen[i + 1] = half - half * y, seen[i + 2] = away;
    }
    for (let t = 0; t < n; t++)
      order[t] = t, depth[t] = seen[9 * t + 2] + seen[9 * t + 5] + seen[9 * t + 8];
    order.sort((a, b) => depth[b] - depth[a]);
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.lineWidth = 0.7;
    for (const t of order) {
      const light = this.light(look, points, 9 * t);
      const at = 4 * Math.round(255 * Math.max(0, Math.min(1, (levels[3 * t] + levels[3 * t + 1] + levels[3 * t + 2]) / 3)));
      const colour = (dim) => `rgb(${[0, 1, 2].map((c) => Math.round(dim * light * this.colours[at + c]))})`;
      context.beginPath();
      for (let k = 0; k < 3; k++) context.lineTo(seen[9 * t + 3 * k], seen[9 * t + 3 * k + 1]);
      context.closePath();
      context.fillStyle = colour(1);
      context.fill();
      context.strokeStyle = edges && !this.places ? colour(0.68) : context.fillStyle; /* which also closes gaps */
      context.stroke();
      if (edges && this.places) this.strokeEdges(t, seen, colour(0.68));
    }
    if (lines) this.drawLines(look, lines, ink, half, middle);
  }

  /* The sides of a triangle that are edges of its face. */
  strokeEdges(t, seen, colour) {
    const { context, places } = this;
    context.strokeStyle = colour;
    context.beginPath();
    for (let k = 0; k < 3; k++) {
      const a = 9 * t + 3 * k, b = 9 * t + 3 * ((k + 1) % 3);
      if (![0, 1, 2].some((c) => places[a + c] === 0 && places[b + c] === 0)) continue;
      context.moveTo(seen[a], seen[a + 1]);
      context.lineTo(seen[b], seen[b + 1]);
    }
    context.stroke();
  }

  drawLines(look, lines, ink, half, middle) {
    const context = this.context;
    context.strokeStyle = `rgba(${ink},0.5)`;
    context.beginPath();
    for (let i = 0; i < lines.length; i += 6) {
      const a = project(look, lines[i], lines[i + 1], lines[i + 2]);
      const b = project(look, lines[i + 3], lines[i + 4], lines[i + 5]);
      context.moveTo(middle + half * a[0], half - half * a[1]);
      context.lineTo(middle + half * b[0], half - half * b[1]);
    }
    context.stroke();
  }

  /* Of the face whose corners are nine numbers from `i` on. */
  light(look, p, i) {
    const a = [0, 1, 2].map((k) => p[i + 3 + k] - p[i + k]), b = [0, 1, 2].map((k) => p[i + 6 + k] - p[i + k]);
    const normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const size = Math.hypot(...normal) || 1, x = look.axes;
    const along = (r) => (x[r] * normal[0] + x[r + 1] * normal[1] + x[r + 2] * normal[2]) / size;
    return 0.55 + 0.45 * Math.min(1, Math.abs(0.25 * along(0) + 0.35 * along(3) + along(6)) / 1.089);
  }
}
