# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes near a degeneracy (of slopes, eigenvalues, scales, ties), and laws and inputs to the ends of their ranges."""

import math
import random

from stickslip_sim.core.types import EventKind

from ..case import Case, Values
from . import draw, machines


def slopes(rng: random.Random) -> Case:
    """Pieces of the kinetic table whose slopes lie twelve decades apart, falling, flat and rising."""
    mass, omega = rng.choice((1.0, 350.0)), draw.powers(rng, 3.0, 300.0)
    normal, at_rest = mass * 9.80665, rng.uniform(0.1, 1.0)
    stiffness = mass * omega * omega
    speed = normal * at_rest / (mass * omega)
    breakpoints, falls = [0.0], [at_rest]
    for _ in range(rng.randint(1, 5)):
        breakpoints.append(breakpoints[-1] + speed * draw.powers(rng, 1e-9, 1.0))
        change = at_rest * rng.choice((0.0, 1.0, 1.0)) * draw.powers(rng, 1e-9, 0.9)
        falls.append(min(max(falls[-1] + rng.choice((-1.0, -1.0, 1.0)) * change, 0.0), 1.5 * at_rest))
    values = draw.axis(mass, stiffness, rng.choice((0.0, 0.1, 1.0)) * mass * omega, normal)
    values |= _either(rng, stiffness, mass) | draw.kinetic(breakpoints, falls, 0.0, rng.random() < 0.3)
    values |= _static(rng, at_rest)
    feed = speed * draw.powers(rng, 1e-3, 1.0)
    return Case(values | draw.constant(feed) | draw.starts(rng, feed),
                40.0 / omega + 2.0 * at_rest * normal / stiffness / feed)


def critical_slip(rng: random.Random) -> Case:
    """A segment of the table on which a slip is damped critically, or nearly so; growing ones, too."""
    mass, stiffness = rng.choice(((1.0, 4.0), (350.0, 6e5), (3.0, 700.0), (1.0, 1.0)))
    normal = rng.choice((mass * 9.80665, 1.0))
    at_rest = rng.uniform(0.2, 1.0)
    omega = math.sqrt(stiffness / mass)
    speed = normal * at_rest / (mass * omega)
    critical = 2.0 * math.sqrt(stiffness * mass)
    n = rng.randint(2, 5)
    breakpoints = [0.0, *sorted(speed * draw.powers(rng, 1e-3, 1.0) for _ in range(n - 1))]
    falls = [at_rest, *sorted((at_rest * rng.uniform(0.1, 1.0) for _ in range(n - 1)), reverse=True)]
    if rng.random() < 0.3:
        falls[1] = falls[0]
    k = rng.randrange(n)
    slope = (falls[k + 1] - falls[k]) / (breakpoints[k + 1] - breakpoints[k]) if k + 1 < n else 0.0
    target = draw.near(rng, critical)
    damping = target - normal * slope
    end_slope = 0.0
    if rng.random() < 0.2 and k + 1 < n:
        # a falling segment that grows at the critical rate
        damping = 0.0
        falls[k + 1] = max(falls[k] - draw.near(rng, critical) * (breakpoints[k + 1] - breakpoints[k]) / normal, 0.0)
    elif rng.random() < 0.2:
        damping, end_slope = 0.5 * critical, draw.near(rng, 0.5 * critical) / normal
    values = draw.axis(mass, stiffness, damping, normal) | _either(rng, stiffness, mass)
    values |= draw.kinetic(breakpoints, falls, end_slope, rng.random() < 0.2) | _static(rng, at_rest)
    feed = speed * draw.powers(rng, 1e-2, 1.0)
    values |= draw.constant(feed, rng.choice((0.0, rng.uniform(-0.8, 0.8))) * normal * at_rest)
    return Case(values | draw.starts(rng, feed), 40.0 / omega + 2.0 * at_rest * normal / stiffness / feed)


def paper_critical(rng: random.Random) -> Case:
    """The paper's axis with a drive damped nearly critically, five breakpoints, any feed and force."""
    damping = draw.near(rng, 2.0 * math.sqrt(6e5 * 350.0), 1e-10, 1e-4)
    flat = rng.choice((0.12, 0.08))
    values = draw.paper(**{'axis.drive_damping': damping}) | draw.kinetic(
        [0.0, 0.001, 0.003, 0.01, 0.035], rng.choice(([0.12, flat, flat, flat, 0.05], [0.12, 0.12, 0.12, 0.12, 0.05],
                                                      [0.12, 0.1, 0.1, 0.1, 0.1])))
    return Case(values | draw.constant(rng.uniform(0.001, 0.06), rng.uniform(-600.0, 600.0)), 1.0)


