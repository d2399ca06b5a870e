# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of an input profile: those of the drive and of the force are alike."""

import math

from ..core import ranges
from ..core.input_profile import FREQUENCIES, MAX_SINUSOIDS
from ..core.ranges import Range
from .parameter import Parameter, When, choice, number, numbers
from .ros_yaml import MOST_NUMBERS

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
