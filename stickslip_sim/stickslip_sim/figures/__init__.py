# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What is read off one motion: cycles, slips, rounds, their names and units.  A whole run is in `runs`."""
