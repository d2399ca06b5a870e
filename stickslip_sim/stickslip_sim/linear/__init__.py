# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of one linear mode in closed form, and its first roots.  Knows no friction and no axis."""
