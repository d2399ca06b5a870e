# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Every parameter of a scene: the one list behind the check of files, the declaration in ROS, and the reference.

Defaults are for what is left out.  The axis is the paper's; all else left out is not modelled: no friction, a
rigid contact, a drive that stands still, no force.  (A node without any file runs the scene `paper_fig8`, not this.)
"""

import math

from ..core import ranges
from ..core.ranges import Range
from ..simulation.faults import MAX_TIME
from .friction_schema import FRICTION
from .parameter import Parameter, When, choice, number, numbers, texts
from .profile_schema import drive_profile, profile

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
    texts('faults.kinds', 'kinds of these faults, like friction_scale or force_pulse'),
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

    Parameter('seed', 'integer', 0, '', 'seed of all random numbers of the run', 0, 2**63 - 1),
)

BY_NAME: dict[str, Parameter] = {entry.name: entry for entry in PARAMETERS}
NULL = 'null'    # in a file: left out
