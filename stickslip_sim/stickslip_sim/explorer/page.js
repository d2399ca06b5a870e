// Copyright 2026 The stickslip authors
// SPDX-License-Identifier: Apache-2.0
// The page: controls change the values of the scene, the values make a run, the run is drawn.

const by = id => document.getElementById(id), make = (tag, more = {}, ...inside) => { const one = Object.assign(document.createElement(tag), more); one.append(...inside); return one; };
const BASES = {};   // the scenes that the page opens with, by name; an address says what differs from one
const START = {"contact.stiffness": 5e6, "contact.damping": 15000, "friction.static.time_constant": 0.2, "friction.static.exponent": 1, "friction.kinetic.velocities": [0, 0.035],
  "friction.kinetic.coefficients": null, "friction.kinetic.initial": null, "friction.kinetic.limit": null, "friction.kinetic.stribeck_velocity": 0.015};
const WORDS = {   // how a parameter is called, the factor of its unit, and that unit
  "drive.velocity": ["feed v", MM, "mm/s"], "axis.drive_stiffness": ["drive stiffness c"], "axis.drive_damping": ["drive damping h"], "axis.mass": ["mass m"],
  "axis.normal_force": ["normal force N"], "force.constant": ["external force F"], "contact.model": ["contact"], "contact.stiffness": ["contact stiffness"], "contact.damping": ["contact damping"],
  "friction.static.law": ["law"], "friction.static.initial": ["at rest time 0, μ₀"], "friction.static.limit": ["after long rest, μ∞"], "friction.static.time_constant": ["time constant τ"],
  "friction.static.exponent": ["exponent n"], "friction.static.delay": ["delay"], "friction.kinetic.law": ["law"], "friction.kinetic.end_slope": ["slope beyond"],
  "friction.kinetic.initial": ["at rest, μ₀"], "friction.kinetic.limit": ["at high speed, μc"], "friction.kinetic.stribeck_velocity": ["Stribeck velocity", MM, "mm/s"],
  "friction.kinetic.exponent": ["exponent δ"], "friction.kinetic.viscous": ["viscous part"], "friction.acceleration_dependence": ["depends on acceleration"],
};
const GROUPS = {"Drive": /^(drive\.(velocity|acceleration)|axis\.drive_(stiffness|damping))$/, "Slider": /^(axis\.(mass|normal_force)|force\.constant)$/, "Contact in stick": /^contact\.(model|stiffness|damping)$/,
  "Static friction": /^friction\.static\.(?!scatter)/, "Kinetic friction": /^friction\.(kinetic\.(?!tolerance)|acceleration_dependence)/};
const MOST_POINTS = 4, STEPS = 1000, FIRST_SAMPLES = 2000;   // the first picture comes before the browser has compiled the engine
let values, opened, run_, shownTime = null, index = 0, isPlaying = !matchMedia("(prefers-reduced-motion: reduce)").matches, stripJob = null, labelJob = null, touring = null, pending = null, hovered = false;
const history_ = [], costs = [];

// Values by path: a parameter, or an element of a list.

function valueAt(v, path) { const [name, i] = path.split(/[[\]]/); return i === undefined ? v[name] : v[name]?.[i]; }
function changeOf(v, path, value) { const [name, i] = path.split(/[[\]]/); return {[name]: i === undefined ? value : v[name].map((one, k) => k === Number(i) ? value : one)}; }

function changed(base, changes) {
  const over = overridden(base, changes);
  for (const entry of PAGE.schema) {   // what a choice just made asks for: a number to begin with
    if (entry.name in over || entry.default !== null || !entry.required || !holds(entry, over)) continue;
    const mu = base["friction.kinetic.coefficients"]?.[0] ?? base["friction.kinetic.initial"] ?? base["friction.static.initial"], low = base["friction.kinetic.coefficients"]?.at(-1) ?? base["friction.kinetic.limit"] ?? 0.5 * mu;
    over[entry.name] = {"friction.kinetic.coefficients": [mu, low], "friction.kinetic.initial": mu, "friction.kinetic.limit": low, "friction.static.limit": 2 * base["friction.static.initial"]}[entry.name] ?? START[entry.name] ?? 0;
  }
  return complete(over);
}

