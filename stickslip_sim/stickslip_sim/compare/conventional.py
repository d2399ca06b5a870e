# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An axis with the conventional characteristics (Fig. 3), beside its own (Fig. 4 of the paper)."""

from contextlib import suppress

from ..core.errors import InputError
from ..runs import Run
from ..scene import Scene, changed
from ..scene.friction_schema import BACKWARD
from ..scene.load import unscaled
from .look import look_at

_KINETIC = 'friction.kinetic'


def scene_as_run(run: Run) -> Scene | None:
    """Return the scene with the inputs of the run; None for a recorded run whose inputs were not constant."""
    if not run.is_recorded:
        return run.scene
    inputs = look_at(run).steady
    if inputs is None or run.is_changed:
        return None
    return changed(run.scene, {'drive.course': 'constant', 'drive.velocity': inputs.velocity,
                                   'force.course': 'constant', 'force.constant': inputs.force})


def characteristics_beside(scene: Scene) -> dict[str, Scene]:
    """Return the scene with constant, with falling, and with acceleration-dependent kinetic friction, by these names.

    What the scene cannot have is left out: one without a falling branch has no limit velocity for the others.
    """
    conventional = {'friction.acceleration_dependence': False}
    friction = unscaled(scene).axis.friction
    kinetic, back = friction.kinetic, friction.along(-1.0).kinetic
    constant: dict[str, object] = {
        f'{_KINETIC}.law': 'table', f'{_KINETIC}.velocities': (0.0,),
        f'{_KINETIC}.coefficients': (kinetic.coefficients[0],), f'{_KINETIC}.end_slope': 0.0}
    if friction.backward is not None:
        constant |= dict.fromkeys(name for name in scene.values if name.startswith(f'{_KINETIC}.{BACKWARD}.'))
        constant[f'{_KINETIC}.{BACKWARD}.coefficients'] = (back.coefficients[0],)
    found = {'constant kinetic friction': changed(scene, {**conventional, **constant})}
    if len(set(kinetic.coefficients)) > 1:
        found['falling kinetic friction'] = changed(scene, conventional)
    with suppress(InputError):
        found['acceleration-dependent friction'] = changed(scene, {'friction.acceleration_dependence': True})
    return found
