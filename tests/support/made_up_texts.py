# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Texts that are nearly scene files, limits files or overrides; and what a reader says of what is made up."""

from collections.abc import Callable, Sequence

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from stickslip_sim.core.errors import LINE_LIMIT, StickslipError
from stickslip_sim.scene.schema import PARAMETERS

NAMES = st.sampled_from([entry.name for entry in PARAMETERS])
_CHOICES = sorted({choice for entry in PARAMETERS for choice in entry.choices})
_ODD = [
    '', '~', 'null', 'yes', '.inf', '-.inf', '.nan', '1e400', '1e-320', '-0.0', '0x10', '017', '1_000', '1:30', '2.0',
    '3', '1.0e-12', '1.0e15', '9223372036854775808', '9' * 400, 'true', "''", '[]', '[0.0, 0.035]', '[1.0, 0.0]',
    '[0.0, 1]', '[1.0, .nan]', '[[1.0]]', '[' * 40, '{}', '{a: 1}', '{max: 3}', '{a: ' * 20, '*a', '&a 1.0', '<<',
    '!!float 1', '!!python/object/apply:os.system [id]', '- x', '? x', '|', '>', '@', '`', '#', '%YAML 1.3', '---',
    '...', '"\\u0000"', '"\\ud800"', '"\\U00110000"', 'x' * 300, '\x00', '\x85', '\ufeff', '😀', '/**',
    'ros__parameters',
]
_LETTERS = '\t :-[]{},#&*!|>%@"\'0e.\x00é'
WORDS = (st.sampled_from(_ODD) | st.sampled_from(_CHOICES) | NAMES
         | st.floats(width=64).map(repr) | st.integers().map(str) | st.text(max_size=20))
OVERRIDES = st.builds('{}{}{}'.format, NAMES | st.text(max_size=20), st.sampled_from(['=', '', '==', ' = ']), WORDS)


@st.composite
def changed(draw: DrawFn, texts: Sequence[str]) -> str:
    """Return one of some texts with a few changes."""
    lines = draw(st.sampled_from(texts)).splitlines()
    for _ in range(draw(st.integers(1, 5))):
        draw(st.sampled_from(_CHANGES))(draw, lines)
    return draw(st.sampled_from(['\n', '\n', '\r\n', '\r', '\n\n'])).join(lines)


ANYTHING: SearchStrategy[str] = st.text(max_size=200) | st.lists(WORDS, max_size=12).map('\n'.join) | st.lists(
    st.builds('{}{}: {}'.format, st.sampled_from(['', ' ', '  ', '    ', '\t', '- ']), WORDS, WORDS), max_size=12,
).map('\n'.join)


def _place(draw: DrawFn, lines: list[str]) -> int:
    return draw(st.integers(0, max(len(lines) - 1, 0)))


def _other_value(draw: DrawFn, lines: list[str]) -> None:
    k = _place(draw, lines)
    for line in lines[k:k + 1]:
        lines[k] = line.partition(':')[0] + ': ' + draw(WORDS)


def _other_letter(draw: DrawFn, lines: list[str]) -> None:
    k = _place(draw, lines)
    for line in lines[k:k + 1]:
        at = draw(st.integers(0, len(line)))
        lines[k] = line[:at] + draw(st.sampled_from(_LETTERS)) + line[at + draw(st.integers(0, 2)):]


def _without(draw: DrawFn, lines: list[str]) -> None:
    k = _place(draw, lines)
    del lines[k:k + draw(st.integers(1, 3))]


def _twice(draw: DrawFn, lines: list[str]) -> None:
    k = _place(draw, lines)
    lines[k:k] = lines[k:k + draw(st.integers(1, 3))]


def _one_more(draw: DrawFn, lines: list[str]) -> None:
    lines.insert(_place(draw, lines), ' ' * draw(st.integers(0, 8)) + draw(WORDS) + ': ' + draw(WORDS))


_CHANGES = [_other_value, _other_value, _other_letter, _without, _twice, _one_more]


def accepts_or_refuses(read: Callable[..., object], *arguments: object) -> object:
    """Return what a reader returns, None when it refused in a line; anything else that it raises is a mistake."""
    try:
        return read(*arguments)
    except StickslipError as error:
        text = str(error)
        assert 0 < len(text) <= LINE_LIMIT + 1, text
        assert '\n' not in text, text
        return None
