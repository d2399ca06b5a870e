# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The command of setuptools that writes the unit in C, and its wrapper, which Cython translates; and compiles both."""

import os
import shutil
import sysconfig
from pathlib import Path

from setuptools import Extension
from setuptools.command.build_ext import build_ext
from setuptools.errors import SetupError

from .javascript import script
from .sources import UnitError
from .unit import ENTRIES, LOOPS, Unit

PACKAGE = 'stickslip_sim'
SWITCH = 'STICKSLIP_COMPILED'
OLDEST_CYTHON = (3, 0, 8)
# No contraction of a product and a sum into one rounding: plain Python gives the same bits.  No error numbers and no
# traps of the C library: nobody asks for them, and they keep calculations in their place.  Much inlining: that is what
# the one unit is for.
FLAGS = ['-O3', '-g0', '-ffp-contract=off', '-fno-math-errno', '-fno-trapping-math', '-finline-limit=2000',
         '--param', 'inline-unit-growth=200', '--param', 'large-function-growth=1000']

# The library of an FMU: small, since each file has a copy; it shows the functions of FMI alone.
_FMU_FLAGS = ['-Os', '-g0', '-ffp-contract=off', '-fno-math-errno', '-fno-trapping-math', '-fvisibility=hidden']
# What the package also runs without.  `text` needs a compiler of C++ that knows std::to_chars of floats; else Python
# writes the numbers.
_OTHERS = {'_text': 'cli/text.pyx', '_standstill': 'ros/standstill.pyx'}


def extensions() -> list[Extension]:
    """Return the extension modules, written when they are built; none on STICKSLIP_COMPILED=0."""
    if os.environ.get(SWITCH) == '0':
        return []
    return [Extension(f'{PACKAGE}._hot', [], extra_compile_args=FLAGS),
            Extension(f'{PACKAGE}._fmu', [], extra_compile_args=_FMU_FLAGS, extra_link_args=['-s'], libraries=['m'],
                      optional=True),
            Extension(f'{PACKAGE}._text', [], extra_compile_args=['-O2', '-g0', '-std=c++17'], language='c++',
                      optional=True),
            Extension(f'{PACKAGE}._standstill', [], extra_compile_args=['-O2', '-g0'], optional=True)]


class BuildUnit(build_ext):  # type: ignore[misc]
    """Builds the unit; its text in Cython and in C stays in the folder for what is in between."""

    def build_extension(self, ext: Extension) -> None:
        """Write the unit and build it; raises SetupError, one line that says what to install or to change."""
        _require_cython()
        _require_compiler(self.compiler.compiler_so[0])
        ext.sources = self._written(ext.name.rpartition('.')[2])
        super().build_extension(ext)

    def _written(self, name: str) -> list[str]:
        """Write an extension in Cython or C, and what it includes; raises SetupError."""
        package = Path(__file__).resolve().parents[1] / PACKAGE
        if name in _OTHERS:
            return [self._write(f'{name}.pyx', (package / _OTHERS[name]).read_text(encoding='utf-8'))]
        try:
            unit = Unit(package)
            if name == '_fmu':
                return [self._write(file, text) for file, text in unit.fmu(package).items()][1:]
            self._write('engine.c', unit.text(ENTRIES | LOOPS))
            return [self._write(f'{name}.pyx', unit.wrapper('engine.c', script(unit)))]
        except UnitError as error:
            raise SetupError(str(error)) from None

    def _write(self, name: str, text: str) -> str:
        """Write a file among what is in between, unless it is there; return its path."""
        path = Path(self.build_temp) / name
        if not path.is_file() or path.read_text(encoding='utf-8') != text:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding='utf-8')
        return str(path)


def _require_cython() -> None:
    wanted = '.'.join(map(str, OLDEST_CYTHON))
    try:
        from Cython import __version__
    except ImportError:
        raise _missing('Cython is missing', f"pip install 'cython>={wanted}', or apt install cython3") from None
    if tuple(int(part) for part in __version__.split('.')[:3] if part.isdigit()) < OLDEST_CYTHON:
        raise _missing(f'Cython {__version__} is older than {wanted}', f"pip install 'cython>={wanted}'")


def _require_compiler(compiler: str) -> None:
    if shutil.which(compiler) is None:
        raise _missing(f'the C compiler {compiler} is missing', 'apt install gcc')
    if not (Path(sysconfig.get_path('include')) / 'Python.h').is_file():
        raise _missing('the Python header Python.h is missing', 'apt install python3-dev')


def _missing(what: str, command: str) -> SetupError:
    return SetupError(f'{what}, which compiles the hot path: {command}; or build without, hundreds of times slower: '
                      f'{SWITCH}=0')
