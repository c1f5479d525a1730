/* Brings the page to life. `window.corot` is for whoever wants to look at the parts. */

function takeData(figure) {
  const script = figure.querySelector('script');
  const data = JSON.parse(script.textContent);
  script.remove();
  return data;
}

const charts = {};
for (const figure of document.querySelectorAll('figure.chart')) charts[figure.id] = new Chart(figure, takeData(figure));

for (const figure of document.querySelectorAll('figure.precision'))
  charts[figure.id] = new Precision(figure, takeData(figure)).chart;

const view = document.querySelector('figure.body');
const body = view ? new Body(view, takeData(view)) : null;

for (const button of document.querySelectorAll('button.moment'))
  button.onclick = () => { timeline.show(+button.dataset.moment), timeline.ask(+button.dataset.moment); };
window.corot = { charts, timeline, body, Axis };
