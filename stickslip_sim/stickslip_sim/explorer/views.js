// Copyright 2026 The stickslip authors
// SPDX-License-Identifier: Apache-2.0
// What is drawn: plots with axes, by one description on a canvas or as SVG; and the axis itself, in motion.

const FONT = "12px system-ui, sans-serif", MM = 1e3;
const colour = name => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
let COLOURS = {};
function takeColours() { for (const name of ["ink", "dim", "grid", "paper", "slider", "drive", "friction", "limit", "measured", "fill"]) COLOURS[name] = colour(name); }

class CanvasPen {
  constructor(canvas, w, h) {
    const scale = devicePixelRatio || 1, context = canvas.getContext("2d");
    if (canvas.width !== Math.round(w * scale) || canvas.height !== Math.round(h * scale)) { canvas.width = Math.round(w * scale); canvas.height = Math.round(h * scale); }
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, w, h);
    context.font = FONT;
    context.lineJoin = "round";
    this.c = context;
  }
  line(points, stroke, width = 1.5, dash = []) {
    const c = this.c;
    c.beginPath();
    for (let i = 0, isDown = false; i < points.length; i += 2) {
      if (points[i + 1] !== points[i + 1]) isDown = false;
      else if (isDown) c.lineTo(points[i], points[i + 1]);
      else { c.moveTo(points[i], points[i + 1]); isDown = true; }
    }
    Object.assign(c, {strokeStyle: stroke, lineWidth: width});
    c.setLineDash(dash);
    c.stroke();
  }
  rect(x, y, w, h, fill) { this.c.fillStyle = fill; this.c.fillRect(x, y, w, h); }
  dot(x, y, r, fill) { this.c.fillStyle = fill; this.c.beginPath(); this.c.arc(x, y, r, 0, 7); this.c.fill(); }
  text(text, x, y, fill, align = "left") { Object.assign(this.c, {fillStyle: fill, textAlign: align}); this.c.fillText(text, x, y); }
  clip(x, y, w, h) { this.c.save(); this.c.beginPath(); this.c.rect(x, y, w, h); this.c.clip(); }
  free() { this.c.restore(); }
}

class SvgPen {
  constructor(w, h) { this.parts = [`<svg xmlns="http://www.w3.org/2000/svg" width="${w}" height="${h}" viewBox="0 0 ${w} ${h}" font-family="sans-serif" font-size="12">`]; this.clips = 0; }
  line(points, stroke, width = 1.5, dash = []) {
    let path = "", isDown = false;
    for (let i = 0; i < points.length; i += 2) {
      if (Number.isNaN(points[i + 1])) { isDown = false; continue; }
      path += `${isDown ? "L" : "M"}${points[i].toFixed(2)} ${points[i + 1].toFixed(2)}`;
      isDown = true;
    }
    this.parts.push(`<path d="${path}" fill="none" stroke="${stroke}" stroke-width="${width}" stroke-dasharray="${dash.join(" ")}" stroke-linejoin="round"/>`);
  }
  rect(x, y, w, h, fill) { this.parts.push(`<rect x="${x}" y="${y}" width="${w}" height="${h}" fill="${fill}"/>`); }
  dot(x, y, r, fill) { this.parts.push(`<circle cx="${x}" cy="${y}" r="${r}" fill="${fill}"/>`); }
  text(text, x, y, fill, align = "left") { this.parts.push(`<text x="${x}" y="${y}" fill="${fill}" text-anchor="${{left: "start", center: "middle", right: "end"}[align]}">${text.replace(/&/g, "&amp;").replace(/</g, "&lt;")}</text>`); }
  clip(x, y, w, h) { this.parts.push(`<clipPath id="c${++this.clips}"><rect x="${x}" y="${y}" width="${w}" height="${h}"/></clipPath><g clip-path="url(#c${this.clips})">`); }
  free() { this.parts.push("</g>"); }
  toString() { return `${this.parts.join("")}</svg>`; }
}

