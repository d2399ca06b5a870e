# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Plausible ranges for a feed axis, which catch a mistaken unit: far narrower than what the engine can take.

A drive at 5 m/s, or friction that falls up to 100 m/s, is most likely given in mm/s; simulated like that it slides
without stick-slip, and nothing in the result shows the mistake.  The tool refuses such a number, with the unit in which
it was read, unless it is allowed by name.  So does the node, whose guard for commands is `command.max_velocity`.
"""

import difflib
from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

from ..core.errors import ALLOW, InputError
from .schema import backward_name

FASTEST = 3.0              # m/s: 180 m/min, above the rapid traverse of linear motors
ROUGHEST = 2.0             # a coefficient of friction: rubber on dry concrete is 1
_SPEED_FIX, _COEFFICIENT_FIX = '5 mm/s is 0.005', 'a force is divided by the normal force'


class Meant(NamedTuple):
    """How to accept implausible numbers: the name of the option or parameter, and what to add for a parameter."""

    name: str
    addition: str


OF_TOOL, OF_NODE = Meant(ALLOW, f'{ALLOW} {{}}'), Meant('meant', "-p 'meant:=[{}]'")


class Plausible(NamedTuple):
    """The largest size of a parameter that passes without a question, in its unit, and the usual mistake."""

    most: float
    unit: str
    usual: str


_SPEED, _COEFFICIENT = Plausible(FASTEST, 'm/s', _SPEED_FIX), Plausible(ROUGHEST, '', _COEFFICIENT_FIX)
_FORWARDS: Mapping[str, Plausible] = {
    **dict.fromkeys(('drive.velocity', 'drive.velocities', 'drive.slopes', 'drive.amplitude', 'drive.amplitudes',
                     'initial.velocity', 'friction.kinetic.velocities', 'friction.kinetic.stribeck_velocity',
                     'friction.excess.velocities', 'friction.excess.limit_velocity'), _SPEED),
    **dict.fromkeys(('friction.static.initial', 'friction.static.limit', 'friction.kinetic.initial',
                     'friction.kinetic.limit', 'friction.kinetic.coefficients'), _COEFFICIENT),
}
PLAUSIBLE: Mapping[str, Plausible] = {
    **_FORWARDS,
    **{backward_name(name): limit for name, limit in _FORWARDS.items() if name.startswith('friction.')}}


def check_plausible(values: Mapping[str, object], meant: Collection[str], where: Meant = OF_TOOL) -> None:
    """Raise InputError on a value, in SI units, that no feed axis has, unless its name is in `meant`."""
    for name in meant:
        if name not in PLAUSIBLE:
            close = difflib.get_close_matches(name, PLAUSIBLE, 1)
            raise InputError(where.name, name, 'one of ' + ', '.join(PLAUSIBLE),
                             f'did you mean {close[0]}?' if close else 'nothing else is asked about')
    for name, limit in PLAUSIBLE.items():
        if name not in meant:
            for value in _numbers(values.get(name)):
                check_number(name, value, limit, where)


def check_number(name: str, value: float, limit: Plausible, where: Meant = OF_TOOL) -> None:
    """Raise InputError on a number beyond a limit, with how it was read."""
    if abs(value) > limit.most:
        read = f'{value:g} {limit.unit}'.rstrip()
        raise InputError(name, value, f'plausible for a feed axis, up to {limit.most:g} {limit.unit}'.rstrip(),
                         f'it was read as {read}, and {limit.usual}; if {read} is intended, '
                         f'add {where.addition.format(name)}')


def _numbers(value: object) -> Iterator[float]:
    if isinstance(value, float):
        yield value
    elif isinstance(value, tuple):
        yield from value
