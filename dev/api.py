# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The lists of docs/api.md and docs/tool.md: every public name, taken from what the programs themselves use."""

import inspect
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import click

import stickslip_sim
from benchmarks.page import replaced
from stickslip_sim.bags import topics
from stickslip_sim.cli.main import stickslip as tool

from .files import ROOT

PAGE = ROOT / 'docs/api.md'
_TOOL_PAGE = ROOT / 'docs/tool.md'
_PAGES_OF_VERBS = {   # where docs/tool.md sends a reader for more
    'scenes': 'scene.md', 'simulate': 'receipt.md', 'close-loop': 'closed_loop.md',
    'tune': 'closed_loop.md#why-does-my-loop-swing', 'import': 'runs.md#a-measured-run',
    'call': 'hil.md#topics-and-services', 'explore': 'explore.md', 'plot': 'runs.md#as-a-picture',
    'compare': 'paper.md', 'export': 'runs.md', 'export-c': 'c.md', 'export-fmu': 'fmu.md', 'export-hal': 'linuxcnc.md',
    'check': 'check.md', 'verify': 'runs.md', 'critical': 'maps.md', 'sweep': 'maps.md', 'map': 'maps.md',
    'uncertainty': 'maps.md#uncertain-friction', 'friction': 'friction_curve.md', 'identify': 'identification.md',
    'predict': 'identification.md', 'design': 'sensitivities.md', 'advise': 'accuracy.md',
    'bench': 'measured.md#races', 'extremes': 'measured.md#extremes',
}
_MESSAGES = ROOT / 'stickslip_msgs'
_OF_THE_NODE, _OF_THE_PLAYER = 'ros/node/*.py', 'ros/replay/node.py'
_SERVICE = re.compile(r"create_service\((?:srv\.)?(\w+), '(~/\w+)'")
_TYPES = {'Trigger': 'std_srvs', 'SetBool': 'std_srvs', 'Step': 'stickslip_msgs', 'InjectFault': 'stickslip_msgs'}
_FIELD = re.compile(r'^([\w/]+(?:\[\])?) +(\w+)$', re.MULTILINE)
_UNNAMED = {'float64': '', 'std_msgs/Header': ''}    # types that go without saying
_SHARED = {'--node', '--timeout'}    # options of every verb of `call`
_WITH_SET = {'--set', '--allow-implausible'}    # the second goes with the first
_OF_OTHER_ROOMS = {   # attributes that no user needs: between rooms of the package, and not promised
    'Scene': {'inputs', 'make_rig', 'make_simulator', 'normal_force', 'rig', 'sources'},
    'Simulator': {'checkpoint', 'event_counts', 'require_sound', 'restore', 'root_iterations', 'skip', 'step',
                  'take_samples'},
}
_CONSTANT = re.compile(r'^\w+ +([A-Z][A-Z0-9_]*) *= *(-?\d+)', re.MULTILINE)


def verbs() -> str:
    """Return a row for each verb of the tool: its arguments and options."""
    rows = [_verb(name, command) for commands in tool.sections.values() for one in commands
            for name, command in _with_their_own(one)]
    return _table(('verb', 'arguments', 'options'), rows)


def tool_page() -> str:
    """Return the text of docs/tool.md with a row for each verb: what its help says in a line, and its page."""
    rows = [(f'`{one.name}`', one.get_short_help_str(200), f'[{page.partition(".")[0].replace("_", " ")}]({page})')
            for commands in tool.sections.values() for one in commands if (page := _PAGES_OF_VERBS[one.name or ''])]
    return replaced(_TOOL_PAGE.read_text(encoding='utf-8'), 'verbs', _table(('verb', 'does', 'more'), rows))


def python() -> str:
    """Return a row for each name of `import stickslip_sim`."""
    names = stickslip_sim.__all__
    return _table(('name', 'is'), [(f'`{name}`', _kind(getattr(stickslip_sim, name))) for name in names])


def topic_list() -> str:
    """Return a row for each topic of the node."""
    found = [value for value in vars(topics).values() if isinstance(value, topics.Topic)]
    return _table(('topic', 'type', 'direction', 'QoS', 'in a bag'), [
        (f'`{one.name}`', f'`{one.type}`', 'in' if one.kept else 'out', quality(one),
         'yes' if one in topics.RECORDED else 'no') for one in found])


