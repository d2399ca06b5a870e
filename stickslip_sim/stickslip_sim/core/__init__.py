# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What every room uses: errors, modes, events, samples, input profiles, the time grid, the switch to compiled code."""
