# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Simulators that one might use instead of this one, each behind the same few words (`peer.Peer`)."""
