# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Every public function that takes a scene takes its name or path, too, and finds there what `load_scene` finds."""

import inspect
import typing
from collections.abc import Callable
from pathlib import Path

import pytest

import stickslip_sim as stickslip
from stickslip_sim.scene import Scene

SceneOrPath = Scene | str | Path
SCENE = """\
# An axis with a profile from a file
/**:
  ros__parameters:
    scene: from_file
    friction: {static: {initial: 0.2}, kinetic: {velocities: [0.0, 0.1], coefficients: [0.2, 0.1]}}
    drive: {velocity: 0.01}
    %s: {course: steps, file: profile.csv}
"""
PROFILES = {'drive': 'time,velocity\n0,0.02\n', 'force': 'time,force\n0,10\n', 'normal_load': 'time,force\n0,50\n'}


def run_of(run: stickslip.Run) -> object:
    return run.scene.text, run.events


def refusal_of_identify(scene: SceneOrPath) -> None:
    """The parameters that are sought are looked for in the scene, before the run is read."""
    stickslip.identify('no run', scene, {'axis.mas': {'distribution': 'uniform', 'low': 1.0, 'high': 2.0}})


CALLS: dict[str, Callable[[SceneOrPath], object]] = {
    'critical': lambda scene: stickslip.critical(scene, 'axis.mass', (50.0, 200.0), 0.5),
    'identify': refusal_of_identify,
    'sensitivities': lambda scene: repr(stickslip.sensitivities(scene, ['event.1.time'], ['axis.drive_stiffness'])),
    'simulate': lambda scene: run_of(stickslip.simulate(scene, 0.5, 0.1)),
    'simulate_events': lambda scene: run_of(stickslip.simulate_events(scene, 0.5)),
    'sweep': lambda scene: repr(stickslip.sweep(scene, 'axis.mass=50:200:2', duration=0.5).columns),
    'uncertainty': lambda scene: stickslip.uncertainty(
        scene, {'axis.mass': {'distribution': 'uniform', 'low': 50.0, 'high': 200.0}}, 16, duration=0.5),
}


def takes_a_scene(name: str) -> bool:
    function = getattr(stickslip, name)
    return inspect.isfunction(function) and any(
        Scene in (hint, *typing.get_args(hint)) for argument, hint in typing.get_type_hints(function).items()
        if argument != 'return')


def outcome(call: Callable[[SceneOrPath], object], scene: SceneOrPath) -> object:
    """Return what a call finds, or the words of its refusal."""
    try:
        return call(scene)
    except stickslip.InputError as error:
        return str(error)


def test_no_public_function_is_forgotten() -> None:
    assert set(CALLS) == {name for name in stickslip.__all__ if takes_a_scene(name)}


@pytest.mark.parametrize('section', PROFILES)
@pytest.mark.parametrize('name', CALLS)
def test_a_path_is_the_scene_that_it_loads(name: str, section: str, tmp_path: Path) -> None:
    """Where a profile is in a file beside the scene, too, and where the scene is then refused."""
    (tmp_path / 'profile.csv').write_text(PROFILES[section])
    path = tmp_path / 'scene.yaml'
    body = SCENE % section
    path.write_text(body.replace('    drive: {velocity: 0.01}\n', '') if section == 'drive' else body)
    expected = outcome(CALLS[name], stickslip.load_scene(path))
    assert outcome(CALLS[name], path) == outcome(CALLS[name], str(path)) == expected


def test_a_name_is_the_scene_that_it_loads() -> None:
    expected = stickslip.simulate_events(stickslip.load_scene('paper_fig7'), 2.0)
    assert run_of(stickslip.simulate_events('paper_fig7', 2.0)) == run_of(expected)
    with pytest.raises(stickslip.InputError, match='did you mean paper_fig'):
        stickslip.simulate_events('paper_fig9', 2.0)
