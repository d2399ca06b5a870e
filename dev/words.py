# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`python3 -m dev.words`: no text of the repository has a word that dev/words.yaml refuses."""

import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from .files import ROOT, files, texts

LIST = ROOT / 'dev/words.yaml'
# Those that have to name what they refuse, and texts of others.
_OUTSIDE = (':!dev/words.yaml', ':!tests/house/test_words.py', ':!tests/data', ':!CHANGELOG.md', ':!*/CHANGELOG.rst',
            ':!*LICENSE', ':!ros2_ws/requirements-*')
_CAPITAL = re.compile(r'(?<=[a-z0-9])(?=[A-Z])')


def _whole(words: str) -> str:
    return rf'(?<!\w)(?:{words})(?!\w)'


class Rule(NamedTuple):
    """What is written instead of what, and where; `words` are the expressions that `refused` is made of."""

    write: str
    words: str
    refused: re.Pattern[str]
    right: re.Pattern[str] | None
    right_in: tuple[str, ...]
    pages_only: bool


class Rules:
    """Rules, and one expression that finds the lines with a word that any of them refuses.

    A text is searched once for all of them, in lower case: eight times as quick as for one after the other.
    """

    def __init__(self, listed: Iterable[Rule]) -> None:
        self.listed = list(listed)
        self._any = re.compile(_whole('|'.join(rule.words for rule in self.listed)))

    def lines(self, words: str) -> list[int]:
        """Return the numbers of the lines with a word that is refused, from 1 on."""
        lowered = words.lower()
        return sorted({lowered.count('\n', 0, match.start()) + 1 for match in self._any.finditer(lowered)})


class Fault(NamedTuple):
    """A word that is not written, where it stands (line 0: in the name of the file), and what is."""

    line: int
    word: str
    write: str


def rules(entries: Iterable[dict[str, Any]]) -> Rules:
    """Return the rules of the list; raises ValueError for a key that means nothing, and for a capital in a word."""
    found = []
    for entry in entries:
        if unknown := set(entry) - {'write', 'not', 'but', 'only', 'right'}:
            raise ValueError(f'{LIST.name}: {entry["write"]}: unknown: {", ".join(unknown)}')
        words = '|'.join(entry['not'])
        if words != words.lower():
            raise ValueError(f'{LIST.name}: {entry["write"]}: in lower case, which finds capitals, too: {words}')
        found.append(Rule(entry['write'], words, re.compile(_whole(words), re.IGNORECASE),
                          re.compile('|'.join(entry['but'])) if 'but' in entry else None, tuple(entry.get('right', ())),
                          entry.get('only') == 'pages'))
    return Rules(found)


def faults(text: str, refusals: Rules, file: str = '') -> Iterator[Fault]:
    """Yield the words of a text that are refused, a line after the other; names are read as the words in them.

    `file` is the name that the text has in the repository.
    """
    lines = text.splitlines()
    words = _CAPITAL.sub(' ', '\n'.join(lines)).replace('_', ' ')
    in_lines = words.split('\n')
    for number in refusals.lines(words):
        for rule in refusals.listed:
            for match in () if file.startswith(rule.right_in) else rule.refused.finditer(in_lines[number - 1]):
                if not (rule.right and rule.right.search(lines[number - 1])):
                    yield Fault(number, match.group(), rule.write)


def name_faults(file: str, refusals: Rules) -> Iterator[Fault]:
    """Yield the words of a file's name in the repository that are refused, those of its folders among them."""
    return (fault._replace(line=0) for fault in faults(file, refusals, file))


def all_faults() -> Iterator[tuple[Path, Fault]]:
    """Yield what is refused in the repository."""
    listed = rules(yaml.safe_load(LIST.read_text(encoding='utf-8')))
    elsewhere = Rules(rule for rule in listed.listed if not rule.pages_only)
    for file in files(*_OUTSIDE):
        for fault in name_faults(file.relative_to(ROOT).as_posix(), elsewhere):
            yield file, fault
    for file in texts(*_OUTSIDE):
        refusals = listed if file.suffix == '.md' else elsewhere
        for fault in faults(file.read_text(encoding='utf-8'), refusals, file.relative_to(ROOT).as_posix()):
            yield file, fault


def main() -> int:
    """Print each word that is refused, and what to write; return the exit code."""
    count = 0
    for file, fault in all_faults():
        print(f'{file.relative_to(ROOT)}:{fault.line}: "{fault.word}": write {fault.write}', file=sys.stderr)
        count += 1
    return 1 if count else 0


if __name__ == '__main__':
    sys.exit(main())
