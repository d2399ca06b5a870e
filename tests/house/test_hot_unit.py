# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The tool that writes and builds the compiled hot path: what it takes, and what it refuses in one line."""

import os
import shutil
import subprocess
import sys
import zlib
from pathlib import Path

import pytest
import yaml

from stickslip_sim.core import hot_path
from tests.support.repository import ROOT

PROJECT = ROOT / 'stickslip_sim'
sys.path.append(str(PROJECT))    # what is installed comes before it, but has no hot_unit

from hot_unit.javascript import script  # noqa: E402
from hot_unit.sources import UnitError  # noqa: E402
from hot_unit.unit import Unit  # noqa: E402

PACKAGE = PROJECT / 'stickslip_sim'
ROOMS = ('core', 'friction', 'linear', 'axis', 'solvers')
HOST = 'linear/oscillator.py'
NO_CYTHON = 'import sys; sys.modules["Cython"] = None'


def unit_of(package: Path, folder: Path) -> tuple[str, str]:
    """Return the unit of a package and what was said instead."""
    out = folder / 'unit.c'
    done = subprocess.run([sys.executable, '-m', 'hot_unit', package, out], cwd=PROJECT, capture_output=True, text=True,
                          timeout=60, check=False)
    assert (done.returncode == 0) == out.exists()
    return out.read_text(encoding='utf-8') if out.exists() else '', done.stderr


def package_with(function: str, folder: Path) -> Path:
    """Return a copy of the package with one more function of the hot path."""
    for room in ROOMS:
        shutil.copytree(PACKAGE / room, folder / room, ignore=shutil.ignore_patterns('__pycache__'))
    host = folder / HOST
    host.write_text(f'{host.read_text(encoding="utf-8")}\n\n@compiled\n{function}\n', encoding='utf-8')
    return folder


def test_every_marked_function_is_in_the_unit(tmp_path: Path) -> None:
    text, said = unit_of(PACKAGE, tmp_path)
    assert said == ''
    for name in ('static_static_coefficient', 'motion_travel', 'steps_step'):
        assert f' {name}(' in text
    assert '\nstatic Long2 engine_advance(Parameters *p, State *s, ' in text
    if hot_path.UNIT is not None:
        unit = Unit(PACKAGE)
        assert (unit.digest, tuple(unit.names)) == (hot_path.UNIT.DIGEST, hot_path.UNIT.SOURCES)
        assert zlib.decompress(hot_path.UNIT.SCRIPT).decode() == script(unit)


def test_a_function_keeps_its_names(tmp_path: Path) -> None:
    text = Unit(package_with('''
def swapped(osc: Oscillator, both: bool, z: complex) -> tuple[float, int]:
    """Return two.

    And no more.
    """
    first, count = (osc.gamma, 1) if both else (osc[1], 2)
    for k in range(int(first)):
        first, second = max(first, second), first ** 2.0 - (first - float(k)) / 3
        if 0.0 < second <= 1.0 and not (both or count == 1):
            z *= first
    return (first, count) if both else (z.real, int(first))
''', tmp_path)).text({HOST: ['swapped']})
    _, _, rest = text.partition('\n/* Return two. */\n')
    assert rest == '''
static DoubleLong oscillator_swapped(Oscillator osc, bool both, Complex z)
{
    long count;
    double first, second;
    DoubleLong got1 = both ? (DoubleLong){osc.gamma, 1} : (DoubleLong){osc.omega2, 2};
    first = got1.item0;
    count = got1.item1;
    for (long k = 0, k_end = (long)first; k < k_end; k++) {
        Double2 got2 = (Double2){larger(first, second), pow(first, 2.0) - (first - (double)k) / 3};
        first = got2.item0;
        second = got2.item1;
        if ((0.0 < second && second <= 1.0) && !(both || count == 1)) {
            z = product_of(z, complex_of(first, 0.0));
        }
    }
    return both ? (DoubleLong){first, count} : (DoubleLong){z.real, (long)first};
}
'''.removeprefix('\n')


@pytest.mark.parametrize(('function', 'what'),
                         yaml.safe_load(Path(__file__).with_name('unit_refused.yaml').read_text(encoding='utf-8')))
def test_what_c_does_not_have_is_refused_in_one_line(function: str, what: str, tmp_path: Path) -> None:
    package = package_with(function, tmp_path / 'package')
    with pytest.raises(UnitError) as refused:
        Unit(package).text({HOST: ['f']})
    place, _, fault = str(refused.value).partition(': ')
    assert fault == what
    file, _, line = place.rpartition(':')
    assert Path(file) == package / HOST
    assert function in (package / HOST).read_text(encoding='utf-8').split('\n')[int(line) - 1]


class TestBuild:
    @staticmethod
    def build(folder: Path, before: str = '', **environment: str) -> tuple[int, str]:
        """Return the exit code of `setup.py build_ext` and the last line that it wrote."""
        arguments = ['setup.py', '-q', 'build_ext', '--build-temp', str(folder), '--build-lib', str(folder)]
        program = (f'{before}\nimport runpy, sys\nsys.argv = {arguments}\n'
                   'runpy.run_path("setup.py", run_name="__main__")')
        done = subprocess.run([sys.executable, '-c', program], cwd=PROJECT, env={**os.environ, **environment},
                              capture_output=True, text=True, timeout=60, check=False)
        return done.returncode, (done.stderr.strip().split('\n') or [''])[-1]

    @pytest.mark.parametrize(('before', 'compiler', 'message'), [
        (NO_CYTHON, '', "error: Cython is missing, which compiles the hot path: pip install 'cython>=3.0.8', or apt "
         'install cython3; or build without, hundreds of times slower: STICKSLIP_COMPILED=0'),
        ('', 'no-such-compiler', 'error: the C compiler no-such-compiler is missing, which compiles the hot path: '),
    ])
    def test_says_what_is_missing(self, before: str, compiler: str, message: str, tmp_path: Path) -> None:
        pytest.importorskip('Cython')
        code, said = self.build(tmp_path, before, **({'CC': compiler} if compiler else {}))
        assert (code, said[:len(message)]) == (1, message)

    def test_leaves_the_unit_out_on_purpose(self, tmp_path: Path) -> None:
        assert self.build(tmp_path, NO_CYTHON, STICKSLIP_COMPILED='0') == (0, '')
        assert not list(tmp_path.iterdir())
