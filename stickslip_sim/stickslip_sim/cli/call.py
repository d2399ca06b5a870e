# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip call`: the services of a running node, for those who have no `ros2`."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import click

from ..ros.environment import answer_of_node
from .files import show


@click.group(short_help='Call a service of a running node.', invoke_without_command=True)
@click.pass_context
def call(context: click.Context) -> None:
    """Call a service of a running node, and print its answer.

    Exit codes: 0 success; 1 no answer; 2 wrong usage, or the node refuses.  Set ROS_DOMAIN_ID to that of the node.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help(), err=True)
        context.exit(2)


def _of(node: str = 'feed_axis') -> Callable[[Callable[..., None]], Any]:
    """Return what adds the options that every call has, with the name of the node where none is given."""
    timeout = click.option('--timeout', type=click.FloatRange(0.1, 3600.0), default=10.0, show_default=True,
                           metavar='SECONDS', help='Time to wait for the node and for its answer.')
    name = click.option('--node', default=node, show_default=True, metavar='NAME',
                        help=f'Name of the node, with its namespace, such as /cell/{node}.')
    return lambda command: name(timeout(command))


@call.command('record')
@click.argument('switch', type=click.Choice(['on', 'off']), default='on', metavar='[on|off]')
@_of()
def _record(switch: str, node: str, timeout: float) -> None:
    """Start (on, the default) or stop (off) a recording."""
    _do('record', {'data': switch == 'on'}, node, timeout)


def _ask(name: str, service: str, request: Mapping[str, object], text: str,
         short: str | None = None, node: str = 'feed_axis') -> None:
    """Add a call that asks for one thing."""
    @call.command(name, help=text, short_help=short)
    @_of(node)
    def _asked(node: str, timeout: float) -> None:
        _do(service, request, node, timeout)


_ask('reset', 'reset', {}, 'Start a new run: reset time, counters, faults and commands.')
_ask('pause', 'set_paused', {'data': True}, 'Pause simulation time.')
_ask('resume', 'set_paused', {'data': False}, 'Resume simulation time.')
_ask('restart', 'restart', {}, 'Restart the moves of an example controller.',
     'Restart the moves of a controller.', 'cascade_controller')
_ask('play-next', 'play_next', {}, 'Send the next message of a paused replay.',
     'Send one message of a paused replay.', 'replay')


@call.command('step', short_help='Step an axis in lock-step or paused.')
@click.argument('steps', type=int, default=1)
@click.option('--velocity', type=float, default=math.nan, metavar='V',
              help='Drive velocity from these steps on, in m/s [default: unchanged].')
@click.option('--force', type=float, default=math.nan, metavar='F',
              help='Force on the slider from these steps on, in N [default: unchanged].')
@_of()
def _step(steps: int, velocity: float, force: float, node: str, timeout: float) -> None:
    """Make STEPS steps (default: 1) of an axis in lock-step or paused; print the events and the state."""
    request = {'steps': steps, 'velocity': velocity, 'force': force}
    answer = answer_of_node('step', request, node, timeout, max(steps, 0) * 1e-3)
    from ..ros.service_call import step_lines
    show(step_lines(answer))


@call.command('inject-fault', short_help='Inject a fault.')
@click.argument('kind')
@click.option('--value', type=float, metavar='X', help='Size of the fault, in the unit of its kind.')
@click.option('--start', type=float, default=0.0, show_default=True, metavar='SECONDS',
              help='Delay before the fault begins.')
@click.option('--duration', type=float, default=math.inf, show_default=True, metavar='SECONDS',
              help='Duration; inf lasts until the fault is cleared.')
@click.option('--id', 'fault', default='', metavar='ID', help='Name of the fault [default: chosen by the node].')
@_of()
def _inject_fault(kind: str, value: float | None, start: float, duration: float, fault: str, node: str,
                  timeout: float) -> None:
    """Inject a fault of a KIND, with its --value.

    Kinds: friction_scale (factor), force_pulse (N), encoder_freeze, encoder_step (m), encoder_dropout (share),
    command_loss (share), command_delay (s), drive_freeze.
    """
    from ..core.errors import InputError
    from ..simulation.faults import value_of_kind

    if value is None and (allowed := value_of_kind(kind)):
        raise InputError('--value', value, f'given with {kind}: {allowed}', 'add --value X')
    request = {'id': fault, 'kind': kind, 'start': start, 'duration': duration, 'value': value or 0.0}
    _do('inject_fault', request, node, timeout)


@call.command('clear-faults', short_help='Clear faults.')
@click.argument('ids', metavar='[ID]...', nargs=-1)
@_of()
def _clear_faults(ids: tuple[str, ...], node: str, timeout: float) -> None:
    """Clear the faults with these ids, or all.

    Clearing all also lets the drive take commands again after a time-out.
    """
    if not ids:
        _do('clear_faults', {}, node, timeout)
    for fault in ids:
        _do('inject_fault', {'id': fault, 'kind': 'clear'}, node, timeout)


@call.command('set', short_help='Change parameters of a node while it runs.')
@click.argument('changes', metavar='A.B=VALUE...', nargs=-1, required=True)
@_of()
def _set(changes: tuple[str, ...], node: str, timeout: float) -> None:
    """Change parameters of a running node, all or none: controller gains, axis.mass, rate of a replay."""
    from ..scene import parse_override

    values = dict(parse_override(change) for change in changes)
    answer_of_node('set_parameters_atomically', values, node, timeout)
    print('set: ' + ', '.join(values))


def _do(service: str, request: Mapping[str, object], node: str, timeout: float) -> None:
    """Print what a node answers."""
    print(answer_of_node(service, request, node, timeout).message)
