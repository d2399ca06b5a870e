# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Verbs by sections: `stickslip --help` lists them by what a reader wants to do."""

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

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the sections, their columns below each other."""
        width = max(map(len, self.commands))
        for title, commands in self.sections.items():
            with formatter.section(title):
                formatter.write_dl([(f'{command.name:{width}}', command.get_short_help_str(limit=100))
                                    for command in commands])
