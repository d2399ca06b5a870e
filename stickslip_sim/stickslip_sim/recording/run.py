# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What every run folder holds beside its messages: the scene, the versions, the receipt."""

import json
import platform
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING

from ..bags.bag import ONE_FILE, BagWriter, Split, ros_distro
from ..bags.topics import Topic, recorded_topics
from ..core.hot_path import hot_path
from ..core.version import __version__
from ..report.values import plain

if TYPE_CHECKING:
    from ..scene import Scene

SCENE_FILE = 'scene.yaml'
RECEIPT_FILE = 'receipt.json'
CHECKPOINT_FILE = 'checkpoint.json'
_LIBRARIES = ('numpy', 'mcap', 'rosbags')


@dataclass(frozen=True)
class RunFacts:
    """What is needed to run a recorded run again; `scene_text` is the whole effective scene.

    An offline run follows the input profiles of its scene for `duration` s, with a sample every `sample_period` s.
    A run of a node (None) follows the recorded orders.
    """

    scene: str
    scene_text: str
    scene_hash: str
    solver: str
    seed: int
    rate: float  # 1/s
    duration: float | None = None
    sample_period: Fraction | None = None
    log_time: str = 'simulation'    # of a node's run

    @classmethod
    def of(cls, scene: 'Scene', duration: float | None = None, sample_period: Fraction | None = None) -> 'RunFacts':
        """Return the facts of a run of a scene: of a node, or offline with a duration and a sample period."""
        return cls(scene.name, scene.text, scene.hash, scene.solver.name, scene.seed, scene.time.rate, duration,
                   sample_period, scene.record.log_time)

    def as_metadata(self) -> dict[str, str]:
        """Return the facts and the versions of all that takes part in the numbers."""
        return {
            'version': __version__,
            'scene': self.scene,
            'scene_hash': self.scene_hash,
            'solver': self.solver,
            'seed': str(self.seed),
            'rate': repr(self.rate),
            **self._origin(),
            'python': platform.python_version(),
            'platform': platform.platform(),
            'ros_distro': ros_distro(),
            'hot_path': hot_path(),
            **{name: _version(name) for name in _LIBRARIES},
        }

    def _origin(self) -> dict[str, str]:
        if self.sample_period is None:
            return {'origin': 'node', 'log_time': self.log_time}
        return {'origin': 'offline', 'duration': repr(self.duration), 'sample_period': str(self.sample_period)}


def open_run(folder: Path | str, facts: RunFacts, topics: Sequence[Topic] = (), split: Split = ONE_FILE) -> BagWriter:
    """Make a run folder with the recorded topics by these names (none: those of RECORDED in the namespace /).

    Raises RecordingError if it exists.
    """
    return BagWriter(folder, topics or recorded_topics(), {SCENE_FILE: facts.scene_text.encode()}, facts.as_metadata(),
                     split)


def receipt_file(receipt: Mapping[str, object]) -> dict[str, bytes]:
    """Return the receipt as the attachment that ends a run."""
    return {RECEIPT_FILE: (json.dumps(receipt, indent=2) + '\n').encode()}


def checkpoint_file(checkpoint: Mapping[str, object]) -> dict[str, bytes]:
    """Return the checkpoint of a rig as the attachment of a recording that begins in mid-run."""
    return {CHECKPOINT_FILE: (json.dumps(plain(checkpoint), allow_nan=False) + '\n').encode()}


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return ''
