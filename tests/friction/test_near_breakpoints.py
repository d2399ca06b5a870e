# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction that jumps between two breakpoints close together: refused, or followed soundly."""

import random
from dataclasses import replace

import pytest

from stickslip_sim.axis import Axis, InitialState
from stickslip_sim.core.errors import InputError, UnsoundError
from stickslip_sim.core.types import Instant
from stickslip_sim.extremes.shared_axes import random_axis, random_profiles
from stickslip_sim.friction import kinetic
from stickslip_sim.simulation.simulator import Simulator


def with_a_jump(axis: Axis, rng: random.Random, distance: float) -> Axis:
    """Return the axis with another breakpoint a little faster than one of its own, of any coefficient."""
    table = axis.friction.kinetic
    k = rng.randrange(1, len(table.velocities))
    speeds, coefficients = [*table.velocities], [*table.coefficients]
    speeds.insert(k + 1, speeds[k] * (1.0 + distance))
    coefficients.insert(k + 1, rng.choice((0.0, 1.0, rng.random())))
    changed = kinetic.KineticTable(tuple(speeds), tuple(coefficients))
    excess = axis.friction.excess and kinetic.default_excess(changed)
    return replace(axis, friction=replace(axis.friction, kinetic=changed, excess=excess))


def unsound_runs(distance: float) -> int:
    """Return how many of 300 runs contradict themselves."""
    count = 0
    for seed in range(300):
        rng = random.Random(seed)
        axis, (drive, force) = with_a_jump(random_axis(rng), rng, distance), random_profiles(rng)
        simulator = Simulator(axis, InitialState(), drive, force, accounting=True)
        try:
            simulator.advance(Instant(3.0, 0.0))
            simulator.require_sound()
        except UnsoundError:
            count += 1
    return count


def test_what_is_not_refused_is_sound() -> None:
    assert unsound_runs(1.1e-8) == 0


def test_nearer_ones_are_refused() -> None:
    """Of runs with a distance of 1e-11 about a tenth contradict themselves."""
    with pytest.raises(InputError, match=r'at least .* m/s apart, 1e-08 of the speed; they are .* m/s apart'):
        unsound_runs(0.9e-8)
