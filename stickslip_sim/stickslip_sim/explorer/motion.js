// Copyright 2026 The stickslip authors
// SPDX-License-Identifier: Apache-2.0
// Runs of the exact engine: events, samples, figures of the cycle; and over which feeds the axis sticks.

const MODES = ["stick", "accelerating slip", "coasting slip", "decelerating slip", "yielding"];
const ENDED = {2: "events follow each other and time does not go on", 3: "the state leaves the range of numbers", 4: "the motion contradicts itself"};
const MOST_EVENTS = 20000, SAMPLES = 10000, NO_SINUSOIDS = Object.assign(new Sinusoids(), {count: 0}), NO_PIECES = Object.assign(new Pieces(), {count: 0});
const COLUMNS = ["time", "position", "velocity", "drive", "stretch", "drive_force", "friction", "mode", "deflection", "limit", "under"];
const TABLE = Object.assign(new Events(), {count: 256, rows: rows(256, () => new EventRow())});

function stateFor(sinusoids) {
  const s = new State();
  s.scratch = rows(state_record_HIGHEST_ORDER + 1, () => new SeriesScratch());
  s.sinusoids = rows(sinusoids, () => new SinusoidRecord());
  s.accounting = 0;
  return s;
}
const STATE = stateFor(0);

function figuresFrom() { return Object.assign(new AxisFigures(), PAGE.figures); }

class Walk {
  constructor(axis, take) {
    Object.assign(this, {axis, take, s: axis.sinusoids.count ? stateFor(axis.sinusoids.count) : STATE, second: 0, fraction: 0});
    this.drive = Object.assign(new Pieces(), axis.drive);
    this.force = Object.assign(new Pieces(), axis.force);
    const v = pieces_piece_at(this.drive, 0), f = pieces_piece_at(this.force, 0);
    this.until = Math.min(v.item2, f.item2);
    this.book(engine_start(axis.p, this.s, ...axis.begin, v.item0, v.item1, f.item0, f.item1, axis.sinusoids, TABLE, 0));
  }

  book(count) { for (let i = 0; i < count; i++) this.take(TABLE.rows[i]); }

  to(time) {
    const {axis, s} = this, second = Math.floor(time), fraction = time - second;
    for (let ended = 1; ended === 1;) {
      if (this.until <= time) {
        const entered = pieces_enter_pieces(axis.p, s, this.drive, this.force, NO_PIECES, this.until, time, axis.sinusoids, TABLE, 0);
        this.until = entered.item0;
        this.book(entered.item1);
        ended = entered.item2;
        if (ended !== 0) continue;
      }
      const advanced = engine_advance(axis.p, s, second, fraction, TABLE, 0);
      this.book(advanced.item0);
      ended = advanced.item1;
      if (ended > 1) throw new Refusal(`the engine gives up at ${time} s: ${ENDED[ended]}; a parameter or an input is too extreme for this axis`);
    }
    this.second = second;
    this.fraction = fraction;
  }

  sample(row) { engine_sample(this.axis.p, this.s, this.second, this.fraction, row); }
}

// The events up to a time, and the figures of the last cycle among them.
function eventsOf(axis, end) {
  const events = [], figures = Object.assign(figuresFrom(), {final_mode: codes_STICK});
  const walk = new Walk(axis, row => {
    if (events.length >= MOST_EVENTS) throw new Refusal(`more than ${MOST_EVENTS} events within ${end} s: show a shorter time`);
    many_axes_book(figures, [], 0, row, 0.5 * end);
    events.push({...row, time: row.second + row.fraction});
  });
  if (!events.length) figures.final_mode = walk.s.mode;
  walk.to(end);
  if (figures.final_mode === codes_STICK) figures.stick_share += end - (figures.since_second + figures.since_fraction);
  figures.stick_share /= end;
  return {events, figures};
}

// The times to draw: even ones, and some between each two events, so that no corner is lost.
function timesOf(events, end, count) {
  const each = Math.min(40, Math.max(10, Math.floor(0.6 * count / (events.length + 1)))), times = [];
  const borders = [0, ...events.map(event => event.time), end];
  for (let i = 0; i + 1 < borders.length; i++) {
    const from = borders[i], length = borders[i + 1] - from, inside = Math.max(each, Math.ceil((count - each * borders.length) * length / end));
    for (let k = 0; k < inside && (length > 0 || !k); k++) times.push(from + length * k / inside);
  }
  times.push(end);
  return times;
}

