# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Studies for Python: a scene and ranges in, arrays out, without a folder."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core.arrays import Numbers, data_frame
from ..core.types import Progress
from ..inputs import SceneOrName, scene_of
from .critical import Critical, critical_of, default_range
from .sample import EvenGrid, Saltelli, Sobol
from .study import Study
from .sweep import columns_of
from .table import words
from .uncertainty import Uncertainty, load_uncertain, uncertain_of, uncertainty_of
from .variation import range_of, variation


@dataclass(frozen=True)
class SweptPoints:
    """The points of a sweep: a column for each parameter that varies, and for each figure (docs/maps.md)."""

    columns: dict[str, Numbers]

    @property
    def motions(self) -> list[str]:
        """What each point ends in, in the words of docs/maps.md: at rest, smooth sliding, stick-slip, undecided, ..."""
        return words(self.columns['motion'])

    def frame(self) -> Any:
        """Return the columns as a pandas.DataFrame, the motions in words; raises InputError without pandas."""
        return data_frame({**self.columns, 'motion': self.motions}, 'columns')


def sweep(scene: SceneOrName, *over: str, sobol: int | None = None, duration: float | None = None,
          progress: Progress = None) -> SweptPoints:
    """Run a scene at many values of its parameters; return what becomes of each point.

    `over` are ranges as `stickslip sweep --over` takes them, 'drive.velocity=1e-4:1e-1:100:log': every combination of
    their values, or with `sobol` so many points between their ends (without N then).  A point runs for `duration` s, or
    until its motion settles.  Raises InputError.
    """
    scene = scene_of(scene)
    variations = tuple(variation(text, drawn=sobol is not None) for text in over)
    sample = EvenGrid(variations) if sobol is None else Sobol(variations, sobol, scene.seed)
    return SweptPoints(columns_of(Study(scene.values, sample, duration), progress=progress))


def critical(scene: SceneOrName, name: str, between: tuple[float, float] | None = None, accuracy: float = 1e-9,
             progress: Progress = None) -> Critical:
    """Return the values of a parameter at which stick-slip begins or ends, from rest and from sliding.

    They are sought `between` two values (None: 1/100 to 100 times that of the scene) to a relative `accuracy`.
    Raises InputError.
    """
    scene = scene_of(scene)
    if between is None:
        over = default_range(scene, name)
    else:
        over = range_of('between', name, '{!r}:{!r}'.format(*map(float, between)))
    return critical_of(scene, over, accuracy, progress)


def uncertainty(scene: SceneOrName, known: str | Path | Mapping[str, object], samples: int = 1024, seed: int = 0,
                duration: float | None = None, progress: Progress = None) -> Uncertainty:
    """Return what becomes of a scene whose parameters are known only roughly: percentiles, and which one decides.

    `known` is a file as `stickslip uncertainty --with` takes it, or its section of parameters with a `seed`; `samples`
    is a power of two.  Raises InputError.
    """
    scene = scene_of(scene)
    found = (uncertain_of({'parameters': known, 'seed': seed}) if isinstance(known, Mapping)
             else load_uncertain(known))
    sample = Saltelli(found.distributions, samples, found.seed, found.correlations)
    return uncertainty_of(sample, columns_of(Study(scene.values, sample, duration), progress=progress))
