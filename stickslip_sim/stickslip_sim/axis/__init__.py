# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The physics of the paper: one axis, its motion in each mode, what happens between two modes; and its records."""

from .parameters import Axis, CompliantContact, Friction, InitialState, RigidContact, check_start, pack

__all__ = ['Axis', 'CompliantContact', 'Friction', 'InitialState', 'RigidContact', 'check_start', 'pack']
