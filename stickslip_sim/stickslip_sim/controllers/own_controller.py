# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers of the user: what one is asked, what it may answer, and how it is loaded from a file."""

import ast
import difflib
import importlib.util
import inspect
import math
import sys
import traceback
from collections.abc import Callable, Mapping
from numbers import Real
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

from ..core.errors import ControllerError, InputError, paths_beside, suggestion
from .moves import Setpoint


class Command(NamedTuple):
    """What a controller orders: `velocity` of the drive, m/s, and `force` on the slider, N.

    None leaves what is in force.
    """

    velocity: float | None = None
    force: float | None = None


class Measurement(NamedTuple):
    """What a controller knows, m, m/s and N; of a measurement that `is_lost`, what was measured last.

    `drive_force` is that of the spring and the damper.  Without a setpoint that is None.
    """

    slider_position: float
    slider_velocity: float
    drive_position: float
    drive_velocity: float
    drive_force: float
    is_lost: bool
    setpoint: Setpoint | None


class OwnController:
    """A controller of the user with its name; `limits` bound what it may answer, m/s and N.

    `ask` is the controller itself.  Raises InputError on what is no controller, ControllerError as it goes wrong.
    """

    def __init__(self, controller: object, limits: tuple[float, float]) -> None:
        if isinstance(controller, type) or not callable(controller):
            kind = f'the class {controller.__name__}' if isinstance(controller, type) else type(controller).__name__
            raise InputError('controller', kind, 'callable as controller(t, measured)',
                             'give an instance: MyController()')
        self.name = str(getattr(controller, '__name__', type(controller).__name__))
        self.ask: Callable[[float, Measurement], Any] = controller
        self._limits = limits
        self._reset = getattr(controller, 'reset', None)

    def reset(self) -> None:
        """Let it begin anew, if it can."""
        if self._reset is not None:
            try:
                self._reset()
            except Exception as error:
                raise ControllerError(f'{self.name}.reset() raised {raised(error)}; correct the controller') from None

    def answer(self, measured: Measurement, step: int, time: float) -> Command:
        """Ask it after a step; return its command.  Raises ControllerError."""
        try:
            answer = self.ask(time, measured)
        except Exception as error:
            self.failed(error, step, time)
        return self.command(answer, step, time)

    def command(self, answer: object, step: int, time: float) -> Command:
        """Return the command that an answer is; raises ControllerError."""
        is_command = isinstance(answer, Command)
        given: tuple[Any, ...] = answer if isinstance(answer, Command) else (answer, None)
        for field, value, limit, unit in zip(Command._fields, given, self._limits, ('m/s', 'N')):
            if value is None and (is_command or field == 'force'):
                continue
            is_number = isinstance(value, Real) and not isinstance(value, bool)
            if not is_number or not -limit <= float(value) <= limit:
                self._refuse(field, value, f'a number within ±{limit:g} {unit} (command.max_{field})', step, time)
        return Command(*(None if value is None else float(value) for value in given))

    def failed(self, error: Exception, step: int, time: float, lacks_setpoint: bool = False) -> NoReturn:
        """Raise the ControllerError about an error that it raised."""
        fix = 'correct the controller'
        if lacks_setpoint and 'NoneType' in str(error):
            fix = 'without setpoint= or --setpoint measured.setpoint is None: give it'
        raise ControllerError(f'{self.name} raised {raised(error)}, asked after step {step} (t = {time:g} s); {fix}'
                              ) from None

    def _refuse(self, field: str, value: Any, allowed: str, step: int, time: float) -> NoReturn:
        is_number = isinstance(value, Real) and not isinstance(value, bool)
        fix = ('limit it in the controller' if is_number and math.isfinite(value)
               else 'return the velocity of the drive, or a Command(velocity, force)')
        refused = InputError(f'{field} of {self.name} after step {step} (t = {time:g} s)', value, allowed, fix)
        raise ControllerError(str(refused))


def raised(error: BaseException) -> str:
    """Return the last line of a traceback, and where in a file of the user it was raised."""
    last = traceback.format_exception_only(error)[-1].strip()
    if isinstance(error, SyntaxError):
        return f'{last} ({Path(error.filename or "").name}, line {error.lineno})'
    places = [place for place in traceback.extract_tb(error.__traceback__)
              if not place.filename.startswith((_PACKAGE, '<frozen'))]
    return f'{last} ({Path(places[-1].filename).name}, line {places[-1].lineno})' if places else last


