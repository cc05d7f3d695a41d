// The sliders: each figure of class "slider" shows the image of `course` that its range and its view choose.
const rowNames = {
  object: "object", colour: "luminance", doppler: "Doppler factor D", angleFromViewAxis: "angle from the middle", angleFromCameraVelocity: "angle from my motion",
  angleFromObjectVelocity: "angle θ from its motion", emissionTime: "light left at", properTime: "its own time then", Z: "distance of its light", P: "place in its frame",
};
const element = (name, properties, ...children) => {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
};
// Four figures; what is less than a float's rounding is none.
const number = value => (Math.abs(value) < 1e-6 ? "0" : String(Number(value.toPrecision(4)))).replace("-", "−");
const told = (row, value) => {
  if (value === null || value === undefined) return row === "object" ? "the sky" : "–";
  if (row === "colour") return number(0.2126 * value[0] + 0.7152 * value[1] + 0.0722 * value[2]);
  if (Array.isArray(value)) return value.map(number).join(", ");
  return typeof value === "number" ? number(value) + (row.startsWith("angle") ? "°" : "") : value;
};

const markOf = (name, [x, y]) => {
  const mark = element("span", { className: "mark", hidden: true }, element("b", { textContent: name }));
  mark.style.left = `${100 * (x + 0.5) / 641}%`;
  mark.style.top = `${100 * (y + 0.5) / 361}%`;
  if (x > 560) mark.classList.add("at-the-edge");
  return mark;
};

const tableOf = (data, readings) => {
  const names = Object.keys(data.marks);
  const body = Object.keys(readings[0]).map(row =>
    element("tr", {}, element("th", { textContent: rowNames[row], scope: "row" }), ...readings.map(r => element("td", { textContent: told(row, r[row]) }))));
  return element("table", {}, element("thead", {}, element("tr", {}, element("td"), ...names.map(n => element("th", { textContent: n, scope: "col" })))),
    element("tbody", {}, ...body));
};

const makeSlider = figure => {
  const name = figure.dataset.slider, data = course[name];
  const image = figure.querySelector("img"), alt = image.alt;
  const marks = Object.entries(data.marks).map(([title, pixel]) => markOf(title, pixel));
  figure.querySelector(".picture").append(...marks);

  const range = element("input", { type: "range", min: 0, max: data.values.length - 1, step: 1, value: data.values.indexOf(data.shown) });
  const output = element("output");
  const views = data.views.map((view, index) =>
    element("label", {}, element("input", { type: "radio", name: `view of ${name}`, value: index, checked: index === 0 }), view.name));
  const marked = element("input", { type: "checkbox" });
  const readings = element("div", { className: "wide" });
  const fold = element("details", { className: "readings" }, element("summary", { textContent: "What the probe says at the marks" }), readings);

  const show = () => {
    const view = data.views[views.findIndex(label => label.firstChild.checked)], at = Number(range.value);
    const value = `${number(data.values[at])} ${data.unit}`.trim();
    image.src = view.pictures[at];
    image.alt = at === data.values.indexOf(data.shown) && view === data.views[0] ? alt : `The same scene, ${view.name}, ${data.label}: ${value}`;
    output.textContent = value;
    range.setAttribute("aria-valuetext", value);
    marks.forEach(mark => { mark.hidden = !marked.checked; });
    readings.replaceChildren(tableOf(data, view.readings[at]));
  };
  [range, marked, ...views.map(label => label.firstChild)].forEach(input => input.addEventListener("input", show));
  const controls = element("div", { className: "controls" }, element("label", { className: "way" }, `${data.label} `, range, output));
  if (views.length > 1) controls.append(element("fieldset", {}, element("legend", { textContent: "View" }), ...views));
  controls.append(element("label", { className: "switch" }, marked, "show the marks"));
  figure.append(controls, fold);
  show();
};
document.querySelectorAll("figure.slider").forEach(makeSlider);

// On paper everything is unfolded.
let unfolded = [];
addEventListener("beforeprint", () => {
  unfolded = [...document.querySelectorAll("details:not([open]):not(.readings)")];
  unfolded.forEach(fold => { fold.open = true; });
});
addEventListener("afterprint", () => unfolded.forEach(fold => { fold.open = false; }));
