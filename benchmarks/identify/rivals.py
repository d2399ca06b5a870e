# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Others on the data of the synthetic axes: how far off they end, and how long they take."""

import contextlib
import importlib.metadata
import importlib.util
import io
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import least_squares

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.errors import StickslipError
from stickslip_sim.runs import simulate
from stickslip_sim.scene import Scene
from stickslip_sim.scene.load import changed
from stickslip_sim.study.points import scene_at

from .axes import RANGE, SyntheticAxis, value_of
from .measuring import Measurement
from .outcomes import Outcome, measured_axis

# Plain least squares on a stepped simulation: the same scene, the same laws, semi-implicit Euler at 0.1 ms.
#
# What one would write in an afternoon: simulate the whole run, subtract, and let `scipy.optimize.least_squares` go from
# the start within the ranges, with all its defaults, so that its differences take steps of 1.5e-8.

STEP = 1e-4         # s
_REFUSED = 10.0     # times the residuals of the start: where the values make no scene


class RivalFit(NamedTuple):
    """What a rival found: values by the names of parameters, how many simulations it took, and s of processor time."""

    values: dict[str, float]
    runs: int
    seconds: float


class SteppedResiduals:
    """Residuals of the whole run, in standard deviations of the sensors, over shares of the start."""

    def __init__(self, axis: SyntheticAxis, measured: Measurement, step: float = STEP) -> None:
        self.runs = 0
        self._names = axis.free
        self._base: Scene = changed(axis.start, {'solver.name': 'fixed_step', 'solver.step': step})
        self._start = np.array([value_of(axis.start, name) for name in axis.free])
        self._measured = measured
        self._worst = _REFUSED * np.abs(self(np.ones(len(axis.free))))

    def values(self, shares: Numbers) -> dict[str, float]:
        """Return the parameters."""
        return dict(zip(self._names, (self._start * shares).tolist(), strict=True))

    def __call__(self, shares: Numbers) -> Numbers:
        """Return the residuals (2 n,) of shares (k,) of the start."""
        self.runs += 1
        times, columns = self._measured.times, self._measured.columns
        try:
            scene = scene_at(self._base.values, self._names, self._start * shares)
            samples = simulate(scene, float(times[-1]), float(times[1] - times[0])).samples
        except StickslipError:
            return self._worst
        return np.concatenate([(columns[name] - samples[name]) / noise
                               for name, noise in self._measured.noise.items()])


def fit_stepped(axis: SyntheticAxis, measured: Measurement) -> RivalFit:
    """Return what scipy's least squares finds with its default steps."""
    begin = time.process_time()
    residuals = SteppedResiduals(axis, measured)
    found = least_squares(residuals, np.ones(len(axis.free)), bounds=RANGE)
    return RivalFit(residuals.values(found.x), residuals.runs, time.process_time() - begin)


# `mujoco.sysid` (pip install 'mujoco[sysid]'), in two ways, each with its defaults.
#
# With MuJoCo's own friction, as its user would: a slide joint with `frictionloss` and `damping`, spring and damper of
# the drive as actuators.  And its optimizer alone, given more than it has: our laws in a stepped simulation as its
# residuals.

_SAMPLE_STEP = 1e-3  # s
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
        step=_SAMPLE_STEP, mass=start.mass, friction=friction, viscous=viscous, stiffness=start.drive_stiffness,
        damping=start.drive_damping))
    model = spec.compile()
    feed = simulate(axis.start, float(measured.times[-1]), _SAMPLE_STEP).samples
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


# All of them.

OURS = '`stickslip identify`'
METHODS: Mapping[str, Callable[[SyntheticAxis, Measurement], RivalFit]] = {
    'least squares, 0.1 ms steps': fit_stepped,
    **({'`mujoco.sysid`, our laws, 0.1 ms steps': fit_our_laws,
        '`mujoco.sysid`, own friction, 1 ms steps': fit_own_friction}
       if is_installed() else {}),
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
