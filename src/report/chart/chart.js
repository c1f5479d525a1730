/* Charts: SVG drawn to the width there is, with values under the pointer, and zoom. */

const MARKS = [
  'M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z', 'M-3.6-3.6h7.2v7.2h-7.2z', 'M0-4.8l4.4 7.8h-8.8z',
  'M0-5l5 5l-5 5l-5-5z', 'M0 4.8l4.4-7.8h-8.8z',
  'M-4.2-1.5h2.7v-2.7h3v2.7h2.7v3h-2.7v2.7h-3v-2.7h-2.7z',
  'M0-5l1.4 3.2h3.4l-2.7 2.3l1 3.7l-3.1-2l-3.1 2l1-3.7l-2.7-2.3h3.4z', 'M-4.6-2.6h9.2v5.2h-9.2z',
];
const DASHES = ['', '7 3', '2 3', '9 3 2 3'];
const MARGIN = { left: 72, right: 14, top: 10, bottom: 46 };

/* Charts over time share their range, and the moment that the body is shown at. */
const timeline = {
  charts: [],
  range: null,  /* [low, high]; null: all */
  moment: null,
  listeners: [],
  zoom(range) {
    this.range = range;
    this.charts.forEach((chart) => chart.draw());
  },
  show(moment) {
    this.moment = moment;
    this.charts.forEach((chart) => chart.drawMoment());
  },
  ask(moment) { this.listeners.forEach((listener) => listener(moment)); },
};

/* Index of the x nearest to a value, x ascending. */
function nearest(x, value) {
  let low = 0, high = x.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle] <= value) low = middle;
    else high = middle;
  }
  return high >= 0 && Math.abs(x[high] - value) < Math.abs(x[low] - value) ? high : low;
}

class Chart {
  constructor(figure, data) {
    this.figure = figure;
    this.hidden = new Set();
    this.legend = element('div', { class: 'legend' }, figure);
    this.frame = element('div', { class: 'frame' }, figure);
    this.svg = svgElement('svg', { tabindex: 0, role: 'img' }, this.frame);
    this.tip = element('div', { class: 'tip', hidden: '' }, this.frame);
    this.reset = element('button', { type: 'button', class: 'reset', hidden: '' }, this.frame, 'show all');
    this.note = element('p', { class: 'note' }, figure);
    this.reset.onclick = () => this.zoom(null);
    this.listen();
    this.setData(data);
    if (data.time) timeline.charts.push(this);
    new ResizeObserver(() => this.draw()).observe(this.frame);
  }

  setData(data) {
    this.data = data;
    this.view = null;
    this.series = data.series.map((s, k) => ({
      name: s.name, style: s.style, k, note: s.note,
      x: typeof s.x === 'string' ? doubles(s.x) : s.x,
      y: typeof s.y === 'string' ? doubles(s.y) : s.y,
      low: s.low, high: s.high,
    }));
    this.sorted = this.series.every((s) => s.style !== 'marked'); /* by x, which is time */
    this.svg.setAttribute('aria-label', data.title + ': ' + data.yLabel + ' over ' + data.xLabel);
    this.drawLegend();
    this.draw();
  }

  drawLegend() {
    this.legend.textContent = '';
    this.series.forEach((s) => {
      const button = element('button', { type: 'button', 'aria-pressed': !this.hidden.has(s.k) }, this.legend);
      const key = svgElement('svg', { width: 34, height: 12, class: this.colour(s) }, button);
      if (s.style !== 'points')
        svgElement('path', { class: 'line', d: 'M0 6H34', 'stroke-dasharray': this.dash(s) }, key);
      if (s.style === 'points' || s.style === 'marked')
        svgElement('path', { class: 'mark', d: MARKS[s.k % 8], transform: 'translate(17 6)' }, key);
      button.append(s.name);
      button.onclick = () => {
        if (!this.hidden.delete(s.k)) this.hidden.add(s.k);
        button.setAttribute('aria-pressed', !this.hidden.has(s.k));
        this.draw();
      };
    });
    this.legend.hidden = this.series.length < 2;
  }

