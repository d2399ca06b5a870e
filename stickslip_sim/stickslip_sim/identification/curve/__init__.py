# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A measured friction curve, and the laws that fit it: the verb `friction`."""