def critical_contact(rng: random.Random) -> Case:
    """A contact that rings down critically, or nearly so."""
    mass, stiffness, contact = rng.choice(((350.0, 6e5, 5e6), (1.0, 1.0, 3.0), (2.0, 50.0, 1e4)))
    damping = 0.05 * math.sqrt(stiffness * mass)
    whole = draw.near(rng, 2.0 * math.sqrt((stiffness + contact) * mass))
    normal = mass * 9.80665
    values = draw.axis(mass, stiffness, damping, normal) | draw.contact(contact, whole - damping)
    at_rest = 0.3
    speed = normal * at_rest / math.sqrt(stiffness * mass)
    values |= draw.kinetic([0.0, 0.3 * speed], [at_rest, 0.2], 0.0, rng.random() < 0.5) | _static(rng, at_rest)
    feed = speed * draw.powers(rng, 3e-3, 0.3)
    period = 30.0 / math.sqrt(stiffness / mass)
    return Case(values | _wild(rng, feed, normal * at_rest, period) | draw.starts(rng, feed), 2.0 * period)


def equal_eigenvalues(rng: random.Random) -> Case:
    """Exactly critical damping, no spring, no damper, no friction: all that a closed form may divide by."""
    mass = rng.choice((0.5, 1.0, 4.0))
    omega = rng.choice((0.0, 1.0, 2.0, 8.0))
    stiffness = mass * omega * omega
    damping = rng.choice((0.0, 1.0, 1.0, 2.0)) * 2.0 * mass * omega if omega else rng.choice((0.0, 1.0))
    at_rest = rng.choice((0.0, 0.25, 0.5))
    values = draw.axis(mass, stiffness, damping, 8.0)
    values |= rng.choice((draw.contact(), draw.contact(64.0 * mass, rng.choice((0.0, 16.0 * mass)))))
    table = rng.choice((([0.0], [at_rest], 0.0), ([0.0, 0.5], [at_rest, 0.5 * at_rest], 0.0),
                        ([0.0, 0.25, 1.0], [at_rest, at_rest, 0.5 * at_rest], 0.25)))
    values |= draw.kinetic(*table, branches=len(table[0]) > 1 and rng.random() < 0.3)
    values |= draw.static(at_rest, rng.choice((None, 2.0 * at_rest if at_rest else 0.25)), 0.5)
    return Case(values | _wild(rng, rng.choice((0.25, 1.0)), 2.0, 12.0) | draw.starts(rng, 0.5), 12.0)


def limit_velocities(rng: random.Random) -> Case:
    """Limit velocities from a picometre to a kilometre in a second, two branches or one."""
    falls = [0.12, rng.choice((0.05, 0.0, 0.12))]
    values = draw.paper() | draw.kinetic([0.0, draw.powers(rng, 1e-12, 1e3)], falls, 0.0, rng.random() < 0.6)
    values |= rng.choice((draw.contact(), draw.contact(5e6, rng.choice((0.0, 15000.0)))))
    feed = draw.powers(rng, 1e-6, 0.1)
    return Case(values | draw.constant(feed) | draw.starts(rng, feed), 3.0 + min(20.0, 0.003 / feed))


def contacts(rng: random.Random) -> Case:
    """Contacts from far softer to far stiffer than the drive, from undamped to frozen."""
    stiffness = 6e5 * draw.powers(rng, 1e-4, 1e8)
    damping = rng.choice((0.0, draw.powers(rng, 1e-6, 1e3) * 2.0 * math.sqrt(350.0 * stiffness)))
    values = draw.paper() | draw.contact(stiffness, damping) | draw.kinetic([0.0, 0.035], [0.12, 0.05], 0.0,
                                                                            rng.random() < 0.5)
    feed = draw.powers(rng, 1e-4, 0.1)
    return Case(values | _wild(rng, feed, 400.0, 3.0) | draw.starts(rng, feed), 3.0)