def services() -> str:
    """Return a row for each service of the nodes."""
    rows = []
    for node, pattern in (('`sim_node`', _OF_THE_NODE), ('`replay_node`', _OF_THE_PLAYER)):
        for path in sorted((ROOT / 'stickslip_sim/stickslip_sim').glob(pattern)):
            rows += [(node, f'`{name}`', f'`{_TYPES.get(kind, "simulation_interfaces")}/srv/{kind}`')
                     for kind, name in _SERVICE.findall(path.read_text(encoding='utf-8'))]
    return _table(('node', 'service', 'type'), rows)


def messages() -> str:
    """Return a row for each message and service of our own: its fields in their order, and its constants."""
    rows = []
    for path in sorted((*_MESSAGES.glob('msg/*.msg'), *_MESSAGES.glob('srv/*.srv'))):
        parts = path.read_text(encoding='utf-8').split('---\n')
        fields = ' → '.join(', '.join(f'`{name}` {_UNNAMED.get(kind, kind)}'.rstrip()
                                      for kind, name in _FIELD.findall(part)) for part in parts)
        constants = ', '.join(f'{name} {number}' for name, number in _CONSTANT.findall(''.join(parts)))
        rows.append((f'`{path.parent.name}/{path.stem}`', fields, constants))
    return _table(('interface', 'fields (→ of the answer)', 'constants'), rows)


LISTS: dict[str, Callable[[], str]] = {
    'verbs': verbs, 'python': python, 'topics': topic_list, 'services': services, 'messages': messages,
}


def page() -> str:
    """Return the text of the page with the lists of today; raises ValueError where it has no place for one."""
    text = PAGE.read_text(encoding='utf-8')
    for name, made in LISTS.items():
        text = replaced(text, name, made())
    return text


def _with_their_own(command: click.Command) -> Iterator[tuple[str, click.Command]]:
    """Yield a verb, or each verb of a group with the group's name."""
    if not isinstance(command, click.Group):
        yield command.name or '', command
        return
    for name, own in command.commands.items():
        yield f'{command.name} {name}', own


def _verb(name: str, command: click.Command) -> tuple[str, str, str]:
    arguments = ' '.join(one.human_readable_name.replace('|', ' or ') for one in command.params
                         if isinstance(one, click.Argument))   # a bar would end the cell
    names = [one.opts[0] for one in command.params if isinstance(one, click.Option)]
    hidden = _SHARED if name.startswith('call ') else {'--allow-implausible'} if {*names} >= _WITH_SET else set()
    options = ', '.join(f'`{one}`' for one in names if one not in hidden)
    return f'`{name}`', f'`{arguments}`' if arguments else '', options


def _kind(value: Any) -> str:
    if isinstance(value, str):
        return 'a text'
    if hasattr(value, '_fields'):
        return 'a tuple of ' + ', '.join(f'`{name}`' for name in value._fields)
    if inspect.isfunction(value):
        bare = [one.replace(annotation=inspect.Parameter.empty) for one in inspect.signature(value).parameters.values()]
        return f'`{inspect.Signature(bare)}`'
    if issubclass(value, BaseException):
        code = getattr(value, 'exit_code', None)
        return f'an error, a kind of `{value.__base__.__name__}`' + ('' if code is None else f', exit code {code}')
    if hasattr(value, '__members__'):
        return 'one of ' + ', '.join(f'`{name}`' for name in value.__members__)
    return 'a class with ' + ', '.join(f'`{name}`' for name in _public(value))


def _public(kind: type) -> list[str]:
    own = {*getattr(kind, '__annotations__', ()), *vars(kind), *getattr(kind, '__dataclass_fields__', ())}
    hidden = _OF_OTHER_ROOMS.get(kind.__name__, set())
    return sorted(name for name in own if not name.startswith('_') and name not in hidden)


def quality(topic: topics.Topic) -> str:
    """Return the quality of service that the node sends or hears a topic with."""
    qos = topic.qos_of_node
    durability = '' if qos.durability == 'volatile' else f', {qos.durability.replace("_", " ")}'
    return f'{qos.reliability.replace("_", " ")}, keep last {qos.depth}{durability}'


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = ['| ' + ' | '.join(heads) + ' |', '|' + '---|' * len(heads)]
    return '\n'.join([*lines, *('| ' + ' | '.join(row) + ' |' for row in rows)]) + '\n'
