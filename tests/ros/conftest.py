# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Without ROS there is nothing to test here."""

from importlib.util import find_spec

collect_ignore_glob = [] if find_spec('rclpy') else ['*']
