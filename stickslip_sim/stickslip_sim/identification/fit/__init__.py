# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The residuals of a point in the range of the parameters, and the least squares that makes them small."""