// From values to the picture.

function apply(next, isStep = true) {
  const began = performance.now();
  try {
    const axis = axisOf(next), end = shownTime ?? timeToShow(axis), found = run(axis, end, costs.length ? SAMPLES : FIRST_SAMPLES);
    if (![found.velocity.at(-1), found.drive_force.at(-1)].every(Number.isFinite)) throw new Refusal("the state leaves the range of numbers: a parameter or an input is too extreme for this axis");
    const from = found.events.filter(event => event.kind === codes_BREAKAWAY && event.mode !== codes_STICK).slice(-2).map(event => found.time.findIndex(time => time >= event.time));
    found.cycle = from.length === 2 ? [from[0], from[1] + 1] : null;
    if (isStep && values) history_.push(values);
    values = next;
    run_ = found;
    say("");
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    say(error.message);
    return false;
  }
  index = Math.min(index, run_.time.length - 1);
  draw();
  costs.push(performance.now() - began);
  by("end").value = short(run_.end, 6);
  by("undo").disabled = !history_.length;
  startStrip(showFigures());
  writeAddress();
  return true;
}

function say(text) {
  by("message").textContent = text;
  document.body.classList.toggle("stale", Boolean(text));
}

function draw() {
  for (const view of Object.values(views)) if (view !== views.strip) { view.index = index; view.take(run_); view.draw(); }
}

function moveTo(i) {
  index = i;
  for (const view of Object.values(views)) if (view !== views.strip && view.run) view.mark(i);
}

function indexAt(time) {
  let low = 0, high = run_.time.length - 1;
  while (low < high) { const middle = (low + high) >> 1; if (run_.time[middle] < time) low = middle + 1; else high = middle; }
  return low;
}

function showFigures() {
  const a = run_.figures, isOn = a.cycles > 0 && run_.end - a.last_break_away < 2 * a.period, settles = Math.abs(a.period - a.period_before) < 1e-6 * a.period;
  const motion = isOn ? `stick-slip${settles ? ", settled" : ""}` : Number.isNaN(a.first_break_away) && !run_.events.length && run_.mode[0] === codes_STICK ? "at rest" : a.cycles ? "sliding after stick-slip" : "sliding";
  const told = [["motion", motion], ["period", a.period, "s"], ["stick time", a.stick_time, "s"], ["slip time", a.slip_time, "s"], ["slip travel", a.slip_travel * MM, "mm"], ["peak speed", a.peak_speed * MM, "mm/s"],
    ["break-away force", a.break_away_force, "N"], ["static coefficient", a.static_coefficient, ""], ["time in stick", a.stick_share * 100, "%"], ["events", run_.events.length, ""]];
  const boxes = by("figures").children;
  if (!boxes.length) by("figures").append(...told.map(([name]) => make("div", {}, make("dt", {textContent: name}), make("dd"))));
  told.forEach(([, value, unit], i) => { boxes[i].lastChild.textContent = typeof value === "string" ? value : `${short(value, 5)} ${Number.isNaN(value) ? "" : unit}`; });
  return motion;
}

function label(motion) {
  const a = run_.figures;
  for (const [name, view] of Object.entries(views)) view.host.setAttribute("aria-label", `${view.title ?? "The axis in motion"}: ${motion}${name === "strip" || !a.cycles ? "" : `, period ${short(a.period)} s, peak speed ${short(a.peak_speed * MM)} mm/s`}`);
}

// The strip over the feed, a run at a time between the frames.

