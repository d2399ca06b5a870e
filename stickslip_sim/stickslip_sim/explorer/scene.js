// Copyright 2026 The stickslip authors
// SPDX-License-Identifier: Apache-2.0
// A scene in the page: its text, its values, and the axis that the engine takes.  All that is refused is a Refusal.

class Refusal extends Error {}

const LEFT_OUT = {default: null, unit: "", low: null, high: null, choices: [], when: null};
PAGE.schema = PAGE.schema.map(entry => ({...LEFT_OUT, ...entry}));
const ENTRY = Object.fromEntries(PAGE.schema.map(entry => [entry.name, entry]));
const PASSED_OVER = /^(use_sim_time$|start_type_description_service$|qos_overrides\.|thread_priority$|lock_memory$|cpu_affinity$|require_real_time$|meant$)/;

function refuse(name, value, allowed, fix) {
  const shown = value === undefined || value === null ? "is missing" : `= ${worded(value)} is refused`;
  throw new Refusal(`${name} ${shown}: must be ${allowed}; ${fix}`);
}

function worded(value) {
  const text = typeof value === "number" ? numberText(value) : Array.isArray(value) ? `[${value.map(worded).join(", ")}]` : String(value);
  return text.length > 80 ? `${text.slice(0, 80)}…` : text;
}

// Text: the part of YAML that scenes are written in, maps by indentation or in braces, lists in brackets.

