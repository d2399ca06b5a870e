# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip critical`: the value of a parameter at which stick-slip begins or ends."""

from typing import TYPE_CHECKING

import click

from . import completion
from .arguments import SceneChanges, scene_argument, scene_changes, verb
from .files import progress_bar, show

if TYPE_CHECKING:
    from ..scene import Scene
    from ..study.variation import Variation

_ACCURACY = 1e-9


@verb(short_help='Find the value at which stick-slip begins or ends.')
@scene_argument
@click.option('--of', 'name', required=True, metavar='A.B', shell_complete=completion.complete_parameters,
              help='Parameter to search, or an element of a list: A.B[1].')
@click.option('--between', metavar='LOW:HIGH', help='Search range [default: 1/100 to 100 times its value].')
@click.option('--accuracy', type=float, default=_ACCURACY, metavar='REL',
              help=f'Relative width of the final bracket [default: {_ACCURACY:g}].')
@scene_changes('Change a parameter of the scene.')
def critical(scene: str, name: str, between: str | None, accuracy: float, changes: SceneChanges) -> None:
    """Find where SCENE changes from stick-slip to sliding, starting from rest and from sliding."""
    from ..study.critical import critical_of
    from ..study.report import critical_report

    loaded = changes.load(scene)
    over = range_given(loaded, name, between, changes)
    with progress_bar('narrowing') as progress:
        found = critical_of(loaded, over, accuracy, progress)
    show(critical_report(loaded, found))


def range_given(scene: 'Scene', name: str, between: str | None, changes: SceneChanges) -> 'Variation':
    """Return where to look for critical values of a parameter; raises InputError."""
    from ..study.critical import default_range
    from ..study.variation import parameter_of, range_of

    parameter_of(name)
    if between is None:
        return default_range(scene, name)
    over = range_of('--between', name, between)
    changes.check_ranges([over])
    return over
