# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Check a run against the set-valued law itself, not against the way it was computed.

At any instant, with ẍ from differences of the positions and F_d from positions and the integrated feed:

    m ẍ = F_d + F_e - F
    slip   σ F in [N mu_k, N (mu_k + E psi)], the upper end when σ ẍ > 0, the lower when σ ẍ < 0
    rest   |F| <= N mu_s(t^-), ẋ = 0 (rigid) or F = F_0 + c_c (x - x_0) + h_c ẋ (compliant)
"""

from __future__ import annotations

import itertools
from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import mpmath
from mpmath import mpf

from stickslip_sim.reference.exact_run import Event, Run, Sample

_STEP = mpf(10) ** -15
_SMALL = mpf(10) ** -12


def violations(run: Run, parameters: Mapping[str, Any], times: Iterable[float]) -> list[str]:
    """Return a line for every instant at which the law is broken by more than 1e-12 of the force scale."""
    with mpmath.workdps(run.digits):
        return [text for t in times for text in _check(run, parameters, mpf(t))]


def _check(run: Run, p: Mapping[str, Any], t: mpf) -> list[str]:
    if _near_change(run, p, t):
        return []
    before, here, after = run.state_at([t - _STEP, t, t + _STEP])
    acceleration = (after.velocity - before.velocity) / (2 * _STEP)
    speed_error = (after.position - before.position) / (2 * _STEP) - here.velocity
    axis = p['axis']
    drive = mpf(axis['drive_stiffness']) * (_feed(p['drive'], t) - (here.position - mpf(p['initial']['position'])))
    drive += mpf(axis['drive_damping']) * (_input(p['drive'], t) - here.velocity)
    force = _input(p['force'], t)
    scale = abs(drive) + abs(force) + abs(here.friction_force) + axis['normal_force']
    residual = mpf(axis['mass']) * acceleration - (drive + force - here.friction_force)
    last = _last_event(run, t)
    broken = {
        'velocity': abs(speed_error) > _SMALL * (1 + abs(here.velocity)),
        'drive force': abs(drive - here.drive_force) > _SMALL * scale,
        'motion': abs(residual) > _SMALL * scale,
    }
    if _resting(p, last):
        broken['rest'] = not _rest_law(p, last, here, scale)
    else:
        broken['slip'] = not _slip_law(run, p, here, acceleration, scale)
    return [f'{name} at t = {mpmath.nstr(t, 12)}' for name, bad in broken.items() if bad]


def _near_change(run: Run, p: Mapping[str, Any], t: mpf) -> bool:
    jumps = [start for key in ('drive', 'force') for start, _, _ in _rows(p[key], t + 1)]
    changes = [*(e.time for e in run), *jumps, run.final.time]
    return any(abs(t - c) < 3 * _STEP for c in changes)


def _last_event(run: Run, t: mpf) -> Event | None:
    index = bisect_right([e.time for e in run], t)
    return run[index - 1] if index else None


def _resting(p: Mapping[str, Any], last: Event | None) -> bool:
    return p['initial']['velocity'] == 0 if last is None else last.kind == 'stick'


def _rest_law(p: Mapping[str, Any], last: Event | None, here: Sample, scale: mpf) -> bool:
    normal, initial = mpf(p['axis']['normal_force']), p['initial']
    age = here.time - last.time if last else mpf(initial['rest_time']) + here.time
    inside = abs(here.friction_force) <= normal * static_coefficient(p['friction']['static'], age) + _SMALL * scale
    if p['contact']['model'] == 'rigid':
        return bool(inside and here.velocity == 0)
    start = last.position if last else mpf(initial['position'])
    preload = last.direction * normal * mpf(p['friction']['kinetic']['coefficients'][0]) if last else mpf(0)
    contact = preload + mpf(p['contact']['stiffness']) * (here.position - start)
    contact += mpf(p['contact']['damping']) * here.velocity
    return bool(inside and abs(contact - here.friction_force) <= _SMALL * scale)


def _slip_law(run: Run, p: Mapping[str, Any], here: Sample, acceleration: mpf, scale: mpf) -> bool:
    normal, friction = mpf(p['axis']['normal_force']), p['friction']
    sigma = 1 if here.velocity > 0 else -1
    speed, force = abs(here.velocity), sigma * here.friction_force
    low = normal * table(friction['kinetic'], 'coefficients', speed)
    high = low + normal * _excess(run, p, here.time) * psi(friction, speed)
    slack = _SMALL * scale
    pull = sigma * acceleration * mpf(p['axis']['mass'])
    if pull > slack and abs(force - high) > slack:
        return False
    if pull < -slack and abs(force - low) > slack:
        return False
    return bool(low - slack <= force <= high + slack)


def _excess(run: Run, p: Mapping[str, Any], t: mpf) -> mpf:
    """Return E of the slip under way: (mu_b - mu_k(w_b)) / psi(w_b)."""
    starts = [e for e in run if e.kind in ('breakaway', 'reverse') and e.time <= t]
    if not starts or not p['friction'].get('acceleration_dependence'):
        return mpf(0)
    speed, share = abs(starts[-1].velocity), psi(p['friction'], abs(starts[-1].velocity))
    over = starts[-1].static_coefficient - table(p['friction']['kinetic'], 'coefficients', speed)
    return over / share if share else mpf(0)


def psi(friction: Mapping[str, Any], speed: mpf) -> mpf:
    """Return the excess share at a speed."""
    default = {'velocities': [0.0, friction['kinetic']['velocities'][-1]], 'fractions': [1.0, 0.0]}
    return table(friction.get('excess', default), 'fractions', speed)


def table(data: Mapping[str, Any], values: str, speed: mpf) -> mpf:
    """Interpolate linearly; the given slope (or none) beyond the last breakpoint."""
    breakpoints = [(mpf(v), mpf(y)) for v, y in zip(data['velocities'], data[values])]
    for (v0, y0), (v1, y1) in itertools.pairwise(breakpoints):
        if speed <= v1:
            return y0 + (y1 - y0) * (speed - v0) / (v1 - v0)
    return breakpoints[-1][1] + mpf(data.get('end_slope', 0.0)) * (speed - breakpoints[-1][0])


def static_coefficient(law: Mapping[str, Any], age: mpf) -> mpf:
    """Return mu_s(age)."""
    first = mpf(law['initial'])
    if law['law'] == 'constant':
        return first
    z = age / mpf(law['time_constant'])
    share = {
        'exponential': lambda: 1 - mpmath.exp(-z),
        'kato': lambda: 1 - mpmath.exp(-(z ** mpf(law['exponent']))),
        'hyperbolic': lambda: 1 - 1 / (1 + z),
        'logarithmic': lambda: mpmath.log(1 + z),
    }[law['law']]()
    return first + (mpf(law['limit']) - first) * share


def _rows(profile: Any, until: mpf) -> list[tuple[mpf, mpf, mpf]]:
    """Return the pieces (start, value, slope) of a profile up to a time, periods written out."""
    given = profile if isinstance(profile, Mapping) else {'segments': profile}
    rows = [(mpf(a), mpf(b), mpf(c)) for a, b, c in given['segments']]
    if 'period' not in given:
        return rows
    period = mpf(given['period'])
    return [(n * period + a, b, c) for n in range(int(until / period) + 1) for a, b, c in rows]


def _sinusoids(profile: Any) -> Sequence[Sequence[float]]:
    return profile.get('waves', ()) if isinstance(profile, Mapping) else ()


def _input(profile: Any, t: mpf) -> mpf:
    start, first, slope = [row for row in _rows(profile, t) if row[0] <= t][-1]
    sinusoids = sum(mpf(a) * mpmath.sin(2 * mpmath.pi * mpf(f) * t + mpf(phase)) for a, f, phase in _sinusoids(profile))
    return first + slope * (t - start) + sinusoids


def _feed(profile: Any, t: mpf) -> mpf:
    """Return ∫ v dt from 0 to t."""
    total = mpf(0)
    rows = _rows(profile, t)
    for (start, first, slope), end in zip(rows, [*(row[0] for row in rows[1:]), mpmath.inf]):
        span = min(t, end) - start
        if span > 0:
            total += first * span + slope * span * span / 2
    for a, f, phase in _sinusoids(profile):
        omega = 2 * mpmath.pi * mpf(f)
        total += mpf(a) * (mpmath.cos(mpf(phase)) - mpmath.cos(omega * t + mpf(phase))) / omega
    return total
