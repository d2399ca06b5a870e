# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The engine for programs in C: one file with its header, a scene as an example, and an axis for LinuxCNC."""
