# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The paper figure by figure: its pictures, its cycle figures and its statements, from any run."""
