# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The paper figure by figure: its pictures, cycle figures and statements, on any run.  Limits are in `check`."""