// Points of a curve in pixels: of times the first, lowest, highest and last of each column, else those that are apart.
function pixels(xs, ys, toX, toY, isTime, first = 0, last = xs.length) {
  const out = [];
  if (!isTime || last - first < 2000) {
    let px = -1e9, py = -1e9;
    for (let i = first; i < last; i++) {
      const x = toX(xs[i]), y = toY(ys[i]);
      if (y === y && (x - px) * (x - px) + (y - py) * (y - py) < 0.16 && i + 1 < last) continue;
      out.push(x, y);
      px = x; py = y;
    }
    return out;
  }
  for (let i = first; i < last;) {
    const column = Math.floor(toX(xs[i])), begin = i;
    let low = i, high = i;
    while (i < last && toX(xs[i]) < column + 1) {
      if (ys[i] !== ys[i]) { if (i === begin) i++; break; }
      if (ys[i] < ys[low]) low = i;
      if (ys[i] > ys[high]) high = i;
      i++;
    }
    let last_ = -1;
    for (const k of [begin, Math.min(low, high), Math.max(low, high), i - 1]) {
      if (k !== last_) out.push(toX(xs[k]), toY(ys[k]));
      last_ = k;
    }
  }
  return out;
}

function ticks(low, high, count, isLog) {
  if (isLog) return Array.from({length: Math.floor(Math.log10(high) + 1e-9) - Math.ceil(Math.log10(low) - 1e-9) + 1}, (_, i) => 10 ** (Math.ceil(Math.log10(low) - 1e-9) + i));
  const raw = (high - low) / count, size = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].find(one => one * size >= raw) * size;
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step);
  return found;
}

function short(number, digits = 4) {
  if (number === undefined || number === null || Number.isNaN(number)) return "–";
  const size = Math.abs(number);
  return number === 0 ? "0" : size >= 1e5 || size < 1e-3 ? number.toExponential(digits - 2).replace(/\.?0+e/, "e").replace("e+", "e") : String(Number(number.toPrecision(digits)));
}

class Plot {
  // `told`: {title, x: [label, factor, log], y: [label, factor], curves(run)}; the host has two canvases, the upper one for what moves.
  constructor(host, told) { Object.assign(this, {host, ...told, base: host.querySelector(".base"), over: host.querySelector(".over"), list: []}); }

  take(run) {
    this.run = run;
    this.list = this.curves(run).filter(curve => curve.xs.length);
    const range = (pick, given) => {
      let low = Infinity, high = -Infinity;
      for (const curve of this.list) {
        if (curve.isLoose) continue;
        const values = curve[pick];
        for (let i = 0; i < values.length; i++) { if (values[i] < low) low = values[i]; if (values[i] > high) high = values[i]; }
      }
      if (given) [low, high] = [given[0] ?? low, given[1] ?? high];
      if (!(low <= high)) [low, high] = [0, 1];
      if (low === high) { const pad = Math.abs(low) * 0.1 || 1e-9; [low, high] = [low - pad, high + pad]; }
      return [low, high];
    };
    const [fx, fy] = [this.x[1], this.y[1]];
    this.span = range("xs", this.within?.(run)).map(value => value * fx);
    const [low, high] = range("ys", this.height).map(value => value * fy);
    this.reach = this.height ? [low, high] : [low - 0.06 * (high - low), high + 0.06 * (high - low)];
  }

  draw() {
    const w = this.host.clientWidth, h = this.host.clientHeight;
    if (!w || !this.run || !this.isSeen) return;
    this.measure(w, h);
    this.paint(new CanvasPen(this.base, w, h));
    this.mark(this.index);
  }

  measure(w, h) {
    Object.assign(this, {w, h, left: 56, top: 26, right: w - 12, bottom: h - 34});
    const [x0, x1] = this.x[2] ? this.span.map(Math.log10) : this.span, [y0, y1] = this.reach, kx = (this.right - this.left) / (x1 - x0), ky = (this.bottom - this.top) / (y1 - y0);
    const [fx, fy] = [this.x[1], this.y[1]], left = this.left, bottom = this.bottom;
    this.toX = this.x[2] ? value => left + kx * (Math.log10(value * fx) - x0) : value => left + kx * (value * fx - x0);
    this.toY = value => bottom - ky * (value * fy - y0);
    this.back = px => { const at = x0 + (px - left) / kx; return (this.x[2] ? 10 ** at : at) / fx; };
  }

