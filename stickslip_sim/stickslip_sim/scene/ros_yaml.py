# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""YAML as ROS 2 reads it, and nothing more: the only place that imports a YAML library.

ROS has its own typing of plain words (6e5 is a number, 1:30 and null are texts), knows no aliases and no tags, and this
reader refuses mistakes that ROS would pass over in silence (a key given twice, a second document).
"""

import math
import re
import sys
from collections.abc import Iterable, Mapping
from typing import Any, NoReturn

from yaml import YAMLError
from yaml.composer import Composer
from yaml.error import MarkedYAMLError
from yaml.events import AliasEvent
from yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode
from yaml.parser import Parser
from yaml.reader import Reader
from yaml.resolver import BaseResolver
from yaml.scanner import Scanner
from yaml.tokens import ScalarToken

from ..core.errors import InputError, suggestion

SIZE_LIMIT = 1 << 20   # letters of a document, beside long lists of numbers
LISTS_LIMIT = 12 << 20   # letters of a document with them
MOST_NUMBERS = 200_000   # of a list: three seconds in the parser of ROS, and four times as long for twice as many
MOST_LEVELS = 16
MOST_NODES = 100_000   # names, values and lists of a document: four seconds of reading
_SHOWN = 100           # letters of a document that is refused
_DIGITS = 24   # no longer word can be a whole number of 64 bits
_TEXT = BaseResolver.DEFAULT_SCALAR_TAG
_TAGS = (_TEXT, BaseResolver.DEFAULT_SEQUENCE_TAG, BaseResolver.DEFAULT_MAPPING_TAG)
_TRUE = {'y', 'Y', 'yes', 'Yes', 'YES', 'true', 'True', 'TRUE', 'on', 'On', 'ON'}
_FALSE = {'n', 'N', 'no', 'No', 'NO', 'false', 'False', 'FALSE', 'off', 'Off', 'OFF'}
_INTEGER = re.compile(r'[-+]?(?:0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)')
_DOUBLE = re.compile(r'[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?')
_NUMBER = r'[-+]?[0-9]+\.[0-9]*(?:[eE][-+]?[0-9]+)?'
_NUMBERS = re.compile(rf'\[ *(?:{_NUMBER} *, *){{99,}}{_NUMBER} *\]')   # in one line
_LIST = '['   # the style of a scalar that is a long list of numbers
_SPECIAL = re.compile(r'[-+]?(?:\.inf|\.Inf|\.INF|(?i:inf|infinity))|\.nan|\.NaN|\.NAN|[-+]?(?i:nan)')


def read_yaml(text: str) -> object:
    """Return a YAML document as dicts, lists, texts, bools and numbers; raises InputError that names the line."""
    _check_size(text)
    try:
        root = _Reader(text).get_single_node()
        return None if root is None else _value(root)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        _refuse(text, mark.line if mark else 0, error.problem or str(error))
    except YAMLError as error:
        raise InputError('text', type(error).__name__, 'printable YAML', str(error)) from None
    except ValueError:    # of PyYAML, which makes letters of any number
        raise InputError('text', 'an escape \\U', 'letters that Unicode has', 'none is beyond \\U0010FFFF') from None


def _check_size(text: str) -> None:
    if len(text) <= SIZE_LIMIT:
        return
    if len(text) > LISTS_LIMIT or len(_NUMBERS.sub('', text)) > SIZE_LIMIT:
        raise InputError('text', text[:_SHOWN], f'at most {SIZE_LIMIT} letters, or {LISTS_LIMIT} with long lists of '
                         'numbers, each in one line', 'is this the right file?')


class _Reader(Reader, Scanner, Parser, Composer, BaseResolver):
    """Composes a tree of nodes without aliases, of a sane depth and size.

    A list of a hundred numbers or more, in one line, is one scalar: its style is `_LIST`.
    """

    def __init__(self, text: str) -> None:
        Reader.__init__(self, text)
        Scanner.__init__(self)
        Parser.__init__(self)
        Composer.__init__(self)
        BaseResolver.__init__(self)
        self._depth = self._nodes = 0

    def compose_node(self, parent: Node | None, index: int) -> Node | None:
        if trouble := self._trouble():
            raise MarkedYAMLError(problem=trouble, problem_mark=self.peek_event().start_mark)
        self._nodes += 1
        self._depth += 1
        node = super().compose_node(parent, index)
        self._depth -= 1
        return node

    def fetch_flow_sequence_start(self) -> None:
        found = _NUMBERS.match(self.buffer, self.pointer)
        if found is None:
            super().fetch_flow_sequence_start()
            return
        self.save_possible_simple_key()
        self.allow_simple_key = False
        start, length = self.get_mark(), found.end() - self.pointer
        self.index, self.column, self.pointer = self.index + length, self.column + length, found.end()
        self.tokens.append(ScalarToken(found.group(), True, start, self.get_mark(), _LIST))

    def _trouble(self) -> str:
        """Return why the next node is refused, or an empty text."""
        if self.check_event(AliasEvent):
            return 'ROS knows no aliases: write the value out'
        if self._depth >= MOST_LEVELS:
            return f'nested more than {MOST_LEVELS} deep'
        return f'more than {MOST_NODES} names and values' if self._nodes >= MOST_NODES else ''


def _value(node: Node) -> object:
    if node.tag not in _TAGS:
        raise MarkedYAMLError(problem=f'ROS knows no tags: drop {node.tag}', problem_mark=node.start_mark)
    if isinstance(node, MappingNode):
        return _mapping(node)
    if isinstance(node, SequenceNode):
        return [_value(item) for item in node.value]
    assert isinstance(node, ScalarNode)
    if node.style == _LIST:
        return _numbers(node)
    if node.style is not None:
        return node.value
    if not node.value:
        raise MarkedYAMLError(problem='a value is missing', problem_mark=node.start_mark)
    return plain_value(node.value)


def _numbers(node: ScalarNode) -> list[Any]:
    words = node.value[1:-1].split(',')
    if len(words) > MOST_NUMBERS:
        raise MarkedYAMLError(problem=f'more than {MOST_NUMBERS} numbers in a list', problem_mark=node.start_mark)
    numbers = [*map(float, words)]
    sizes = [*filter(None, map(abs, numbers))]
    if sizes and (max(sizes) == math.inf or min(sizes) < sys.float_info.min):
        return [plain_value(word.strip()) for word in words]
    return numbers


def _mapping(node: MappingNode) -> dict[str, object]:
    result: dict[str, object] = {}
    for key, value in node.value:
        if not isinstance(key, ScalarNode) or key.style == _LIST:
            raise MarkedYAMLError(problem='a name must be a word', problem_mark=key.start_mark)
        if key.value in result:
            raise MarkedYAMLError(problem=f'{key.value} is given twice: drop one', problem_mark=key.start_mark)
        result[key.value] = _value(value)
    return result


def plain_value(word: str) -> bool | int | float | str:
    """Return an unquoted word as the type that ROS gives it."""
    if word in _TRUE or word in _FALSE:
        return word in _TRUE
    if _INTEGER.fullmatch(word) and len(word) <= _DIGITS:
        return _integer(word)
    if _DOUBLE.fullmatch(word):
        number = float(word)
        lost = math.isinf(number) or 0.0 < abs(number) < sys.float_info.min
        return word if lost else number   # out of the range of doubles is no number in ROS
    if _SPECIAL.fullmatch(word):
        return float(word.replace('.', ''))
    return word


def _integer(word: str) -> int | float:
    digits = word.lstrip('+-')
    base = 16 if digits[:2] in ('0x', '0X') else 8 if digits[0] == '0' else 10
    number = int(word, base)
    return number if -2**63 <= number < 2**63 else float(number)


def _refuse(text: str, line: int, problem: str) -> NoReturn:
    lines = text.splitlines()
    source = lines[line].strip() if line < len(lines) else 'the end'
    raise InputError(f'line {line + 1}', source, 'YAML as ROS reads it', ' '.join(problem.split()))


# Sections of the files beside a scene, read strictly: a key that nobody knows is an error.

def section(name: str, given: object, known: Iterable[str], page: str) -> Mapping[str, object]:
    """Return a section whose keys are all known; raises InputError on anything else, and points to a `page`.

    The outermost one is named `file`.
    """
    names = [*known]
    if not isinstance(given, Mapping):
        raise InputError(name, given, 'a section of ' + ', '.join(names), f'see {page}')
    for key, value in given.items():
        if key not in names:
            raise InputError(key if name == 'file' else f'{name}.{key}', value, 'one of ' + ', '.join(names),
                             suggestion(str(key), names, 'drop it'))
    return given
