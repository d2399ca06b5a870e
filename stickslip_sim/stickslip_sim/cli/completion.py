# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a shell completes: verbs and options by click, and here scenes, runs and parameters."""

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING

from click.shell_completion import CompletionItem, shell_complete

if TYPE_CHECKING:
    import click

_VARIABLE = '_STICKSLIP_COMPLETE'


def complete_for_shell(command: 'click.Command') -> int | None:
    """Answer a shell that asks what to complete, or how; return the exit code, None where none asks."""
    asked = os.environ.get(_VARIABLE)
    return shell_complete(command, {}, 'stickslip', _VARIABLE, asked) if asked else None


def complete_scenes(context: 'click.Context', parameter: 'click.Parameter', begin: str) -> list[CompletionItem]:
    """Return the shipped scenes; files where none begins so."""
    from ..scene import scene_names

    return _those(scene_names(), begin) or [CompletionItem(begin, type='file')]


def complete_parameters(context: 'click.Context', parameter: 'click.Parameter', begin: str) -> list[CompletionItem]:
    """Return the parameters of a scene."""
    from ..scene.schema import BY_NAME

    return _those(BY_NAME, begin)


def complete_folders(context: 'click.Context', parameter: 'click.Parameter', begin: str) -> list[CompletionItem]:
    """Return folders."""
    return [CompletionItem(begin, type='dir')]


def _those(words: Iterable[str], begin: str) -> list[CompletionItem]:
    return [CompletionItem(word) for word in words if word.startswith(begin)]
