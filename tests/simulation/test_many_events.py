# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of very many events in one call: they go on as long as time does."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from stickslip_sim.axis import Axis, Friction, InitialState
from stickslip_sim.core.errors import SolverError
from stickslip_sim.core.time_grid import Instants
from stickslip_sim.core.types import EventKind, Instant, Sample
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import RIGID, make

STIFFNESS = 6e5
NO_FRICTION = Friction(StaticLaw(StaticLawKind.CONSTANT, 0.0, 0.0), KineticTable((0.0,), (0.0,)), None)


def swinging(mass: float) -> Simulator:
    """Return a slider on an undamped spring, which turns round twice a swing for ever."""
    return make(Axis(mass, STIFFNESS, 0.0, 0.0, RIGID, NO_FRICTION), 0.0, initial=InitialState(velocity=0.1))


def test_a_long_call_has_any_number_of_events() -> None:
    whole, parts, skipped = swinging(350.0), swinging(350.0), swinging(350.0)
    end = Instant(9000.0, 0.0)
    turns = [event for event in whole.advance(end) if event.kind == EventKind.REVERSE]
    assert len(turns) == math.floor(9000.0 * math.sqrt(STIFFNESS / 350.0) / math.pi + 0.5) > 100_000
    assert [event for k in range(1, 10) for event in parts.advance(Instant(1000.0 * k, 0.0))
            if event.kind == EventKind.REVERSE] == turns
    skipped.skip(end)
    assert skipped.sample() == parts.sample() == whole.sample()


@pytest.mark.parametrize('go_on', [
    lambda simulator: simulator.advance(Instant(1.0, 0.0)), lambda simulator: simulator.skip(Instant(1.0, 0.0)),
    lambda simulator: simulator.take_samples(Instants(np.array([1.0]), np.array([0.0])),
                                             np.empty((1, len(Sample._fields))))])
def test_a_call_in_which_time_stands_ends(go_on: Callable[[Simulator], object]) -> None:
    """It reverses 250 million times a second."""
    simulator = swinging(1e-12)
    times = []
    for _ in range(2):
        with pytest.raises(SolverError, match=r'^1000\d\d events up to t = .* time hardly goes on'):
            go_on(simulator)
        times.append(simulator.time.seconds)
    assert 0.0 < times[0] < times[1] < 0.001
