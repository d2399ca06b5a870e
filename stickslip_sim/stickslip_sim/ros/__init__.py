# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS 2 node: the only room that knows rclpy and the messages.  No physics in here."""
