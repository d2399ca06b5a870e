# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded runs, run again from what travels in them: the same to the last bit, or as something else had been."""
