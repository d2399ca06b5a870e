# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What came of the identification of an axis whose truth is known."""

import json
import time
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from stickslip_sim.identification.identified import FOUND, Identification
from stickslip_sim.identification.identify import identify

from .axes import SyntheticAxis
from .measuring import Measurement, measure

CLOSE = 0.01   # a share of the true value
FAR, INTERVALS = 0.03, 5.0   # of the true value, and times the side of an interval: what is off by both is far off


@dataclass(frozen=True)
class ParameterOutcome:
    """One free parameter: what is true, where the search began, what was found, and the 95 % interval of it."""

    name: str
    true: float
    start: float
    value: float
    low: float
    high: float
    kind: str

    @property
    def error(self) -> float:
        """How far it is from the truth, as a share of it."""
        return abs(self.value / self.true - 1.0)

    @property
    def is_covered(self) -> bool:
        """Whether the truth lies in its interval."""
        return self.low <= self.true <= self.high

    @property
    def is_found(self) -> bool:
        """Whether it is within 1 %, or the truth within its interval."""
        return self.error <= CLOSE or self.is_covered

    @property
    def is_far(self) -> bool:
        """Whether it is called found, and is far off."""
        side = self.value - self.low if self.true < self.value else self.high - self.value
        return self.kind == FOUND and self.error > FAR and abs(self.value - self.true) > INTERVALS * side

    @property
    def width(self) -> float:
        """Half of its interval, as a share of the truth."""
        return (self.high - self.low) / (2.0 * self.true)


@dataclass(frozen=True)
class Outcome:
    """An axis: its parameters, whether the model is said to fit, s of processor time, and how many simulations."""

    axis: str
    models: tuple[str, ...]
    parameters: tuple[ParameterOutcome, ...]
    fits: bool
    seconds: float
    runs: int
    failure: str = ''

    @property
    def is_found(self) -> bool:
        """Whether all of its parameters are."""
        return bool(self.parameters) and all(parameter.is_found for parameter in self.parameters)


def measured_axis(axis: SyntheticAxis) -> Measurement:
    """Return what its sensors show of an axis."""
    return measure(axis.truth, axis.duration, np.random.default_rng(axis.seed), axis.sensors)


def identified(axis: SyntheticAxis, measured: Measurement) -> Identification:
    """Return what is found from a measurement, on one core."""
    with TemporaryDirectory() as parent:
        run = measured.as_run(Path(parent, 'run'))
        return identify(run, axis.start, axis.free_file())


def outcome_of(axis: SyntheticAxis) -> Outcome:
    """Return what came of an axis; a refusal or a failure is an outcome, too."""
    measured = measured_axis(axis)
    begin = time.process_time()
    try:
        found = identified(axis, measured)
    except Exception as error:   # to be counted, not to end a run of hours
        return Outcome(axis.name, models_of(axis), (), False, time.process_time() - begin, 0,
                       f'{type(error).__name__}: {error}')
    seconds = time.process_time() - begin
    true = axis.true_values()
    return Outcome(axis.name, models_of(axis), tuple(
        ParameterOutcome(each.name, true[each.name], each.start, each.value, *each.best_interval, each.kind)
        for each in found.estimates if each.name in true), found.fits, seconds, found.runs)   # without those it frees


def models_of(axis: SyntheticAxis) -> tuple[str, ...]:
    """Return the contact and the laws of static and kinetic friction."""
    values = axis.truth.values
    return tuple(str(values[name]) for name in ('contact.model', 'friction.static.law', 'friction.kinetic.law'))


def save(outcomes: Sequence[Outcome], path: Path) -> None:
    """Write outcomes, from which a run goes on."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps([asdict(outcome) for outcome in outcomes], indent=1) + '\n', encoding='utf-8')


def load(path: Path) -> list[Outcome]:
    """Return the outcomes in a file, none without one."""
    if not path.exists():
        return []
    return [Outcome(**{**entry, 'models': tuple(entry['models']),
                       'parameters': tuple(ParameterOutcome(**each) for each in entry['parameters'])})
            for entry in json.loads(path.read_text(encoding='utf-8'))]


def all_parameters(outcomes: Iterable[Outcome]) -> list[ParameterOutcome]:
    """Return the parameters of all axes."""
    return [parameter for outcome in outcomes for parameter in outcome.parameters]