function startStrip(motion) {
  clearTimeout(stripJob);
  clearTimeout(labelJob);
  labelJob = setTimeout(label, 30, motion);
  const axis = run_.axis, isConstant = axis.drive.count === 1 && axis.drive.rates[0] === 0 && axis.force.count === 1 && axis.force.rates[0] === 0 && !axis.sinusoids.count && axis.drive.values[0] !== 0;
  by("strip_note").textContent = isConstant ? "" : "Only with a constant feed other than 0.";
  views.strip.host.hidden = !isConstant;
  if (!isConstant) return;
  const feed = axis.drive.values[0], old = views.strip.run, low = old && Math.abs(feed) > old.low * 1.5 && Math.abs(feed) < old.high / 1.5 && Math.sign(feed) === old.sign ? old.low * 100 : feed;
  const job = strip(axis, Math.sign(feed) * Math.abs(low)), began = performance.now();
  const go = () => {
    const slice = performance.now();
    let found;
    do found = job.next().value; while (!found.done && performance.now() - slice < 8);
    if (!found.done) { stripJob = setTimeout(go); return; }
    Object.assign(found, {feed: Math.abs(feed), sign: Math.sign(feed)});
    explorer.stripCost = performance.now() - began;
    views.strip.take(found);
    views.strip.draw();
    by("strip_note").textContent = `Critical feed from rest: ${found.critical ? `${short(found.critical * MM, 6)} mm/s` : "none within the strip"}; steady sliding is lost below ${found.sliding === Infinity ? "any feed" : found.sliding ? `${short(found.sliding * MM, 6)} mm/s` : "no feed"}.`;
  };
  stripJob = setTimeout(go, 30);
}

// Controls.

function controls() {
  const panel = by("controls"), isOpen = Object.fromEntries([...panel.querySelectorAll("details")].map(one => [one.dataset.name, one.open]));
  panel.replaceChildren(...Object.entries(GROUPS).map(([title, pattern], k) => {
    const group = make("details", {open: isOpen[title] ?? (innerWidth > 800 || k === 0)}, make("summary", {textContent: title}));
    group.dataset.name = title;
    for (const entry of [...PAGE.schema].sort((a, b) => b.name.startsWith("drive.") - a.name.startsWith("drive."))) {
      const value = values[entry.name];
      if (!pattern.test(entry.name) || value === undefined) continue;
      if (Array.isArray(value) && value.length <= MOST_POINTS) value.forEach((_, i) => { if (i || entry.name.endsWith("coefficients")) group.append(row(`${entry.name}[${i}]`, entry)); });
      else if (Array.isArray(value)) group.append(make("p", {textContent: `${entry.name}: a table of ${value.length} points`}));
      else group.append(row(entry.name, entry));
    }
    if (title === "Drive" && values["drive.velocity"] === undefined) group.append(make("p", {textContent: `Its velocity is a profile of the scene: ${values["drive.course"]}.`}));
    return group;
  }));
}