_PACKAGE = str(Path(__file__).parents[1])


# A controller by FILE.py:NAME.

_FORM = 'FILE.py:NAME'


def load_controller(place: str, arguments: Mapping[str, object] | None = None) -> Any:
    """Return what NAME is in FILE.py: of a class an instance made with keyword `arguments`; else the thing itself.

    Raises InputError, also where the file cannot be imported.
    """
    found, given = named_controller(place), dict(arguments or {})
    if not isinstance(found, type):
        if given:
            raise InputError(next(iter(given)), next(iter(given.values())),
                             f'omitted: {place.rpartition(":")[2]} is not a class', 'only a class takes arguments')
        return found
    return made_controller(found, given)


def named_controller(place: str) -> Any:
    """Return what NAME is in FILE.py, as it stands there; raises InputError, also where it cannot be imported."""
    file, colon, name = place.rpartition(':')
    if not colon or not name or not file:
        raise InputError('controller', place, _FORM, 'add a colon and the name of the class or function')
    return _named(place, _imported(place, Path(file)), name)


def made_controller(found: Callable[..., Any], given: Mapping[str, object]) -> Any:
    """Return what a class, or a function that makes controllers, makes of arguments; raises InputError."""
    name = getattr(found, '__name__', type(found).__name__)
    made = f'{name}({", ".join(f"{key}={value!r}" for key, value in given.items())})'
    try:
        bound = inspect.signature(found).bind(**given)
    except TypeError as error:
        raise InputError('controller', made, f'{name}{inspect.signature(found)}', str(error)) from None
    for key, one in bound.signature.parameters.items():
        if isinstance(given.get(key), str) and not (isinstance(one.default, str) or 'str' in str(one.annotation)):
            raise InputError(f'gain {key}', given[key], f'a number: {name} has no text there ({one})',
                             f'correct it, or annotate the argument as {key}: str')
    try:
        return found(**given)
    except Exception as error:
        raise InputError('controller', made, 'a class that can be instantiated', raised(error)) from None


def parse_gain(text: str) -> tuple[str, object]:
    """Return name and value of `kp=4.0`: a number, a word, or any literal of Python; raises InputError."""
    name, equals, word = (part.strip() for part in text.partition('='))
    if not equals or not name.isidentifier() or not word:
        raise InputError('--gain', text, 'NAME=VALUE, an argument of the class', 'for example kp=4.0')
    try:
        return name, ast.literal_eval(word)
    except (SyntaxError, ValueError):
        return name, word


def _imported(place: str, file: Path) -> Any:
    if not file.is_file():
        fix = suggestion(str(file), paths_beside(file, ['.py']), 'check the path')
        raise InputError('controller', place, f'{_FORM}, an existing file', fix)
    spec = importlib.util.spec_from_file_location(file.stem, file.resolve())
    if spec is None:
        raise InputError('controller', place, _FORM, 'name a file that ends in .py')
    module = importlib.util.module_from_spec(spec)
    sys.modules.setdefault(file.stem, module)      # dataclasses look there; a module of the installation stays
    if (folder := str(file.resolve().parent)) not in sys.path:
        sys.path.insert(0, folder)                 # as for a script: modules beside it
    try:
        exec(compile(file.read_bytes(), file.resolve(), 'exec'), vars(module))    # no import, which Ctrl-C waits for
    except (Exception, SystemExit) as error:
        raise InputError('controller', place, 'a file that can be imported', raised(error)) from None
    return module


def _named(place: str, module: Any, name: str) -> Any:
    found = getattr(module, name, None)
    if callable(found):
        return found
    own = [key for key, value in vars(module).items() if callable(value)
           and getattr(value, '__module__', module.__name__) == module.__name__]
    close = difflib.get_close_matches(name, own, 1)
    raise InputError('controller', place, f'a class, function or callable object of {module.__name__}.py',
                     f'did you mean {close[0]}?' if close else f'there are: {", ".join(own) or "none"}')
