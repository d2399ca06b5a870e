# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The axis with trial values of its parameters, and what its slips show."""
