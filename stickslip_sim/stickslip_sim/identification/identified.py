# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What an identification found: the scene that reproduces a measured run, and how well each of its numbers is known."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ..core.arrays import Numbers
from ..report.html import Shown
from ..report.model import Part, Table
from ..scene import Scene

FOUND, AT_BOUND, NOT_IDENTIFIABLE, VOID = 'found', 'at a bound', 'not identifiable', 'void'
LEVEL = 0.95   # of all intervals
_CONSTANT = 1e-12   # of the largest: a range so small is rounding


@dataclass(frozen=True)
class Estimate:
    """A free parameter: all numbers in `unit`, but `standard_deviation` of the logarithm where `logarithmic`.

    `low` and `high` are its range in the file of free parameters.  `interval` (low, high) is that of the covariance,
    `profile` that of the profile likelihood (None where it was not computed); an end may lie at that of the range.
    `kind` is FOUND, AT_BOUND, NOT_IDENTIFIABLE, whose interval is the range, or VOID: the best number of a model that
    a test rejects.  Then no interval holds: both ends are NaN, `standard_deviation` is that of the rejected fit.
    """

    name: str
    unit: str
    value: float
    start: float
    low: float
    high: float
    logarithmic: bool
    standard_deviation: float
    interval: tuple[float, float]
    profile: tuple[float, float] | None
    kind: str
    derivation: str

    @property
    def best_interval(self) -> tuple[float, float]:
        """The interval to rely on: that of the profile likelihood where there is one."""
        return self.profile or self.interval


def moved(one: Estimate, step: float) -> float:
    """Return the value of an estimate a step farther: of the logarithm where `logarithmic`, else in its unit."""
    return one.value * math.exp(step) if one.logarithmic else one.value + step


def fit_percent(measured: Numbers, off: Numbers) -> float:
    """Return the fit in % of what is `off` by so much (n,); NaN where what was measured is constant."""
    spread = float(np.linalg.norm(measured - measured.mean()))
    constant = np.ptp(measured) <= _CONSTANT * np.abs(measured).max(initial=0.0)
    return float('nan') if constant else 100.0 * (1.0 - float(np.linalg.norm(off)) / spread)


@dataclass(frozen=True)
class ChannelFit:
    """A measured channel, in `unit`: arrays (n,) of `times` (s, of the measurement), `measured` and `fitted` numbers.

    `fitted` has the sensor's own offset and scale.  `resolution` is the standard deviation that the fit took for the
    noise, `correlation_time` (s) over how long residuals go together (0 when each sample stands for itself).  Where
    noise of a measured force moves the slider, what is `new` in each sample counts: the residuals are these.
    Where single slips are `fitted`, each from a measured arrest, `free` is what the model does by itself from the start
    of the run on; None where `fitted` is that, or where there is no such motion.
    """

    name: str
    unit: str
    times: Numbers
    measured: Numbers
    fitted: Numbers
    resolution: float
    correlation_time: float = 0.0
    new: Numbers | None = None
    free: Numbers | None = None

    @property
    def residuals(self) -> Numbers:
        """Measured less fitted (n,), in `unit`, or what is new in that."""
        return self.measured - self.fitted if self.new is None else self.new

    @property
    def rmse(self) -> float:
        """The root mean square of measured less fitted, in `unit`."""
        return float(np.sqrt(np.mean((self.measured - self.fitted)**2)))

    @property
    def largest(self) -> float:
        """The largest distance of measured and fitted, in `unit`."""
        return float(np.abs(self.measured - self.fitted).max())

    @property
    def fit_percent(self) -> float:
        """100 (1 − |measured − fitted| / |measured − its mean|), in %; NaN of a channel that is constant."""
        return fit_percent(self.measured, self.measured - self.fitted)


@dataclass(frozen=True)
class Misfit:
    """A test that the residuals of a channel fail, from a time to another (s): the `statistic` is beyond its `limit`.

    `statement` says it in a sentence.
    """

    channel: str
    test: str
    statistic: float
    limit: float
    from_time: float
    to_time: float
    statement: str


@dataclass(frozen=True)
class Combination:
    """Parameters that the data know only together: the product of each to the power of its weight is free.

    (The sum of each times its weight, for those that are not fitted by their logarithm.)  `spread` is the standard
    deviation of its logarithm (or of the sum, in widths of the ranges), inf where nothing limits it.
    """

    names: tuple[str, ...]
    weights: tuple[float, ...]
    spread: float
    statement: str