def touching(rng: random.Random) -> Case:
    """An undamped contact with mu_s = mu_k and a drive at rest: it touches its limit with every swing."""
    at_rest = rng.choice((0.1, 0.12, 0.25, rng.uniform(0.05, 0.5)))
    mass = rng.choice((350.0, 1.0, rng.uniform(0.5, 500.0)))
    stiffness = mass * draw.powers(rng, 1.0, 1e4)
    values = draw.axis(mass, stiffness, rng.choice((0.0, 0.0, 0.01)) * math.sqrt(stiffness * mass), mass * 9.80665)
    values |= draw.contact(stiffness * draw.powers(rng, 0.3, 30.0), 0.0) | draw.static(at_rest)
    values |= draw.kinetic([0.0], [at_rest]) | draw.constant(0.0, rng.choice((0.0, rng.uniform(-0.2, 0.2) * mass)))
    speed = mass * 9.80665 * at_rest / math.sqrt(stiffness * mass)
    return Case(values | {'initial.velocity': speed * draw.powers(rng, 0.1, 5.0), 'initial.rest_time': 0.0},
                40.0 * math.sqrt(mass / stiffness))


def ties(rng: random.Random) -> Case:
    """Round numbers: two guards at one time, forces that meet limits exactly, symmetric data."""
    values = draw.axis(rng.choice((1.0, 2.0, 4.0)), rng.choice((1.0, 4.0, 16.0)), rng.choice((0.0, 0.0, 1.0, 4.0)), 8.0)
    values |= rng.choice((draw.contact(), draw.contact(), draw.contact(16.0, rng.choice((0.0, 1.0)))))
    at_rest = rng.choice((0.125, 0.25, 0.5))
    breakpoints = [0.0, rng.choice((0.125, 0.25, 0.5, 1.0))]
    values |= draw.kinetic(breakpoints, [at_rest, rng.choice((0.5, 0.0, 1.0)) * at_rest], 0.0, rng.random() < 0.5)
    values |= draw.static(at_rest * rng.choice((1.0, 1.0, 2.0)), rng.choice((None, 2.0 * at_rest)),
                          rng.choice((0.25, 1.0)))
    size = rng.choice((at_rest * 8.0, 1.0, 2.0))
    speed = rng.choice((0.125, 0.25, 0.5, 1.0))
    times = [0.0, *sorted(rng.sample((0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0), 3))]
    values |= draw.steps('drive', 'velocities', times, [speed * rng.choice((1.0, -1.0, 0.0)) for _ in times])
    values |= draw.steps('force', 'forces', times, [size * rng.choice((0.0, 1.0, -1.0)) for _ in times])
    return Case(values | draw.starts(rng, speed), 8.0)


def static_laws(rng: random.Random) -> Case:
    """Rises of static friction from a jump to a crawl, of any shape, met by forces that rise or come back."""
    law = rng.choice(('exponential', 'kato', 'kato', 'hyperbolic', 'logarithmic'))
    initial = 0.12
    rise = rng.choice((draw.powers(rng, 1e-9, 10.0), draw.powers(rng, 0.1, 1.0)))
    values = draw.paper() | draw.static(initial, initial * (1.0 + rise), draw.powers(rng, 1e-6, 1e4), law,
                                        draw.powers(rng, 0.05, 20.0))
    values |= rng.choice((draw.contact(), draw.contact(5e6, rng.choice((0.0, 15000.0)))))
    values |= draw.kinetic([0.0, 0.035], [0.12, 0.05], 0.0, rng.random() < 0.3)
    feed = draw.powers(rng, 1e-4, 0.05)
    values |= draw.constant(feed, rng.choice((0.0, rng.uniform(-300.0, 300.0))))
    form = rng.random()
    if form < 0.3:
        values |= {'drive.course': 'ramp', 'drive.velocity': feed * rng.choice((0.0, 1.0, -1.0)),
                   'drive.acceleration': feed * rng.choice((1.0, -1.0))}
    elif form < 0.5:
        values |= {'drive.course': 'sine', 'drive.amplitude': feed, 'drive.frequency': draw.powers(rng, 0.1, 50.0),
                   'drive.phase': rng.uniform(-3.0, 3.0)}
    return Case(values | {'initial.rest_time': rng.choice((0.0, 1e-3, 1.0, 1e6))}, rng.choice((1.0, 5.0)))


