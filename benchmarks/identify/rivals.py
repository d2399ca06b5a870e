# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Others on the data of the synthetic axes: how far off they end, and how long they take."""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from . import mujoco_sysid
from .axes import SyntheticAxis
from .measuring import Measurement
from .outcomes import Outcome, measured_axis
from .stepped import RivalFit, fit_stepped

OURS = '`stickslip identify`'
METHODS: Mapping[str, Callable[[SyntheticAxis, Measurement], RivalFit]] = {
    'least squares, 0.1 ms steps': fit_stepped,
    **({'`mujoco.sysid`, our laws, 0.1 ms steps': mujoco_sysid.fit_our_laws,
        '`mujoco.sysid`, own friction, 1 ms steps': mujoco_sysid.fit_own_friction}
       if mujoco_sysid.is_installed() else {}),
}


class RivalOutcome(NamedTuple):
    """Of an axis: the `errors` of the parameters, as shares of the truth, s of processor time, and simulations."""

    axis: str
    errors: tuple[float, ...]
    seconds: float
    runs: int


def rival_outcome(method: str, axis: SyntheticAxis) -> RivalOutcome:
    """Return what came of a method on an axis."""
    found = METHODS[method](axis, measured_axis(axis))
    true = axis.true_values()
    errors = tuple(abs(value / true[name] - 1.0) for name, value in found.values.items() if name in true)
    return RivalOutcome(axis.name, errors, found.seconds, found.runs)


def our_outcomes(outcomes: Sequence[Outcome]) -> list[RivalOutcome]:
    """Return ours in the same terms."""
    return [RivalOutcome(one.axis, tuple(each.error for each in one.parameters), one.seconds, one.runs)
            for one in outcomes]