  colour(s) { return 'series c' + (s.k % 8) + (Math.floor(s.k / 8) % 2 ? ' hollow' : ''); }

  /* Marks tell marked series apart, so that these need dashes only beyond the colours. */
  dash(s) { return s.style === 'marked' ? DASHES[Math.floor(s.k / 8) % 4] : DASHES[s.k % 4]; }

  shown() { return this.series.filter((s) => !this.hidden.has(s.k)); }

  /* [low, high] of one coordinate of the shown points that both axes take, within `range` of x. */
  extent(coordinate, range) {
    let low = Infinity, high = -Infinity;
    const { xLog, yLog } = this.data;
    for (const s of this.shown()) {
      for (let i = 0; i < s.x.length; i++) {
        const x = s.x[i], y = s.y[i];
        if (!isFinite(x) || !isFinite(y) || (xLog && x <= 0) || (yLog && y <= 0)) continue;
        if (range && (x < range[0] || x > range[1])) continue;
        const value = coordinate === 'x' ? x : y;
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    return [low, high];
  }

  /* The axes: of what is zoomed to, or of all there is. */
  findAxes() {
    const { xLog, yLog, floor, time, interval } = this.data;
    const range = time ? timeline.range : this.view && this.view.x;
    const all = this.extent('x', null);
    this.x = range ? Axis.around(range[0], range[1], xLog, true) : Axis.around(all[0], all[1], xLog, time);
    let [low, high] = this.extent('y', range);
    if (floor !== null && !range) low = Math.min(low, floor), high = Math.max(high, floor);
    if (interval && !range) low = Math.min(low, interval[0]), high = Math.max(high, interval[1]);
    this.y = this.view && this.view.y ? Axis.around(this.view.y[0], this.view.y[1], yLog, true)
                                      : Axis.around(low, high, yLog, false);
    this.reset.hidden = !(range || this.view);
  }

  across(x) { return MARGIN.left + this.x.place(x) * this.width; }
  down(y) { return MARGIN.top + (1 - this.y.place(y)) * this.height; }

  draw() {
    const total = Math.floor(this.frame.clientWidth);
    if (total < 50) return;
    this.findAxes();
    this.width = total - MARGIN.left - MARGIN.right;
    const wanted = this.data.tall ? Math.min(460, Math.max(300, 0.75 * total)) : 220;
    this.height = Math.round(wanted);
    const outer = this.height + MARGIN.top + MARGIN.bottom;
    this.svg.textContent = '';
    this.svg.setAttribute('viewBox', `0 0 ${total} ${outer}`);
    this.svg.setAttribute('width', total);
    this.svg.setAttribute('height', outer);
    this.drawAxes();
    const clip = svgElement('svg', { x: MARGIN.left, y: MARGIN.top, width: this.width, height: this.height,
      viewBox: `${MARGIN.left} ${MARGIN.top} ${this.width} ${this.height}` }, this.svg);
    this.drawFloor(clip);
    this.drawInterval(clip);
    let skipped = 0;
    for (const s of this.shown()) skipped += this.drawSeries(s, clip);
    this.note.textContent = skipped ? `${skipped} point${skipped > 1 ? 's' : ''} without a place on these axes` : '';
    this.cursor = svgElement('path', { class: 'cursor' }, this.svg);
    this.momentLine = svgElement('path', { class: 'moment' }, this.svg);
    this.band = svgElement('rect', { class: 'band', visibility: 'hidden' }, this.svg);
    this.drawMoment();
  }

  drawAxes() {
    const { left, top } = MARGIN, right = left + this.width, bottom = top + this.height;
    const label = (tick, attributes) => {
      const [base, power] = tick.label.split('^');
      const text = svgElement('text', attributes, this.svg, base);
      if (power) svgElement('tspan', { dy: -5, 'font-size': 9 }, text, power);
    };
    for (const tick of this.x.ticks(Math.max(3, Math.floor(this.width / 75)))) {
      const x = this.across(tick.at).toFixed(1);
      svgElement('path', { class: tick.label ? 'grid' : 'minor', d: `M${x} ${top}V${bottom}` }, this.svg);
      if (tick.label) label(tick, { class: 'tick x', x, y: bottom + 17, 'text-anchor': 'middle' });
    }
    for (const tick of this.y.ticks(Math.max(3, Math.floor(this.height / 34)), this.data.whole)) {
      const y = this.down(tick.at);
      svgElement('path', { class: tick.label ? 'grid' : 'minor', d: `M${left} ${y.toFixed(1)}H${right}` }, this.svg);
      if (tick.label) label(tick, { class: 'tick y', x: left - 7, y: (y + 4).toFixed(1), 'text-anchor': 'end' });
    }
    svgElement('rect', { class: 'axes', x: left, y: top, width: this.width, height: this.height }, this.svg);
    svgElement('text', { class: 'label', x: (left + right) / 2, y: bottom + 37, 'text-anchor': 'middle' },
               this.svg, this.data.xLabel);
    svgElement('text', { class: 'label', transform: `translate(12 ${(top + bottom) / 2})rotate(-90)`,
                         'text-anchor': 'middle' }, this.svg, this.data.yLabel);
  }

  drawFloor(parent) {
    if (this.data.floor === null || !this.y.takes(this.data.floor)) return;
    const y = Math.max(MARGIN.top, Math.min(MARGIN.top + this.height, this.down(this.data.floor)));
    svgElement('rect', { class: 'floor', x: MARGIN.left, y, width: this.width,
                         height: MARGIN.top + this.height - y }, parent);
    svgElement('path', { class: 'floor-edge', d: `M${MARGIN.left} ${y}h${this.width}` }, parent);
    svgElement('text', { class: 'tick', x: MARGIN.left + 8, y: y - 6 }, parent, this.data.floorLabel || 'floor');
  }

  drawInterval(parent) {
    if (!this.data.interval) return;
    const [low, high] = this.data.interval, y = this.down(high);
    svgElement('rect', { class: 'interval', x: MARGIN.left, y, width: this.width,
                         height: Math.max(1, this.down(low) - y) }, parent);
    /* above the band, where there is room */
    svgElement('text', { class: 'tick', x: MARGIN.left + 8, y: y < MARGIN.top + 16 ? y + 15 : y - 6 }, parent,
               this.data.intervalLabel);
  }

  /* Draws one series and returns how many of its points have no place. */
  drawSeries(s, parent) {
    const group = svgElement('g', { class: this.colour(s), 'data-points': s.x.length }, parent);
    const steps = s.style === 'steps';
    let path = '', skipped = 0, joined = false;
    const keep = this.thinned(s);
    for (let j = 0; j < (keep ? keep.length : s.x.length); j++) {
      const i = keep ? keep[j] : j;
      const drawn = this.x.takes(s.x[i]) && this.y.takes(s.y[i]);
      if (drawn) {
        const x = this.across(s.x[i]).toFixed(1), y = this.down(s.y[i]).toFixed(1);
        path += !joined ? `M${x} ${y}` : steps ? `V${y}H${x}` : `L${x} ${y}`;
        if (s.low && s.low[i] > 0 && s.high[i] > 0)
          svgElement('path', { class: 'spread', d: `M${this.across(s.low[i])} ${y}H${this.across(s.high[i])}` }, group);
        if (s.style === 'points' || s.style === 'marked' || s.x.length === 1) /* no line shows one point */
          svgElement('path', { class: 'mark', d: MARKS[s.k % 8], transform: `translate(${x} ${y})` }, group);
      } else if (!isNaN(s.y[i])) skipped++;
      joined = drawn;
    }
    if (s.style !== 'points')
      svgElement('path', { class: 'line', d: path, 'stroke-dasharray': this.dash(s) }, group);
    return skipped;
  }

  /* Of many points over time those that can be seen: in each column of pixels the first, the
     lowest, the highest and the last. null: all. */
  thinned(s) {
    if (!this.sorted || s.x.length <= 4 * this.width) return null;
    const keep = [];
    let column = null, first = 0, low = 0, high = 0;
    const flush = (last) => {
      if (column !== null) keep.push(...[...new Set([first, low, high, last])].sort((a, b) => a - b));
    };
    for (let i = 0; i < s.x.length; i++) {
      const at = Math.floor(this.across(s.x[i]));
      if (at < MARGIN.left - 2 || at > MARGIN.left + this.width + 2) continue;
      if (at !== column) {
        if (i) flush(i - 1);
        column = at, first = low = high = i;
      }
      if (s.y[i] < s.y[low]) low = i;
      if (s.y[i] > s.y[high]) high = i;
    }
    flush(s.x.length - 1);
    return keep;
  }

  drawMoment() {
    if (!this.momentLine || !this.data.time || timeline.moment === null) return;
    const x = this.across(timeline.moment);
    const inside = x >= MARGIN.left - 1 && x <= MARGIN.left + this.width + 1;
    this.momentLine.setAttribute('d', inside ? `M${x.toFixed(1)} ${MARGIN.top}v${this.height}` : '');
  }

  zoom(view) {
    this.view = view;
    if (this.data.time) timeline.zoom(view && view.x);
    else this.draw();
  }

  /* Moves and scales the x axis: `about` stays where it is. */
  scale(factor, about, shift) {
    const to = (place) => this.x.value(about + (place - about) * factor + shift);
    this.zoom({ x: [to(0), to(1)], y: this.view && this.view.y });
  }

  listen() {
    const svg = this.svg, pointers = new Map();
    const at = (event) => {
      const box = svg.getBoundingClientRect();
      return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    const place = (p) => (p.x - MARGIN.left) / this.width;
    let start = null, moved = false;

    svg.onpointerdown = (event) => {
      if (event.button !== 0) return;
      pointers.set(event.pointerId, at(event));
      start = at(event), moved = false;
      if (event.pointerType === 'mouse') svg.setPointerCapture(event.pointerId);
    };
    svg.onpointermove = (event) => {
      const p = at(event), before = pointers.get(event.pointerId);
      this.point(p);
      if (!before || !start) return;
      if (pointers.size === 2) {
        const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
        const factor = Math.abs(before.x - other.x) / Math.max(8, Math.abs(p.x - other.x));
        this.scale(factor, place(other), 0);
      } else if (event.shiftKey) {
        this.scale(1, 0, place(before) - place(p));
      } else if (event.pointerType === 'mouse') {
        this.select(start, p);
      }
      if (Math.hypot(p.x - start.x, p.y - start.y) > 6) moved = true;
      pointers.set(event.pointerId, p);
    };
    const release = (event) => {
      const p = at(event), mouse = event.pointerType === 'mouse';
      if (!pointers.delete(event.pointerId) || !start) return;
      this.band.setAttribute('visibility', 'hidden');
      if (moved && mouse && !event.shiftKey && event.type === 'pointerup') this.zoomTo(start, p);
      else if (!moved && this.data.time) timeline.ask(this.x.value(place(p)));
      if (pointers.size === 0) start = null;
    };
    svg.onpointerup = svg.onpointercancel = release;
    svg.onpointerleave = () => this.point(null);
    svg.ondblclick = () => this.zoom(null);
    svg.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && !event.shiftKey) return; /* the page scrolls */
      event.preventDefault();
      this.scale(Math.pow(1.002, event.deltaY || event.deltaX), place(at(event)), 0);
    }, { passive: false });
    svg.onkeydown = (event) => {
      const act = {
        '+': () => this.scale(0.8, 0.5, 0), '-': () => this.scale(1.25, 0.5, 0),
        ArrowLeft: () => this.scale(1, 0, -0.1), ArrowRight: () => this.scale(1, 0, 0.1),
        0: () => this.zoom(null),
      }[event.key];
      if (!act) return;
      event.preventDefault();
      act();
    };
  }

