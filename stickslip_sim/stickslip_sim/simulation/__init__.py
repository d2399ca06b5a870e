# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One axis through time: the simulator, its inputs, its checkpoints and its cycle figures."""
