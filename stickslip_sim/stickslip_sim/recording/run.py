"""What every run folder holds beside its messages: the scene, the versions, the receipt."""

import json
import platform
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING

from .. import __version__
from .bag import BagWriter
from .metadata import ros_distro
from .topics import recorded

if TYPE_CHECKING:
    from ..scene import Scene

SCENE_FILE = 'scene.yaml'
RECEIPT_FILE = 'receipt.json'
_LIBRARIES = ('numpy', 'numba', 'mcap', 'rosbags')


@dataclass(frozen=True)
class RunFacts:
    """What is needed to run a recorded run again; `scene_text` is the whole effective scene."""

    scene: str
    scene_text: str
    scene_hash: str
    solver: str
    seed: int
    rate: float  # 1/s

    @classmethod
    def of(cls, scene: 'Scene') -> 'RunFacts':
        """Return the facts of a scene."""
        return cls(scene.name, scene.text, scene.hash, scene.solver.name, scene.seed, scene.time.rate)

    def as_metadata(self) -> dict[str, str]:
        """Return the facts and the versions of all that takes part in the numbers."""
        return {
            'version': __version__,
            'scene': self.scene,
            'scene_hash': self.scene_hash,
            'solver': self.solver,
            'seed': str(self.seed),
            'rate': repr(self.rate),
            'python': platform.python_version(),
            'platform': platform.platform(),
            'ros_distro': ros_distro(),
            **{name: _version(name) for name in _LIBRARIES},
        }


def open_run(folder: Path | str, facts: RunFacts, namespace: str = '/') -> BagWriter:
    """Make a run folder with the recorded topics of a node in `namespace`; raises RecordingError if it exists."""
    return BagWriter(folder, recorded(namespace), {SCENE_FILE: facts.scene_text.encode()}, facts.as_metadata())


def receipt_file(receipt: Mapping[str, object]) -> dict[str, bytes]:
    """Return the receipt as the attachment that ends a run."""
    return {RECEIPT_FILE: (json.dumps(receipt, indent=2) + '\n').encode()}


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return ''
