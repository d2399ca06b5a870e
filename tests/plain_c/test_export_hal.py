# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip export-hal`: what the component does, in a stand-in for HAL and in a real LinuxCNC where there is one."""

import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from dev import cnc
from stickslip_sim import load_scene
from stickslip_sim.cli.main import run
from stickslip_sim.core import hot_path
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.plain_c.hal_files import HAL_NAMES

pytestmark = [pytest.mark.slow, pytest.mark.skipif(hot_path.UNIT is None, reason='no compiled code')]
# What halcompile puts before the C of a component, with pins that are not shared; then commands of the standard input:
# a pin and a number, or `step` and how many.
STAND_IN = '''
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stdbool.h>
#define RTAPI_MSG_ERR 1
#define rtapi_snprintf snprintf
#define rtapi_print_msg(level, ...) printf(__VA_ARGS__)
struct __comp_state {
    struct __comp_state *_next;
    double *velocity, *force, *friction_scale, *position_fb, *drive_fb, *drive_force;
    bool *enable, *fault;
    int *mode;
    unsigned *events;
    double resolution, scale, v, f, friction, friction_in_force;
    char label[48];
    void *engine;
    double *scaled;
    long long nanoseconds;
    unsigned count;
    bool is_stopped;
};
#include "component.c"

int main(void)
{
    static double velocity, force, friction_scale = 1.0, position, drive, drive_force;
    static bool enable = true, fault;
    static int mode;
    static unsigned events;
    static struct __comp_state one = {NULL, &velocity, &force, &friction_scale, &position, &drive, &drive_force,
                                      &enable, &fault, &mode, &events, .friction = 1.0, .friction_in_force = 1.0,
                                      .scale = 1000.0};
    char word[32];
    double number;
    if (extra_setup(&one, "slide", 0) != 0) {
        return 1;
    }
    while (scanf("%31s %lf", word, &number) == 2) {
        if (strcmp(word, "step") == 0) {
            for (int i = 0; i < (int)number; i++) {
                _(&one, 1000000);
            }
            printf("%a %a %a %a %a %a\\n", position, drive, drive_force, (double)mode, (double)events, (double)fault);
        } else {
            double *pin = word[0] == 'v' ? &velocity : word[0] == 'f' ? &force : word[0] == 'm' ? &friction_scale
                : word[0] == 'r' ? &one.resolution : &one.scale;
            *pin = number;
        }
    }
    return 0;
}
'''
PROGRAM = '''G21 G17 G90 G94 G61
M62 P0
G1 X0.5 F120
G1 X0
G1 Y-0.5
G1 Y0
G2 X0 Y0 I-0.5 J0
G3 X0 Y0 I-0.5 J0
M63 P0
G1 X0.01
M2
'''
WIDE, TIGHT = ({'FERROR': size, 'MIN_FERROR': size} for size in ('5', '0.05'))   # mm
SCENE, GRID = load_scene('paper_fig8', cnc.STILL), Grid(1000.0)


