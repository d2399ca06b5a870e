# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a scene says of the rig."""

from dataclasses import dataclass, field

from .drive import DriveLimits
from .encoder import EncoderSettings
from .faults import Fault


@dataclass(frozen=True, slots=True)
class RigSettings:
    """`on_timeout`: hold, ramp_to_zero or fault, with `timeout_deceleration` (m/s²); `measures`: encoders are read."""

    seed: int = 0
    measures: bool = False
    encoder: EncoderSettings = field(default_factory=EncoderSettings)
    encoder_delay_steps: int = 0
    limits: DriveLimits = field(default_factory=DriveLimits)
    on_timeout: str = 'hold'
    timeout_deceleration: float = 1.0
    faults: tuple[Fault, ...] = ()
