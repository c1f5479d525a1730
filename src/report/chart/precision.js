/* Work and precision: any error against any cost of a study's runs. */

class Precision {
  constructor(figure, data) {
    this.data = data;
    const bar = element('div', { class: 'controls' }, figure);
    const choice = (label, id, options, chosen) => {
      const select = element('select', { id }, element('label', {}, bar, label));
      options.forEach((text, k) => element('option', { value: k }, select, text));
      select.value = chosen;
      select.onchange = () => this.update();
      return select;
    };
    this.error = choice('Error: ', 'error', data.errors.map((e) => e.label), data.error);
    this.cost = choice('Cost: ', 'cost', data.costs, data.cost);
    this.chart = new Chart(figure, this.picture());
    this.leftOut = element('p', { class: 'note' }, figure);
    this.update();
  }

  picture() {
    const { costs, errors, series, cells } = this.data, cost = +this.cost.value, error = +this.error.value;
    return {
      title: 'Work and precision', xLabel: costs[cost], yLabel: errors[error].label, xLog: true, yLog: true,
      time: false, tall: true, floor: errors[error].floor, floorLabel: 'floor: ten times what the references differ by',
      series: series.map((name, k) => {
        const own = cells.filter((c) => c.series === k && c.error[error] !== null);
        return {
          name, style: 'marked', x: own.map((c) => c.cost[cost]), y: own.map((c) => c.error[error]),
          low: own.map((c) => c.low[cost]), high: own.map((c) => c.high[cost]),
          note: own.map((c) => (c.tolerance === null ? c.id : `at ${plain(c.tolerance)}, run ${c.id}`)),
        };
      }),
    };
  }

  update() {
    this.chart.setData(this.picture());
    this.leftOut.textContent = this.data.errors[+this.error.value].leftOut;
  }
}
