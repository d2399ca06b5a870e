# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The experiment that would narrow chosen parameters most: feeds to choose from, and what each would say."""