@pytest.fixture(scope='module')
def component(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The component of paper_fig8 in the stand-in, compiled."""
    if shutil.which('cc') is None:
        pytest.skip('no C compiler')
    folder = tmp_path_factory.mktemp('hal') / 'out'
    assert run(['export-hal', 'paper_fig8', '--out', str(folder)]) == 0
    assert sorted(path.name for path in folder.iterdir()) == sorted(HAL_NAMES)
    code = (folder / 'stickslip.comp').read_text().split('\n;;\n')[1]
    (folder / 'component.c').write_text(re.sub('#pragma.*', '', code))   # as quickly compiled as can be
    (folder / 'stand_in.c').write_text(STAND_IN)
    subprocess.run(['cc', '-Wall', '-Wextra', '-Werror', 'stand_in.c', '-lm', '-o', 'program'], cwd=folder, check=True)
    return folder / 'program'


def answers(component: Path, commands: str) -> tuple[list[list[float]], list[str]]:
    """Return the pins after each `step`, and the messages."""
    said = subprocess.run([component], input=commands, capture_output=True, text=True, check=True, timeout=60).stdout
    lines = said.splitlines()
    return ([[float.fromhex(word) for word in line.split()] for line in lines if not line.startswith('slide')],
            [line for line in lines if line.startswith('slide')])


def test_the_pins_have_the_bits_of_the_engine(component: Path) -> None:
    velocities = [2.0, 2.0, -3.5, 0.0, 8.0]
    commands = ''.join(f'velocity {v} step 700 ' for v in velocities)
    rows, said = answers(component, f'{commands} resolution 0.001 step 1')
    simulator, count = SCENE.make_simulator(), 0
    for n, (velocity, row) in enumerate(zip(velocities, rows, strict=False), 1):
        simulator.inputs.command_drive(velocity / 1000.0)
        count += len(simulator.advance(GRID.instant(700 * n)))
        sample = simulator.sample()
        assert row == [sample.position * 1000.0, sample.drive_position * 1000.0, sample.drive_force, sample.mode,
                       count, 0]
    assert count == 10
    assert said == []
    assert rows[-1][0] == 0.001 * round(rows[-1][0] / 0.001)


@pytest.mark.parametrize('given', ['velocity nan', 'velocity -inf', 'force nan', 'mu -1', 'mu nan', 'scale 0',
                                   'scale nan', 'resolution nan', 'resolution -1'])
def test_an_input_that_is_no_number_is_held_and_told_once(component: Path, given: str) -> None:
    good = {'velocity': 5, 'force': 0, 'mu': 1, 'scale': 1000, 'resolution': 0}
    pin = given.split()[0]
    rows, said = answers(component, f'velocity 5 step 500 {given} step 500 {pin} {good[pin]} step 1 {given} step 1')
    smooth, _ = answers(component, 'velocity 5 step 500 step 500 step 1 step 1')
    assert [row[5] for row in rows] == [0, 1, 0, 1]
    assert [row[:5] for row in rows] == [row[:5] for row in smooth]
    assert len(said) == 2


def test_where_the_engine_stops_the_pins_stay_and_the_fault_too(component: Path) -> None:
    rows, said = answers(component, 'velocity 5 step 500 scale 1e-300 velocity 1e8 step 2 scale 1000 velocity 0 step 2')
    assert [row[5] for row in rows] == [0, 1, 1]
    assert rows[1][:5] == rows[2][:5]
    assert ['stopped' in line for line in said] == [True]


def test_the_factor_on_friction_acts_at_once(component: Path) -> None:
    (_, low), _ = answers(component, 'mu 0.5 step 1 velocity 2 step 1000')
    other = load_scene('paper_fig8', {**cnc.STILL, 'friction.scale': 0.5}).make_simulator()
    other.advance(GRID.instant(1))
    other.inputs.command_drive(0.002)
    other.advance(GRID.instant(1001))
    assert low[0] == pytest.approx(1000.0 * other.sample().position, rel=1e-12)
    assert low[4] > 2


@pytest.mark.parametrize(('scene', 'changes', 'named'), [
    ('cutting_force', [], 'force'), ('paper_fig8', ['command.velocity_limit=0.1'], 'command.velocity_limit'),
    ('paper_fig8', ['encoder.noise=1e-7'], 'encoder'),
    ('paper_fig8', ['solver.name=fixed_step', 'solver.step=1e-4'], 'solver'),
    ('paper_fig8', ['normal_load.course=sine', 'normal_load.amplitude=10', 'normal_load.frequency=2'], 'normal_load')])
def test_a_scene_that_it_cannot_do_is_refused(scene: str, changes: list[str], named: str, tmp_path: Path,
                                              capsys: pytest.CaptureFixture[str]) -> None:
    given = [word for change in changes for word in ('--set', change)]
    assert run(['export-hal', scene, '--out', str(tmp_path / 'out'), *given]) == 2
    message = capsys.readouterr().err
    assert re.match(rf'stickslip: {named}[^\n]* is refused[^\n]*\n\Z', message), message
    assert not (tmp_path / 'out').exists()


def test_the_resolution_is_that_of_the_scene(tmp_path: Path) -> None:
    assert run(['export-hal', 'paper_fig8', '--out', str(tmp_path / 'out'), '--set', 'encoder.resolution=1e-6']) == 0
    assert 'resolution = 0.001 ' in (tmp_path / 'out/stickslip.comp').read_text()


@pytest.fixture(scope='module')
def machine() -> Iterator[Path]:
    """A folder for LinuxCNC to run in, with the component installed."""
    reason = cnc.obstacle()
    if reason:
        pytest.skip(reason)
    with cnc.installed(SCENE) as folder:
        yield folder


def test_linuxcnc_has_the_samples_of_the_engine(machine: Path) -> None:
    code, said, rows = cnc.machined(machine, WIDE, PROGRAM)
    assert (code, len(rows) > 4000) == (0, True), said
    assert cnc.differing(SCENE, rows) == 0
    assert {row[6] for row in rows} >= {0.0, 1.0, 3.0}   # modes: it sticks and slips
    assert max(abs(row[first] - row[first + 2]) for row in rows for first in (1, 7)) > 0.5   # mm


def test_a_tight_limit_makes_linuxcnc_fault_on_stick_slip(machine: Path) -> None:
    code, said, rows = cnc.machined(machine, TIGHT, PROGRAM)
    assert code == 1
    assert 'joint 0 following error' in said
    assert max(abs(row[1] - row[3]) for row in rows) > 0.05


def test_hal_takes_any_number_of_them(machine: Path) -> None:
    name = cnc.NAME.replace('_', '-')
    (machine / 'many.hal').write_text('\n'.join([
        'loadrt threads name1=t period1=1000000', f'loadrt {cnc.NAME} count=30',
        *(f'addf {name}.{i} t' for i in range(30)), f'setp {name}.3.velocity nan', 'start',
        'loadusr -w sleep 0.2', f'show pin {name}.3.fault', f'show pin {name}.29.fault']) + '\n')
    ended = cnc.as_user(['halrun', '-f', 'many.hal'], machine)
    assert ended.returncode == 0, ended.stdout
    assert re.search(r'TRUE\s+\S*\.3\.fault', ended.stdout), ended.stdout
    assert re.search(r'FALSE\s+\S*\.29\.fault', ended.stdout), ended.stdout
    assert ended.stdout.count('going on with the last good ones') == 1


def test_make_cnc_names_the_packages_where_linuxcnc_is_not_installed(monkeypatch: pytest.MonkeyPatch,
                                                                     capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(shutil, 'which', lambda _: None)
    cnc.main()
    assert capsys.readouterr().out == f'skipped: LinuxCNC is not installed: apt install {cnc.PACKAGES}\n'
