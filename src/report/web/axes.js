/* Ranges and ticks of axes: what ticks.c does, for axes that are zoomed. */

class Axis {
  constructor(low, high, log) {
    Object.assign(this, { low, high, log });
  }

  /* 0 at the low end, 1 at the high end, and back. */
  place(x) {
    if (this.log) return Math.log10(x / this.low) / Math.log10(this.high / this.low);
    return (x - this.low) / (this.high - this.low);
  }

  value(place) {
    if (this.log) return this.low * Math.pow(this.high / this.low, place);
    return this.low + place * (this.high - this.low);
  }

  takes(x) {
    return this.log ? x > 1e-300 && x < 1e300 : Math.abs(x) < 1e300;
  }

  /* The axis that holds [low, high], and a little more unless it is `tight`. */
  static around(low, high, log, tight) {
    if (!(low <= high)) return log ? new Axis(0.1, 10, true) : new Axis(0, 1, false);
    if (log) {
      const margin = Math.pow(high / low, tight ? 0 : 0.05);
      return margin > 1.01 || (tight && high > low) ? new Axis(low / margin, high * margin, true)
                                                    : new Axis(low / 1.6, high * 1.6, true);
    }
    let margin = (tight ? 0 : 0.05) * (high - low);
    if (!(high - low > 1e-12 * Math.max(Math.abs(low), Math.abs(high))))
      margin = 0.1 * Math.max(Math.abs(low), Math.abs(high)) || 1;
    return new Axis(low - margin, high + margin, false);
  }

  /* [{at, label}], ascending; minor ticks have no label. What follows a ^ is raised. */
  ticks(most, whole) {
    if (!this.log) return linearTicks(this, most, whole);
    const decades = Math.floor(Math.log10(this.high)) - Math.ceil(Math.log10(this.low)) + 1;
    if (decades >= 2) {
      let stride = Math.ceil(decades / most);
      if (decades > 8 && stride === 1) stride = 2;
      return decadeTicks(this, stride, false);
    }
    const ticks = decadeTicks(this, 1, true);
    return ticks.filter((t) => t.label).length >= 2 ? ticks : linearTicks(this, most);
  }
}

function tickLabel(x, step) {
  const size = Math.abs(x);
  if (size < 1e-9 * step) return '0';
  if (size < 1e6 && step >= 1e-4) return x.toFixed(Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)));
  const digits = Math.floor(Math.log10(size)) - Math.floor(Math.log10(step) + 1e-9);
  return x.toExponential(Math.min(15, Math.max(0, digits))).replace('e+', 'e');
}

function linearTicks(axis, most, whole) {
  let step = Math.pow(10, Math.floor(Math.log10((axis.high - axis.low) / most)));
  const count = (s) => Math.floor(axis.high / s) - Math.ceil(axis.low / s) + 1;
  step *= [1, 2, 5, 10, 20].find((factor) => count(factor * step) <= most) || 20;
  if (whole) step = Math.max(1, step);
  const ticks = [];
  for (let i = Math.ceil(axis.low / step); i <= Math.floor(axis.high / step) && ticks.length < 64; i++)
    ticks.push({ at: i * step, label: tickLabel(i * step, step) });
  return ticks;
}

function decadeTicks(axis, stride, few) {
  const ticks = [];
  const first = Math.floor(Math.log10(axis.low)), last = Math.ceil(Math.log10(axis.high));
  for (let e = first; e <= last; e++) {
    for (let digit = 1; digit <= (stride === 1 ? 9 : 1); digit++) {
      const at = digit * Math.pow(10, e);
      if (at < axis.low || at > axis.high) continue;
      let label = '';
      if (few && (digit === 1 || digit === 2 || digit === 5)) label = tickLabel(at, Math.pow(10, e));
      else if (!few && digit === 1 && e % stride === 0) label = e === 0 ? '1' : e === 1 ? '10' : '10^' + e;
      ticks.push({ at, label });
    }
  }
  return ticks;
}
