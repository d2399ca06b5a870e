# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How the motion is computed, and the solver that these settings make."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from ..axis import Axis
from ..core.errors import InputError
from ..solvers import Solver, adaptive, exact, fixed_step

_METHODS = {'exact': (), 'fixed_step': tuple(fixed_step.METHODS), 'adaptive': adaptive.METHODS}
_DEFAULT_METHODS = {'fixed_step': 'euler', 'adaptive': 'DOP853'}


@dataclass(frozen=True, slots=True)
class SolverSettings:
    """`name` of the solver; settings that it does not have are None: `method`, `step` (s), `rtol`, `atol` (m, m/s).

    Raises InputError when the method is not one of this solver.
    """

    name: str
    method: str | None = None
    step: float | None = None
    rtol: float | None = None
    atol: float | None = None

    def __post_init__(self) -> None:
        methods = _METHODS[self.name]
        if self.method is not None and self.method not in methods:
            raise InputError('solver.method', self.method, f'one of {", ".join(methods)} with solver.name: {self.name}',
                             'the other methods belong to another solver')

    @property
    def settings(self) -> dict[str, Any]:
        """The settings beside the name."""
        return {key: value for key, value in asdict(self).items() if key != 'name' and value is not None}

    def check(self, axis: Axis) -> None:
        """Raise InputError when steps of this length cannot follow an axis."""
        if self.name == 'fixed_step':
            fixed_step.check_step(axis, **self.settings)

    def make(self, axis: Axis) -> Solver:
        """Return the solver, for the smooth law of an axis's kinetic friction if it can take one and there is one.

        Raises InputError as `check` does.
        """
        self.check(axis)
        if self.name == 'fixed_step':
            return fixed_step.solver(**self.settings)
        if self.name == 'adaptive':
            ahead, back = (axis.friction.along(direction).kinetic.law for direction in (1.0, -1.0))
            return adaptive.solver(**self.settings, kinetic=ahead, backward=back)
        return exact.SOLVER


def method_of(values: Mapping[str, object]) -> str | None:
    """Return the method that is meant when none is given: the usual one of this solver."""
    return _DEFAULT_METHODS.get(str(values['solver.name']))
