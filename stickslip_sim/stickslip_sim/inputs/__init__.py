# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What comes from outside: scenes by name or path, profiles and measurements from files, stated units to SI."""

from .scene_files import SceneOrName, load_scene, scene_of

__all__ = ['SceneOrName', 'load_scene', 'scene_of']
