# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip export-c`: the files compile without a warning, and a program in C has the bits of the engine."""

import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from stickslip_sim import load_scene
from stickslip_sim.cli.main import run
from stickslip_sim.core import hot_path
from stickslip_sim.plain_c.c_files import NAMES
from stickslip_sim.proof.axes import instant
from stickslip_sim.simulation.simulator import Simulator

pytestmark = [pytest.mark.slow, pytest.mark.skipif(hot_path.UNIT is None or shutil.which('cc') is None,
                                                   reason='no compiled code, or no C compiler')]
WARNINGS = '-std=c11', '-Wall', '-Wextra', '-Werror'
DURATION = 3.25
SINES = {'drive.amplitudes': [5.0e-3, 2.0e-3], 'drive.frequencies': [3.0, 17.0]}
LOAD = {'normal_load.course': 'sine', 'normal_load.constant': 500.0, 'normal_load.amplitude': 400.0,
        'normal_load.frequency': 7.0}
STEPS = {'force.course': 'steps', 'force.times': [0.0, 0.4, 1.0], 'force.forces': [0.0, 300.0, -50.0],
         'force.period': 1.5}
DRIVER = '''
#include <stdio.h>
#include <string.h>
#include "stickslip_axis.h"

int main(void)
{
    double numbers[AXIS_PARAMETERS + 6] = {0};
    int code;
    printf("%d", axis_new(numbers, AXIS_PARAMETERS + 5, 0, 8, false, &code) == NULL && code == AXIS_BAD_PARAMETERS);
    numbers[AXIS_MASS] = 1.0; numbers[AXIS_STIFFNESS] = 100.0; numbers[AXIS_NORMAL_FORCE] = 10.0;
    numbers[AXIS_STATIC_INITIAL] = numbers[AXIS_STATIC_LIMIT] = 0.2; numbers[AXIS_SEGMENT_COUNT] = 1.0;
    numbers[AXIS_FEED_SHARE] = numbers[AXIS_STATIC_TAU] = numbers[AXIS_STATIC_EXPONENT] = 1.0;
    numbers[AXIS_PARAMETERS + 1] = 1.0 / 0.0; numbers[AXIS_PARAMETERS + 2] = 0.1;
    axis *a = axis_new(numbers, AXIS_PARAMETERS + 6, 0, 1, false, &code);
    axis *b = axis_new(numbers, AXIS_PARAMETERS + 6, 0, 1, false, &code);
    axis_inputs inputs = {.drive = {.value = 0.1}};
    const axis_start_state at_rest = {.rest_time = 1.0};
    printf("%d", axis_start(a, &at_rest, &inputs) == AXIS_OK && axis_start(b, &at_rest, &inputs) == AXIS_OK);
    printf("%d", axis_advance(a, 0.0, 1.5) == AXIS_BAD_TIME && axis_advance(a, -1.0, 0.0) == AXIS_BAD_TIME);
    printf("%d", axis_advance(a, 3.0, 0.0) == AXIS_FULL && axis_event_count(a) == 1);
    double state[2000];
    size_t size = axis_state_size(a);
    axis_get_state(a, state);
    printf("%d", axis_set_state(b, state, size - 1) == AXIS_BAD_STATE && axis_set_state(b, state, size) == AXIS_OK);
    axis_sample_row one, other;
    while (axis_advance(a, 3.0, 0.0) == AXIS_FULL) { }
    while (axis_advance(b, 3.0, 0.0) == AXIS_FULL) { }
    axis_sample(a, &one);
    axis_sample(b, &other);
    printf("%d", memcmp(&one, &other, sizeof one) == 0 && one.second == 3.0 && one.velocity != 0.0);
    inputs.force = (axis_profile){.value = 1e300 * 1e300};
    printf("%d", axis_set_inputs(a, &inputs) == AXIS_BAD_INPUTS && axis_time(a) == 3.0);
    printf(" %s", axis_text(AXIS_BAD_INPUTS));
    axis_free(a);
    axis_free(b);
    return 0;
}
'''


def exported(folder: Path, scene: str, changes: dict[str, Any]) -> Path:
    """Return the folder of an export."""
    given = [word for name, value in changes.items() for word in ('--set', f'{name}={value}')]
    assert run(['export-c', str(folder), '--scene', scene, '--duration', str(DURATION), *given]) == 0
    return folder


def printed(folder: Path, *sources: str, compiler: Sequence[str] = ('cc',), runner: Sequence[str] = ()) -> str:
    """Return what a program prints, compiled without a warning."""
    subprocess.run([*compiler, *WARNINGS, *sources, 'stickslip_axis.c', '-lm', '-o', 'program'], cwd=folder, check=True)
    return subprocess.run([*runner, folder / 'program'], capture_output=True, text=True, check=True, timeout=60).stdout


@pytest.mark.parametrize(('scene', 'changes'), [
    ('stribeck', {}), ('paper_fig8', LOAD | STEPS), ('paper_fig7', SINES | {'friction.static.scatter': 0.1})],
    ids=['constant', 'a load and steps', 'sines and scatter'])
def test_the_example_has_the_bits_of_the_engine(scene: str, changes: dict[str, Any], tmp_path: Path) -> None:
    lines = printed(exported(tmp_path / 'c', scene, changes), 'example.c').splitlines()
    loaded = load_scene(scene, changes)
    simulator = Simulator(loaded.axis, loaded.initial, loaded.drive, loaded.force, accounting=True,
                          load=loaded.normal_load)
    events = simulator.advance(instant(DURATION))
    assert [tuple(map(float.fromhex, line.split()[1:])) for line in lines[:-1]] == [
        tuple(map(float, event[:7])) for event in events]
    assert len(events) > 3
    sample, energy = simulator.sample(), simulator.energy
    assert energy is not None
    assert tuple(map(float.fromhex, lines[-1].split()[1:])) == (sample.position, sample.velocity, sample.drive_force,
                                                                energy.stored)


@pytest.mark.parametrize(('compiler', 'runner'), [
    (('clang', '-O1', '-march=native'), ()),
    (('aarch64-linux-gnu-gcc', '-O1', '-ffp-contract=off'), ('qemu-aarch64', '-L', '/usr/aarch64-linux-gnu'))],
    ids=['clang with fused products', 'aarch64'])
def test_other_compilers_and_processors_have_the_same_bits(compiler: Sequence[str], runner: Sequence[str],
                                                           tmp_path: Path) -> None:
    missing = [name for name in (compiler[0], *runner[:1]) if shutil.which(name) is None]
    if missing:
        pytest.skip(f'not installed: {", ".join(missing)}')
    folder = exported(tmp_path / 'c', 'paper_fig7', SINES)
    assert printed(folder, 'example.c', compiler=compiler, runner=runner) == printed(folder, 'example.c')


def test_what_is_wrong_has_a_code_and_a_state_goes_on_in_another_axis(tmp_path: Path) -> None:
    folder = exported(tmp_path / 'c', 'paper_fig8', {})
    (folder / 'driver.c').write_text(DRIVER, encoding='utf-8')
    assert printed(folder, 'driver.c').startswith('1111111 the inputs are none: ')


def test_nothing_is_overwritten_and_a_duration_is_checked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    exported(tmp_path, 'paper_fig8', {})
    capsys.readouterr()
    assert run(['export-c', str(tmp_path)]) == 2
    assert f'a folder without {NAMES[0]}' in capsys.readouterr().err
    assert run(['export-c', str(tmp_path / 'other'), '--duration', '-1']) == 2
    assert not (tmp_path / 'other').exists()