function row(path, entry) {
  const id = path.replace(/[^\w]/g, "_"), [name, i] = path.split(/[[\]]/), isSpeed = name === "friction.kinetic.velocities";
  const [word, factor = isSpeed ? MM : 1, unit = isSpeed ? "mm/s" : entry.unit] = WORDS[name] ?? [i === undefined ? name.split(".").at(-1) : `${isSpeed ? "speed" : "μ"} of point ${i}`];
  const label = make("label", {htmlFor: id, textContent: unit ? `${word}, ${unit}` : word}), line = make("div", {className: "row"}, label);
  if (entry.choices.length) {
    const select = make("select", {id}, ...entry.choices.map(one => make("option", {textContent: one})));
    select.value = values[name];
    select.onchange = () => choose(changeOf(values, path, select.value));
    line.append(select);
  } else if (entry.type === "bool") {
    const box = make("input", {id, type: "checkbox", checked: values[name]});
    box.onchange = () => choose({[name]: box.checked});
    line.append(box);
  } else {
    const base = Math.abs(valueAt(opened, path) || valueAt(values, path)) || START[name] || 1, isLog = !/friction\.(static\.(initial|limit)|kinetic\.(initial|limit|coeff))|exponent|end_slope|viscous|delay|force\.constant/.test(name);
    const top = isLog ? base * 100 : name === "force.constant" ? 2 * values["axis.normal_force"] : Math.max(2.5 * base, entry.name.includes("exponent") ? 4 : 0.1), low = name === "force.constant" ? -top : 0;
    const toPlace = value => Math.round(isLog ? value ? STEPS * Math.log(Math.abs(value) / base * 100) / Math.log(1e4) : 0 : STEPS * (value - low) / (top - low));
    const ofPlace = place => Number((isLog ? (place <= 0 && entry.low === 0 ? 0 : base / 100 * 1e4 ** (place / STEPS)) * (valueAt(values, path) < 0 ? -1 : 1) : low + (top - low) * place / STEPS).toPrecision(3));
    const range = make("input", {type: "range", min: 0, max: STEPS, value: toPlace(valueAt(values, path))}), box = make("input", {id, type: "text", inputMode: "decimal", value: short(valueAt(values, path) * factor, 6), autocomplete: "off"});
    range.setAttribute("aria-label", `${word}, slider`);
    Object.assign(range.dataset, {path});
    range.oninput = () => {
      const value = ofPlace(Number(range.value));
      box.value = short(value * factor, 6);
      range.before_ ??= values;
      schedule(() => apply(changed(values, changeOf(values, path, value)), false));
    };
    range.onchange = () => { flush(); if (range.before_ && range.before_ !== values) history_.push(range.before_); range.before_ = null; by("undo").disabled = !history_.length; };
    box.onchange = () => {
      const text = box.value.trim().replace(",", "."), value = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(text) ? Number(text) / factor : NaN;
      const isTaken = attempt(() => { checked(entry, i === undefined ? value : [value]); return apply(changed(values, changeOf(values, path, value === 0 ? 0 : Number(value.toPrecision(15))))); }, `${path} = ${text || "nothing"} is refused: must be ${entry.allowed}${factor === 1 ? "" : `; here in ${unit}`}`);
      box.setAttribute("aria-invalid", String(!isTaken));
      if (isTaken) range.value = toPlace(valueAt(values, path));
    };
    line.append(range, box);
  }
  return line;
}

function attempt(what, otherwise) {
  try { return what(); } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    say(otherwise ?? error.message);
    return false;
  }
}

function choose(changes) { attempt(() => apply(changed(values, changes))); controls(); }
function schedule(what) { if (!pending) requestAnimationFrame(flush); pending = what; }
function flush() { const what = pending; pending = null; if (what) attempt(what); }

// Scenes: open, address, copy.

function open(next) {
  const before = opened;
  opened = next;
  history_.length = 0;
  values = undefined;
  index = 0;
  if (views.strip) views.strip.run = null;
  if (!apply(next, false)) { opened = before; values = before; return false; }
  controls();
  by("scene").value = BASES[next.scene] ? next.scene : "";
  return true;
}

function openText(text) { return attempt(() => open(valuesOf(text))); }

function writeAddress() {
  const base = BASES[values.scene] ?? {}, parts = [encodeURIComponent(values.scene)];
  for (const [name, value] of Object.entries(values)) if (name !== "scene" && valueText(ENTRY[name], value) !== (name in base ? valueText(ENTRY[name], base[name]) : undefined)) parts.push(`${name}=${encodeURIComponent(valueText(ENTRY[name], value))}`);
  const address = `#${parts.join("&")}`;
  if (decodeURI(location.hash) !== decodeURI(address)) try { history.replaceState(null, "", address); } catch { location.hash = address; }
}

function readAddress() {
  const [name, ...parts] = location.hash.slice(1).split("&"), scene = decodeURIComponent(name);
  if (!scene) return attempt(() => open(valuesOf(PAGE.scene)));
  return attempt(() => {
    const lines = parts.map(part => part.split("=").map(decodeURIComponent)).map(([key, value]) => `${key}: ${value}`);
    const given = lines.length ? readYaml(lines.join("\n")) : {}, base = BASES[scene];
    const next = base ? complete(overridden(base, given)) : complete({scene, ...given});
    const isOpen = open(base ?? next) && (next === base || apply(next, false));
    controls();
    return isOpen;
  });
}

