# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Every parameter of a scene: the one list behind the check of files, the declaration in ROS, and the reference.

Defaults are for what is left out.  The axis is the paper's; all else left out is not modelled: no friction, a
rigid contact, a drive that stands still, no force.  (A node without any file runs the scene `paper_fig8`, not this.)
"""

import math
from dataclasses import replace

from ..core import ranges
from ..core.input_profile import FREQUENCIES, MAX_SINUSOIDS
from ..core.ranges import Range
from ..friction.shapes import MAX_EXPONENT, MIN_EXPONENT
from ..simulation.faults import MAX_TIME, RULES
from .parameter import Parameter, When, choice, number, numbers, texts
from .ros_yaml import MOST_NUMBERS

# The parameters of friction, those of both directions first; a number backwards that is left out is that forwards.

BACKWARD = 'backward'

_LAWS = ('constant', 'exponential', 'kato', 'hyperbolic', 'logarithmic')
_KINETIC = ('table', 'stribeck', 'exponential', 'hyperbolic')
_EXCESS = ('table', 'cosine', 'power')

_GROWS = When('friction.static.law', _LAWS[1:])
_BRANCHES = When('friction.acceleration_dependence', (True,))
_BREAKPOINTS = When('friction.kinetic.law', ('table',))
_SMOOTH = When('friction.kinetic.law', _KINETIC[1:])
_EXCESS_BREAKPOINTS = When('friction.excess.law', ('table',))
_EXCESS_SMOOTH = When('friction.excess.law', _EXCESS[1:])

_STATIC_LAW: tuple[Parameter, ...] = (
    choice('friction.static.law', 'constant', 'Growth of the static coefficient mu_s with rest time.', _LAWS),
    number('friction.static.initial', 0.0, '', 'Static coefficient mu_s at zero rest time.', within=ranges.COEFFICIENT,
           live=True),
    number('friction.static.limit', None, '', 'mu_s after infinite rest (logarithmic: initial + one unit of growth).',
           within=ranges.COEFFICIENT, live=True, when=_GROWS),
    number('friction.static.time_constant', None, 's', 'Time constant tau of the growth of mu_s.',
           within=ranges.TIME_CONSTANT, live=True, when=_GROWS),
    number('friction.static.exponent', None, '', "Exponent n of Kato's law exp(-(t/tau)^n).",
           within=ranges.KATO_EXPONENT, live=True, when=When('friction.static.law', ('kato',))),
    Parameter('friction.static.delay', 'double', None, 's', 'Rest time before mu_s starts to grow, for example while'
              ' the contact still rings (docs/paper.md). Default: 0.', *ranges.TIME, live=True, when=_GROWS),
    Parameter('friction.static.scatter', 'double', None, '', 'Relative standard deviation of mu_s from stick to stick,'
              ' drawn from the seed (docs/model.md). mu_s never falls below mu_k at rest. Default: 0.',
              *ranges.SCATTER, live=True),
    Parameter('friction.static.scatter_run', 'double', None, '', 'Relative standard deviation of mu_s from run to run:'
              ' one factor for all sticks, drawn from the seed. Default: 0.', *ranges.SCATTER, live=True),
)

_KINETIC_LAW: tuple[Parameter, ...] = (
    choice('friction.kinetic.law', 'table', 'Kinetic coefficient mu_k as a function of speed: a table, linear between'
           ' breakpoints, or a smooth law (docs/model.md).', _KINETIC),
    numbers('friction.kinetic.velocities', (0.0,), 'm/s', 'Breakpoints of mu_k, rising from 0; the last is v_gr.',
            within=ranges.SPEED, live=True, when=_BREAKPOINTS),
    numbers('friction.kinetic.coefficients', (0.0,), '', 'mu_k at these speeds.',
            within=ranges.COEFFICIENT, live=True, when=_BREAKPOINTS),
    number('friction.kinetic.end_slope', 0.0, 's/m', 'Slope of mu_k beyond the last breakpoint.',
           within=ranges.SLOPE, live=True, when=_BREAKPOINTS),
    number('friction.kinetic.initial', None, '', 'mu_0, the value of mu_k at rest; at most friction.static.initial.',
           within=ranges.COEFFICIENT, live=True, when=_SMOOTH),
    number('friction.kinetic.limit', None, '', 'mu_c, the limit of the falling part at high speed.',
           within=ranges.COEFFICIENT, live=True, when=_SMOOTH),
    number('friction.kinetic.stribeck_velocity', None, 'm/s', 'v_s, the speed at which the falling part has'
           ' dropped to 1/e (hyperbolic: 1/2).', within=ranges.LAW_SPEED, live=True, when=_SMOOTH),
    number('friction.kinetic.exponent', 2.0, '', 'Exponent of the stribeck law; 2 is Gaussian.',
           within=Range(MIN_EXPONENT, MAX_EXPONENT), live=True, when=When('friction.kinetic.law', ('stribeck',))),
    number('friction.kinetic.viscous', 0.0, 's/m', 'k_v, the viscous rise of mu_k with speed.', within=ranges.SLOPE,
           live=True, when=_SMOOTH),
    number('friction.kinetic.tolerance', 1e-4, '', 'Largest difference in mu between the smooth law and its'
           ' table.', within=ranges.TOLERANCE, live=True, when=_SMOOTH),
)

_COMMON: tuple[Parameter, ...] = (
    Parameter('friction.scale', 'double', None, '', 'Factor on all friction coefficients, static and kinetic, like the'
              ' fault friction_scale. Default: 1.',
              *ranges.FACTOR, live=True),
    Parameter('friction.acceleration_dependence', 'bool', False, '', 'Put the accelerating branch of mu_k above the'
              ' decelerating one (Fig. 6) instead of using one curve for both (Fig. 3).'),
)

_EXCESS_LAW: tuple[Parameter, ...] = (
    choice('friction.excess.law', 'table', 'Shape psi(speed) of the excess of the accelerating branch (docs/model.md).',
           _EXCESS, _BRANCHES),
    numbers('friction.excess.velocities', None, 'm/s', 'Breakpoints of psi. Default: linear to 0 at the last'
            ' breakpoint of mu_k (of a smooth law: where its falling part has dropped to 1 %).', within=ranges.SPEED,
            live=True, when=_EXCESS_BREAKPOINTS, required=False),
    numbers('friction.excess.fractions', None, '', 'psi at these speeds: 1 at the first, 0 at the last.',
            within=ranges.SHARE, live=True, when=_EXCESS_BREAKPOINTS, required=False),
    Parameter('friction.excess.limit_velocity', 'double', None, 'm/s', 'Speed at which psi reaches 0. Default: as for'
              ' a table.', *ranges.LAW_SPEED, live=True, when=_EXCESS_SMOOTH),
    number('friction.excess.exponent', None, '', 'Exponent of the power law.', within=Range(1.0, MAX_EXPONENT),
           above=True, live=True, when=When('friction.excess.law', ('power',))),
    number('friction.excess.tolerance', 1e-3, '', 'Largest difference between the smooth psi and its table.',
           within=ranges.TOLERANCE, live=True, when=_EXCESS_SMOOTH),
)


def backward_name(name: str) -> str:
    """Return the name of the parameter backwards of one of friction."""
    section, _, leaf = name.rpartition('.')
    return f'{section}.{BACKWARD}.{leaf}'


def forward_name(name: str) -> str:
    """Return the name of a parameter of friction without its direction."""
    return name.replace(f'.{BACKWARD}.', '.')


def _with_backward(section: tuple[Parameter, ...]) -> tuple[Parameter, ...]:
    """Return a section and behind it its numbers for motion along −x."""
    shared = ('law', 'tolerance', 'delay', 'scatter', 'scatter_run')
    return section + tuple(
        replace(entry, name=backward_name(entry.name), default=None, required=False,
                description=f'Along -x: {entry.description.partition(" Default:")[0]} Default: the forward value.')
        for entry in section if entry.name.rpartition('.')[2] not in shared)


FRICTION: tuple[Parameter, ...] = (*_with_backward(_STATIC_LAW), *_with_backward(_KINETIC_LAW), *_COMMON,
                                   *_with_backward(_EXCESS_LAW))


# The parameters of an input profile: those of the drive and of the force are alike.

MOST_POINTS = MOST_NUMBERS   # of a profile from a file
FILE_SETTINGS = ('file', 'file_column', 'file_unit', 'file_time', 'file_time_unit', 'file_begin', 'file_resample')

PROFILES = 'drive', 'force', 'normal_load'   # the sections of a scene that are input profiles
_SHAPES = ('constant', 'ramp', 'steps', 'sine', 'table')
_POSITION = When('drive.course', ('position',))
_OF_FILES = {'m/s': ('velocity, or position', 'm/s, or m', 'mm/s'), 'N': ('force', 'N', 'kN')}


def drive_profile() -> tuple[Parameter, ...]:
    """Return the parameters of the drive: an input profile of its velocity, or of its position."""
    shapes = (': constant, ramp (to a constant), steps (jumps), sine, table (linear between breakpoints), position'
              ' (drive position at breakpoints, differentiated)')
    return (
        *profile('drive', 'velocity', 'acceleration', 'velocities', 'm/s', 'velocity of the drive',
                 ranges.VELOCITY, ranges.ACCELERATION, _POSITION.values, shapes),
        numbers('drive.positions', None, 'm', 'Drive position s at these times, linear between them. The first is'
                ' initial.position + initial.stretch; the last one holds.',
                within=ranges.PLACE, when=_POSITION),
        numbers('drive.slopes', None, 'm/s', 'Velocity just after each of these times, which makes s quadratic'
                ' between them; the last one holds. Default: linear.', within=ranges.VELOCITY, when=_POSITION,
                required=False),
    )


def profile(section: str, value: str, rate: str, values: str, unit: str, what: str, size: Range, change: Range,
            more: tuple[object, ...] = (), shapes: str = '', optional: bool = False) -> tuple[Parameter, ...]:
    """Return the parameters of an input profile of `what`, with values and rates in these ranges.

    `more` choices have breakpoints of their own; `shapes` describes all choices.  An `optional` profile is there where
    `SECTION.course` is given.
    """
    ramp = When(f'{section}.course', ('ramp',))
    breakpoints = When(f'{section}.course', ('steps', 'table'))
    points = When(f'{section}.course', (*breakpoints.values, *more))
    sine = When(f'{section}.course', ('sine',))
    on_top = When(f'{section}.course', _SHAPES) if optional else None
    return (
        choice(f'{section}.course', None if optional else 'constant',
               f'Profile of the {what}{"" if optional else ", in the node until a command arrives"}{shapes}.',
               (*_SHAPES, *map(str, more))),
        number(f'{section}.{value}', 0.0, unit, f'{_begin(what)}; initial value of a ramp, mean of a sine.',
               within=size, when=When(f'{section}.course', ('constant', 'ramp', 'sine'))),
        number(f'{section}.{rate}', None, f'{unit}/s' if unit == 'N' else 'm/s²',
               'Slope of a ramp.', within=change, when=ramp),
        number(f'{section}.duration', math.inf, 's', 'Duration of a ramp; afterwards its last value holds.',
               within=ranges.TIME, above=True, infinite=True, when=ramp),
        numbers(f'{section}.times', None, 's', 'Times of the breakpoints, rising from 0.', within=ranges.TIME,
                when=points),
        numbers(f'{section}.{values}', None, unit, f'{_begin(what)} at these times; the last one holds.', within=size,
                when=breakpoints),
        number(f'{section}.period', math.inf, 's', 'Time after which the breakpoints repeat (.inf: never). A'
               ' table or position returns linearly to its first breakpoint.', within=Range(1e-6, ranges.TIME.high),
               infinite=True, when=points),
        *_file(section, _OF_FILES[unit], points),
        number(f'{section}.amplitude', None, unit, 'Amplitude of a sine: amplitude sin(2π frequency t + phase),'
               ' with t from the start of the run.', within=size, when=sine),
        number(f'{section}.frequency', None, 'Hz', 'Frequency of a sine.', within=Range(*FREQUENCIES), when=sine),
        number(f'{section}.phase', 0.0, 'rad', 'Phase of a sine.', within=ranges.PHASE, when=sine),
        numbers(f'{section}.amplitudes', None, unit,
                f'Amplitudes of sinusoids added to any profile, at most {MAX_SINUSOIDS}.',
                within=size, required=False, when=on_top),
        numbers(f'{section}.frequencies', None, 'Hz', 'Frequencies of these sinusoids.', within=Range(*FREQUENCIES),
                required=False, when=on_top),
        numbers(f'{section}.phases', None, 'rad', 'Phases of these sinusoids. Default: 0.', within=ranges.PHASE,
                required=False, when=on_top),
    )


def _begin(words: str) -> str:
    return words[0].upper() + words[1:]


def _file(section: str, left_out: tuple[str, str, str], when: When) -> tuple[Parameter, ...]:
    """Return the parameters of a profile from a file; `left_out` are column, unit and a unit like it."""
    column, unit, other = left_out

    def text(name: str, description: str) -> Parameter:
        return Parameter(f'{section}.{name}', 'string', None, '', description, when=when)

    return (
        text('file', 'CSV file with a header line, or BAG:TOPIC, read instead of times and values; relative to the'
             ' folder of the scene. A table unless course says otherwise.'),
        text('file_column', f'Column of the values, or message field such as velocity[0]. Default: {column}.'),
        text('file_unit', f'Unit of the values, such as {other} or 2.5 {other}. Default: {unit}.'),
        text('file_time', 'Column of the times, or message field, header.stamp or log_time. Default: time; of messages'
             ' log_time.'),
        text('file_time_unit', 'Unit of the times: s, ms, us, ns or min. Default: s.'),
        number(f'{section}.file_begin', None, 's', 'Time in the file at which the run starts. Default: 0, which the'
               ' first row must have; of messages the first one.', within=Range(-1e15, 1e15), when=when,
               required=False),
        number(f'{section}.file_resample', None, 's', 'Sample the file at this interval, linearly (steps: held).'
               ' Default: keep its points.', within=Range(1e-6, 1e6), when=when, required=False),
    )


_SOLVERS = ('exact', 'fixed_step', 'adaptive')
_METHODS = ('euler', 'rk4', 'RK45', 'DOP853', 'Radau', 'BDF', 'LSODA')
_LOG_TIMES = ('simulation', 'wall')
_MODES = ('realtime', 'lockstep', 'free_run')
_REACTIONS = ('hold', 'ramp_to_zero', 'fault')

_COMPLIANT = When('contact.model', ('compliant',))
_FIXED_STEP = When('solver.name', ('fixed_step',))
_ADAPTIVE = When('solver.name', ('adaptive',))
_OWN_CLOCK = When('time.mode', _MODES[1:])
_STOPS = When('command.on_timeout', _REACTIONS[1:])

JOINT_PREFIX = Parameter('joint_interface.prefix', 'string', None, '', 'Prefix of the joint and frame names, for'
                         ' several axes in one robot description (docs/hil.md). Default: no prefix.', starts_names=True)

PARAMETERS: tuple[Parameter, ...] = (
    Parameter('scene', 'string', 'unnamed', '', 'Name of the scene. That of a shipped scene loads it, and the file'
              ' changes it.'),

    number('axis.mass', 350.0, 'kg', 'Mass m of the slider.', within=ranges.MASS, live=True),
    number('axis.drive_stiffness', 6.0e5, 'N/m', 'Stiffness c of the drive spring.', within=ranges.STIFFNESS,
           live=True),
    number('axis.drive_damping', 4000.0, 'N s/m', 'Damping h of the drive damper.', within=ranges.DAMPING, live=True),
    Parameter('axis.damper', 'string', None, '', 'Far end of this damper: the drive; or the slideway, and a'
              ' separate force −h ẋ brakes the slider (docs/paper.md). Default: drive.',
              choices=('drive', 'slideway')),
    number('axis.normal_force', 3432.3275, 'N', 'Normal force N. The default, the weight of 350 kg, does not follow'
           ' axis.mass.', within=ranges.NORMAL_FORCE, live=True),

    choice('contact.model', 'rigid', 'Contact in stick: rigid (the slider stands still) or compliant (a spring and a'
           ' damper).', ('rigid', 'compliant')),
    number('contact.stiffness', None, 'N/m', 'Tangential contact stiffness c_c, in stick only.',
           within=ranges.CONTACT_STIFFNESS, live=True, when=_COMPLIANT),
    number('contact.damping', 0.0, 'N s/m', 'Tangential contact damping h_c, in stick only.',
           within=ranges.DAMPING, live=True, when=_COMPLIANT),
    Parameter('contact.arrest', 'string', None, '', 'Deflection of the contact when a stick begins (docs/paper.md):'
              ' continuous keeps the friction force continuous; undeflected drops it to 0. Default: continuous.',
              choices=('continuous', 'undeflected'), when=_COMPLIANT),
    Parameter('contact.break_away', 'string', None, '', 'Force that ends a stick when it reaches N mu_s'
              ' (docs/paper.md): contact_force, F_c; or drive_force, F_d + F_e, which differs while the contact rings.'
              ' Default: contact_force.', choices=('contact_force', 'drive_force'), when=_COMPLIANT),

    *FRICTION,

    *drive_profile(),
    *profile('force', 'constant', 'rate', 'forces', 'N', 'external force on the slider along +x', ranges.FORCE,
            ranges.FORCE_RATE),
    *profile('normal_load', 'constant', 'rate', 'forces', 'N', 'load normal to the slideway, added to'
             ' axis.normal_force', ranges.FORCE, ranges.FORCE_RATE, optional=True),

    number('initial.position', 0.0, 'm', 'Initial position of the slider.', within=ranges.PLACE),
    number('initial.velocity', 0.0, 'm/s', 'Initial velocity of the slider.', within=ranges.VELOCITY),
    number('initial.rest_time', math.inf, 's', 'Rest time before the start; .inf is a prolonged rest.',
           within=ranges.TIME, infinite=True),
    number('initial.stretch', 0.0, 'm', 'Initial stretch s_0 of the drive spring: drive position minus position.',
           within=ranges.PLACE),
    number('initial.deflection', 0.0, 'm', 'Initial deflection of a compliant contact, within its static limit.',
           within=ranges.PLACE),

    choice('solver.name', 'exact', 'exact: closed form from event to event; fixed_step: the usual loop, for'
           ' comparison; adaptive: error-controlled steps, offline only (docs/solvers.md).', _SOLVERS),
    Parameter('solver.method', 'string', None, '', 'euler or rk4 with fixed_step (default: euler), one of the others'
              ' with adaptive (default: DOP853).', choices=_METHODS, when=When('solver.name', _SOLVERS[1:])),
    number('solver.step', 1e-3, 's', 'Length of a step.', within=Range(1e-9, 1.0), when=_FIXED_STEP),
    number('solver.rtol', 1e-8, '', 'Error of a step relative to travel and velocity.', within=Range(2.3e-14, 1e-2),
           when=_ADAPTIVE),
    number('solver.atol', 1e-10, 'm, m/s', 'Absolute error of a step in travel and velocity.',
           within=Range(1e-300, 1.0), when=_ADAPTIVE),

    choice('time.mode', 'realtime', 'Time of the node: realtime follows the machine clock; lockstep advances with'
           ' ~/step only; free_run runs at time.factor, flat out with .inf. The last two publish /clock.', _MODES),
    number('time.rate', 1000.0, 'Hz', 'Steps per second of simulation time.', within=Range(1.0, 20_000.0)),
    number('time.factor', 1.0, '', 'Simulation time per real time; .inf with free_run only.', within=Range(1e-3, 1e3),
           infinite=True),
    Parameter('clock.rate', 'double', None, 'Hz', 'Rate of /clock in simulation time, at most time.rate. Default:'
              ' every step.', 1e-3, 20_000.0, when=_OWN_CLOCK),

    number('command.max_velocity', 1.0, 'm/s', 'Refuse a drive_velocity above this, in either direction.',
           within=ranges.SPEED, above=True, live=True),
    number('command.max_force', 1.0e5, 'N', 'Refuse an external_force above this, in either direction.',
           within=Range(0.0, ranges.FORCE.high), above=True, live=True),

    number('command.timeout', 0.0, 's', 'Time without a command, after the first, that counts as a time-out:'
           ' on the steady clock in real time, else in simulation time; 0 disables it.', within=ranges.TIME),
    choice('command.on_timeout', 'hold', 'Reaction to a time-out: hold the velocity; ramp_to_zero and wait for the'
           ' next command; or fault, which stops the drive until ~/clear_faults or ~/reset.', _REACTIONS),
    number('command.timeout_deceleration', 1.0, 'm/s²', 'Deceleration of that stop.',
           within=ranges.RAMP, when=_STOPS),
    number('command.velocity_limit', math.inf, 'm/s', 'Largest velocity of the drive; commands above it are clipped'
           ' and counted as limited.', within=ranges.SPEED, above=True, infinite=True),
    number('command.acceleration_limit', math.inf, 'm/s²', 'Largest acceleration of the drive; a change that takes'
           ' longer than a step is counted as limited.', within=ranges.RAMP, infinite=True),

    number('encoder.resolution', 0.0, 'm', 'Resolution of the positions on joint_states; 0 does not round.',
           within=Range(0.0, 1.0)),
    number('encoder.offset', 0.0, 'm', 'Offset added to the positions before rounding.',
           within=Range(-1e3, 1e3)),
    number('encoder.noise', 0.0, 'm', 'Standard deviation of normal, seeded noise before rounding.',
           within=Range(0.0, 1.0)),
    number('encoder.delay', 0.0, 's', 'Delay of the measurement, in whole steps.', within=Range(0.0, 1.0)),
    Parameter('encoder.velocity_steps', 'integer', 1, '', 'Steps over which positions are differenced to measure'
              ' velocity (with all else 0: the true velocity).', 1, 1000),

    Parameter('joint_interface.enabled', 'bool', False, '', 'Offer joint_states and joint_commands, with the'
              ' measured joints axis_slider and axis_drive (docs/hil.md).'),
    JOINT_PREFIX,

    texts('faults.ids', 'Ids of faults from the start (docs/hil.md#faults).'),
    texts('faults.kinds', f'Kinds of these faults: {", ".join(RULES)}.'),
    numbers('faults.starts', None, 's', 'Start times of these faults.', within=Range(0.0, MAX_TIME), required=False),
    numbers('faults.durations', None, 's', 'Durations of these faults.',
            within=Range(ranges.TIME_CONSTANT.low, MAX_TIME),
            infinite=True, required=False),
    numbers('faults.values', None, 'by kind', 'Values of these faults. Default: 0.',
            within=ranges.FORCE, required=False),

    number('timing.max_lateness', 0.01, 's', 'Largest lateness of a step in a real-time valid run.',
           within=ranges.TIME, above=True, infinite=True),
    number('timing.max_overruns', 0.01, '', 'Largest share of steps that start over a period late in such a run.',
           within=ranges.SHARE),
    number('timing.max_latency', math.inf, 's', 'Largest time from a command to the first state that it changed, in'
           ' such a run.', within=ranges.TIME, above=True, infinite=True),

    Parameter('record.enabled', 'bool', False, '', 'Record a bag from the start.'),
    Parameter('record.folder', 'string', '', '', 'New folder of the bag; empty: the node chooses. A live change must'
              ' stay where the first one was (empty: runs/), or below.', live=True),
    Parameter('record.max_size', 'integer', None, 'bytes', 'Split the bag at this size. Default: one file.',
              2**20, 2**62),
    Parameter('record.max_duration', 'double', None, 's', 'Split the bag at this length. Default: one file.',
              1.0, MAX_TIME),
    Parameter('record.log_time', 'string', None, '', 'Log times of the bag: simulation, starting at 0, or wall, the'
              ' stamps, like ros2 bag record. Default: simulation.', choices=_LOG_TIMES),
    Parameter('record.each_reset', 'bool', None, '', 'Start a new bag at each ~/reset and close the previous one; if'
              ' record.folder exists, append a number. Default: false.'),

    Parameter('seed', 'integer', 0, '', 'Seed of all random numbers of the run.', 0, 2**63 - 1),
)

BY_NAME: dict[str, Parameter] = {entry.name: entry for entry in PARAMETERS}
NULL = 'null'    # in a file: left out
