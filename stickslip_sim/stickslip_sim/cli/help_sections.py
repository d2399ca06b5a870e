# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Verbs by sections: `stickslip --help` lists them by what a reader wants to do."""

import os
from collections.abc import Sequence

import click


class SectionedGroup(click.Group):
    """A group of commands that are added, and listed, section by section."""

    def __init__(self, *arguments: object, **options: object) -> None:
        super().__init__(*arguments, **options)  # type: ignore[arg-type]
        self.sections: dict[str, list[click.Command]] = {}

    def add_section(self, title: str, commands: Sequence[click.Command]) -> None:
        """Add commands below a title, in the order of the list."""
        self.sections[title] = list(commands)
        for command in commands:
            self.add_command(command)

    def resolve_command(self, ctx: click.Context, args: list[str]
                        ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the verb that is first among the arguments; raises UsageError, with what may have been meant."""
        word = args[0]
        if self.get_command(ctx, word) is None and not word.startswith('-'):
            raise click.UsageError(f'No such command {word!r}: {self.meant_by(word)}', ctx)
        return super().resolve_command(ctx, args)

    def meant_by(self, word: str) -> str:
        """Return what to do in place of a verb that is none: a scene or a path was given in its place, or a typo."""
        from ..core.did_you_mean import suggestion
        from ..scene import scene_names

        if word in scene_names():
            return f'it is a scene; give a verb first, as in stickslip simulate {word} --duration 10.'
        if os.path.exists(word):
            return f'it is a path; give a verb first, as in stickslip plot {word}.'
        return suggestion(word, self.commands, 'the verbs are ' + ', '.join(sorted(self.commands)) + '.')

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the sections, their columns below each other."""
        width = max(map(len, self.commands))
        for title, commands in self.sections.items():
            with formatter.section(title):
                formatter.write_dl([(f'{command.name:{width}}', command.get_short_help_str(limit=100))
                                    for command in commands])
