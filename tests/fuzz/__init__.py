# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Input that nobody meant well: what it is made of, and what must hold for all of it.

Some of it in every test run (tests/fuzz/test_fuzz.py), more for as long as asked for (`make fuzz MINUTES=10`).
"""
