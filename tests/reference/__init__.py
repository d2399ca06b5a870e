# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes for the reference automaton, the law it must keep, and the runs of it that are stored."""
