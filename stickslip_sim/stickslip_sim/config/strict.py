# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Sections of the files beside a scene, read strictly: a key that nobody knows is an error."""

import difflib
from collections.abc import Iterable, Mapping

from ..core.errors import InputError


def section(name: str, given: object, known: Iterable[str], page: str) -> Mapping[str, object]:
    """Return a section whose keys are all known; raises InputError on anything else, and points to a `page`.

    The outermost one is named `file`.
    """
    names = [*known]
    if not isinstance(given, Mapping):
        raise InputError(name, given, 'a section of ' + ', '.join(names), f'see {page}')
    for key, value in given.items():
        if key not in names:
            close = difflib.get_close_matches(key, names, 1)
            raise InputError(key if name == 'file' else f'{name}.{key}', value, 'one of ' + ', '.join(names),
                             f'did you mean {close[0]}?' if close else 'drop it')
    return given
