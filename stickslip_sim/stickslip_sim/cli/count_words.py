# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Counts in words."""


def counted(count: int, what: str) -> str:
    """Return a count of things, of one without the s."""
    return f'{count} {what}' + ('' if count == 1 else 's')
