# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The rival `mujoco.sysid` (pip install 'mujoco[sysid]'), in two ways, each with its defaults.

With MuJoCo's own friction, as its user would: a slide joint with `frictionloss` and `damping`, spring and damper of the
drive as actuators.  And its optimizer alone, given more than it has: our laws in a stepped simulation as its residuals.
"""

import contextlib
import importlib.metadata
import importlib.util
import io
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.runs import simulate

from .axes import RANGE, SyntheticAxis, value_of
from .measuring import Measurement
from .stepped import RivalFit, SteppedResiduals

STEP = 1e-3          # s, that of the samples
_VISCOUS = 0.3       # s/m, times the normal force: where its search for viscous friction starts
_MOST_STEPS = 200    # of its optimizer: its default
_MODEL = """
<mujoco>
  <option timestep="{step!r}" gravity="0 0 0"/>
  <worldbody>
    <body name="slider">
      <inertial mass="{mass!r}" pos="0 0 0" diaginertia="1 1 1"/>
      <joint name="axis" type="slide" axis="1 0 0" frictionloss="{friction!r}" damping="{viscous!r}"/>
    </body>
  </worldbody>
  <actuator>
    <general name="spring" joint="axis" gainprm="{stiffness!r}" biastype="affine" biasprm="0 -{stiffness!r} 0"/>
    <general name="damper" joint="axis" gainprm="{damping!r}" biastype="affine" biasprm="0 0 -{damping!r}"/>
  </actuator>
  <sensor>
    <jointpos name="position" joint="axis"/>
    <jointactuatorfrc name="drive_force" joint="axis"/>
  </sensor>
</mujoco>
"""


def is_installed() -> bool:
    """Return whether mujoco is there, with what its sysid needs."""
    return all(importlib.util.find_spec(name) for name in ('mujoco', 'colorama', 'tabulate', 'plotly'))


def version() -> str:
    """Return which MuJoCo it is."""
    return f'mujoco.sysid {importlib.metadata.version("mujoco")}'


def fit_own_friction(axis: SyntheticAxis, measured: Measurement) -> RivalFit:
    """Return mass, stiffness and damping as far as they are free, found together with Coulomb and viscous friction."""
    import mujoco
    from mujoco import sysid

    begin = time.process_time()
    start = axis.start.axis
    normal = start.normal_force
    friction = normal * value_of(axis.start, 'friction.static.initial')
    viscous = _VISCOUS * normal
    spec = mujoco.MjSpec.from_string(_MODEL.format(
        step=STEP, mass=start.mass, friction=friction, viscous=viscous, stiffness=start.drive_stiffness,
        damping=start.drive_damping))
    model = spec.compile()
    feed = simulate(axis.start, float(measured.times[-1]), STEP).samples
    parameters = sysid.ParameterDict()
    for name, modifier in _MODIFIERS.items():
        if name in axis.free:
            value = value_of(axis.start, name)
            parameters.add(sysid.Parameter(name, value, RANGE[0] * value, RANGE[1] * value, modifier=modifier))
    parameters.add(sysid.Parameter('friction', friction, 0.0, RANGE[1] * friction, modifier=_set_friction))
    parameters.add(sysid.Parameter('viscous', viscous, 0.0, 10.0 * viscous, modifier=_set_viscous))
    sequences = sysid.ModelSequences(
        'axis', spec, 'run', sysid.create_initial_state(model, np.zeros(1), np.zeros(1)),
        sysid.TimeSeries.from_control_names(
            measured.times, np.column_stack((feed['drive_position'], feed['drive_velocity'])), model),
        sysid.TimeSeries.from_names(
            measured.times, np.column_stack([measured.columns[name] for name in ('position', 'drive_force')]), model))
    runs = Counted(sysid.build_residual_fn(models_sequences=[sequences], n_threads=1))
    found = _optimized(parameters, runs)
    values = {name: float(parameter.value[0]) for name, parameter in found.items()}
    return RivalFit(values, runs.count, time.process_time() - begin)


def fit_our_laws(axis: SyntheticAxis, measured: Measurement) -> RivalFit:
    """Return what its optimizer makes of the residuals of our scene, simulated in steps of 0.1 ms."""
    from mujoco import sysid

    begin = time.process_time()
    residuals = SteppedResiduals(axis, measured)
    parameters = sysid.ParameterDict()
    for name in axis.free:
        parameters.add(sysid.Parameter(name, 1.0, *RANGE))

    def residual_of(shares: Numbers, _: object) -> tuple[list[Numbers], None, None]:
        if shares.ndim == 1:
            return [residuals(shares)], None, None
        return [np.column_stack([residuals(column) for column in shares.T])], None, None

    found = _optimized(parameters, residual_of)
    return RivalFit(residuals.values(found.as_vector()), residuals.runs, time.process_time() - begin)


def _optimized(parameters: Any, residual_of: Callable[..., Any]) -> Any:
    """Return the parameters that its optimizer ends at; what it prints is dropped."""
    from mujoco import sysid

    with contextlib.redirect_stdout(io.StringIO()):
        found, _ = sysid.optimize(parameters, residual_of, max_iters=_MOST_STEPS, verbose=False)
    return found


class Counted:
    """A function of residuals that counts the simulations that it takes."""

    def __init__(self, residual_of: Callable[..., Any]) -> None:
        self.count = 0
        self._residual_of = residual_of

    def __call__(self, values: Numbers, parameters: Any) -> Any:
        self.count += 1 if values.ndim == 1 else values.shape[1]
        return self._residual_of(values, parameters)


def _set_mass(spec: Any, parameter: Any) -> None:
    spec.body('slider').mass = parameter.value[0]


def _set_stiffness(spec: Any, parameter: Any) -> None:
    spec.actuator('spring').gainprm[0] = parameter.value[0]
    spec.actuator('spring').biasprm[1] = -parameter.value[0]


def _set_damping(spec: Any, parameter: Any) -> None:
    spec.actuator('damper').gainprm[0] = parameter.value[0]
    spec.actuator('damper').biasprm[2] = -parameter.value[0]


def _set_friction(spec: Any, parameter: Any) -> None:
    spec.joint('axis').frictionloss = parameter.value[0]


def _set_viscous(spec: Any, parameter: Any) -> None:
    spec.joint('axis').damping = [parameter.value[0], 0.0, 0.0]


_MODIFIERS = {'axis.mass': _set_mass, 'axis.drive_stiffness': _set_stiffness, 'axis.drive_damping': _set_damping}
