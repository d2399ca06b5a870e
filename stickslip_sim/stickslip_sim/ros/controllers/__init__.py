# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The example controllers as ROS nodes."""