function readYaml(text) {
  const lines = [];
  text.split(/\r?\n/).forEach((raw, i) => {
    const line = raw.replace(/("[^"]*"|'[^']*')|(^|\s)#.*$/g, (_, quoted) => quoted ?? "").trimEnd();
    const inside = line.trim(), last = lines[lines.length - 1];
    if (!inside || inside === "---") return;
    if (/^\s*\t/.test(line)) unreadable(i + 1, "a tab is in the indentation: use spaces");
    if (last && last.open > 0) { last.text += ` ${inside}`; last.open += depth(inside); return; }
    lines.push({indent: line.length - line.trimStart().length, text: inside, open: depth(inside), at: i + 1});
  });
  if (!lines.length) unreadable(1, "the text is empty: give a scene that begins with /**:");
  let k = 0;
  const document = block(lines[0].indent);
  if (k < lines.length) unreadable(lines[k].at, "it is indented less than the first line");
  return document;

  function depth(part) {
    const plain = part.replace(/"[^"]*"|'[^']*'/g, "");
    return plain.replace(/[^{[]/g, "").length - plain.replace(/[^}\]]/g, "").length;
  }
  function block(indent) {
    const map = {};
    while (k < lines.length && lines[k].indent >= indent) {
      const line = lines[k++];
      const found = /^("[^"]*"|'[^']*'|[^\s"'{}[\],&*!|>%@`-][^:]*):(?:\s+(.*))?$/.exec(line.text);
      if (line.indent > indent) unreadable(line.at, "it is indented more than the line above");
      if (!found) unreadable(line.at, line.text.startsWith("-") ? "write lists in brackets: [0.0, 0.035]" : "write name: value");
      const name = found[1].replace(/^["']|["']$/g, "").trim();
      if (Object.hasOwn(map, name)) unreadable(line.at, `${name} is given twice: drop one`);
      const inner = k < lines.length && lines[k].indent > indent ? lines[k] : null;
      if (found[2]) map[name] = flow(found[2], line.at);
      else if (inner && /^[{[]/.test(inner.text)) { k++; map[name] = flow(inner.text, inner.at); }
      else map[name] = inner ? block(inner.indent) : null;
    }
    return map;
  }
  function flow(source, at) {
    let i = 0;
    const value = one(false);
    if (source.slice(i).trim()) unreadable(at, `${source.slice(i).trim()} follows the value: drop it`);
    return value;

    function skip() { while (source[i] === " ") i++; }
    function one(isInside) {
      skip();
      if (source[i] === "{") return many("}", map => {
        const found = /^\s*("[^"]*"|'[^']*'|[\w./*-]+)\s*:\s/.exec(source.slice(i));
        if (!found) unreadable(at, "write {name: value, name: value}");
        i += found[0].length;
        map[found[1].replace(/^["']|["']$/g, "")] = one(true);
      }, {});
      if (source[i] === "[") return many("]", list => list.push(one(true)), []);
      const found = (isInside ? /^("(?:[^"\\]|\\.)*"|'[^']*'|[^,\]}]*)/ : /^("(?:[^"\\]|\\.)*"|'[^']*'|.*)/).exec(source.slice(i))[0];
      i += found.length;
      return plain(found.trim());
    }
    function many(end, take, into) {
      for (i++, skip(); source[i] !== end;) {
        if (i >= source.length) unreadable(at, `${end} is missing`);
        take(into);
        skip();
        if (source[i] === ",") { i++; skip(); } else if (source[i] !== end) unreadable(at, `${end} is missing`);
      }
      i++;
      return into;
    }
    function plain(word) {
      if (/^["']/.test(word)) return word.slice(1, -1);
      if (/^[&*!|>%@`]/.test(word)) unreadable(at, `${word} is more YAML than a scene needs: write the value itself`);
      if (/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(word)) return Number(word);
      const known = {"true": true, "false": false, "null": null, "~": null, "": null, ".inf": Infinity, "-.inf": -Infinity, ".nan": NaN};
      return Object.hasOwn(known, word.toLowerCase()) ? known[word.toLowerCase()] : word;
    }
  }
  function unreadable(at, what) { throw new Refusal(`line ${at} of the scene cannot be read: ${what}`); }
}

// Values, by dotted name: complete, and in their ranges.

function valuesOf(text) {
  const given = {};
  for (const [node, section] of Object.entries(readYaml(text))) {
    const inner = section && section.ros__parameters;
    if (!inner || typeof inner !== "object") refuse("file", node, "a section /**: with ros__parameters: in it", "open a scene, as the shipped ones");
    if (!/^\/?(\*\*?|feed_axis|.*\/feed_axis)$/.test(node)) refuse("node", node, "/** or feed_axis", "a scene file holds the parameters of one axis only");
    flatten(inner, "", given);
  }
  const file = Object.keys(given).find(name => /\.file(_|$)/.test(name));
  if (file) throw new Refusal(`this page cannot run an input profile from a file (${file}): open the page with stickslip explore, which puts its points into the scene`);
  return overBase(given);
}

function flatten(tree, path, into) {
  for (const [key, value] of Object.entries(tree)) {
    const name = path ? `${path}.${key}` : key;
    if (value && typeof value === "object" && !Array.isArray(value)) flatten(value, name, into);
    else if (value !== null && !PASSED_OVER.test(name)) into[name] = value;
  }
  return into;
}

function overBase(given) {
  const base = PAGE.shipped[given.scene];
  if (base) return complete(overridden(flatten(readYaml(base)["/**"].ros__parameters, "", {}), given));
  for (const needed of ["friction.static", "friction.kinetic"]) {
    if (!given.scene && !Object.keys(given).some(name => name.startsWith(needed))) refuse(needed, null, "given in a scene without a name", "add it");
  }
  return complete(given);
}

function holds(entry, values) { return !entry.when || entry.when[1].includes(values[entry.when[0]]); }

function overridden(base, changes) {
  const outlived = name => {
    const when = ENTRY[name]?.when;
    return Boolean(when) && (when[0] in changes ? !when[1].includes(changes[when[0]]) : outlived(when[0]));
  };
  return {...Object.fromEntries(Object.entries(base).filter(([name]) => !outlived(name))), ...changes};
}

function complete(given) {
  const values = {};
  for (const name of Object.keys(given)) if (!ENTRY[name]) refuse(name, given[name], "a parameter of a scene", "no parameter has this name: check it");
  for (const entry of PAGE.schema) {
    const value = given[entry.name];
    if (value !== undefined && value !== null) {
      if (!holds(entry, values)) refuse(entry.name, value, `left out with ${entry.when[0]}: ${values[entry.when[0]]}`, "drop it");
      values[entry.name] = checked(entry, value);
    } else if (holds(entry, values)) {
      if (entry.default !== null) values[entry.name] = entry.default;
      else if (entry.required) refuse(entry.name, null, entry.allowed, "add it");
    }
  }
  return values;
}

function checked(entry, value) {
  const isNumber = item => typeof item === "number" && (entry.lowOpen ? item > entry.low : entry.low === null || item >= entry.low)
    && (entry.high === null || item <= entry.high || (entry.infinite && item === Infinity));
  const isRight = {
    double: isNumber, integer: item => Number.isInteger(item) && isNumber(item), bool: item => typeof item === "boolean",
    string: item => typeof item === "string" && (!entry.choices.length || entry.choices.includes(item)),
    double_array: list => Array.isArray(list) && list.length > 0 && list.every(isNumber),
    string_array: list => Array.isArray(list) && list.every(item => typeof item === "string"),
  }[entry.type];
  if (!isRight(value)) refuse(entry.name, value, entry.allowed, "give such a value");
  return value === 0 ? 0 : value;
}

// And back to text: the canonical file that the tool writes, too.

function numberText(value) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? ".nan" : value > 0 ? ".inf" : "-.inf";
  const [digits, power] = String(value).split("e");
  return digits + (digits.includes(".") ? "" : ".0") + (power ? `e${power}` : "");
}

function valueText(entry, value) {
  if (Array.isArray(value)) return `[${value.map(item => valueText(entry, item)).join(", ")}]`;
  if (typeof value === "number" && entry.type !== "integer") return numberText(value);
  return typeof value === "string" && !entry.choices.length ? JSON.stringify(value) : String(value);
}

function sceneText(values) {
  const lines = ["/**:", "  ros__parameters:"];
  let inside = [];
  for (const entry of PAGE.schema) {
    if (values[entry.name] === undefined) continue;
    const sections = entry.name.split("."), leaf = sections.pop();
    sections.forEach((section, depth) => {
      if (inside.slice(0, depth + 1).join() !== sections.slice(0, depth + 1).join()) lines.push(`${"  ".repeat(depth + 2)}${section}:`);
    });
    inside = sections;
    lines.push(`${"  ".repeat(sections.length + 2)}${leaf}: ${valueText(entry, values[entry.name])}`);
  }
  return `${lines.join("\n")}\n`;
}

// What the engine takes.

function checkRunnable(v) {
  const cannot = [
    [v["solver.name"] !== "exact", `solver.name: ${v["solver.name"]}`, "it has the exact solver alone"],
    [v["drive.course"] === "position", "drive.course: position", "give velocities"],
    ["normal_load.course" in v, "a normal_load over time", "its normal force is constant"],
    [Object.keys(v).some(name => name.includes(".backward.")), "friction that differs backwards", "it has one friction for both directions"],
    [(v["friction.scale"] ?? 1) !== 1, "friction.scale", "scale the coefficients themselves"],
    [v["friction.static.scatter"] || v["friction.static.scatter_run"], "friction.static.scatter", "its static friction has no scatter: set it to 0"],
    ["faults.kinds" in v, "faults", "inject them with stickslip simulate"],
  ].find(([is]) => is);
  if (cannot) throw new Refusal(`this page cannot run ${cannot[1]}: ${cannot[2]}`);
}

function axisOf(v) {
  checkRunnable(v);
  const kinetic = kineticOf(v), excess = v["friction.acceleration_dependence"] ? excessOf(v, kinetic) : null;
  const initial = v["friction.static.initial"], law = v["friction.static.law"], limit = v["friction.static.limit"] ?? initial;
  if (limit < initial) refuse("friction.static.limit", limit, `>= friction.static.initial (${worded(initial)})`, "static friction grows with rest time");
  if (kinetic.coefficients[0] > initial) refuse(v["friction.kinetic.law"] === "table" ? "friction.kinetic.coefficients[0]" : "friction.kinetic.initial", kinetic.coefficients[0], `<= friction.static.initial (${worded(initial)})`, "kinetic friction at rest cannot exceed static friction");
  if (law === "logarithmic" && v["initial.rest_time"] === Infinity) refuse("initial.rest_time", Infinity, "finite with the logarithmic static law", "give the seconds of rest before the start");
  const speeds = [...new Set([...kinetic.velocities, ...(excess ? excess.velocities : [])])].sort((a, b) => a - b);
  const p = new Parameters(), isCompliant = v["contact.model"] === "compliant";
  Object.assign(p, {
    mass: v["axis.mass"], stiffness: v["axis.drive_stiffness"], damping: v["axis.drive_damping"], feed_share: v["axis.damper"] === "slideway" ? 0 : 1,
    normal_force: v["axis.normal_force"], compliant: +isCompliant, contact_stiffness: v["contact.stiffness"] ?? 0, contact_damping: v["contact.damping"] ?? 0,
    arrest_share: +!(isCompliant && v["contact.arrest"] === "undeflected"), ends_by_drive: +(isCompliant && v["contact.break_away"] === "drive_force"),
    static_law: ENTRY["friction.static.law"].choices.indexOf(law), static_initial: initial, static_limit: limit, static_tau: v["friction.static.time_constant"] ?? 1,
    static_exponent: v["friction.static.exponent"] ?? 1, static_delay: v["friction.static.delay"] ?? 0, branches: +Boolean(excess), end_slope: kinetic.endSlope,
    segment_count: speeds.length, sided: 0, backward_segment: 0, normal_rate: 0, seed: 0, scatter: 0, scatter_run: 0, drawn_sticks: 0,
  });
  Object.assign(p, {backward_initial: p.static_initial, backward_limit: p.static_limit, backward_tau: p.static_tau, backward_exponent: p.static_exponent});
  p.segments = speeds.map((speed, i) => Object.assign(new Segment(), {
    speed, end: speeds[i + 1] ?? Infinity, friction: tableAt(kinetic.velocities, kinetic.coefficients, speed, kinetic.endSlope),
    psi: excess ? tableAt(excess.velocities, excess.fractions, speed, 0) : 0, slope: slopeAbove(kinetic.velocities, kinetic.coefficients, speed, kinetic.endSlope),
    psi_slope: excess ? slopeAbove(excess.velocities, excess.fractions, speed, 0) : 0,
  }));
  const begin = ["position", "velocity", "rest_time", "stretch", "deflection"].map(name => v[`initial.${name}`]);
  const carried = p.contact_stiffness * begin[4] + p.contact_damping * begin[1];
  if (begin[4] && !(isCompliant && Math.abs(carried) <= p.normal_force * staticAt(p, begin[2]))) refuse("initial.deflection", begin[4], "such that a compliant contact carries at most N mu_s", "lower it, or use 0");
  return {p, begin, kinetic, excess, drive: profileOf(v, "drive", "velocity", "acceleration", "velocities"), force: profileOf(v, "force", "constant", "rate", "forces"), sinusoids: sinusoidsOf(v)};
}

function staticAt(p, rest) {
  return static_static_coefficient(p.static_law, p.static_initial, p.static_limit, p.static_tau, p.static_exponent, Math.max(rest - p.static_delay, 0));
}

function slopeAbove(xs, ys, x, end) {
  let i = 0;
  while (i + 1 < xs.length && xs[i + 1] <= x) i++;
  return i + 1 === xs.length ? end : (ys[i + 1] - ys[i]) / (xs[i + 1] - xs[i]);
}

function tableAt(xs, ys, x, end) {
  let i = 0;
  while (i + 1 < xs.length && xs[i + 1] <= x) i++;
  return ys[i] + slopeAbove(xs, ys, x, end) * (x - xs[i]);
}

function rising(name, xs, other, ys, below) {
  if (xs.length !== ys.length) refuse(name, xs, `as many numbers as ${other} (${ys.length})`, "give one value for every breakpoint");
  if (xs[0] !== 0) refuse(name, xs[0], "0 at the first breakpoint", "a table starts at 0");
  xs.forEach((x, i) => { if (!(x < (xs[i + 1] ?? below))) refuse(name, xs, "strictly increasing", `${worded(xs[i + 1] ?? below)} follows ${worded(x)}`); });
}

function kineticOf(v) {
  const of = name => v[`friction.kinetic.${name}`], law = of("law");
  if (law === "table") {
    rising("friction.kinetic.velocities", of("velocities"), "coefficients", of("coefficients"), Infinity);
    return {velocities: of("velocities"), coefficients: of("coefficients"), endSlope: of("end_slope"), limitVelocity: of("velocities").at(-1)};
  }
  const shape = law === "hyperbolic" ? SHAPES.hyperbola() : SHAPES.decay(law === "stribeck" ? of("exponent") : 1);
  const fall = of("initial") - of("limit"), points = fall ? shapeTable("friction.kinetic", shape, of("tolerance") / Math.abs(fall)) : [[0, 0]];
  const velocities = points.map(([z]) => of("stribeck_velocity") * z);
  const coefficients = points.map(([, g], i) => i ? of("limit") + fall * g + of("viscous") * velocities[i] : of("initial"));
  return {velocities, coefficients, endSlope: of("viscous"), limitVelocity: of("stribeck_velocity") * shape.reach(0.01),
          slope: w => fall / of("stribeck_velocity") * shape.slope(w / of("stribeck_velocity")) + of("viscous")};
}

function excessOf(v, kinetic) {
  const of = name => v[`friction.excess.${name}`], law = of("law");
  if (law !== "table") {
    const shape = law === "power" ? SHAPES.power(of("exponent")) : SHAPES.cosine(), points = shapeTable("friction.excess", shape, of("tolerance"));
    return {velocities: points.map(([z]) => (of("limit_velocity") ?? kinetic.limitVelocity) * z), fractions: points.map(([, g]) => g)};
  }
  const velocities = of("velocities"), fractions = of("fractions");
  if (!velocities !== !fractions) refuse("friction.excess", velocities ?? fractions, "given with both velocities and fractions", "add the other, or leave both out");
  if (velocities) {
    rising("friction.excess.velocities", velocities, "fractions", fractions, Infinity);
    if (fractions[0] !== 1 || fractions.at(-1) !== 0 || fractions.some((one, i) => one < fractions[i + 1])) refuse("friction.excess.fractions", fractions, "falling from 1 to 0", "psi is relative to the excess at the break-away");
    return {velocities, fractions};
  }
  if (!kinetic.limitVelocity) refuse("friction.excess", null, "a table when friction.kinetic has one breakpoint only", "set friction.acceleration_dependence: false");
  return {velocities: [0, kinetic.limitVelocity], fractions: [1, 0]};
}

function profileOf(v, section, value, rate, breakpoints) {
  const of = name => v[`${section}.${name}`], course = of("course"), made = new Pieces();
  Object.assign(made, {latest: 0, period: Infinity, starts: [0], values: [of(value) ?? 0], rates: [0]});
  if (course === "ramp") {
    const end = of("duration"), last = of(value) + of(rate) * end;
    Object.assign(made, end === Infinity ? {rates: [of(rate)]} : {starts: [0, end], values: [of(value), last], rates: [of(rate), 0]});
  } else if (course === "steps" || course === "table") {
    const times = of("times"), values = of(breakpoints), period = of("period"), isTable = course === "table";
    rising(`${section}.times`, times, breakpoints, values, period);
    const slope = i => i + 1 < times.length ? (values[i + 1] - values[i]) / (times[i + 1] - times[i]) : period < Infinity ? (values[0] - values[i]) / (period - times[i]) : 0;
    Object.assign(made, {period, starts: times, values, rates: times.map((_, i) => isTable ? slope(i) : 0)});
  }
  made.count = made.starts.length;
  return made;
}

function sinusoidsOf(v) {
  const found = new Sinusoids();
  ["drive", "force"].forEach((section, place) => {
    const of = name => v[`${section}.${name}`] ?? [], isSine = v[`${section}.course`] === "sine";
    const amplitudes = [...(isSine ? [v[`${section}.amplitude`]] : []), ...of("amplitudes")];
    const frequencies = [...(isSine ? [v[`${section}.frequency`]] : []), ...of("frequencies")], phases = [...(isSine ? [v[`${section}.phase`]] : []), ...of("phases")];
    if (frequencies.length !== amplitudes.length || (of("phases").length && phases.length !== amplitudes.length)) refuse(`${section}.frequencies`, frequencies, `as many as there are amplitudes (${amplitudes.length})`, "give one for every sinusoid");
    amplitudes.forEach((amplitude, i) => {
      if (amplitude) found.rows.push(Object.assign(new GivenSinusoid(), {frequency: frequencies[i], phase: 0.5 * (phases[i] ?? 0) / Math.PI % 1, v: place ? 0 : amplitude, f: place ? amplitude : 0, n: 0}));
    });
  });
  found.count = found.rows.length;
  return found;
}

// Smooth laws as tables, step by step as friction/refine.py does it, so that a scene has the same breakpoints.

const SHAPES = {
  decay: n => ({inflection: n > 1 ? ((n - 1) / n) ** (1 / n) : 0, value: z => Math.exp(-(z ** n)), reach: share => (-Math.log(share)) ** (1 / n),
                slope: z => z === 0 ? (n > 1 ? 0 : n === 1 ? -1 : -Infinity) : -n * (z ** n / z) * Math.exp(-(z ** n))}),
  hyperbola: () => ({inflection: 0, value: z => 1 / (1 + z), slope: z => -1 / (1 + z) / (1 + z), reach: share => 1 / share - 1}),
  cosine: () => ({inflection: 0.5, value: z => z < 1 ? Math.cos(0.5 * Math.PI * z) ** 2 : 0, slope: z => z < 1 ? -0.5 * Math.PI * Math.sin(Math.PI * z) : 0, reach: share => Math.acos(2 * share - 1) / Math.PI}),
  power: n => ({inflection: 0, value: z => z < 1 ? (1 - z) ** n : 0, slope: z => z < 1 ? -n * (1 - z) ** (n - 1) : 0, reach: share => 1 - share ** (1 / n)}),
};

function shapeTable(name, shape, tolerance) {
  const allowed = Math.min(tolerance, 0.25) * 0.999, points = [[0, 1]];
  for (let bend = 1 / 3; points.at(-1)[1] > 0; bend = 0.5) {
    if (points.length === 1000) refuse(`${name}.tolerance`, tolerance, "large enough for at most 1000 breakpoints", "raise it");
    points.push(nextBreakpoint(shape, points.at(-1), allowed, bend * allowed));
  }
  return points;
}

function nextBreakpoint(shape, [z, p], allowed, bend) {
  const concave = z < shape.inflection;
  if (!concave && p <= allowed) return [shape.reach(0.25 * allowed), 0];
  let [touch, rise] = tangent(shape, z, p, bend, concave);
  const above = x => p + rise * (x - z) - shape.value(x);
  if (touch < shape.inflection) {
    const back = where(x => rise - shape.slope(x), shape.inflection, shape.inflection);
    if (above(back) >= allowed) {
      const end = rootOf(x => above(x) - allowed, touch, above(touch) - allowed, back, above(back) - allowed);
      return [end, p + rise * (end - z)];
    }
    touch = back;
  }
  const end = where(x => above(x) + allowed, touch, touch - z), fall = z - p / rise;
  return fall <= end ? [fall, 0] : [end, p + rise * (end - z)];
}

function tangent(shape, z, p, bend, concave) {
  const sign = concave ? -1 : 1, first = sign * (shape.value(z) - p) + bend;
  const gap = x => sign * (shape.value(x) + shape.slope(x) * (z - x) - p) + bend;
  if (first <= 0) return [z, shape.slope(z)];
  if (concave && gap(shape.inflection) > 0) return [shape.inflection, shape.slope(shape.inflection)];
  const touch = where(gap, z, concave ? shape.inflection - z : Math.max(z, 1e-3), first);
  return [touch, (shape.value(touch) + sign * bend - p) / (touch - z)];
}

function where(f, start, step, first) {
  let a = start, fa = first ?? f(start);
  for (step = step > 0 ? step : 1e-3; ; step *= 2) {
    const b = start + step, fb = f(b);
    if (fb <= 0) return rootOf(f, a, fa, b, fb);
    if (b > 1e300) return b;
    a = b; fa = fb;
  }
}

function rootOf(f, a, fa, b, fb) {
  for (let turn = 0; turn < 200 && !(b - a <= 1e-15 * Math.abs(b) || fb === 0); turn++) {
    let x = (a * fb - b * fa) / (fb - fa);
    if (!(a < x && x < b)) x = a + 0.5 * (b - a);
    if (!(a < x && x < b)) break;
    const fx = f(x);
    if (fx === 0) return x;
    if ((fx < 0) === (fb < 0)) { b = x; fb = fx; fa *= 0.5; } else { a = x; fa = fx; fb *= 0.5; }
  }
  return b;
}
