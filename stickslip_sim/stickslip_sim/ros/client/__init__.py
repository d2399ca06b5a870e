# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The services of a running node from outside, for the tool."""
