# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Studies from Python: what the tool finds, without a folder."""

import math

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.study import EvenGrid, Study, variation
from stickslip_sim.study.in_memory import critical, sweep, uncertainty

SCENE = load_scene('paper_fig7')
KNOWN = {'axis.mass': {'distribution': 'uniform', 'low': 300.0, 'high': 400.0}}


def test_a_sweep_has_the_figures_of_its_study() -> None:
    found = sweep(SCENE, 'drive.velocity=1e-3:1e-1:5:log', 'axis.mass=300.0:400.0:2')
    figures = Study(SCENE.values, EvenGrid((variation('drive.velocity=1e-3:1e-1:5:log'),
                                        variation('axis.mass=300.0:400.0:2')))).figures(0, 10)
    assert list(found.columns)[:3] == ['drive.velocity', 'axis.mass', 'motion']
    assert found.columns['period'].tolist() == pytest.approx(figures.period.tolist(), rel=0, nan_ok=True)
    assert found.motions[0] == 'stick-slip'
    assert found.motions[-1] == 'smooth sliding'


def test_points_can_be_drawn() -> None:
    shares: list[float] = []
    found = sweep(SCENE, 'drive.velocity=1e-3:1e-1:log', sobol=8, duration=2.0, progress=shares.append)
    assert len(set(found.columns['drive.velocity'].tolist())) == 8
    assert found.columns['duration'].tolist() == [2.0] * 8
    assert shares[-1] == 1.0


def test_a_sweep_as_a_data_frame() -> None:
    pytest.importorskip('pandas')
    frame = sweep(SCENE, 'drive.velocity=1e-3:1e-1:3:log').frame()
    assert list(frame['motion']) == ['stick-slip', 'stick-slip', 'smooth sliding']


def test_a_critical_value() -> None:
    conventional = load_scene('paper_fig4_falling')
    found = critical(conventional, 'drive.velocity', (1e-3, 1.0), accuracy=1e-3)
    (transition,) = found.from_rest.transitions
    assert 1e-3 < transition.value < 1.0
    with pytest.raises(InputError, match='LOW < HIGH'):
        critical(conventional, 'drive.velocity', (1.0, 1e-3))


def test_uncertainty_of_a_parameter() -> None:
    found = uncertainty(SCENE, KNOWN, samples=16, seed=3)
    assert found == uncertainty(SCENE, KNOWN, samples=16, seed=3)
    assert found.points == 32
    assert found.stick_slip == 1.0
    index = (found.indices['period'] or {})['axis.mass']
    assert math.isfinite(index.first_order)


def test_refused() -> None:
    with pytest.raises(InputError, match='did you mean axis'):
        sweep(SCENE, 'axis.mas=1.0:2.0:3')
    with pytest.raises(InputError, match='given once'):
        sweep(SCENE)
    with pytest.raises(InputError, match='distribution'):
        uncertainty(SCENE, {'axis.mass': 'about 300'})
