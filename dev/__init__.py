# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What keeps the pages of this repository in order: pictures, links, words.  Nothing in here is installed."""
