# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The measured trade: what every solver costs and how wrong it is, against the reference and against its peers."""
