# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The laws of friction: static over the time at rest, kinetic over the speed.  The motion they cause is in `axis`."""

from .kinetic import ExcessTable, KineticTable
from .smooth import SmoothExcess, SmoothKinetic
from .static import Scatter, StaticLaw, StaticLawKind
from .tables import excess_table, kinetic_table

__all__ = [
    'ExcessTable', 'KineticTable', 'Scatter', 'SmoothExcess', 'SmoothKinetic', 'StaticLaw', 'StaticLawKind',
    'excess_table', 'kinetic_table',
]