  paint(pen) {
    const {left, right, top, bottom, w, h} = this, {ink, dim, grid, paper} = COLOURS;
    pen.rect(0, 0, w, h, paper);
    for (const at of ticks(...this.span, Math.max(2, w / 90), this.x[2])) {
      const x = this.toX(at / this.x[1]);
      pen.line([x, top, x, bottom], grid, 1);
      pen.text(short(at), x, bottom + 15, dim, "center");
    }
    for (const at of ticks(...this.reach, Math.max(3, h / 48))) {
      const y = this.toY(at / this.y[1]);
      pen.line([left, y, right, y], grid, 1);
      pen.text(short(at), left - 6, y + 4, dim, "right");
    }
    pen.text(this.x[0], right, h - 5, dim, "right");
    pen.text(this.y[0], 6, top - 9, ink);
    pen.clip(left, top - 2, right - left, bottom - top + 4);
    for (const curve of this.list) {
      const stroke = COLOURS[curve.colour], bar = 0.5 * (right - left) / (curve.xs.length - 1);
      if (curve.bars) curve.xs.forEach((x, i) => pen.rect(this.toX(x) - bar, this.toY(curve.ys[i]), 2 * bar + 0.5, Math.max(bottom - this.toY(curve.ys[i]), 0), stroke));
      else if (curve.dots) curve.xs.forEach((x, i) => pen.dot(this.toX(x), this.toY(curve.ys[i]), 3.5, stroke));
      else pen.line(pixels(curve.xs, curve.ys, this.toX, this.toY, curve.isTime), stroke, curve.width, curve.dash);
    }
    pen.free();
    let x = right;
    for (const curve of this.list.filter(one => one.label).reverse()) {
      pen.text(curve.label, x, top - 9, ink, "right");
      x -= 6.2 * curve.label.length + 28;
      if (curve.dots || curve.bars) pen.dot(x + 9, top - 13, 3.5, COLOURS[curve.colour]);
      else pen.line([x, top - 13, x + 18, top - 13], COLOURS[curve.colour], curve.width ?? 1.5, curve.dash);
      x -= 10;
    }
  }

  mark(index) {
    this.index = index;
    if (!this.isSeen || !this.w) return;
    const pen = new CanvasPen(this.over, this.w, this.h), told = this.cursor?.(this.run, index);
    if (!told) return;
    if (this.isTime) pen.line([this.toX(told.x), this.top, this.toX(told.x), this.bottom], COLOURS.dim, 1);
    pen.clip(this.left - 5, this.top - 5, this.right - this.left + 10, this.bottom - this.top + 10);
    for (const [value, name] of told.points) pen.dot(this.toX(told.x), this.toY(value), 4.5, COLOURS[name]);
    pen.free();
    const y = told.isLow ? this.bottom - 8 : this.top + 13, width = 7 * told.text.length;
    pen.rect(this.right - width - 4, y - 12, width + 4, 16, COLOURS.paper);
    pen.text(told.text, this.right - 3, y, COLOURS.ink, "right");
  }

  svg() { const pen = new SvgPen(this.w, this.h); this.paint(pen); return String(pen); }
}

// The axis: the drive pulls the slider through spring and damper, over a slideway with its normal force.
class Scheme {
  constructor(host) { Object.assign(this, {host, over: host.querySelector(".over")}); }

  take(run) {
    this.run = run;
    this.size = largest(run.stretch) || 1e-12;
    this.force = largest(run.drive_force) || 1e-12;
  }

  draw() { this.mark(this.index); }

