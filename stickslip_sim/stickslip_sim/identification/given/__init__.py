# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What an identification starts from: the readings of a run, what is free, and whether the one can tell the other."""
