# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Input profiles with sines that several tests use."""

from dataclasses import replace

from stickslip_sim.core.input_profile import InputProfile, Sinusoid


def with_sinusoids(profile: InputProfile, *sinusoids: tuple[float, float, float]) -> InputProfile:
    return replace(profile, sinusoids=tuple(Sinusoid(*sinusoid) for sinusoid in sinusoids))