  mark(index = 0) {
    this.index = index;
    const w = this.host.clientWidth, h = this.host.clientHeight, run = this.run;
    if (!w || !run) return;
    const pen = new CanvasPen(this.over, w, h), {ink, dim, slider, drive, friction, fill} = COLOURS, scale = 0.2 * w / this.size;
    const ground = h - 44, tall = Math.min(74, ground - 34), wide = Math.min(0.2 * w, 130), x = 0.3 * w, end = x + wide / 2 + 0.22 * w + scale * run.stretch[index];
    const sign = run.mode[index] === codes_STICK ? "stick" : MODES[run.mode[index]];
    pen.rect(0, ground, w, 7, fill);
    const step = 24, offset = (((scale * run.position[index]) % step) + step) % step;
    for (let at = -offset; at < w + step; at += step) pen.line([at, ground + 7, at - 9, ground + 17], dim, 1);
    const body = ground - tall, middle = ground - 0.68 * tall, low = ground - 0.28 * tall, from = x + wide / 2;
    pen.rect(x - wide / 2, body, wide, tall - (run.axis.p.compliant ? 9 : 2), slider);
    if (run.axis.p.compliant) for (let at = -3; at <= 3; at++) {
      const lean = run.mode[index] === codes_STICK || run.mode[index] === 4 ? Math.max(-8, Math.min(8, scale * run.deflection[index] * 4)) : 0;
      pen.line([x + at * wide / 8 + lean, ground - 9, x + at * wide / 8, ground], ink, 1.5);
    }
    const coil = [from, middle, from + 10, middle], turns = 9, length = end - from - 20;
    for (let i = 0; i < turns; i++) coil.push(from + 10 + length * (i + 0.5) / turns, middle + (i % 2 ? 7 : -7));
    coil.push(end - 10, middle, end, middle);
    pen.line(coil, ink, 1.6);
    const cup = from + 0.4 * (0.22 * w), rod = Math.max(end - 0.1 * w, cup + 4);
    pen.line([from, low, cup, low, NaN, NaN, cup + 0.07 * w, low - 7, cup, low - 7, cup, low + 7, cup + 0.07 * w, low + 7, NaN, NaN, rod - 0.05 * w, low - 5, rod - 0.05 * w, low + 5, NaN, NaN, rod - 0.05 * w, low, end, low], ink, 1.6);
    pen.rect(end, body, 10, tall - 2, drive);
    const next = Math.min(index + 1, run.time.length - 1), goes = Math.sign(run.drive[next] - run.drive[next - 1]);
    this.arrow(pen, end + (goes < 0 ? 46 : 12), body + tall / 2, 34 * goes, drive);
    pen.text(run.axis.drive.count === 1 ? "drive" : "drive (profile)", Math.min(end - 4, w - 96), body - 8, ink);
    this.arrow(pen, x, body - 6, -0.2 * w * run.friction[index] / this.force, friction);
    pen.text(`slider: ${sign}`, x, body - 14, ink, "center");
    pen.text(`t = ${short(run.time[index])} s     ẋ = ${short(run.velocity[index] * MM, 3)} mm/s     friction ${short(run.friction[index], 3)} N`, 12, h - 8, ink);
  }

  arrow(pen, x, y, length, stroke) {
    if (Math.abs(length) < 2) return;
    const tip = x + length, side = Math.sign(length) * 7;
    pen.line([x, y, tip, y, NaN, NaN, tip - side, y - 5, tip, y, tip - side, y + 5], stroke, 2.5);
  }
}

function largest(values) {
  let most = 0;
  for (let i = 0; i < values.length; i++) most = Math.max(most, Math.abs(values[i]));
  return most;
}

// The plots of a run.

const part = (run, name, more) => ({xs: run.time, ys: run[name], isTime: true, ...more});
const beside = (name, time = PAGE.beside?.time) => PAGE.beside?.[name] ? [{xs: time, ys: PAGE.beside[name], colour: "measured", label: "measured", width: 3, isTime: true, isLoose: true}] : [];
const both = (run, psi) => {   // a branch of the friction characteristic, both ways
  const segments = run.axis.p.segments, top = Math.max(1.15 * segments.at(-1).speed, largest(run.velocity));
  const speeds = [...segments.map(one => one.speed), ...(top > segments.at(-1).speed ? [top] : [])];
  const values = speeds.map(w => { const at = segments.findLast(one => one.speed <= w); return at.friction + at.slope * (w - at.speed) + psi * (at.psi + at.psi_slope * (w - at.speed)); });
  return {xs: [...speeds.map(w => -w).reverse(), ...speeds], ys: [...values.map(one => -one).reverse(), ...values]};
};
const overTime = {x: ["time, s", 1], isTime: true, within: run => [0, run.end]};
const at = (run, i, text, points, more) => ({x: run.time[i], text: `${short(run.time[i])} s: ${text}`, points, ...more});

