# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Limits files, runs and bags for tests of `stickslip check` and `verify`, and the tool itself."""

import math
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path

from stickslip_sim.bags.topics import DRIVE_VELOCITY, RECORDED, SLIDER_STATE
from stickslip_sim.check.limits import LimitOutcome, limits_of, outcomes_of
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import RunFacts, flat_layout, write_bag
from stickslip_sim.recording.messages import Packer
from stickslip_sim.recording.run import open_run, receipt_file
from stickslip_sim.runs import SimulatedRun, simulate
from stickslip_sim.scene import Scene, scene_from_values
from stickslip_sim.scene.ros_yaml import read_yaml
from tests.support import tool
from tests.support.tool import Capture

LIMITS = 'limits: {sticks: {max: 1}, longest_stick: {max: 1.0}, peak_speed: {max: 0.02}}'
DURATION = '1.4'   # s; paper_fig7 sticks once

# An axis without friction that swings out from rest position 0: everything about it has a closed form.
START_VELOCITY = 0.1                     # m/s
DECAY = 4000.0 / (2.0 * 350.0)           # 1/s
FREQUENCY = math.sqrt(6e5 / 350.0 - DECAY**2)   # rad/s
FREE = scene_from_values({'initial.velocity': START_VELOCITY}, 'free')


def free_position(time: float) -> float:
    return START_VELOCITY / FREQUENCY * math.exp(-DECAY * time) * math.sin(FREQUENCY * time)


def simulated(scene: Scene | str, duration: float) -> SimulatedRun:
    return simulate(load_scene(scene) if isinstance(scene, str) else scene, duration)


def of_limits(text: str, found: SimulatedRun) -> dict[str, LimitOutcome]:
    """Return the outcomes of limits given as YAML, by name."""
    return {outcome.name: outcome for outcome in outcomes_of(limits_of(read_yaml(text)), found)}


def measured(text: str, found: SimulatedRun) -> float:
    """Return the figure of the one limit given as YAML."""
    (outcome,) = of_limits(f'limits: {{{text}}}', found).values()
    assert outcome.value is not None
    return outcome.value


def limits_file(folder: Path, text: str) -> str:
    path = folder / 'limits.yaml'
    path.write_text(text, encoding='utf-8')
    return str(path)


def node_bag(folder: Path, timing: object) -> Path:
    """Write a bag as a node does, with this in its receipt."""
    scene = load_scene('paper_fig7')
    done = simulate(scene, 0.2, scene.time.step)
    write_bag(folder, RunFacts.of(scene), done.sample_rows(), done.events, {'timing': timing})
    return folder


def commanded_bag(folder: Path, commands: Mapping[int, float], steps: int, timing: object = None) -> Path:
    """Write the states of a node whose drive rests but for these commands (m/s), each taken up by a step."""
    scene = load_scene('paper_fig8', {'drive.velocity': 0.0})
    rig, pack = scene.make_rig(), Packer(SLIDER_STATE).pack
    writer = open_run(folder, RunFacts.of(scene))
    for step in range(steps + 1):
        begin = rig.time_ns
        sample = rig.make_step(commands.get(step)).sample
        if step in commands:
            data = flat_layout(DRIVE_VELOCITY.type).pack(begin, commands[step])
            writer.write(RECORDED.index(DRIVE_VELOCITY), data, begin, begin, step)
        end = rig.time_ns
        writer.write(RECORDED.index(SLIDER_STATE), pack(end, step, sample), end, end, step)
    writer.close(receipt_file({'timing': timing} if timing else {}))
    return folder


def cut(bag: Path, folder: Path, share: float) -> Path:
    """Return a copy of a bag that ends early, as a killed process leaves it."""
    shutil.copytree(bag, folder)
    (path,) = folder.glob('*.mcap')
    data = path.read_bytes()
    path.write_bytes(data[:int(share * len(data))])
    return folder


def checked(capsys: Capture, *arguments: str | Path) -> tuple[int, str, str]:
    """Run `stickslip check` in this process; return its exit code, standard output and standard error."""
    return tool.answered(capsys, 'check', *arguments)


def refused(capsys: Capture, *arguments: str | Path, words: Iterable[str] = ()) -> str:
    """Return the one line on standard error, with these words in it."""
    return tool.refused(capsys, 'check', *arguments, words=words)


def verified(capsys: Capture, *arguments: str | Path) -> tuple[int, str, str]:
    """Run `stickslip verify` in this process; return its exit code, standard output and standard error."""
    code, out, err = tool.answered(capsys, 'verify', *arguments)
    assert err.count('\n') == (code != 0)
    return code, out, err
