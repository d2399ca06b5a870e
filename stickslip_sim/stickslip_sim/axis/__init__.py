# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The physics of one axis: forces, modes, transitions, records.  What brings it through time is in `solvers`."""

from .parameters import Axis, CompliantContact, Friction, InitialState, RigidContact, check_start, pack

__all__ = ['Axis', 'CompliantContact', 'Friction', 'InitialState', 'RigidContact', 'check_start', 'pack']