  /* The area between two points, as it is being drawn: over time its height is that of the chart. */
  area(a, b) {
    const clamp = (v, low, size) => Math.max(low, Math.min(low + size, v));
    const x = [a.x, b.x].map((v) => clamp(v, MARGIN.left, this.width)).sort((p, q) => p - q);
    let y = [a.y, b.y].map((v) => clamp(v, MARGIN.top, this.height)).sort((p, q) => p - q);
    if (this.data.time || y[1] - y[0] < 12) y = [MARGIN.top, MARGIN.top + this.height];
    return { x, y };
  }

  select(a, b) {
    const { x, y } = this.area(a, b);
    const band = { x: x[0], y: y[0], width: x[1] - x[0], height: y[1] - y[0], visibility: 'visible' };
    for (const key in band) this.band.setAttribute(key, band[key]);
  }

  zoomTo(a, b) {
    const { x, y } = this.area(a, b);
    if (x[1] - x[0] < 6) return;
    const horizontal = x.map((v) => this.x.value((v - MARGIN.left) / this.width));
    const vertical = [y[1], y[0]].map((v) => this.y.value(1 - (v - MARGIN.top) / this.height));
    this.zoom({ x: horizontal, y: y[1] - y[0] < this.height ? vertical : null });
  }

  /* The values under the pointer; null: it has left. */
  point(p) {
    this.tip.hidden = true;
    if (this.cursor) this.cursor.setAttribute('d', '');
    if (!p || p.x < MARGIN.left || p.x > MARGIN.left + this.width) return;
    const found = this.sorted ? this.under(p) : this.near(p);
    if (!found.length) return;
    this.tip.textContent = '';
    element('b', {}, this.tip, `${this.data.xLabel.replace(/ \[.*/, '')} = ${plain(found[0].s.x[found[0].i])}`);
    for (const { s, i } of found) {
      const line = element('div', { class: this.colour(s) }, this.tip);
      element('i', {}, line);
      line.append(`${s.name}: ${plain(s.y[i])}` + (s.note && s.note[i] ? ` (${s.note[i]})` : ''));
    }
    const { s, i } = found[0], x = this.across(s.x[i]);
    this.cursor.setAttribute('d', this.sorted
      ? `M${x} ${MARGIN.top}v${this.height}`
      : `M${x} ${this.down(s.y[i])}m-8 0a8 8 0 1 0 16 0a8 8 0 1 0-16 0`);
    this.tip.hidden = false;
    const wide = this.tip.offsetWidth;
    this.tip.style.left = (x + 12 + wide > this.frame.clientWidth ? Math.max(0, x - 12 - wide) : x + 12) + 'px';
    this.tip.style.top = MARGIN.top + 6 + 'px';
  }

  under(p) {
    const value = this.x.value((p.x - MARGIN.left) / this.width);
    return this.shown().filter((s) => s.x.length).map((s) => ({ s, i: nearest(s.x, value) }));
  }

  near(p) {
    let best = null, distance = 40;
    for (const s of this.shown()) {
      for (let i = 0; i < s.x.length; i++) {
        if (!this.x.takes(s.x[i]) || !this.y.takes(s.y[i])) continue;
        const d = Math.hypot(this.across(s.x[i]) - p.x, this.down(s.y[i]) - p.y);
        if (d < distance) distance = d, best = { s, i };
      }
    }
    return best ? [best] : [];
  }
}
