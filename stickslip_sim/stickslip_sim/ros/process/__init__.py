# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The process around a node: signals, environment, parameter files, exit codes."""
