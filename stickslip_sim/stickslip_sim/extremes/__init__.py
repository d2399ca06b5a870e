# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The extremes: what breaks other simulators, measured on this one against its mark."""
