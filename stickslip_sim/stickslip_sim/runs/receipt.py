# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The receipt of an offline run: what ran, with which versions, what came out, what it cost.  JSON values only."""

import time
from typing import Any

from ..core.types import EnergyBalance, Sample
from ..figures.cycles import Summary
from ..figures.wording import miss_note, touch_note
from ..report.values import plain, versions
from ..scene import Scene


class CostMeter:
    """What a run costs, from `begin` on; it begins at once."""

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Begin to count anew."""
        self._cpu, self._wall = time.process_time(), time.perf_counter()

    def so_far(self) -> tuple[float, float]:
        """Return the CPU and the wall time, s."""
        return time.process_time() - self._cpu, time.perf_counter() - self._wall


def receipt_of(scene: Scene, duration: float, sample_period: float | None, figures: Summary, root_iterations: int,
               final: Sample, energy: EnergyBalance | None, cpu_time: float, wall_time: float) -> dict[str, Any]:
    """Return the receipt of a run of `duration` s that took `cpu_time` and `wall_time` s.

    `results` and `energy` (J; None when the solver keeps no account) are the same on every machine; `versions` and
    `cost` are not.  An infinite number is the text 'inf'.
    """
    note = '; '.join(filter(None, (touch_note(figures), miss_note(scene))))
    receipt = {
        'scene': scene.name,
        'scene_hash': scene.hash,
        'solver': scene.solver.name,
        'solver_settings': scene.solver.settings,
        'duration': duration,
        'sample_period': sample_period,
        **profiles_from_files(scene),
        'versions': versions(),
        'results': {**figures._asdict(), **({'note': note} if note else {}), 'root_iterations': root_iterations,
                    'final_state': final},
        'energy': energy and {**energy._asdict(), 'residual': energy.residual,
                              'relative_residual': energy.relative_residual},
        'cost': {'cpu_time_s': cpu_time, 'cpu_time_per_simulated_second': cpu_time / duration,
                 'wall_time_s': wall_time},
    }
    result: dict[str, Any] = plain(receipt)
    return result


def profiles_from_files(scene: Scene) -> dict[str, Any]:
    """Return the profiles that were in files: their points, and where these came from; nothing without any."""
    names = ('course', 'times', 'velocities', 'positions', 'slopes', 'forces', 'period')
    profiles = {section: {**source._asdict(), **{name: scene.values[f'{section}.{name}'] for name in names
                                                 if f'{section}.{name}' in scene.values}}
                for section, source in scene.sources.items()}
    return {'profiles': profiles} if profiles else {}
