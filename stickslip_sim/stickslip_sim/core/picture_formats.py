# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The kinds of files that a picture can be; known without matplotlib, so that a wrong name is refused at once."""

from pathlib import Path

from .errors import InputError

PICTURE_FORMATS = ('.png', '.pdf', '.svg')


def check_picture_name(name: str, path: Path | str) -> None:
    """Raise InputError unless the ending of a path is that of a picture; `name` is that of the option."""
    if Path(path).suffix.lower() not in PICTURE_FORMATS:
        *others, last = PICTURE_FORMATS
        raise InputError(name, str(path), f'a file ending in {", ".join(others)} or {last}', 'the ending decides the '
                         'format: name it so')
