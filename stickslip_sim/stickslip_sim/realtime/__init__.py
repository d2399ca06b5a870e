# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The real-time core, without ROS: pacing, the step loop, command slots, timing statistics, the verdict."""
