# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Input profiles with sines that several tests use."""

import math
import random
from dataclasses import replace

from stickslip_sim.axis import Axis
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, ramp, steps, table


def with_sinusoids(profile: InputProfile, *sinusoids: tuple[float, float, float]) -> InputProfile:
    return replace(profile, sinusoids=tuple(Sinusoid(*sinusoid) for sinusoid in sinusoids))


def random_profiles(rng: random.Random, axis: Axis) -> tuple[InputProfile, InputProfile]:
    """Return input profiles of all kinds with one to three sinusoids; some are in resonance with the slip."""
    speed = rng.choice((-1, 1)) * 10 ** rng.uniform(-3, -1.3)
    omega = math.sqrt(axis.drive_stiffness / axis.mass)
    frequencies = [rng.choice((omega / (2.0 * math.pi), rng.uniform(0.01, 2.0), 10 ** rng.uniform(-1, 2)))
                   for _ in range(3)]
    drive = rng.choice((constant(speed), constant(0.0), ramp(0.0, speed, 2.0),
                        steps('drive', [0.0, 1.0], [speed, -speed]),
                        table('drive', [0.0, 0.5, 1.5], [0.0, speed, -speed], 2.0)))
    force = rng.choice((constant(0.0), ramp(0.0, axis.normal_force * 0.1, 1.0),
                        steps('force', [0.0, 0.7, 0.9], [0.0, rng.uniform(-0.5, 0.5) * axis.normal_force, 0.0])))
    pull = [(rng.uniform(0.0, 0.3) * axis.normal_force, f, rng.uniform(-7, 7)) for f in frequencies]
    shake = [(rng.uniform(0.0, 2.0) * abs(speed), f, rng.uniform(-7, 7)) for f in frequencies]
    return with_sinusoids(drive, *shake[:rng.randint(0, 2)]), with_sinusoids(force, *pull[:rng.randint(1, 3)])
