# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Closed-form motion of one linear mode, and its guaranteed first roots.  Knows no friction and no axis."""
