# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers that a feed axis has, to ask back when a unit was mistaken: far narrower than what the engine can take."""

MEANT = '--meant'          # the option of the tool that says so
FASTEST = 3.0              # m/s: 180 m/min, above the rapid traverse of linear motors
ROUGHEST = 2.0             # a coefficient of friction: rubber on dry concrete is 1
