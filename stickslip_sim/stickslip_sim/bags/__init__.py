# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""MCAP files as rosbag2 has them: messages, topics, metadata.  A run in a bag is next door, in `recording`."""
