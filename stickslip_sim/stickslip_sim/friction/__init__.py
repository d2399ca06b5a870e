# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction characteristics: how the static coefficient grows at rest and the kinetic one falls with speed."""

from .kinetic import ExcessTable, KineticTable
from .smooth import SmoothExcess, SmoothKinetic
from .static import StaticLaw, StaticLawKind
from .tables import excess_table, kinetic_table

__all__ = [
    'ExcessTable', 'KineticTable', 'SmoothExcess', 'SmoothKinetic', 'StaticLaw', 'StaticLawKind', 'excess_table',
    'kinetic_table',
]
