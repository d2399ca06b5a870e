# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The channels of a measurement that an identification uses, and their units."""

from collections.abc import Mapping

OUTPUTS: Mapping[str, str] = {'position': 'm', 'velocity': 'm/s', 'drive_force': 'N', 'friction_force': 'N'}
INPUTS: Mapping[str, str] = {'external_force': 'N'}   # measured inputs with a sensor that may be off
UNITS: Mapping[str, str] = {**OUTPUTS, **INPUTS}
