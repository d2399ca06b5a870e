# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Which solver and which parts of a scene are worth their time, by trial runs.  Rivals are measured in `bench`."""