function run(axis, end, count = SAMPLES) {
  const {events, figures} = eventsOf(axis, end), times = timesOf(events, end, count), row = new SampleRow();
  const columns = COLUMNS.map(() => new Float64Array(times.length)), walk = new Walk(axis, () => {});
  const [time, position, velocity, drive, stretch, drive_force, friction, mode, deflection, limit, under] = columns;
  for (let i = 0; i < times.length; i++) {
    walk.to(times[i]);
    walk.sample(row);
    time[i] = times[i]; position[i] = row.position; velocity[i] = row.velocity; drive[i] = row.drive; stretch[i] = row.drive - row.position;
    drive_force[i] = row.drive_force; friction[i] = row.friction; mode[i] = row.mode; deflection[i] = row.deflection;
    limit[i] = row.mode === codes_STICK ? axis.p.normal_force * staticAt(axis.p, row.rest) : NaN;
    under[i] = -limit[i];
  }
  return Object.fromEntries([["axis", axis], ["end", end], ["events", events], ["figures", figures], ...COLUMNS.map((name, i) => [name, columns[i]])]);
}

// How long to show: some cycles, by the time in which the drive loads the spring to the static limit; 1, 2 or 5.
function timeToShow(axis) {
  const {p, drive} = axis, speed = Math.max(...drive.values.map(Math.abs));
  const loading = p.stiffness * speed ? p.normal_force * Math.min(staticAt(p, Infinity), 10 * p.static_limit) / (p.stiffness * speed) : 0;
  const wanted = drive.period < Infinity ? drive.period : Math.max(6 * loading, p.stiffness ? 120 * Math.sqrt(p.mass / p.stiffness) : 1, 1e-4, 1.2 * drive.starts.at(-1));
  const size = 10 ** Math.floor(Math.log10(Math.min(wanted, 1e6)));
  return drive.period < Infinity ? wanted : [1, 2, 5, 10].find(one => one * size >= 0.999 * Math.min(wanted, 1e6)) * size;
}

// Whether stick-slip goes on from the start of a scene at a feed: 1, 0, or NaN where that is not known.
function sticksAt(axis, feed, most = 12) {
  const {p, begin} = axis, natural = p.stiffness ? 2 * Math.PI * Math.sqrt(p.mass / p.stiffness) : 1;
  const loading = p.normal_force * p.static_limit / (p.stiffness * Math.abs(feed) || 1);
  let duration = 2 ** Math.ceil(Math.log2(8 * Math.max(natural, loading))), a = null;
  for (let turn = 0; turn < most; turn++, duration *= 2) {
    const before = a;
    a = figuresFrom();
    many_axes_run_axis(p, STATE, ...begin, feed, axis.force.values[0], duration, NO_SINUSOIDS, TABLE, a, [], 0);
    const isRound = a.round_stick > 1e-6 * a.round_period;
    if (isRound && a.last_stick - a.round_settling > 8 * a.round_period) return {sticks: 1, figures: a};
    if (a.lasts || (before && a.events === before.events && a.final_mode !== codes_STICK)) return {sticks: 0, figures: a};
    if (a.events > 40000) break;
  }
  return {sticks: NaN, figures: a};
}

// The damping h + N mu_k' of steady sliding is negative below this feed; 0 where it is nowhere.
function slidingLostBelow(axis) {
  const {p, kinetic} = axis, isLost = slope => p.damping + p.normal_force * slope < 0;
  if (!kinetic.slope) {
    for (let i = p.segments.length - 1; i >= 0; i--) if (isLost(p.segments[i].slope)) return p.segments[i].end;
    return 0;
  }
  let low = 0, high = 0;
  for (let i = 4000; i > 0 && !low; i--) {
    const feed = kinetic.limitVelocity * i / 2000;
    if (isLost(kinetic.slope(feed))) low = feed; else high = feed;
  }
  for (let turn = 0; low && turn < 60; turn++) {
    const middle = 0.5 * (low + high);
    if (isLost(kinetic.slope(middle))) low = middle; else high = middle;
  }
  return low;
}

// The strip over the feed and its critical feed from rest, in steps, each a run: a generator.
function* strip(axis, feed, count = 40) {
  const low = Math.max(Math.abs(feed), 1e-9) / 100, sign = feed < 0 ? -1 : 1;
  const found = {feeds: [], share: [], slip: [], sticks: [], critical: null, sliding: slidingLostBelow(axis), low, high: low * 1e4};
  const at = place => low * 1e4 ** place;
  for (let i = 0; i <= count; i++) {
    const {sticks, figures} = sticksAt(axis, sign * at(i / count));
    found.feeds.push(at(i / count));
    found.sticks.push(sticks);
    found.share.push(sticks ? figures.round_stick / figures.round_period : 0);
    found.slip.push(sticks ? figures.round_travel : 0);
    yield found;
  }
  const last = found.sticks.lastIndexOf(1);
  if (last >= 0 && last < count) {
    let [a, b] = [found.feeds[last], found.feeds[last + 1]];
    while (b - a > 1e-6 * b) {
      const middle = Math.sqrt(a * b);
      if (sticksAt(axis, sign * middle).sticks === 1) a = middle; else b = middle;
      yield found;
    }
    found.critical = 0.5 * (a + b);
  }
  found.done = true;
  yield found;
}
