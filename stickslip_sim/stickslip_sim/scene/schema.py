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
    choice('friction.static.law', 'constant', 'growth of the static coefficient mu_s with the rest time', _LAWS),
    number('friction.static.initial', 0.0, '', 'mu_s at zero rest time', within=ranges.COEFFICIENT, live=True),
    number('friction.static.limit', None, '', 'mu_s after infinite rest (logarithmic: initial + one unit of growth)',
           within=ranges.COEFFICIENT, live=True, when=_GROWS),
    number('friction.static.time_constant', None, 's', 'tau of the growth of mu_s',
           within=ranges.TIME_CONSTANT, live=True, when=_GROWS),
    number('friction.static.exponent', None, '', "n of Kato's law exp(-(t/tau)^n)",
           within=ranges.KATO_EXPONENT, live=True, when=When('friction.static.law', ('kato',))),
    Parameter('friction.static.delay', 'double', None, 's', 'rest time before mu_s begins to grow, as while the contact'
              ' still rings (docs/paper.md); left out: 0', *ranges.TIME, live=True, when=_GROWS),
)

_KINETIC_LAW: tuple[Parameter, ...] = (
    choice('friction.kinetic.law', 'table', 'kinetic coefficient mu_k over the speed: a table, linear between'
           ' breakpoints; or mu_c + (mu_0 - mu_c) g(speed/v_s) + k_v speed with g(z) = exp(-z^exponent) (stribeck),'
           ' exp(-z) (exponential) or 1/(1 + z) (hyperbolic)', _KINETIC),
    numbers('friction.kinetic.velocities', (0.0,), 'm/s', 'breakpoints of the kinetic coefficient; the first is 0, each'
            ' is higher, the last is v_gr', within=ranges.SPEED, live=True, when=_BREAKPOINTS),
    numbers('friction.kinetic.coefficients', (0.0,), '', 'mu_k at these speeds',
            within=ranges.COEFFICIENT, live=True, when=_BREAKPOINTS),
    number('friction.kinetic.end_slope', 0.0, 's/m', 'slope of mu_k beyond the last breakpoint',
           within=ranges.SLOPE, live=True, when=_BREAKPOINTS),
    number('friction.kinetic.initial', None, '', 'mu_0, mu_k at rest; not above friction.static.initial',
           within=ranges.COEFFICIENT, live=True, when=_SMOOTH),
    number('friction.kinetic.limit', None, '', 'mu_c, limit of the falling part at high speed',
           within=ranges.COEFFICIENT, live=True, when=_SMOOTH),
    number('friction.kinetic.stribeck_velocity', None, 'm/s', 'v_s, at which the falling part has dropped to 1/e'
           ' (hyperbolic: to 1/2)', within=ranges.LAW_SPEED, live=True, when=_SMOOTH),
    number('friction.kinetic.exponent', 2.0, '', 'delta of the law stribeck; 2: Gaussian',
           within=Range(MIN_EXPONENT, MAX_EXPONENT), live=True, when=When('friction.kinetic.law', ('stribeck',))),
    number('friction.kinetic.viscous', 0.0, 's/m', 'k_v, rise of mu_k with the speed', within=ranges.SLOPE,
           live=True, when=_SMOOTH),
    number('friction.kinetic.tolerance', 1e-4, '', 'largest difference, in mu, between the smooth law and its'
           ' table', within=ranges.TOLERANCE, live=True, when=_SMOOTH),
)

_COMMON: tuple[Parameter, ...] = (
    Parameter('friction.scale', 'double', None, '', 'factor on all coefficients of friction, static and kinetic, as of'
              ' the fault friction_scale: a whole measured curve that is known to some percent; left out: 1',
              *ranges.FACTOR, live=True),
    Parameter('friction.acceleration_dependence', 'bool', False, '', 'whether the accelerating branch of mu_k lies'
              ' above the decelerating one (Fig. 6) instead of one curve for both (Fig. 3)'),
)

