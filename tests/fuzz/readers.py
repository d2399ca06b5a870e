# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Every reader of what comes from outside, called as the product calls it."""

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from stickslip_sim.check.limits import limits_of
from stickslip_sim.check.sources import recorded
from stickslip_sim.cli.export import csv_lines
from stickslip_sim.errors import LINE_LIMIT, RecordingWarning, StickslipError
from stickslip_sim.paper.recorded import history_of_run
from stickslip_sim.recording import Run, read_run
from stickslip_sim.rerun.recording import open_recording
from stickslip_sim.rerun.verdict import verify
from stickslip_sim.scene import load_scene, parse_override, parse_scene
from stickslip_sim.scene.ros_yaml import read_yaml


def accepts_or_refuses(read: Callable[..., object], *arguments: object) -> object:
    """Return what a reader returns, None when it refused in a line; anything else that it raises is a mistake."""
    try:
        return read(*arguments)
    except StickslipError as error:
        text = str(error)
        assert 0 < len(text) <= LINE_LIMIT + 1, text
        assert '\n' not in text, text
        return None


def scene(text: str) -> None:
    """Read a scene file, and what it came to once more."""
    found: Any = accepts_or_refuses(parse_scene, text)
    if found is not None:
        assert parse_scene(found.text).hash == found.hash


def limits(text: str) -> None:
    """Read a limits file."""
    accepts_or_refuses(lambda: limits_of(read_yaml(text)))


def override(name: str, *changes: str) -> None:
    """Change a shipped scene as --set does."""
    accepts_or_refuses(lambda: load_scene(name, dict(parse_override(change) for change in changes)))


def bag(path: Path) -> None:
    """Read a bag in every way that there is."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RecordingWarning)
        run = accepts_or_refuses(read_run, path)
        if isinstance(run, Run):
            for look in (lambda run: run.scene, lambda run: run.receipt, lambda run: run.events):
                accepts_or_refuses(look, run)
            for topic in run.topics:
                accepts_or_refuses(lambda run, topic: list(csv_lines(run.columns(topic))), run, topic)
        for read in (recorded, history_of_run):
            accepts_or_refuses(read, str(path))
        accepts_or_refuses(lambda: verify(open_recording(path)))
