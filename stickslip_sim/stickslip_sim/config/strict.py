# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Sections of the files beside a scene, read strictly: a key that nobody knows is an error."""

from collections.abc import Iterable, Mapping

from ..core.did_you_mean import suggestion
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
            raise InputError(key if name == 'file' else f'{name}.{key}', value, 'one of ' + ', '.join(names),
                             suggestion(str(key), names, 'drop it'))
    return given
