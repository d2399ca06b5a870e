# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Profiles and measured numbers from files."""