function copyText() {
  const isBase = BASES[values.scene] && sceneText(BASES[values.scene]) === sceneText(values);
  return sceneText(isBase ? values : {...values, scene: `${values.scene.replace(/_explored$/, "")}_explored`});
}

async function copy() {
  by("yaml").value = copyText();
  by("dialog").showModal();
  by("yaml").select();
  try { await navigator.clipboard.writeText(by("yaml").value); by("copied").textContent = "Copied."; } catch { by("copied").textContent = document.execCommand("copy") ? "Copied." : "Select the text and copy it."; }
}

function takeFile(file) {
  file.text().then(text => {
    if (!/\.csv$/i.test(file.name)) return openText(text);
    return attempt(() => { PAGE.beside = readCsv(text); draw(); });
  });
}

function readCsv(text) {
  const [head, ...lines] = text.trim().split(/\r?\n/).filter(line => !line.startsWith("#")), names = head.split(/[,;\t]/).map(name => name.trim().toLowerCase());
  const rows_ = lines.map(line => line.split(/[,;\t]/).map(Number)), columns = Object.fromEntries(names.map((name, i) => [name, rows_.map(one => one[i])]));
  if (!columns.time || !["position", "velocity", "drive_force"].some(name => columns[name])) refuse("CSV", head, "columns time and position, velocity or drive_force, in SI", "name its columns in the first line");
  if (rows_.some(one => names.some((name, i) => /^(time|position|velocity|drive_force)$/.test(name) && !Number.isFinite(one[i])))) refuse("CSV", file_row(rows_), "a number in each of these columns", "correct that line");
  return columns;
}
function file_row(rows_) { return `line ${rows_.findIndex(one => !one.every(Number.isFinite)) + 2}`; }

function save(view, kind) {
  const name = `${values.scene}_${view.name}.${kind}`, link = make("a", {download: name});
  if (kind === "svg") link.href = URL.createObjectURL(new Blob([view.svg()], {type: "image/svg+xml"}));
  else link.href = view.base.toDataURL("image/png");
  link.click();
}

// Guided tours.

const TOURS = {
  "Why it sticks": [
    ["paper_fig8", {}, "force", "The drive moves at 2 mm/s. While the slider stands still, the spring stretches and the drive force rises, until it reaches the static limit (dotted)."],
    ["paper_fig8", {}, "velocity", "The slider breaks away. Kinetic friction is lower, and falls with speed: the slider overtakes the drive, many times as fast as the feed, then stops. The cycle begins again."],
    ["paper_fig8", {}, "rest", "The longer it rests, the more static friction grows. Each break-away (dots) is one point of this law."],
    ["paper_fig8", {"drive.velocity": 0.01}, "phase", "At 10 mm/s rests are shorter, the static limit grows less, and cycles come three times as fast. In the phase plane the motion ends on one closed curve, the limit cycle."],
    ["paper_fig8", {"drive.velocity": 0.04}, "strip", "At 40 mm/s, above the critical feed, the slider no longer sticks. The strip shows where that begins."]],
  "What acceleration does": [
    ["paper_fig4_falling", {}, "law", "Here friction falls with speed, the same on the way up and down: one curve, the conventional characteristic."],
    ["paper_fig7", {}, "law", "Measured slideways show two branches: while the slider accelerates, friction starts from the static value and falls along the upper branch (dotted)."],
    ["paper_fig7", {}, "velocity", "The upper branch takes energy out of the slip: the peak speed is lower than without it."],
    ["paper_fig8", {}, "force", "With a compliant contact the slider yields a little before it breaks away, and rings as it comes to rest."],
    ["paper_fig4_constant", {}, "strip", "With a constant kinetic coefficient, stick-slip ends at a far lower feed: the falling branch is what feeds it."]],
  "How to end it": [
    ["paper_fig8", {}, "strip", "Stick-slip at 2 mm/s. The strip shows all feeds: with this drive the slider sticks up to 31.7 mm/s."],
    ["paper_fig8", {"axis.drive_damping": 12000}, "strip", "Three times the damping, more than N |μk′| = 6865 N s/m: steady sliding is stable at every feed, and the critical feed falls to 1.5 mm/s."],
    ["paper_fig8", {"axis.drive_damping": 40000}, "velocity", "Ten times the damping: no stick-slip at any feed. The slider creeps up to the speed of the drive."],
    ["paper_fig8", {"axis.drive_stiffness": 6e6}, "position", "Ten times the stiffness instead: slips of 0.21 mm in place of 1.24 mm, six times as often. The staircase comes close to the line of the drive, but it does not end: 31.2 mm/s."],
    ["paper_fig8", {"axis.drive_stiffness": 6e6, "axis.drive_damping": 12000}, "strip", "Both, ten times the stiffness and three times the damping: the slider sticks below 0.3 mm/s only."]],
};