_EXCESS_LAW: tuple[Parameter, ...] = (
    choice('friction.excess.law', 'table', 'psi over the speed, the shape of the excess of the accelerating branch: a'
           ' table; or (1 + cos(pi z))/2 (cosine) or (1 - z)^exponent (power) with z = speed/limit_velocity,'
           ' 0 beyond', _EXCESS, _BRANCHES),
    numbers('friction.excess.velocities', None, 'm/s', 'breakpoints of psi; left out: linear to 0 at the last'
            ' breakpoint of mu_k (a smooth law: where its falling part has dropped to 1 %)', within=ranges.SPEED,
            live=True, when=_EXCESS_BREAKPOINTS, required=False),
    numbers('friction.excess.fractions', None, '', 'psi at these speeds: 1 at the first, 0 at the last',
            within=ranges.SHARE, live=True, when=_EXCESS_BREAKPOINTS, required=False),
    Parameter('friction.excess.limit_velocity', 'double', None, 'm/s', 'speed at which psi ends; left out: as for a'
              ' table', *ranges.LAW_SPEED, live=True, when=_EXCESS_SMOOTH),
    number('friction.excess.exponent', None, '', 'n of the law power', within=Range(1.0, MAX_EXPONENT), above=True,
           live=True, when=When('friction.excess.law', ('power',))),
    number('friction.excess.tolerance', 1e-3, '', 'largest difference between the smooth psi and its table',
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
    shared = ('law', 'tolerance', 'delay')
    return section + tuple(
        replace(entry, name=backward_name(entry.name), default=None, required=False,
                description=f'along -x: {entry.description.partition("; left out")[0]}; left out: as forwards')
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
    place = '; position (breakpoints of the drive position, whose derivative the velocity is)'
    return (
        *profile('drive', 'velocity', 'acceleration', 'velocities', 'm/s', 'velocity of the drive end of the spring',
                 ranges.VELOCITY, ranges.ACCELERATION, _POSITION.values, place),
        numbers('drive.positions', None, 'm', 'drive position s at these times; the first is initial.position +'
                ' initial.stretch, the last one holds; linear between them, so that the velocity jumps',
                within=ranges.PLACE, when=_POSITION),
        numbers('drive.slopes', None, 'm/s', 'velocity just after each of these times: s is then quadratic between its'
                ' breakpoints; the last one holds; left out: linear', within=ranges.VELOCITY, when=_POSITION,
                required=False),
    )


def profile(section: str, value: str, rate: str, values: str, unit: str, what: str, size: Range, change: Range,
            more: tuple[object, ...] = (), of_more: str = '', optional: bool = False) -> tuple[Parameter, ...]:
    """Return the parameters of an input profile of `what`, with values and rates in these ranges.

    `more` choices have breakpoints of their own; `of_more` describes them.  An `optional` profile is there where
    `SECTION.course` is given.
    """
    ramp = When(f'{section}.course', ('ramp',))
    breakpoints = When(f'{section}.course', ('steps', 'table'))
    points = When(f'{section}.course', (*breakpoints.values, *more))
    sine = When(f'{section}.course', ('sine',))
    on_top = When(f'{section}.course', _SHAPES) if optional else None
    return (
        choice(f'{section}.course', None if optional else 'constant',
               f'input profile of the {what}, offline and in the node{"" if optional else " until a command arrives"}:'
               ' constant; ramp (to a'
               f' constant); steps (jumps); sine; table (linear between breakpoints){of_more}; sinusoids may'
               ' come on top',
               (*_SHAPES, *map(str, more))),
        number(f'{section}.{value}', 0.0, unit, f'{what}; of a ramp its value at the start, of a sine its mean',
               within=size, when=When(f'{section}.course', ('constant', 'ramp', 'sine'))),
        number(f'{section}.{rate}', None, f'{unit}/s' if unit == 'N' else 'm/s²',
               f'rate of change of the {what}, of a ramp', within=change, when=ramp),
        number(f'{section}.duration', math.inf, 's', 'duration of a ramp; then its last value holds',
               within=ranges.TIME, above=True, infinite=True, when=ramp),
        numbers(f'{section}.times', None, 's', 'times at which these begin: 0, then each later', within=ranges.TIME,
                when=points),
        numbers(f'{section}.{values}', None, unit, f'{what} at these times; the last one holds', within=size,
                when=breakpoints),
        number(f'{section}.period', math.inf, 's', 'time after which breakpoints begin again (.inf: never); a'
               ' table or position goes from its last breakpoint back to the first', within=Range(1e-6,
               ranges.TIME.high), infinite=True, when=points),
        *_file(section, _OF_FILES[unit], points),
        number(f'{section}.amplitude', None, unit, 'of a sine amplitude sin(2π frequency t + phase), t since the'
               ' start of the run', within=size, when=sine),
        number(f'{section}.frequency', None, 'Hz', 'frequency of a sine', within=Range(*FREQUENCIES), when=sine),
        number(f'{section}.phase', 0.0, 'rad', 'phase of a sine', within=ranges.PHASE, when=sine),
        numbers(f'{section}.amplitudes', None, unit,
                f'amplitudes of sinusoids on top of any input profile, at most {MAX_SINUSOIDS}',
                within=size, required=False, when=on_top),
        numbers(f'{section}.frequencies', None, 'Hz', 'frequencies of these sinusoids', within=Range(*FREQUENCIES),
                required=False, when=on_top),
        numbers(f'{section}.phases', None, 'rad', 'phases of these sinusoids; left out: 0', within=ranges.PHASE,
                required=False, when=on_top),
    )


def _file(section: str, left_out: tuple[str, str, str], when: When) -> tuple[Parameter, ...]:
    """Return the parameters of a profile from a file; `left_out` are column, unit and a unit like it."""
    column, unit, other = left_out

    def text(name: str, description: str) -> Parameter:
        return Parameter(f'{section}.{name}', 'string', None, '', description, when=when)

    return (
        text('file', f'in place of times and {section} values: a CSV file with a line of names (separated by commas,'
             ' semicolons, tabs or spaces), or BAG:TOPIC; relative to the folder of the scene; its points become the'
             ' times and values of this scene; course: table when none is given'),
        text('file_column', f'column of the values, or field of the messages like velocity[0]; left out: {column}'),
        text('file_unit', f'unit of the values, like {other} or 2.5 {other}; left out: {unit}'),
        text('file_time', 'column of the times, or field of the messages, header.stamp or log_time; left out: time, of'
             ' messages log_time'),
        text('file_time_unit', 'unit of the times: s, ms, us, ns or min; left out: s'),
        number(f'{section}.file_begin', None, 's', 'time of the file at which the run starts; left out: 0, which the'
               ' first row must have (of messages the first)', within=Range(-1e15, 1e15), when=when, required=False),
        number(f'{section}.file_resample', None, 's', 'take a point every so often, linear between those of the file'
               ' (steps: held); left out: the points as they are', within=Range(1e-6, 1e6), when=when, required=False),
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

JOINT_PREFIX = Parameter('joint_interface.prefix', 'string', None, '', 'put before the names of the joints and of the'
                         ' frame, so that several axes share one robot description (docs/hil.md); left out:'
                         ' nothing', starts_names=True)

PARAMETERS: tuple[Parameter, ...] = (
    Parameter('scene', 'string', 'unnamed', '', 'name of the scene; that of a shipped one takes that scene, and what'
              ' else is given changes it'),

    number('axis.mass', 350.0, 'kg', "slider m; default: the paper's", within=ranges.MASS,
           live=True),
    number('axis.drive_stiffness', 6.0e5, 'N/m', "drive spring c; default: the paper's", within=ranges.STIFFNESS,
           live=True),
    number('axis.drive_damping', 4000.0, 'N s/m', "drive damper h; default: the paper's", within=ranges.DAMPING,
           live=True),
    Parameter('axis.damper', 'string', None, '', 'where the far end of this damper is (docs/paper.md): drive, F_d ='
              ' c (s − x) + h (v − ẋ); or slideway, F_d = c (s − x), with −h ẋ beside it; left out: drive',
              choices=('drive', 'slideway')),
    number('axis.normal_force', 3432.3275, 'N', 'normal force N, friction = coefficient times N; not in the paper,'
           ' default: the weight of its 350 kg (it does not follow axis.mass)', within=ranges.NORMAL_FORCE, live=True),

    choice('contact.model', 'rigid', 'contact in stick: rigid (the slider stands still) or compliant (a spring and a'
           ' damper)', ('rigid', 'compliant')),
    number('contact.stiffness', None, 'N/m', 'tangential contact spring c_c, in stick only',
           within=ranges.CONTACT_STIFFNESS, live=True, when=_COMPLIANT),
    number('contact.damping', 0.0, 'N s/m', 'tangential contact damper h_c, in stick only',
           within=ranges.DAMPING, live=True, when=_COMPLIANT),
    Parameter('contact.arrest', 'string', None, '', 'deflection of the contact as a stick begins (docs/paper.md): such'
              ' that the friction force is continuous; or undeflected, whereby it drops to 0; left out: continuous',
              choices=('continuous', 'undeflected'), when=_COMPLIANT),
    Parameter('contact.break_away', 'string', None, '', 'force whose size ends a stick at N mu_s (docs/paper.md):'
              ' contact_force, F_c; or drive_force, F_d + F_e, which differs while the contact rings; left out:'
              ' contact_force', choices=('contact_force', 'drive_force'), when=_COMPLIANT),

    *FRICTION,

    *drive_profile(),
    *profile('force', 'constant', 'rate', 'forces', 'N', 'external force on the slider, along +x', ranges.FORCE,
            ranges.FORCE_RATE),
    *profile('normal_load', 'constant', 'rate', 'forces', 'N', 'load normal to the slideway, as of clamping, on top of'
             ' axis.normal_force', ranges.FORCE, ranges.FORCE_RATE, optional=True),

    number('initial.position', 0.0, 'm', 'position of the slider at the start', within=ranges.PLACE),
    number('initial.velocity', 0.0, 'm/s', 'velocity of the slider at the start', within=ranges.VELOCITY),
    number('initial.rest_time', math.inf, 's', 'rest time before the start (.inf: prolonged rest)',
           within=ranges.TIME, infinite=True),
    number('initial.stretch', 0.0, 'm', 'stretch of the drive spring at the start, s_0: drive position minus position',
           within=ranges.PLACE),
    number('initial.deflection', 0.0, 'm', 'deflection of a compliant contact at the start; it must hold that',
           within=ranges.PLACE),

    choice('solver.name', 'exact', 'exact: closed form, from event to event; fixed_step: the usual loop, to compare'
           ' with; adaptive: steps of a stated tolerance, offline only (docs/solvers.md)', _SOLVERS),
    Parameter('solver.method', 'string', None, '', 'with fixed_step euler or rk4, left out: euler; with adaptive one of'
              ' the others, left out: DOP853', choices=_METHODS, when=When('solver.name', _SOLVERS[1:])),
    number('solver.step', 1e-3, 's', 'length of a step', within=Range(1e-9, 1.0), when=_FIXED_STEP),
    number('solver.rtol', 1e-8, '', 'error of a step relative to travel and velocity', within=Range(2.3e-14, 1e-2),
           when=_ADAPTIVE),
    number('solver.atol', 1e-10, 'm, m/s', 'error of a step in travel and velocity', within=Range(1e-300, 1.0),
           when=_ADAPTIVE),

    choice('time.mode', 'realtime', 'time of the node: realtime follows the clock of the machine; lockstep moves with'
           ' ~/step only; free_run goes at time.factor, or as fast as it can with .inf; the last two publish /clock',
           _MODES),
    number('time.rate', 1000.0, 'Hz', 'steps per second of simulation time', within=Range(1.0, 20_000.0)),
    number('time.factor', 1.0, '', 'simulation time per real time; .inf with free_run only', within=Range(1e-3, 1e3),
           infinite=True),
    Parameter('clock.rate', 'double', None, 'Hz', 'rate of /clock, per second of simulation time, at most time.rate;'
              ' left out: with every step', 1e-3, 20_000.0, when=_OWN_CLOCK),

    number('command.max_velocity', 1.0, 'm/s', 'largest drive_velocity, in both directions; beyond it is refused',
           within=ranges.SPEED, above=True, live=True),
    number('command.max_force', 1.0e5, 'N', 'largest external_force, in both directions; beyond it is refused',
           within=Range(0.0, ranges.FORCE.high), above=True, live=True),

    number('command.timeout', 0.0, 's', 'silence after the first drive_velocity that counts as a time-out, in real'
           ' time on the steady clock, else in simulation time; 0: off', within=ranges.TIME),
    choice('command.on_timeout', 'hold', 'reaction to a time-out: the drive holds the velocity; stops until the next'
           ' command; or stops and takes none until ~/clear_faults or ~/reset', _REACTIONS),
    number('command.timeout_deceleration', 1.0, 'm/s²', 'deceleration with which the drive then stops',
           within=ranges.RAMP, when=_STOPS),
    number('command.velocity_limit', math.inf, 'm/s', 'largest velocity of the drive: commands beyond it are followed'
           ' up to it, and counted as limited', within=ranges.SPEED, above=True, infinite=True),
    number('command.acceleration_limit', math.inf, 'm/s²', 'largest acceleration of the drive: changes follow a'
           ' ramp, and are counted as limited when it takes longer than a step', within=ranges.RAMP, infinite=True),

    number('encoder.resolution', 0.0, 'm', 'resolution of the positions on joint_states; 0: none',
           within=Range(0.0, 1.0)),
    number('encoder.offset', 0.0, 'm', 'added to the positions before they are rounded to the resolution',
           within=Range(-1e3, 1e3)),
    number('encoder.noise', 0.0, 'm', 'standard deviation of the noise before rounding, normal, seeded',
           within=Range(0.0, 1.0)),
    number('encoder.delay', 0.0, 's', 'delay of the measurement: whole steps', within=Range(0.0, 1.0)),
    Parameter('encoder.velocity_steps', 'integer', 1, '', 'steps over which the measured velocity is the difference of'
              ' measured positions (with all else 0: the true velocity)', 1, 1000),

    Parameter('joint_interface.enabled', 'bool', False, '', 'whether the node has joint_states and joint_commands,'
              ' with the joints axis_slider and axis_drive as measured (docs/hil.md)'),
    JOINT_PREFIX,

    texts('faults.ids', 'ids of faults from the start on, as with ~/inject_fault (docs/hil.md)'),
    texts('faults.kinds', f'kinds of these faults (docs/hil.md#faults): {", ".join(RULES)}'),
    numbers('faults.starts', None, 's', 'starts of these faults', within=Range(0.0, MAX_TIME), required=False),
    numbers('faults.durations', None, 's', 'durations of these faults',
            within=Range(ranges.TIME_CONSTANT.low, MAX_TIME),
            infinite=True, required=False),
    numbers('faults.values', None, 'by kind', 'values of these faults; left out: 0',
            within=ranges.FORCE, required=False),

    number('timing.max_lateness', 0.01, 's', 'largest lateness of a step in a run that is real-time valid',
           within=ranges.TIME, above=True, infinite=True),
    number('timing.max_overruns', 0.01, '', 'largest share of steps that start more than a period late in such a run',
           within=ranges.SHARE),
    number('timing.max_latency', math.inf, 's', 'largest time from a command to the first state that it moved, in'
           ' such a run', within=ranges.TIME, above=True, infinite=True),

    Parameter('record.enabled', 'bool', False, '', 'whether the node records a bag from the start'),
    Parameter('record.folder', 'string', '', '', 'folder of the bag, which must not exist; empty: the node chooses;'
              ' changed live, it must lie where it lay at the start (empty: runs/), or below',
              live=True),
    Parameter('record.max_size', 'integer', None, 'bytes', 'size from which on the bag goes on in another file, as with'
              ' ros2 bag record --max-bag-size; left out: one file', 2**20, 2**62),
    Parameter('record.max_duration', 'double', None, 's', 'length from which on the bag goes on in another file, as'
              ' with ros2 bag record --max-bag-duration; left out: one file', 1.0, MAX_TIME),
    Parameter('record.log_time', 'string', None, '', 'log times of the bag: simulation, from 0 on, or wall, the stamps,'
              ' as in bags of ros2 bag record; left out: simulation', choices=_LOG_TIMES),
    Parameter('record.each_reset', 'bool', None, '', 'whether each ~/reset begins a new bag, and ends the one that is'
              ' recorded into; where record.folder exists, a number follows it; left out: false'),

    Parameter('seed', 'integer', 0, '', 'seed of all random numbers of the run', 0, 2**63 - 1),
)

BY_NAME: dict[str, Parameter] = {entry.name: entry for entry in PARAMETERS}
NULL = 'null'    # in a file: left out
