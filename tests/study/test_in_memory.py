# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Studies from Python: what the tool finds, without a folder."""

import math

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import simulate_events
from stickslip_sim.scene import changed
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


@pytest.mark.parametrize('solver', ['exact', 'adaptive'])
@pytest.mark.parametrize('duration', [20.0, None])
def test_sliding_that_swings_on_is_called_so_as_by_a_run(duration: float | None, solver: str) -> None:
    """By 19 mm/s about the feed of 30 mm/s, for ever, though steady sliding is stable."""
    scene = load_scene('paper_fig8', {'axis.normal_force': 1500.0, 'solver.name': solver})
    found = sweep(scene, 'drive.velocity=0.03:0.0301:2', duration=duration or (None if solver == 'exact' else 10.0))
    assert found.motions == ['sliding that swings on'] * 2
    assert found.columns['settled'].tolist() == [0.0, 0.0]
    assert simulate_events(changed(scene, {'drive.velocity': 0.03}), 20.0).summary.motion == found.motions[0]


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
    with pytest.raises(InputError, match="parameters = 'list' is refused: must be the path of a file, or names with"):
        uncertainty(SCENE, ['axis.mass'])    # type: ignore[arg-type]
