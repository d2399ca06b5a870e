# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many variants of one scene: sweeps, maps, critical values, uncertainty.  Derivatives are in `sensitivity`.

    study = Study(load_scene('paper_fig7').values, Grid((variation('drive.velocity=1e-4:1e-1:100:log'),)))
    figures = study.figures(0, study.count)

A study is plain data and can be sent to other processes; `figures` of a stretch of its points depends on nothing else.
"""

from ..figures.point_figures import MOTIONS, Figures, Motion
from .sample import Distribution, EvenGrid, Saltelli, Sobol
from .study import Study
from .variation import Variation, variation

__all__ = ['MOTIONS', 'Distribution', 'EvenGrid', 'Figures', 'Motion', 'Saltelli', 'Sobol', 'Study', 'Variation',
           'variation']
