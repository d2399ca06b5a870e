# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One parameter and its checks, and YAML as ROS 2 reads it.  The only door to a YAML library."""
