# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The measured trade: cost and error of every solver, against the reference and its peers; times of a start."""
