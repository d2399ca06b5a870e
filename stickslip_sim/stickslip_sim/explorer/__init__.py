# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene as one page for any browser, with the exact engine in it: a slider moves, the motion follows."""
