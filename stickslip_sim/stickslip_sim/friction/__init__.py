"""Friction characteristics: how the static coefficient grows at rest and the kinetic one falls with speed."""

from .kinetic import ExcessTable, KineticTable
from .static import StaticLaw, StaticLawKind

__all__ = ['ExcessTable', 'KineticTable', 'StaticLaw', 'StaticLawKind']