def late(rng: random.Random) -> Case:
    """Drives so slow that the first break-away comes after hours or centuries."""
    feed = draw.powers(rng, 1e-13, 1e-6)
    values = draw.paper() | rng.choice((draw.contact(), draw.contact(5e6, 15000.0)))
    values |= draw.kinetic([0.0, 0.035], [0.12, 0.05], 0.0, rng.random() < 0.5)
    values |= draw.static(0.12, 0.24, draw.powers(rng, 1e-2, 1e6)) | draw.constant(feed)
    if rng.random() < 0.3:
        at = math.floor(0.0013 / feed) * rng.uniform(0.2, 1.0)
        del values['force.constant']
        values |= draw.steps('force', 'forces', [0.0, at], [0.0, rng.choice((-100.0, 100.0, 900.0))])
    return Case(values, 0.0014 / feed * rng.choice((1.0, 3.0)))


def whole_range(rng: random.Random) -> Case:
    """All parameters over the whole range that a scene may have."""
    mass, stiffness = draw.powers(rng, 1e-9, 1e12), rng.choice((0.0, draw.powers(rng, 1e-6, 1e18)))
    damping = rng.choice((0.0, draw.powers(rng, 1e-6, 1e15)))
    normal = rng.choice((0.0, draw.powers(rng, 1e-9, 1e15), draw.powers(rng, 1e-9, 1e15)))
    values = draw.axis(mass, stiffness, damping, normal)
    values |= rng.choice((draw.contact(), draw.contact(draw.powers(rng, 1e-6, 1e18),
                                                       rng.choice((0.0, draw.powers(rng, 1e-6, 1e15))))))
    at_rest = draw.powers(rng, 1e-6, 1e3)
    values |= draw.static(at_rest, rng.choice((None, min(at_rest * draw.powers(rng, 1.0, 1e3), 1e3))),
                          draw.powers(rng, 1e-12, 1e15))
    breakpoints = sorted({0.0, *(draw.powers(rng, 1e-12, 1e6) for _ in range(rng.randint(0, 3)))})
    values |= draw.kinetic(breakpoints, [at_rest, *(at_rest * rng.random() for _ in breakpoints[1:])],
                           rng.choice((0.0, draw.powers(rng, 1e-9, 1e9))), len(breakpoints) > 1 and rng.random() < 0.3)
    values |= draw.constant(rng.choice((-1.0, 1.0)) * draw.powers(rng, 1e-12, 1e6),
                            rng.choice((0.0, draw.powers(rng, 1e-9, 1e15))))
    rates = [r for r in (math.sqrt(stiffness / mass), damping / mass) if r > 0.0] or [1.0]
    duration = min(draw.powers(rng, 1.0, 1e3) / rng.choice(rates), 1e9)   # as long as `simulate` takes
    return Case(values | draw.starts(rng, draw.powers(rng, 1e-12, 1e6)), duration)


def excesses(rng: random.Random) -> Case:
    """Excess tables of their own, and break-aways of a compliant contact where psi has all but ended."""
    case = machines.any_machine(rng)
    values: Values = case.values
    breakpoints = values['friction.kinetic.velocities']
    values['friction.acceleration_dependence'] = True
    if rng.random() < 0.5:
        inner = sorted({breakpoints[-1] * draw.powers(rng, 1e-3, 3.0) for _ in range(rng.randint(1, 3))})
        fractions = sorted((rng.choice((rng.random(), draw.powers(rng, 1e-12, 1.0))) for _ in inner[:-1]), reverse=True)
        values |= {'friction.excess.velocities': [0.0, *inner], 'friction.excess.fractions': [1.0, *fractions, 0.0]}
        return Case(values, case.duration)
    stiffness, mass = values['axis.drive_stiffness'], values['axis.mass']
    values |= draw.contact(stiffness * draw.powers(rng, 0.5, 10.0),
                           rng.choice((0.0, 0.2)) * math.sqrt(stiffness * mass))
    speeds = [abs(e.velocity) for e in Case(values, case.duration).events
              if e.kind == EventKind.BREAKAWAY and e.velocity]
    if speeds:
        end = speeds[0] * (1.0 + rng.choice((1.0, 1.0, -1.0)) * draw.powers(rng, 1e-15, 1e-1))
        values |= {'friction.excess.velocities': [0.0, end], 'friction.excess.fractions': [1.0, 0.0]}
    return Case(values, case.duration)


