# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers that no feed axis has are asked back by the tool, once, with the unit in which they were read."""

from pathlib import Path

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import scene_names
from stickslip_sim.scene.plausible import PLAUSIBLE, check_plausible
from stickslip_sim.scene.schema import BY_NAME
from tests.support.tool import Capture, answered, refused

FAST = ('--set', 'drive.velocity=5')


@pytest.mark.parametrize('name', scene_names())
def test_the_shipped_scenes_are_plausible(name: str) -> None:
    check_plausible(load_scene(name).values, ())


def test_only_numbers_of_a_scene_are_asked_about_in_their_unit() -> None:
    assert {name: BY_NAME[name].unit for name in PLAUSIBLE} == {name: limit.unit for name, limit in PLAUSIBLE.items()}


@pytest.mark.parametrize(('changes', 'name', 'read'), [
    ({'drive.velocity': -5.0}, 'drive.velocity', '-5 m/s'),
    ({'friction.kinetic.velocities': (0.0, 100.0)}, 'friction.kinetic.velocities', '100 m/s'),
    ({'friction.kinetic.coefficients': (192.0, 84.0)}, 'friction.kinetic.coefficients', '192'),
])
def test_a_question_names_value_unit_and_answer(changes: dict[str, object], name: str, read: str) -> None:
    with pytest.raises(InputError, match=rf'{name} = .* it was read as {read}, .* if {read} is meant, '
                                         rf'add --meant {name}$'):
        check_plausible(changes, ())
    check_plausible(changes, (name,))


def test_a_name_that_is_never_asked_about_is_refused() -> None:
    with pytest.raises(InputError, match=r'--meant = .drive.velocit. is refused: .* did you mean drive.velocity\?'):
        check_plausible({}, ('drive.velocit',))


@pytest.mark.parametrize('verb', [
    ('simulate', 'paper_fig8', '--duration', '0.1', *FAST),
    ('plot', 'paper_fig8', '--duration', '0.1', *FAST),
    ('critical', 'paper_fig8', '--of', 'axis.drive_damping', *FAST),
    ('critical', 'paper_fig8', '--of', 'drive.velocity', '--between', '1:100'),
    ('advise', 'paper_fig8', '--tolerance', '1e-3', *FAST),
    ('compare', 'paper_fig8', '--out', 'figures', *FAST),
    ('sweep', 'paper_fig8', '--over', 'drive.velocity=1:100:3', '--out', 'study'),
    ('sweep', 'paper_fig8', '--over', 'friction.kinetic.velocities[1]=1:100:3', '--out', 'study'),
])
def test_every_verb_asks(verb: tuple[str, ...], tmp_path: Path, capsys: Capture,
                         monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert 'is meant, add --meant ' in refused(capsys, *verb)
    assert list(tmp_path.iterdir()) == []


def test_a_file_is_named_and_what_is_meant_runs(tmp_path: Path, capsys: Capture) -> None:
    scene = tmp_path / 'fast.yaml'
    scene.write_text('/**: {ros__parameters: {scene: fast, drive: {velocity: 5.0}}}\n')
    assert f'{scene}: drive.velocity = 5.0 is refused' in refused(capsys, 'simulate', scene, '--duration', '0.1')
    assert answered(capsys, 'simulate', scene, '--duration', '0.1', '--meant', 'drive.velocity')[0] == 0


def test_what_if_asks_about_what_it_changes(fig8_bag: Path, capsys: Capture) -> None:
    assert 'add --meant drive.velocity' in refused(capsys, 'verify', fig8_bag, *FAST)
