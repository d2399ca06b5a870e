# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Short ways to declare the parameters of a scene."""

from ..config.parameter import Parameter, When
from ..core.ranges import Range


def number(name: str, default: float | None, unit: str, description: str, *, within: Range, above: bool = False,
           infinite: bool = False, live: bool = False, when: When | None = None, required: bool = True) -> Parameter:
    """Return a double within a range (with `above` not at its low end); required when it has no default."""
    return Parameter(name, 'double', default, unit, description, *within, above, infinite, (), live, when,
                     required and default is None)


def numbers(name: str, default: tuple[float, ...] | None, unit: str, description: str, *, within: Range,
            infinite: bool = False, live: bool = False, when: When | None = None, required: bool = True) -> Parameter:
    """Return a list of doubles."""
    return Parameter(name, 'double_array', default, unit, description, *within, infinite=infinite, live=live,
                     when=when, required=required and default is None)


def texts(name: str, description: str) -> Parameter:
    """Return a list of texts that may be left out."""
    return Parameter(name, 'string_array', None, '', description)


def choice(name: str, default: str | None, description: str, choices: tuple[str, ...], when: When | None = None
           ) -> Parameter:
    """Return a text that is one of a few."""
    return Parameter(name, 'string', default, '', description, choices=choices, when=when)
