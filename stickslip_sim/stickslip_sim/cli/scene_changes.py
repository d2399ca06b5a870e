# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The options --set and --meant of every verb that loads a scene, and the scene with them."""

import functools
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from . import completion

if TYPE_CHECKING:
    from ..scene import Scene
    from ..study.distribution import Distribution
    from ..study.variation import Variation

ClickCommand = Callable[..., Any]


class SceneChanges(NamedTuple):
    """The values of --set, and the names of --meant."""

    overrides: tuple[str, ...]
    meant: tuple[str, ...]

    def given(self) -> dict[str, object]:
        """Return the changed values by dotted name; raises InputError."""
        from ..scene import parse_override

        return dict(parse_override(override) for override in self.overrides)

    def load(self, name: str) -> 'Scene':
        """Return a shipped scene or a file with the changes; raises InputError, also on a value to be asked back."""
        from ..inputs import load_scene
        from ..scene.load import named
        from ..scene.plausible import check_plausible

        scene = load_scene(name, self.given())
        with named(name):
            check_plausible(scene.values, self.meant)
        return scene

    def check_changed(self, scene: 'Scene') -> None:
        """Raise InputError on a value among those of --set to be asked back."""
        from ..scene.plausible import check_plausible

        check_plausible({name: scene.values.get(name) for name in self.given()}, self.meant)

    def check_ranges(self, ranges: 'Iterable[Variation | Distribution]') -> None:
        """Raise InputError on an end of a range, or of a distribution, to be asked back."""
        from ..scene.plausible import check_plausible

        for one in ranges:
            check_plausible({one.name.partition('[')[0]: (one.low, one.high)}, self.meant)


def scene_changes(help_of_set: str) -> Callable[[ClickCommand], ClickCommand]:
    """Give a command the two options; it takes them as one argument `changes`."""
    def decorated(command: ClickCommand) -> ClickCommand:
        @functools.wraps(command)
        def with_changes(*, changes: tuple[str, ...], meant: tuple[str, ...], **arguments: Any) -> Any:
            return command(changes=SceneChanges(changes, meant), **arguments)

        asked = click.option('--meant', multiple=True, metavar='A.B', shell_complete=completion.complete_parameters,
                             help='Its value is meant, however unusual.')
        return click.option('--set', 'changes', multiple=True, metavar='A.B=VALUE', help=help_of_set,
                            shell_complete=completion.complete_parameters)(
            asked(with_changes))
    return decorated
