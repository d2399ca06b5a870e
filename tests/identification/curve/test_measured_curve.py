# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measured friction curves as files: what is read, in which unit, and one line for each thing that is wrong."""

from pathlib import Path

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.identification.curve.measured_curve import FrictionCurve, Units, load_curve, units_of
from stickslip_sim.inputs.units import SPEEDS, in_si, named_unit
from tests.support.repository import ROOT

MILLI = Units('mm/s')


def curve_of(tmp_path: Path, text: str, units: Units = MILLI, direction: str = 'both',
             meant: tuple[str, ...] = ()) -> FrictionCurve:
    path = tmp_path / 'curve.csv'
    path.write_text(text, encoding='utf-8')
    return load_curve(str(path), units, meant).chosen(direction)


def test_the_example_is_read_to_the_last_bit() -> None:
    curve = load_curve(str(ROOT / 'examples' / 'friction_curve.csv'), MILLI)
    assert curve.speeds.tolist() == [0.0, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1]
    assert curve.coefficients.tolist() == [0.16, 0.148, 0.139, 0.124, 0.098, 0.079, 0.07, 0.074, 0.082]
    assert curve.forward.all()


@pytest.mark.parametrize('text', [
    '5,0.1\n10,0.08\n',
    'v;mu\n5,0;0,1\n10,0;0,08\n',
    '# a remark\nspeed\tcoefficient\n\n5\t0.1 # first\n10\t0.08\n',
    '\ufeffspeed,coefficient,note\n10,0.08,later\n5,0.1,earlier\n',
    '5 0.1\n10 0.08\n',
])
def test_separators_headings_and_decimal_commas(tmp_path: Path, text: str) -> None:
    curve = curve_of(tmp_path, text)
    assert curve.speeds.tolist() == [0.005, 0.01]
    assert curve.coefficients.tolist() == [0.1, 0.08]


@pytest.mark.parametrize('backward', ['-5,-0.11\n-10,-0.09\n', '-5,0.11\n-10,0.09\n'])
def test_both_directions_signed_or_not(tmp_path: Path, backward: str) -> None:
    text = '5,0.1\n10,0.08\n' + backward
    both = curve_of(tmp_path, text)
    assert both.speeds.tolist() == [0.005, 0.005, 0.01, 0.01]
    assert both.forward.tolist() == [True, False, True, False]
    assert curve_of(tmp_path, text, direction='backward').coefficients.tolist() == [0.11, 0.09]


def test_forces_are_divided_by_the_normal_force(tmp_path: Path) -> None:
    curve = curve_of(tmp_path, 'v [mm/s],F [kN]\n5,0.1\n10,0.08\n', units_of('mm/s', 'kN', 1000.0))
    assert curve.coefficients.tolist() == [0.1, 0.08]
    assert curve.unread == 0


def test_units_are_exact_and_found_in_headings() -> None:
    assert in_si(0.3, SPEEDS['mm/s']) == 0.0003    # 0.3 * 1e-3 is not
    assert in_si(60.0, SPEEDS['m/min']) == 1.0
    assert [named_unit(text, SPEEDS) for text in ('v / (µm/s)', 'speed_mm_per_s', 'speed [m/min]', 'speed')] \
        == ['um/s', 'mm/s', 'm/min', None]


@pytest.mark.parametrize(('text', 'said'), [
    ('', 'lines of two numbers'),
    ('speed,coefficient\n', 'lines of two numbers'),
    ('5\n10\n', 'line 1 = .5. is refused: must be two columns'),
    ('5,0.1\n10,0.o8\n', 'line 2 = .0.o8. is refused: must be a finite number'),
    ('5,0.1\nten,eight\n', 'line 2 = .ten. is refused: must be a finite number'),
    ('0.l,0.1\n10,0.08\n', 'line 1 = .0.l. is refused'),
    ('5,nan\n', 'line 1 = .nan. is refused'),
    ('5,0.1\n10,1e999\n', 'line 2 = .1e999. is refused'),
    ('5,0.1\n10,-0.08\n', 'line 2 = -0.08 is refused: must be friction of one sign'),
    ('-5,-0.1\n-10,0.08\n', 'line 2 = 0.08 is refused: must be friction of one sign'),
    ('speed [m/s],mu\n5,0.1\n', '--speed-unit = .mm/s. is refused: must be m/s, as the heading says'),
    ('5,0\n10,0\n', 'must be friction above 0'),
    ('5,0.1\n' * 20_001, 'at most 20000'),
])
def test_a_wrong_file_is_refused_with_its_line(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(InputError, match=said) as refused:
        curve_of(tmp_path, text)
    assert str(refused.value).startswith(f'{tmp_path}/curve.csv: ')


def test_a_file_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'friction curve = .absent.csv. is refused'):
        load_curve(str(tmp_path / 'absent.csv'), MILLI)
    (tmp_path / 'picture.csv').write_bytes(b'\x89PNG\r\n\x1a\n\x00')
    with pytest.raises(InputError, match='text in UTF-8'):
        load_curve(str(tmp_path / 'picture.csv'), MILLI)


def test_text_in_another_encoding_is_to_be_saved_as_utf8_and_named_once(tmp_path: Path) -> None:
    latin = tmp_path / 'latin.csv'
    latin.write_bytes('v [µm/s],mu\n500,0.1\n900,0.08\n'.encode('latin-1'))
    with pytest.raises(InputError, match='save it as UTF-8') as caught:
        load_curve(str(latin), MILLI)
    assert str(caught.value).count('latin.csv') == 1


@pytest.mark.parametrize(('speed', 'force', 'normal_force', 'said'), [
    ('mm', None, None, '--speed-unit = .mm. is refused: must be one of m/s, .*did you mean mm/s?'),
    ('mm/s', 'kg', 1.0, '--force-unit = .kg. is refused'),
    ('mm/s', 'N m', None, '--force-unit = .N m. is refused: .*it is of a turn: give --lead'),
    ('mm/s', '%', None, '--force-unit = .%. is refused: .*it is of a rating: give --rated'),
    ('mm/s', 'N', 0.0, '--normal-force = 0.0 is refused'),
    ('mm/s', None, 1200.0, '--normal-force = 1200.0 is refused: must be given with --force-unit'),
])
def test_wrong_units_are_refused(speed: str, force: str | None, normal_force: float | None, said: str) -> None:
    with pytest.raises(InputError, match=said):
        units_of(speed, force, normal_force)


@pytest.mark.parametrize(('text', 'units', 'name', 'read'), [
    ('5,0.1\n100,0.08\n', Units('m/s'), 'speed', 'm/s'),
    ('0.05,0.1\n0.1,0.08\n', MILLI, 'speed', 'mm/s'),
    ('5,120\n100,96\n', MILLI, 'friction', 'a coefficient'),
    ('5,0.12\n100,0.09\n', Units('mm/s', 'N', 1200.0), 'friction', 'N and 1200 N'),
])
def test_a_mistaken_unit_is_asked_back(tmp_path: Path, text: str, units: Units, name: str, read: str) -> None:
    with pytest.raises(InputError,
                       match=f'the highest {name} = .* it was read as {read}: .* add --allow-implausible {name}'):
        curve_of(tmp_path, text, units)
    assert len(curve_of(tmp_path, text, units, meant=(name,)).speeds) == 2


def test_a_direction_without_points_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'--direction = .backward. is refused'):
        curve_of(tmp_path, '5,0.1\n10,0.08\n', direction='backward')
