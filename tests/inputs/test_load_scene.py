# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes by a path as Python has it."""

from pathlib import Path

import stickslip_sim as stickslip


def test_a_path_is_as_good_as_a_name(tmp_path: Path) -> None:
    file = tmp_path / 'axis.yaml'
    file.write_text('/**:\n  ros__parameters:\n    scene: light\n    axis: {mass: 20.0}\n')
    assert stickslip.load_scene(file).axis.mass == stickslip.load_scene(str(file)).axis.mass == 20.0
