# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip call`: the services of a running node, for those who have no `ros2`."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial, wraps
from typing import Any

import click

from ..ros.environment import answer_of_node
from .files import show

Ask = Callable[..., Any]   # a service and its request of a node: as `answer_of_node`
Asked = Callable[..., Iterable[str]]   # with that, what is said of the answers
_NODE = 'feed_axis'


@click.group(short_help='Call a service of a running node.', invoke_without_command=True)
@click.pass_context
def call(context: click.Context) -> None:
    """Call a service of a running node, and print its answer.

    Exit codes: 0 success; 1 no answer; 2 wrong usage, or the node refuses.  Set ROS_DOMAIN_ID to that of the node.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help(), err=True)
        context.exit(2)


def _calls(name: str, node: str = _NODE, **texts: str | None) -> Callable[[Asked], None]:
    """Return what adds a call with the options of all calls, which finds the `node` where no other is given."""
    def added(asked: Asked) -> None:
        @wraps(asked)
        def called(node: str, timeout: float, **given: Any) -> None:
            for line in asked(partial(answer_of_node, node=node, patience=timeout), **given):
                show([line])
        call.command(name, **texts)(called).params += [
            click.Option(['--node'], default=node, show_default=True, metavar='NAME',
                         help=f'Name of the node, with its namespace, such as /cell/{node}.'),
            click.Option(['--timeout'], type=click.FloatRange(0.1, 3600.0), default=10.0, show_default=True,
                         metavar='SECONDS', help='Time to wait for the node and for its answer.')]
    return added


def _asks(name: str, service: str, request: Mapping[str, object], text: str, short: str | None = None,
          node: str = _NODE) -> None:
    """Add a call that asks for one thing."""
    _calls(name, node, help=text, short_help=short)(lambda ask: [ask(service, request).message])


@_calls('record')
@click.argument('switch', type=click.Choice(['on', 'off']), default='on', metavar='[on|off]')
def _record(ask: Ask, switch: str) -> Iterator[str]:
    """Start (on, the default) or stop (off) a recording."""
    yield ask('record', {'data': switch == 'on'}).message


_asks('reset', 'reset', {}, 'Start a new run: reset time, counters, faults and commands.')
_asks('pause', 'set_paused', {'data': True}, 'Pause simulation time.')
_asks('resume', 'set_paused', {'data': False}, 'Resume simulation time.')
_asks('restart', 'restart', {}, 'Restart the moves of an example controller.', 'Restart the moves of a controller.',
      'cascade_controller')
_asks('play-next', 'play_next', {}, 'Send the next message of a paused replay.',
      'Send one message of a paused replay.', 'replay')


@_calls('step', short_help='Step an axis in lock-step or paused.')
@click.argument('steps', type=int, default=1)
@click.option('--velocity', type=float, default=math.nan, metavar='V',
              help='Drive velocity from these steps on, in m/s [default: unchanged].')
@click.option('--force', type=float, default=math.nan, metavar='F',
              help='Force on the slider from these steps on, in N [default: unchanged].')
def _step(ask: Ask, **request: float) -> Iterator[str]:
    """Make STEPS steps (default: 1) of an axis in lock-step or paused; print the events and the state."""
    answer = ask('step', request, duration=max(request['steps'], 0) * 1e-3)

    from ..ros.service_call import step_lines

    yield from step_lines(answer)


@_calls('inject-fault', short_help='Inject a fault.')
@click.argument('kind')
@click.option('--value', type=float, metavar='X', help='Size of the fault, in the unit of its kind.')
@click.option('--start', type=float, default=0.0, show_default=True, metavar='SECONDS',
              help='Delay before the fault begins.')
@click.option('--duration', type=float, default=math.inf, show_default=True, metavar='SECONDS',
              help='Duration; inf lasts until the fault is cleared.')
@click.option('--id', default='', metavar='ID', help='Name of the fault [default: chosen by the node].')
def _inject_fault(ask: Ask, kind: str, value: float | None, **fault: object) -> Iterator[str]:
    """Inject a fault of a KIND, with its --value.

    Kinds: friction_scale (factor), force_pulse (N), encoder_freeze, encoder_step (m), encoder_dropout (share),
    command_loss (share), command_delay (s), drive_freeze.
    """
    from ..core.errors import InputError
    from ..simulation.faults import value_of_kind

    if value is None and (allowed := value_of_kind(kind)):
        raise InputError('--value', value, f'given with {kind}: {allowed}', 'add --value X')
    yield ask('inject_fault', {**fault, 'kind': kind, 'value': value or 0.0}).message


@_calls('clear-faults', short_help='Clear faults.')
@click.argument('ids', metavar='[ID]...', nargs=-1)
def _clear_faults(ask: Ask, ids: tuple[str, ...]) -> Iterator[str]:
    """Clear the faults with these ids, or all.

    Clearing all also lets the drive take commands again after a time-out.
    """
    if not ids:
        yield ask('clear_faults', {}).message
    for fault in ids:
        yield ask('inject_fault', {'id': fault, 'kind': 'clear'}).message


@_calls('set', short_help='Change parameters of a node while it runs.')
@click.argument('changes', metavar='A.B=VALUE...', nargs=-1, required=True)
def _set(ask: Ask, changes: tuple[str, ...]) -> Iterator[str]:
    """Change parameters of a running node, all or none: controller gains, axis.mass, rate of a replay."""
    from ..scene import parse_override

    values = dict(parse_override(change) for change in changes)
    ask('set_parameters_atomically', values)
    yield 'set: ' + ', '.join(values)
