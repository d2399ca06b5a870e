# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What comes from outside: profiles and measured numbers from files, in the units that are stated."""

from .scene_files import SceneOrName, load_scene, scene_of

__all__ = ['SceneOrName', 'load_scene', 'scene_of']
