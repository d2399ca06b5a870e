# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Defects that a forked program is given before it begins."""

from importlib import import_module


def break_method(module: str, owner: str, method: str) -> None:
    """Let a method of a class of stickslip_sim raise an error of two lines: for `prepare`, with its arguments."""
    setattr(getattr(import_module(f'stickslip_sim.{module}'), owner), method, broken)


def broken(*_: object) -> None:
    raise ZeroDivisionError('first\nsecond')
