# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a reader says of what it is given."""

from collections.abc import Callable

from stickslip_sim.core.errors import LINE_LIMIT, StickslipError


def accepts_or_refuses(read: Callable[..., object], *arguments: object) -> object:
    """Return what a reader returns, None when it refused in a line; anything else that it raises is a mistake."""
    try:
        return read(*arguments)
    except StickslipError as error:
        text = str(error)
        assert 0 < len(text) <= LINE_LIMIT + 1, text
        assert '\n' not in text, text
        return None