const PLOTS = {
  position: {title: "Position of slider and drive", y: ["position, mm", MM], ...overTime,
    curves: run => [...beside("position"), part(run, "drive", {colour: "drive", label: "drive", dash: [6, 3]}), part(run, "position", {colour: "slider", label: "slider", width: 2})],
    cursor: (run, i) => at(run, i, `${short(run.position[i] * MM)} mm, drive ${short(run.drive[i] * MM)} mm`, [[run.drive[i], "drive"], [run.position[i], "slider"]], {isLow: true})},
  velocity: {title: "Velocity of the slider", y: ["velocity, mm/s", MM], ...overTime,
    curves: run => [...beside("velocity"), part(run, "velocity", {colour: "slider", label: "slider", width: 2})],
    cursor: (run, i) => at(run, i, `${short(run.velocity[i] * MM)} mm/s`, [[run.velocity[i], "slider"]])},
  force: {title: "Drive force, friction, static limit", y: ["force, N", 1], ...overTime,
    curves: run => [...beside("drive_force"), part(run, "limit", {colour: "limit", label: "static limit", dash: [2, 3], width: 2}), part(run, "under", {colour: "limit", dash: [2, 3], width: 2, isLoose: true}),
      part(run, "drive_force", {colour: "drive", label: "drive", dash: [6, 3]}), part(run, "friction", {colour: "friction", label: "friction", width: 2})],
    cursor: (run, i) => at(run, i, `drive ${short(run.drive_force[i])} N, friction ${short(run.friction[i])} N`, [[run.drive_force[i], "drive"], [run.friction[i], "friction"]], {isLow: true})},
  phase: {title: "Phase plane with the last cycle", x: ["stretch of the drive spring, mm", MM], y: ["velocity, mm/s", MM],
    curves: run => {
      const [from, to] = run.cycle ?? [0, 0];
      return [{xs: run.stretch, ys: run.velocity, colour: "dim", width: 1, label: "run"}, {xs: run.stretch.subarray(from, to), ys: run.velocity.subarray(from, to), colour: "slider", width: 2.5, label: "last cycle"}];
    },
    cursor: (run, i) => ({x: run.stretch[i], points: [[run.velocity[i], "slider"]], text: `${short(run.stretch[i] * MM)} mm, ${short(run.velocity[i] * MM)} mm/s`})},
  law: {title: "Friction characteristic", x: ["velocity, mm/s", MM], y: ["friction / N", 1],
    curves: run => {
      const last = run.events.findLast(event => event.kind === codes_BREAKAWAY), excess = last ? Math.max(last.static_ - run.axis.p.segments[0].friction, 0) : 0, N = run.axis.p.normal_force || 1;
      return [...(run.axis.p.branches ? [{...both(run, excess), colour: "limit", dash: [2, 3], label: "accelerating", width: 2}] : []), {...both(run, 0), colour: "drive", dash: [6, 3], label: "kinetic"},
        {xs: run.velocity, ys: run.friction.map(one => one / N), colour: "friction", width: 2, label: "run"}];
    },
    cursor: (run, i) => ({x: run.velocity[i], points: [[run.friction[i] / (run.axis.p.normal_force || 1), "friction"]], isLow: true, text: `${short(run.velocity[i] * MM)} mm/s, ${short(run.friction[i] / (run.axis.p.normal_force || 1))}`})},
  rest: {title: "Static friction over rest time", x: ["rest time, s", 1], y: ["static coefficient", 1],
    curves: run => {
      const went = run.events.filter(event => event.kind === codes_BREAKAWAY && event.rest < Infinity), {p} = run.axis;
      const top = Math.max(p.static_delay + 5 * p.static_tau, ...went.slice(-200).map(event => 1.05 * event.rest)), xs = Array.from({length: 201}, (_, i) => top * i / 200);
      return [{xs, ys: xs.map(rest => staticAt(p, rest)), colour: "limit", dash: [2, 3], width: 2, label: "law"}, {xs: went.slice(-200).map(event => event.rest), ys: went.slice(-200).map(event => event.static_), colour: "slider", dots: true, label: "break-away"}];
    },
    cursor: (run, i) => {
      if (run.mode[i] !== codes_STICK || Math.abs(run.limit[i]) === Infinity) return null;
      const mu = run.limit[i] / (run.axis.p.normal_force || 1), since = run.events.findLast(event => event.time <= run.time[i] && event.mode === codes_STICK);
      return since ? {x: run.time[i] - since.time, points: [[mu, "limit"]], isLow: true, text: `${short(run.time[i] - since.time)} s, ${short(mu)}`} : null;
    }},
};
const STRIP = {title: "Over the feed: where it sticks and slips", x: ["feed, mm/s", MM, true], y: ["share in stick", 1], height: [0, 1], within: run => [run.low, run.high],
  curves: run => [
    {xs: run.feeds, ys: run.share, colour: "fill", bars: true, label: "stick-slip"}, {xs: run.feeds, ys: run.share, colour: "slider", width: 2},
    ...(run.critical ? [{xs: [run.critical, run.critical], ys: [0, 1], colour: "friction", width: 2.5, label: "critical"}] : []),
    ...(run.sliding > run.low && run.sliding < run.high ? [{xs: [run.sliding, run.sliding], ys: [0, 1], colour: "drive", dash: [6, 3], width: 2, label: "from sliding"}] : [])],
  isTime: true, cursor: run => run.feed && {x: run.feed, points: [[0, "ink"]], text: ""}};
