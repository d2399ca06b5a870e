# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Judges by name: each takes a run and raises Find."""