def odd_sines(rng: random.Random) -> Case:
    """Many sines, very slow and very fast ones, and sines that cancel."""
    values = draw.paper() | rng.choice((draw.contact(), draw.contact(5e6, rng.choice((0.0, 15000.0)))))
    values |= draw.kinetic([0.0, 0.035], [0.12, 0.05], 0.0, rng.random() < 0.5) | draw.constant(
        rng.choice((0.0, 0.002, 0.02)))
    kind = rng.random()
    if kind < 0.3:
        count = rng.randint(3, 12)
        frequencies = [draw.powers(rng, 0.1, 100.0) for _ in range(count)]
        amplitudes = [draw.powers(rng, 1e-4, 0.05) for _ in frequencies]
    elif kind < 0.6:
        frequency = draw.powers(rng, 0.5, 30.0)
        frequencies = [frequency, draw.near(rng, frequency, 1e-14, 1e-3)]
        amplitudes = [0.02, -0.02]
    else:
        # below 1e-5 Hz the account of energy loses digits to the way that such a sine goes (2e-9 at 4e-9 Hz)
        frequencies = [rng.choice((draw.powers(rng, 1e-5, 1e-2), draw.powers(rng, 100.0, 3000.0)))]
        amplitudes = [draw.powers(rng, 1e-3, 1.0)]
    values |= {'drive.amplitudes': amplitudes, 'drive.frequencies': frequencies,
               'drive.phases': [rng.choice((0.0, 0.5 * math.pi, rng.uniform(-3.0, 3.0))) for _ in frequencies]}
    return Case(values, rng.choice((0.3, 1.0)))


def periodic(rng: random.Random) -> Case:
    """Inputs that begin anew with short periods, some of them in step with the axis."""
    case = machines.any_machine(rng)
    values = {name: value for name, value in case.values.items() if not name.startswith(('drive.', 'force.'))}
    omega = math.sqrt(values['axis.drive_stiffness'] / values['axis.mass'])
    limit = values['axis.normal_force'] * values['friction.static.initial']
    speed = limit / math.sqrt(values['axis.drive_stiffness'] * values['axis.mass'])
    for name, item, size in (('drive', 'velocities', speed), ('force', 'forces', limit)):
        period = rng.choice((1.0, 0.5, 2.0, draw.powers(rng, 0.05, 3.0))) * 2.0 * math.pi / omega
        values |= {f'{name}.course': rng.choice(('steps', 'table')), f'{name}.period': max(period, 1e-5),
                   f'{name}.times': [0.0, 0.25 * max(period, 1e-5), 0.5 * max(period, 1e-5)],
                   f'{name}.{item}': [size * rng.choice((0.0, 1.0, -1.0, rng.uniform(-1.0, 1.0))) for _ in range(3)]}
    return Case(values, 30.0 / omega)


def _either(rng: random.Random, stiffness: float, mass: float) -> Values:
    stiffer = 8.0 * stiffness
    return draw.contact() if rng.random() < 0.6 else draw.contact(
        stiffer, rng.choice((0.0, 0.1, 1.0)) * math.sqrt(stiffer * mass))


def _static(rng: random.Random, at_rest: float) -> Values:
    initial = at_rest * rng.choice((1.0, 1.0, 1.0 + 1e-12, 1.1))
    return draw.static(initial, rng.choice((None, 1.5 * initial, initial * (1.0 + 1e-9))), draw.powers(rng, 1e-2, 1.0))


def _wild(rng: random.Random, feed: float, limit: float, duration: float) -> Values:
    values = draw.constant(feed * rng.choice((1.0, -1.0)), limit * rng.choice((0.0, rng.uniform(-0.9, 0.9))))
    if rng.random() < 0.4:
        values['drive.course'] = 'ramp'
        values['drive.acceleration'] = feed / duration * rng.choice((-3.0, 3.0))
    if rng.random() < 0.3:
        del values['force.constant']
        values |= draw.steps('force', 'forces', [0.0, 0.4 * duration, 0.6 * duration],
                             [0.0, 1.5 * limit * rng.uniform(-1.0, 1.0), 0.0])
    return values
