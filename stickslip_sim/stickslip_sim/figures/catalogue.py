# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Catalogue of all figures that the tool shows: name, SI unit, formula and label, each once.

The name is that of the field in Python, in tables and in files.  Verbs choose figures by name and take unit and label
from here.
"""

from typing import NamedTuple


class Entry(NamedTuple):
    """A figure; `unit` is SI.  `head` stands above a column of cycles where the label is too long for that."""

    unit: str
    formula: str
    label: str = ''   # else the name in words
    head: str = ''    # else the label


CATALOGUE = {
    # of a cycle, a round, or the motion that a point of a study ends in
    'begin': Entry('s', 'time of the break-away', 'break-away'),
    'period': Entry('s', 'from break-away to break-away; of a round, both out of stick'),
    'stick_time': Entry('s', 'from standstill to the next break-away', head='stick'),
    'slip_time': Entry('s', 'from break-away to standstill', head='slip'),
    'rest_time': Entry('s', 'at rest before the break-away', 'rest time before'),
    'slip_travel': Entry('m', 'travel from break-away to standstill'),
    'jump': Entry('m', 'travel from break-away to break-away'),
    'amplitude': Entry('m', 'slip travel, the longest of a round; 0 without stick-slip'),
    'peak_speed': Entry('m/s', 'largest |velocity|'),
    'peak_acceleration': Entry('m/s²', 'largest |acceleration| of a slip'),
    'break_away_force': Entry('N', '|friction| at the break-away'),
    'break_away_drive_force': Entry('N', 'drive force at the break-away', 'drive force at break-away'),
    'arrest_drive_force': Entry('N', 'drive force when the slip ends', 'drive force at arrest'),
    'static_coefficient': Entry('', 'mu_s at the break-away'),
    'stick_share': Entry('', 'stick time over the period, or over the run; 0 for sliding, 1 at rest'),
    'motion': Entry('', 'the motion that the run ends in: one of MOTIONS'),
    'stick_slip': Entry('', '1 with stick-slip, else 0'),
    'settling_time': Entry('s', 'to the break-away from which on each period is the one before, to 1e-6; of '
                                    'smooth sliding the last break-away; of a move the time to stay in its band'),
    'cycles': Entry('', 'complete ones'),
    'settled': Entry('', '1: the motion is as it stays; 0: it still changed at the end'),
    'duration': Entry('s', 'simulated'),
    # of a window of a run, with a limit
    'following_error': Entry('m', 'largest |commanded − actual position|'),
    'end_position_error': Entry('m', '|position − target| at the end'),
    'overshoot': Entry('m', 'furthest beyond the target in the sense of the motion'),
    'sticks': Entry('', 'number of stops'),
    'longest_stick': Entry('s', 'longest time in stick'),
    'limit_cycle_amplitude': Entry('m', 'peak-to-peak following error over the last cycles'),
    'following_error_rms': Entry('m', 'root mean square of the following error over the states'),
    'move_settling_time': Entry('s', 'longest time from the end of a commanded move to the band about its end'),
    'move_overshoot': Entry('m', 'furthest beyond the end of a commanded move while the command rests there'),
    'steady_state_error': Entry('m', 'largest |position − commanded| at the end of a rest of the command'),
    'velocity_ripple': Entry('m/s', 'largest less smallest velocity'),
    'lowest_speed': Entry('m/s', 'smallest |velocity|'),
    'standstill': Entry('s', 'longest time with |velocity| below a speed'),
    'reversal_spike': Entry('m', 'largest |following error| within some time after a turn of the command'),
    'command_peak': Entry('m/s', 'largest |drive velocity|'),
    'command_rms': Entry('m/s', 'root mean square of the drive velocity over the states'),
    'command_rate_peak': Entry('m/s²', 'largest |change of the drive velocity| from state to state, over the time'),
    'command_rate_rms': Entry('m/s²', 'root mean square of this rate'),
    # of the circular test of two axes, ISO 230-4 (docs/check.md)
    'circular_deviation': Entry('m', 'G, the larger of both senses: width of the narrowest zone of two circles', 'G'),
    'bidirectional_circular_deviation': Entry('m', 'G(b): the narrowest zone of the paths in both senses', 'G(b)'),
    'radial_deviation': Entry('m', 'largest |F|, distance from the nominal circle'),
    'mean_radial_deviation': Entry('m', '|D|, least-squares radius of both senses less the nominal one'),
    'quadrant_glitch': Entry('m', 'largest radial excursion behind a reversal, of all quadrants and both senses'),
    # of the positioning test of an axis, ISO 230-2:2014
    'positioning_accuracy': Entry('m', 'A, bi-directional', 'A'),
    'positioning_accuracy_forward': Entry('m', 'A↑', 'A↑'),
    'positioning_accuracy_backward': Entry('m', 'A↓', 'A↓'),
    'positioning_repeatability': Entry('m', 'R, bi-directional', 'R'),
    'positioning_repeatability_forward': Entry('m', 'R↑', 'R↑'),
    'positioning_repeatability_backward': Entry('m', 'R↓', 'R↓'),
    'systematic_positioning_error': Entry('m', 'E, bi-directional', 'E'),
    'systematic_positioning_error_forward': Entry('m', 'E↑', 'E↑'),
    'systematic_positioning_error_backward': Entry('m', 'E↓', 'E↓'),
    'mean_positioning_error': Entry('m', 'M, range of the mean deviations of the targets', 'M'),
    'reversal_error': Entry('m', 'B, largest |mean from below less mean from above|', 'B'),
    'mean_reversal_error': Entry('m', '|mean of these differences|', 'mean B'),
    # of a sample or an event
    'time': Entry('s', 'from the start of the run'),
    'position': Entry('m', 'x'),
    'velocity': Entry('m/s', 'ẋ'),
    'acceleration': Entry('m/s²', 'ẍ'),
    'drive_position': Entry('m', 's'),
    'drive_velocity': Entry('m/s', 'v = ṡ'),
    'drive_force': Entry('N', 'c (s − x) + h (v − ẋ)'),
    'external_force': Entry('N', 'F_e'),
    'friction_force': Entry('N', 'F, against the motion'),
    'friction_coefficient': Entry('', '|friction force| over normal force'),
    'contact_deflection': Entry('m', 'δ'),
}
OF_A_CYCLE = ('period', 'stick_time', 'slip_time', 'jump', 'peak_speed', 'break_away_force', 'arrest_drive_force',
              'static_coefficient')
COMPARED = ('period', 'jump', 'peak_speed', 'break_away_force')   # of a cycle: they tell how much two of them differ

_READ_IN = {'m': ('mm', 1e3), 'm/s': ('mm/s', 1e3)}


def unit_of(name: str) -> str:
    """Return the SI unit of a figure; empty where it is a number without unit."""
    return CATALOGUE[name].unit


def label_of(name: str) -> str:
    """Return the label of a figure in a text."""
    return CATALOGUE[name].label or in_words(name)


def head_of(name: str) -> str:
    """Return the label of a figure in a table of cycles."""
    return CATALOGUE[name].head or label_of(name)


def read_in(unit: str) -> tuple[str, float]:
    """Return the unit that figures of an SI unit are read in, and how many of it that is: m in mm, m/s in mm/s."""
    return _READ_IN.get(unit, (unit, 1.0))


def in_words(name: str) -> str:
    """Return the name of a parameter or a figure as it is written in a text."""
    words = name.replace('.', ' ').replace('_', ' ')
    return words.replace('break away', 'break-away').replace('stick slip', 'stick-slip')
