# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a shell completes: verbs and options by click, and here scenes, runs and parameters."""

import os
from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from keyword import iskeyword
from typing import Any

import click
from click.shell_completion import CompletionItem, shell_complete

_VARIABLE = '_STICKSLIP_COMPLETE'


def complete_for_shell(command: click.Command) -> int | None:
    """Answer a shell that asks what to complete, or how; return the exit code, None where none asks."""
    asked = os.environ.get(_VARIABLE)
    return shell_complete(command, {}, 'stickslip', _VARIABLE, asked) if asked else None


def complete_scenes(context: click.Context, parameter: click.Parameter, begin: str) -> list[CompletionItem]:
    """Return the shipped scenes; files where none begins so."""
    from ..scene import scene_names

    return _those(scene_names(), begin) or [CompletionItem(begin, type='file')]


def complete_parameters(context: click.Context, parameter: click.Parameter, begin: str) -> list[CompletionItem]:
    """Return the parameters of a scene."""
    from ..scene.schema import BY_NAME

    return _those(BY_NAME, begin)


def complete_folders(context: click.Context, parameter: click.Parameter, begin: str) -> list[CompletionItem]:
    """Return folders."""
    return [CompletionItem(begin, type='dir')]


def _those(words: Iterable[str], begin: str) -> list[CompletionItem]:
    return [CompletionItem(word) for word in words if word.startswith(begin)]


# Verbs by sections: `stickslip --help` lists them by what a reader wants to do.

class LazyGroup(click.Group):
    """A group whose commands, by section, are imported when they are asked for, each from its file beside this."""

    def __init__(self, *arguments: Any, sections: Mapping[str, Sequence[str]], **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._sections = sections
        self._names = sorted(name for verbs in sections.values() for name in verbs)

    @property
    def sections(self) -> dict[str, list[click.Command]]:
        """The commands by section, in the order of the help; imports all of them."""
        return {title: [self._imported(name) for name in verbs] for title, verbs in self._sections.items()}

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all verbs."""
        return self._names

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a verb; None when there is none of that name."""
        return self._imported(cmd_name) if cmd_name in self._names else None

    def _imported(self, name: str) -> click.Command:
        file = name.replace('-', '_') + ('_' if iskeyword(name) else '')
        found = vars(import_module(f'.{file}', __package__)).values()
        return next(one for one in found if isinstance(one, click.Command) and one.name == name)

    def resolve_command(self, ctx: click.Context, args: list[str]
                        ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the verb that is first among the arguments; raises UsageError, with what may have been meant."""
        word = args[0]
        if self.get_command(ctx, word) is None and not word.startswith('-'):
            raise click.UsageError(f'No such command {word!r}: {self._meant_by(word)}', ctx)
        return super().resolve_command(ctx, args)

    def _meant_by(self, word: str) -> str:
        """Return what to do in place of a verb that is none: a scene or a path was given in its place, or a typo."""
        from ..core.errors import suggestion
        from ..scene import scene_names

        if word in scene_names():
            return f'it is a scene; give a verb first, as in stickslip simulate {word} --duration 10.'
        if os.path.exists(word):
            return f'it is a path; give a verb first, as in stickslip plot {word}.'
        return suggestion(word, self._names, 'the verbs are ' + ', '.join(self._names) + '.')

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the sections, their columns below each other."""
        width = max(map(len, self._names))
        for title, commands in self.sections.items():
            with formatter.section(title):
                formatter.write_dl([(f'{command.name:{width}}', command.get_short_help_str(limit=100))
                                    for command in commands])
