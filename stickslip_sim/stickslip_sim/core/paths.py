# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Places in the file system."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .errors import InputError


def nearest_existing(path: Path) -> Path:
    """Return an absolute path, or the closest of the folders around it that is there."""
    return next(place for place in (path, *path.parents) if os.path.lexists(place))


@contextmanager
def made_folder(folder: Path) -> Iterator[None]:
    """Make a folder and those around it; unless it was renamed it goes again, with all in it, and what is empty then.

    Raises OSError.
    """
    new = [place for place in (folder, *folder.parents) if not os.path.lexists(place)]
    try:
        folder.mkdir(parents=True)
        yield
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        for place in new[1:]:
            with suppress(OSError):
                place.rmdir()


@contextmanager
def replacing(place: Path) -> Iterator[Path]:
    """Yield a path beside that of a file, whose content takes its place at the end, or vanishes on an error.

    Raises OSError.
    """
    temporary = place.with_name(f'.{os.getpid()}.{place.name}')
    try:
        yield temporary
        temporary.replace(place)
    finally:
        temporary.unlink(missing_ok=True)


# The kinds of files that a picture can be; known without matplotlib, so that a wrong name is refused at once.

PICTURE_FORMATS = ('.png', '.pdf', '.svg')


def check_picture_name(name: str, path: Path | str) -> None:
    """Raise InputError unless the ending of a path is that of a picture; `name` is that of the option."""
    if Path(path).suffix.lower() not in PICTURE_FORMATS:
        *others, last = PICTURE_FORMATS
        raise InputError(name, str(path), f'a file ending in {", ".join(others)} or {last}', 'the ending selects '
                         'the format')
