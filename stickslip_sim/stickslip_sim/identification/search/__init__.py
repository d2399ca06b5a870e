# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The way from starts far off to the best fit, from many of them, and where the axis is not quite the model."""
