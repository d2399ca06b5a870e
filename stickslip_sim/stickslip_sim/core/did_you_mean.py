# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a misspelt word was meant to be: a path for a path, a name for a name."""

import difflib
from collections.abc import Iterable
from pathlib import Path

_ENDINGS = '.yaml', '.yml', '.mcap', '.csv'
_LISTED = 1000   # files of a folder that are looked at


def suggestion(word: str, known: Iterable[str], otherwise: str) -> str:
    """Return the question for the known word that is nearest, or what to do `otherwise`.

    An ending that files have in common makes none of them near.
    """
    ending = next((one for one in _ENDINGS if word.endswith(one)), '')
    names = {one.removesuffix(ending): one for one in known}
    close = difflib.get_close_matches(word.removesuffix(ending), names, 1)
    return f'did you mean {names[close[0]]}?' if close and names[close[0]] != word else otherwise


def paths_beside(path: Path, endings: Iterable[str], *, folders: bool = False) -> list[str]:
    """Return what lies in the folder of a path, as it would be written: files with these endings, and folders."""
    wanted = tuple(endings)
    known: list[str] = []
    if not path.name:   # of no word, nothing is near
        return known
    try:
        for _, place in zip(range(_LISTED), path.parent.iterdir()):
            if place.name.endswith(wanted) or (folders and not place.name.startswith('.') and place.is_dir()):
                known.append(str(path.with_name(place.name)))
    except OSError:
        return []
    return known
