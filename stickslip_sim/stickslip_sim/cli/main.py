# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The command `stickslip`: its verbs, and the exit code of each error.

Exit codes: 0 done; 1 internal error, or no node answers; 2 wrong use, scene, parameter or file, or a node refuses;
3 the verdict is "failed" or "differs"; 4 the solver gave up; 130 interrupted.  One line on standard error says why;
STICKSLIP_DEBUG=1 shows the traceback.
"""

import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import NoReturn

import click

from ..core.errors import StickslipError, internal_error
from ..core.version import __version__
from . import process
from .completion import LazyGroup, complete_for_shell

_SECTIONS = {   # each verb by what a reader wants, as in the help; its file has its name
    'Run': ('scenes', 'simulate', 'close-loop', 'tune', 'import', 'call'),
    'Look': ('explore', 'plot', 'compare', 'export', 'export-c', 'export-fmu', 'export-hal'),
    'Check': ('check', 'verify'),
    'Study': ('critical', 'sweep', 'map', 'uncertainty'),
    'Identify': ('friction', 'identify', 'predict', 'design'),
    'Measure the engine': ('advise', 'bench', 'extremes'),
}
_INTERRUPTED = 130


@click.group(cls=LazyGroup, sections=_SECTIONS,
             context_settings={'help_option_names': ['-h', '--help'], 'max_content_width': 100},
             epilog='Start with: stickslip simulate paper_fig8 --duration 10 --plot run.png',
             invoke_without_command=True, subcommand_metavar='COMMAND [ARGS]...')
@click.version_option(__version__, message='stickslip %(version)s')
@click.pass_context
def stickslip(context: click.Context) -> None:
    """Simulate the stick-slip motion of a feed axis exactly."""
    if context.invoked_subcommand is None:   # the behaviour of click depends on its version
        click.echo(context.get_help(), err=True)
        context.exit(2)


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the tool and exit with its code."""
    process.listen()
    process.buffer()
    code = complete_for_shell(stickslip)
    if code is not None:
        sys.exit(code)
    sys.exit(run(sys.argv[1:] if arguments is None else arguments))


def run(arguments: Sequence[str]) -> int:
    """Run the tool and return its exit code."""
    code = 0
    try:
        code = _invoked(arguments)
        process.flush()
        return code
    except BrokenPipeError:     # the reader has seen enough
        process.give_up()
        return code
    except OSError as error:
        process.give_up()
        return _refuse(f'standard output cannot be written: {error.strerror}; send it somewhere else', 2)


def _invoked(arguments: Sequence[str]) -> int:
    """Run the tool and return its exit code; raises OSError when standard output fails."""
    try:
        with stickslip.make_context('stickslip', list(arguments)) as context:
            stickslip.invoke(context)
        return 0
    except click.exceptions.Exit as end:
        return end.exit_code
    except click.ClickException as error:
        return _refuse(_usage(error), error.exit_code)
    except StickslipError as error:
        return _refuse(str(error), error.exit_code)
    except KeyboardInterrupt as stop:
        return _refuse(str(stop) or 'interrupted', _INTERRUPTED)
    except Exception as error:
        if process.is_its(error):
            raise
        return _refuse(internal_error(error), 1)


def _refuse(text: str, code: int) -> int:
    with suppress(OSError):
        print(f'stickslip: {" ".join(text.split())}', file=sys.stderr)
    return code


def _usage(error: click.ClickException) -> str:
    context = getattr(error, 'ctx', None)
    command = context.command_path if context else 'stickslip'
    return f'{error.format_message()} See {command} --help'
