# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Limits files and evidence for tests of `stickslip check`."""

import math
from pathlib import Path

from stickslip_sim.check.limits import limits_of
from stickslip_sim.check.sources import Evidence, simulated
from stickslip_sim.check.verdict import Outcome, judge
from stickslip_sim.offline import run_offline
from stickslip_sim.scene import Scene, load_scene, scene_from_values
from stickslip_sim.scene.ros_yaml import read_yaml

# An axis without friction that swings out from rest position 0: everything about it has a closed form.
START_VELOCITY = 0.1                     # m/s
DECAY = 4000.0 / (2.0 * 350.0)           # 1/s
FREQUENCY = math.sqrt(6e5 / 350.0 - DECAY**2)   # rad/s
FREE = scene_from_values({'initial.velocity': START_VELOCITY}, 'free')


def free_position(time: float) -> float:
    return START_VELOCITY / FREQUENCY * math.exp(-DECAY * time) * math.sin(FREQUENCY * time)


def evidence(scene: Scene | str, duration: float) -> Evidence:
    scene = load_scene(scene) if isinstance(scene, str) else scene
    return simulated(run_offline(scene, duration, scene.time.step))


def judged(text: str, found: Evidence) -> dict[str, Outcome]:
    """Return the outcomes of limits given as YAML, by name."""
    return {outcome.name: outcome for outcome in judge(limits_of(read_yaml(text)), found)}


def measured(text: str, found: Evidence) -> float:
    """Return the figure of the one limit given as YAML."""
    (outcome,) = judged(f'limits: {{{text}}}', found).values()
    assert outcome.value is not None
    return outcome.value


def limits_file(folder: Path, text: str) -> str:
    path = folder / 'limits.yaml'
    path.write_text(text, encoding='utf-8')
    return str(path)
