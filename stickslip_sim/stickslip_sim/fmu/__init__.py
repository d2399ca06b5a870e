# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A scene as an FMU, for co-simulation in other tools."""