function tour(name) {
  clearTimeout(touring?.timer);
  document.querySelector(".told")?.classList.remove("told");
  touring = null;
  by("tour_box").hidden = !name;
  if (name) step(name, 0);
}

function step(name, at_) {
  const [scene, changes, view, text] = TOURS[name][at_], next = complete(overridden(BASES[scene], changes));
  shownTime = null;
  open(BASES[scene]);
  apply(next, false);
  controls();
  document.querySelector(".told")?.classList.remove("told");
  const card = views[view].host.closest("figure");
  card.classList.add("told");
  card.scrollIntoView({block: "nearest"});
  by("tour_text").textContent = `${name}, ${at_ + 1} of ${TOURS[name].length}. ${text}`;
  touring = {name, at: at_, timer: setTimeout(() => { if (at_ + 1 < TOURS[name].length) step(name, at_ + 1); }, 12000)};
}

// Start.

const views = {};

function tick(then) {
  return now => {
    if (isPlaying && run_ && !hovered) {
      const time = (run_.time[index] ?? 0) + Math.min(now - then, 100) / 1000 * run_.end / 20;
      moveTo(time >= run_.end ? 0 : indexAt(time));
    }
    requestAnimationFrame(tick(now));
  };
}

function play(is) { isPlaying = is; by("play").textContent = is ? "Pause" : "Play"; }

