# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From a measured run to the scene that reproduces it, with how well each of its numbers is known."""

import os
import time
from collections.abc import Mapping
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from ..core.errors import InputError
from ..inputs import SceneOrName, scene_of
from ..recording import read_run
from ..runs import Run
from .findings import identification_of
from .fit.direct_motion import with_delay
from .fit.fit_problem import FitProblem
from .given.free_parameters import free_parameters
from .given.input_checks import check_data, check_parameters
from .given.motions import motions_of, track_of
from .given.quiet_rests import with_quiet_rests
from .given.readings import drives_directly, readings_of
from .given.run_start import from_measured_start
from .identified import Identification
from .search.law_comparison import with_laws
from .search.many_fits import Keeper, fits_from
from .search.slip_fit import best_of_slips
from .search.stages import StageProgress, best_fit
from .search.starts import starts_of
from .search.whole_position import along_the_run
from .trial.axis_model import AxisModel


def identify(run: Run | str | os.PathLike[str], start: SceneOrName, free: str | Path | Mapping[str, object], *,
             resolutions: Mapping[str, float] | None = None, seed: int = 0, workers: int = 1,
             laws: bool = False, progress: StageProgress | None = None, keeper: Keeper | None = None) -> Identification:
    """Return the scene that reproduces a measured or recorded run, found from the scene `start`.

    `free` is a file as `uncertainty --with` takes it, or its section of parameters, and names beside parameters of the
    scene `sensor.CHANNEL.offset` and `sensor.CHANNEL.scale`.  `resolutions` are standard deviations of the noise by
    channel, in its unit, where they are known.  `progress` is called with a stage and the share of it that is done.
    With `laws` the run is fitted with other laws of friction, too, and a criterion says which is best.  Fits from
    several starts are shared out to `workers` processes, and kept by a `keeper`, if there is one.
    What is not known of the start of the run is taken from it, and noted.  Raises InputError and RecordingError.
    """
    began = time.perf_counter()
    say = progress or (lambda stage, share: None)
    scene = scene_of(start)
    parameters = free_parameters(scene, free)
    measurement = readings_of(_run_of(run), scene, resolutions or {})
    motions = motions_of(track_of(measurement, measurement.drive or scene.drive))
    check_parameters(parameters, measurement)
    check_data(parameters, measurement, motions, scene)
    scene, parameters, notes = from_measured_start(scene, parameters, measurement, motions)
    measurement = replace(measurement, notes=(*measurement.notes, *notes))
    if drives_directly(scene):
        parameters, measurement = with_delay(parameters, measurement, scene.axis.mass)
        measurement = with_quiet_rests(measurement, motions)
    model = AxisModel(scene, parameters, measurement)
    problem = FitProblem(model, parameters, measurement, motions)
    with closing(fits_from(problem, starts_of(problem, seed), workers, keeper)) as fits:
        ends = best_fit(fits, say)
    model.take_tolerance(ends[0].tolerance)
    identified = identification_of(problem, scene, best_of_slips(problem, along_the_run(problem, ends)), began)
    return with_laws(identified, problem, workers, keeper, say) if laws else identified


def _run_of(given: Run | str | os.PathLike[str]) -> Run:
    """Return a run, or the one in a folder; raises InputError on what is neither."""
    if isinstance(given, str | os.PathLike):
        return read_run(os.fspath(given))
    if not hasattr(given, 'samples'):
        raise InputError('run', type(given).__name__, 'a run, or the path of its folder',
                         'make one of columns first: stickslip import')
    return given
