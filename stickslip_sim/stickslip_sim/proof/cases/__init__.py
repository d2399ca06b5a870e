# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The cases behind the names X1 to X27: each function measures one of them, by the judges of `proof.judges`."""
