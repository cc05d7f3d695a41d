// Added to a report by report_test.py.
const errors = [];
addEventListener("error", event => errors.push(event.message));
const loaded = async image => { while (!image.complete) await new Promise(resolve => setTimeout(resolve, 20)); };
const settle = () => loaded($("below"));
const press = async key => { document.body.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true })); await settle(); };
const pixel = (x, y) => {
  const image = $("below"), canvas = document.createElement("canvas");
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  return [...context.getImageData(x, y, 1, 1).data];
};
const pick = async name => {
  [...document.querySelectorAll("#images tbody tr")].find(row => row.cells[0].textContent === name).click();
  await settle();
};
const worstOfColour = () => { const p = data.images[state.image].pictures[0]; return [p.worstX, p.worstY]; };
const options = id => [...$(id).options].map(option => option.text);

// Contrast of ink on paper, from the style sheet's own colours of one scheme.
const contrastOf = variables => {
  const luminance = hex => {
    const c = [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16) / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
  };
  const ratio = (a, b) => {
    const [low, high] = [luminance(variables[a]), luminance(variables[b])].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  };
  return { text: ratio("--ink", "--page"), onCard: ratio("--ink", "--card"), soft: ratio("--soft", "--page"), softOnCard: ratio("--soft", "--card"),
    good: ratio("--good", "--good-back"), bad: ratio("--bad", "--bad-back"), odd: ratio("--odd", "--odd-back"), button: ratio("--card", "--accent") };
};
const variablesOf = rule => Object.fromEntries([...rule.style].filter(n => n.startsWith("--")).map(n => [n, rule.style.getPropertyValue(n).trim()]));

(async () => {
  const found = { errors };
  found.names = data.images.map(image => image.name);
  found.firstTitle = $("title").textContent;
  found.firstReason = $("reason").textContent;
  found.counts = [...document.querySelectorAll("#counts div")].map(box => [...box.children].map(c => c.textContent).join(" "));
  found.counts = found.counts.map(text => text.trim());
  found.sizes = [];
  for (const source of data.images.flatMap(i => i.pictures.flatMap(p => [p.reference, p.now, p.heat])).filter(Boolean)) {
    const image = new Image();
    image.src = source;
    await loaded(image);
    found.sizes.push([image.naturalWidth, image.naturalHeight]);
  }
  found.fetched = performance.getEntriesByType("resource").map(e => e.name).filter(name => !name.startsWith("data:"));

  await pick("scene.0003.exr");
  found.command = $("command").textContent;
  const [x, y] = worstOfColour();
  const look = () => ({ shown: $("shown").textContent, pixel: pixel(x, y) });
  found.flips = [look()];
  $("frame").click();
  await settle();
  found.flips.push(look());
  for (const key of ["f", " ", "n"]) {
    await press(key);
    found.flips.push(look());
  }

  await pick("scene.0001.exr");
  await press("h");
  found.heat = { shown: $("shown").textContent, worst: pixel(...worstOfColour()), corner: pixel(0, 0) };
  await press("s");
  found.slider = [[$("above").hidden, $("above").style.clipPath]];
  $("wipe").value = 80;
  $("wipe").dispatchEvent(new Event("input"));
  found.slider.push([$("above").hidden, $("above").style.clipPath]);
  await press("n");
  found.slider.push($("above").hidden);

  found.pictures = options("picture");
  const before = $("below").src;
  $("picture").selectedIndex = 1;
  $("picture").dispatchEvent(new Event("change"));
  found.pictureChanges = $("below").src !== before;
  found.graphChannels = options("graphChannel");
  const dots = [...document.querySelectorAll("#graph circle")];
  found.heights = dots.map(dot => Number(dot.getAttribute("cy")));
  dots[3].dispatchEvent(new Event("click"));
  found.afterGraph = $("title").textContent;

  const rules = [...document.styleSheets[0].cssRules];
  const dark = rules.find(rule => rule instanceof CSSMediaRule);
  found.contrast = { light: contrastOf(variablesOf(rules[0])), dark: contrastOf(variablesOf(dark.cssRules[0])) };
  return found;
})().catch(error => ({ errors: [...errors, String(error)] })).then(found => {
  const out = element("pre", JSON.stringify(found));
  out.id = "found";
  document.body.append(out);
});
