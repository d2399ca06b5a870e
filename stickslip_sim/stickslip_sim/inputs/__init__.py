# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What comes from outside: profiles and measured numbers from files, in the units that are stated."""

from .scene_files import load_scene

__all__ = ['load_scene']
