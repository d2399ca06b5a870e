# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Axes through time: the simulator of one, the batch of thousands, their inputs, checkpoints and cycle figures."""