@dataclass(frozen=True)
class StartEnd:
    """Where the fit from one start ended: values in the order of the estimates, and the cost, chi-square, there."""

    start: tuple[float, ...]
    end: tuple[float, ...]
    cost: float
    is_best: bool


@dataclass(frozen=True)
class LawFit:
    """A pair of laws fitted to the same data: its criterion (the lower the better), and how many parameters it took."""

    static: str
    kinetic: str
    criterion: float
    n_parameters: int
    cost: float
    is_chosen: bool


@dataclass(frozen=True)
class SlipFit:
    """A slip of the measurement beside the fitted one: times of break-away (s), stick before it (s), force there (N).

    NaN where one of the two has none.
    """

    time: float
    fitted_time: float
    stick_time: float
    fitted_stick_time: float
    break_away_force: float
    fitted_break_away_force: float


@dataclass(frozen=True)
class FoundNumber:
    """A number of a sensor, or of the start, that was found in a run; `is_at_end` of its range."""

    name: str
    unit: str
    value: float
    is_at_end: bool


@dataclass(frozen=True)
class Prediction:
    """What a scene says of a measured run: `channels` measured and predicted, with their own sensors.

    `found` is what was fitted to the run, and nothing else: offsets of its sensors, delays not known, and its start.
    `stretch_fit` is the fit in % of the stretch of the drive spring, NaN without one: the position follows the drive
    whatever the friction is.
    """

    scene: Scene
    run: str
    channels: tuple[ChannelFit, ...]
    found: tuple[FoundNumber, ...]
    stretch_fit: float
    notes: tuple[str, ...] = ()

    @property
    def values(self) -> dict[str, float]:
        """What was found of the sensors and the start, by its name."""
        return {one.name: one.value for one in self.found}


@dataclass(frozen=True)
class RunAlone:
    """What one of several runs says by itself, and the numbers of its `own` in the fit of all, by name."""

    run: str
    fits: bool
    estimates: tuple[Estimate, ...]
    own: Mapping[str, float]


@dataclass(frozen=True, repr=False)
class Identification(Shown):
    """A scene identified from a run.

    `start` is the scene that was given, `scene` the one with the estimates in it; sensor offsets and scales are among
    the estimates alone.  `correlation` (k, k) is of the k estimates, in their order; NaN in rows that the data do not
    determine.  `fits` says whether no test rejects the model (`misfits` is empty).  `criterion` names the one that
    compares `laws`, `cost` is the chi-square over `n_residuals`, `runs` how many simulations it took, `notes` what a
    user must know.  The start of the simulation is at `shift` s of the measurement, whose times all of this has.
    `measured_inputs` are the sections of the scene, `drive` or `force`, that are as they were measured; `restarts` are
    the measured arrests (s) at which the fitted motion begins anew.  `predictions` are of other runs.
    Of several runs the channels, slips and numbers of its own are those of the first; `alone` is what each says by
    itself, `disagreements` where their intervals do not meet.
    """

    start: Scene
    scene: Scene
    estimates: tuple[Estimate, ...]
    correlation: Numbers
    channels: tuple[ChannelFit, ...]
    misfits: tuple[Misfit, ...]
    combinations: tuple[Combination, ...]
    starts: tuple[StartEnd, ...]
    laws: tuple[LawFit, ...]
    slips: tuple[SlipFit, ...]
    criterion: str
    cost: float
    n_residuals: int
    runs: int
    seconds: float
    notes: tuple[str, ...] = ()
    shift: float = 0.0
    measured_inputs: tuple[str, ...] = ()
    restarts: tuple[float, ...] = ()
    predictions: tuple[Prediction, ...] = ()
    alone: tuple[RunAlone, ...] = ()
    disagreements: tuple[str, ...] = ()

    def _shown(self) -> Iterator[Part]:
        yield (f'Identification of {self.scene.name}: {len(self.estimates)} parameters, '
               + ('no test rejects the model' if self.fits else 'the model does not fit'))
        yield Table(('', 'start', 'found', '95 % interval', ''), [
            (one.name, f'{one.start:.6g}', f'{one.value:.6g}', ' to '.join(f'{end:.6g}' for end in one.interval),
             one.kind) for one in self.estimates], texts=(0, 4))
        yield from [one.statement for one in self.misfits] + [one.statement for one in self.combinations]
        yield from self.notes

    @property
    def fits(self) -> bool:
        """Whether no test of the residuals rejects the model."""
        return not self.misfits

    @property
    def values(self) -> dict[str, float]:
        """The estimated value of each free parameter, by its name."""
        return {estimate.name: estimate.value for estimate in self.estimates}