function begin() {
  takeColours();
  for (const name of Object.keys(PAGE.shipped)) BASES[name] = valuesOf(PAGE.shipped[name]);
  const given = valuesOf(PAGE.scene);
  BASES[given.scene] ??= given;
  by("scene").append(...Object.keys(BASES).map(name => make("option", {value: name, textContent: name})), make("option", {value: "", textContent: "another scene", disabled: true}));
  views.scheme = new Scheme(by("scheme"));
  for (const [name, told] of [...Object.entries(PLOTS), ["strip", STRIP]]) {
    const host = make("div", {className: "plot", tabIndex: 0, role: "img"}, make("canvas", {className: "base"}), make("canvas", {className: "over"})), view = views[name] = new Plot(host, {name, ...told});
    const saved = ["png", "svg"].map(kind => { const button = make("button", {type: "button", textContent: kind.toUpperCase(), title: `Save as ${kind.toUpperCase()}`}); button.setAttribute("aria-label", `Save ${told.title} as ${kind.toUpperCase()}`); button.onclick = () => save(view, kind); return button; });
    by("views").append(make("figure", {id: `view_${name}`}, make("figcaption", {}, make("span", {textContent: told.title}), ...saved), host, ...(name === "strip" ? [make("p", {id: "strip_note", ariaLive: "polite"})] : [])));
    host.onpointermove = event => {
      if (!run_ || !view.run) return;
      const x = event.clientX - host.getBoundingClientRect().left;
      hovered = name !== "strip";
      if (view.isTime) moveTo(indexAt(view.back(x)));
      else if (name !== "strip") moveTo(nearest(view, x, event.clientY - host.getBoundingClientRect().top));
    };
    host.onpointerleave = () => { hovered = false; };
    host.onclick = event => { if (name === "strip" && view.run) choose({"drive.velocity": view.run.sign * Number(view.back(event.clientX - host.getBoundingClientRect().left).toPrecision(3))}); };
    host.onkeydown = event => {
      const by_ = {ArrowRight: 1, ArrowLeft: -1, PageDown: 25, PageUp: -25}[event.key];
      if (!by_) return;
      event.preventDefault();
      play(false);
      moveTo(Math.max(0, Math.min(run_.time.length - 1, index + by_ * Math.ceil(run_.time.length / 500))));
    };
  }
  by("scene").onchange = event => { tour(""); open(BASES[event.target.value]); };
  by("undo").onclick = () => { if (history_.length) { apply(history_.pop(), false); controls(); } };
  by("reset").onclick = () => { shownTime = null; apply(opened); controls(); };
  by("copy").onclick = copy;
  by("close").onclick = () => by("dialog").close();
  by("file").onchange = event => { if (event.target.files[0]) takeFile(event.target.files[0]); event.target.value = ""; };
  by("play").onclick = () => play(!isPlaying);
  by("end").onchange = event => {
    const time = Number(event.target.value.replace(",", "."));
    if (event.target.value.trim() && !(time >= 1e-6 && time <= 1e6)) { say(`time shown = ${event.target.value} is refused: must be a number, >= 1e-6 and <= 1e6 s; leave it empty for some cycles`); return; }
    shownTime = event.target.value.trim() ? time : null;
    apply(values, false);
  };
  by("tours").append(make("option", {value: "", textContent: "Guided tours"}), ...Object.keys(TOURS).map(name => make("option", {textContent: name})));
  by("tours").onchange = event => { tour(event.target.value); event.target.value = ""; };
  by("tour_next").onclick = () => { const {name, at: at_} = touring; clearTimeout(touring.timer); if (at_ + 1 < TOURS[name].length) step(name, at_ + 1); else tour(""); };
  by("tour_end").onclick = () => tour("");
  addEventListener("keydown", event => {
    const isText = /^(INPUT|TEXTAREA|SELECT|BUTTON)$/.test(document.activeElement.tagName);
    if ((event.ctrlKey || event.metaKey) && event.key === "z" && !isText) { event.preventDefault(); by("undo").click(); }
    if (event.key === " " && !isText) { event.preventDefault(); play(!isPlaying); }
    if (event.key === "Escape" && touring) tour("");
  });
  addEventListener("dragover", event => event.preventDefault());
  addEventListener("drop", event => { event.preventDefault(); if (event.dataTransfer.files[0]) takeFile(event.dataTransfer.files[0]); });
  addEventListener("hashchange", readAddress);
  const seen = new IntersectionObserver(entries => {   // what is out of sight is not drawn
    for (const {target, isIntersecting} of entries) { const view = Object.values(views).find(one => one.host === target); view.isSeen = isIntersecting; view.draw(); }
  });
  for (const view of Object.values(views)) seen.observe(view.host);
  new ResizeObserver(() => { for (const view of Object.values(views)) view.draw(); }).observe(document.body);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { takeColours(); for (const view of Object.values(views)) view.draw(); });
  play(isPlaying);
  if (!readAddress() && !values) { const told = by("message").textContent; open(BASES.paper_fig8); say(told); }
  setTimeout(() => apply(values, false));
  requestAnimationFrame(tick(performance.now()));
}

function nearest(view, x, y) {
  const [xs, ys] = {phase: [run_.stretch, run_.velocity], law: [run_.velocity, run_.friction], rest: [run_.time, run_.velocity]}[view.name], ky = view.name === "law" ? run_.axis.p.normal_force || 1 : 1;
  let best = index, least = Infinity;
  if (view.name !== "rest") for (let i = 0; i < xs.length; i++) {
    const far = (view.toX(xs[i]) - x) ** 2 + (view.toY(ys[i] / ky) - y) ** 2;
    if (far < least) { least = far; best = i; }
  }
  return best;
}

const explorer = {valuesOf, axisOf, eventsOf, sceneText, copyText, costs, run, openText, stripCost: null, get values() { return values; }, get figures() { return run_.figures; }, get index() { return index; }, views};
globalThis.explorer = explorer;
begin();
explorer.opened = performance.now();
