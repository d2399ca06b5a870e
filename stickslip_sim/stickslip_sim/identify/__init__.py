# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From measurements to a scene: a measured friction curve, and the laws of the engine that fit it."""
