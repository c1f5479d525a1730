/* The faces of the surface as triangles to paint. Those of four-node tets are that; those of
   ten-node tets are curved, and cut into flat ones whose corners the shape functions place. */

/* Up to so many faces are cut finely. */
const FINE_FACES = 5000;

class Faces {
  /* corners, and the nodes on the edges 01 12 20 or nothing: three numbers a face. */
  constructor(corners, middles) {
    this.corners = Uint32Array.from(corners), this.count = corners.length / 3;
    this.middles = middles ? Uint32Array.from(middles) : null;
    this.cuts = middles ? (this.count > FINE_FACES ? 2 : 4) : 1; /* of an edge */
    this.makeParts();
    this.makePlaces();
  }

  /* Where a face is looked at: barycentric coordinates, shape functions other than 0 as [node of the
     face, value]; and its parts, three of these each. */
  makeParts() {
    const n = this.cuts, number = (i, j) => j * (n + 1) - j * (j - 1) / 2 + i;
    this.samples = [], this.parts = [];
    for (let j = 0; j <= n; j++) {
      for (let i = 0; i + j <= n; i++) {
        this.samples.push(this.sample([1 - (i + j) / n, i / n, j / n]));
        if (i + j < n) this.parts.push(number(i, j), number(i + 1, j), number(i, j + 1));
        if (i + j < n - 1) this.parts.push(number(i + 1, j), number(i + 1, j + 1), number(i, j + 1));
      }
    }
    this.triangles = this.count * this.parts.length / 3;
  }

  sample(at) {
    const [a, b, c] = at;
    const values = this.middles ? [a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a]
                                : at;
    return { at, shape: values.map((value, k) => [k, value]).filter(([, value]) => value !== 0) };
  }

  node(face, k) { return k < 3 ? this.corners[3 * face + k] : this.middles[3 * face + k - 3]; }

  /* Of each corner to paint, where in its face it is: a coordinate is 0 along an edge of the face. */
  makePlaces() {
    const once = this.parts.map((s) => this.samples[s].at).flat();
    this.places = new Float32Array(9 * this.triangles);
    for (let i = 0; i < this.places.length; i++) this.places[i] = once[i % once.length];
  }

  /* to[item] at each corner to paint, from what look(face, sample) says there. */
  spread(to, look) {
    const { samples, parts } = this, there = new Float64Array(samples.length);
    for (let face = 0, at = 0; face < this.count; face++) {
      for (let s = 0; s < samples.length; s++) there[s] = look(face, samples[s]);
      for (let p = 0; p < parts.length; p++) to(at++, there[parts[p]]);
    }
  }

  /* A function that the shape functions interpolate, value(node), in a face. */
  nodal(face, { shape }, value) {
    let sum = 0;
    for (const [k, weight] of shape) sum += weight * value(this.node(face, k));
    return sum;
  }

  /* One that is linear in it, value(number of the corner). */
  linear(face, { at }, value) {
    return at[0] * value(3 * face) + at[1] * value(3 * face + 1) + at[2] * value(3 * face + 2);
  }

  /* The edges, each once, as lines: position [3 a node]. */
  outline(position) {
    const seen = new Set(), lines = [], { corners, middles, cuts } = this;
    for (let i = 0; i < corners.length; i++) {
      const a = corners[i], b = corners[i % 3 === 2 ? i - 2 : i + 1];
      const key = Math.min(a, b) * (position.length / 3) + Math.max(a, b);
      if (seen.has(key)) continue;
      seen.add(key);
      for (let k = 0; k < cuts; k++)
        lines.push(...this.along(position, a, b, middles && middles[i], k / cuts),
                   ...this.along(position, a, b, middles && middles[i], (k + 1) / cuts));
    }
    return Float32Array.from(lines);
  }

  /* The point of an edge a part `t` of the way from node a to b; middle: the node on it, if any. */
  along(position, a, b, middle, t) {
    const terms = this.middles ? [[a, (1 - t) * (1 - 2 * t)], [b, t * (2 * t - 1)], [middle, 4 * t * (1 - t)]]
                               : [[a, 1 - t], [b, t]];
    return [0, 1, 2].map((c) => terms.reduce((sum, [node, weight]) => sum + weight * position[3 * node + c], 0));
  }

  /* The middle of a face, whose number in `corners` is i. */
  middle(position, i) {
    const mean = (nodes) => [0, 1, 2].map((c) => nodes.reduce((sum, n) => sum + position[3 * n + c], 0) / 3);
    const flat = mean([...this.corners.subarray(i, i + 3)]);
    if (!this.middles) return flat;
    const edges = mean([...this.middles.subarray(i, i + 3)]);
    return flat.map((x, c) => (4 * edges[c] - x) / 3);
  }
}
