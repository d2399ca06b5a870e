# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`python3 -m dev.prose [--figures] [PAGE...]` checks the prose of the pages: proselint, and a small style of our own.

Sentences count outside code, tables and headings; the style counts in tables and headings too.  `--figures` prints
the number of sentences, their length and the reading ease of each page instead.
"""

import os
import re
import sys
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

from proselint.checks import __register__ as checks_of_proselint
from proselint.config import DEFAULT
from proselint.registry import CheckRegistry
from proselint.tools import LintFile

from .files import ROOT, files

PAGES = 'docs/*.md', 'README.md', 'CONTRIBUTING.md', 'QUALITY_DECLARATION.md', 'stickslip_*/README.md'
MOST_WORDS, LONG = 35, 30              # of a sentence: allowed, and counted as long
LEAST_EASE, FEW = 50.0, 10             # Flesch reading ease of a page with more sentences than a few
STYLE = {re.compile(pattern): advice for pattern, advice in {
    r'\b[Ww]hat (?:is|was|are|were)\b': 'name it with a noun',
    r'\b(?:is|are|was|were) none\b': 'write "no ...", or name the gap',
    r'\b[Bb]eside\b': 'write next to, with, as well as or compared with',
    r'\b(?:[Ff]or ever|[Hh]erein|[Tt]hereby|[Tt]hereof|[Ww]hereby|[Ww]hereof)\b': 'archaic',
}.items()}
OPENINGS = {re.compile(pattern): advice for pattern, advice in {
    r'There (?:is|are|was|were) |It is \w+ed ': 'begin with the subject, or with "you"',
    r'(?:\S+ ){1,6}(?:is|are|was|were) (?:\w+ed|drawn|found|given|held|kept|made|read|run|shown|taken|written) by ':
        'passive: let the subject act',
}.items()}
ALLOWED: dict[str, tuple[str, ...]] = {}    # by page: how the findings begin that stay, each with its reason
# Checks of proselint that take options, numbers, dashes or "for every" for errors, or want American typography.
_OFF = dict.fromkeys(('archaism', 'dates_times', 'lexical_illusions', 'misc.phrasal_adjectives', 'spelling',
                      'typography'), False)
_CODE = re.compile(r'^ *(```|~~~).*?^ *\1|^ {4,}(?![*-] |\d+\. )[^\n]*|<!--.*?-->|<[^>\n]+>|(?<=\])\([^)\s]*\)',
                   re.MULTILINE | re.DOTALL)
_TABLE_OR_HEADING = re.compile(r'^ *[|#][^\n]*', re.MULTILINE)
_WORD_OF_CODE = re.compile(r'`[^`]+`|https?://\S+|\b[\w./]+/[\w.]+\b')
_MARKUP = re.compile(r'[\[\]]|\*+(?=\S)|(?<=\S)\*+')
_BLOCK = re.compile(r'\n\s*\n|\n(?=\s*(?:[*-]|\d+\.) )')
_END = re.compile(r'(?<=[.!?])["”)]*(?:  +|\s+(?=\W*(?:[A-Z0-9]|x\b)))')
_VOWELS = re.compile(r'[aeiouy]+')
_SILENT = re.compile(r'[^aeiouyl]e$|[^aeiouytd]ed$|[^aeiouycgsxz]es$')


def words_of(markdown: str) -> str:
    """Return a page with blanks in place of code and markup; code within a sentence is the word x."""
    text = _WORD_OF_CODE.sub(lambda match: f'{"x":>{len(match[0])}}', _blank(_CODE, markdown))
    return _blank(_MARKUP, text)


def sentences(markdown: str) -> list[tuple[int, str]]:
    """Return the sentences of a page with the lines in which they begin."""
    text = _blank(_TABLE_OR_HEADING, words_of(markdown))
    return [(_line(text, start + begin), ' '.join(sentence.split())) for start, block in _pieces(_BLOCK, text)
            for begin, sentence in _pieces(_END, block) if size(sentence) > 2]


def size(sentence: str) -> int:
    """Return the number of words."""
    return sum(bool(re.search(r'\w', word)) for word in sentence.split())


def reading_ease(found: list[str]) -> float:
    """Return the Flesch reading ease of sentences: 206.835 - 1.015 words a sentence - 84.6 syllables a word."""
    words = re.findall(r"[a-z][a-z'’]+|\b[ai]\b", ' '.join(found).lower())
    syllables = sum(max(1, len(_VOWELS.findall(word)) - len(_SILENT.findall(word))) for word in words)
    return 206.835 - 1.015 * len(words) / len(found) - 84.6 * syllables / len(words)


def findings(name: str, markdown: str) -> list[tuple[int, str]]:
    """Return what to change in a page: the lines, and why."""
    return sorted((line, text) for line, text in _findings(name, markdown)
                  if not text.startswith(ALLOWED.get(name, ())))


def _findings(name: str, markdown: str) -> Iterator[tuple[int, str]]:
    text, found = words_of(markdown), sentences(markdown)
    for result in LintFile(name, text).lint({**DEFAULT, 'checks': _OFF | DEFAULT['checks'] | _OFF}):
        yield result.pos[0], f'{result.check_result.check_path}: {result.check_result.message}'
    for pattern, advice in STYLE.items():
        yield from ((_line(text, match.start()), f'{match[0]!r}: {advice}') for match in pattern.finditer(text))
    for line, sentence in found:
        if size(sentence) > MOST_WORDS:
            yield line, f'"{sentence[:50]}...": {size(sentence)} words, at most {MOST_WORDS}'
        yield from ((line, f'"{match[0]}...": {advice}') for pattern, advice in OPENINGS.items()
                    if (match := pattern.match(sentence)))
    if len(found) > FEW and (ease := reading_ease([sentence for _, sentence in found])) < LEAST_EASE:
        yield 1, f'reading ease {ease:.0f}, at least {LEAST_EASE:.0f}: shorter words and sentences'


def _blank(pattern: re.Pattern[str], text: str) -> str:
    return pattern.sub(lambda match: re.sub(r'[^\n]', ' ', match[0]), text)


def _line(text: str, place: int) -> int:
    return text.count('\n', 0, place + len(text[place:]) - len(text[place:].lstrip())) + 1


def _pieces(between: re.Pattern[str], text: str) -> Iterator[tuple[int, str]]:
    begin = 0
    for match in between.finditer(text):
        yield begin, text[begin:match.start()]
        begin = match.end()
    yield begin, text[begin:]


def _figures(name: str, found: list[str]) -> str:
    sizes = [size(sentence) for sentence in found]
    return (f'{name:28} {len(sizes):5} sentences of {sum(sizes) / len(sizes):4.1f} words, '
            f'{sum(one > LONG for one in sizes) / len(sizes):5.1%} above {LONG}, '
            f'{sum(one > MOST_WORDS for one in sizes):3} above {MOST_WORDS}, reading ease {reading_ease(found):.0f}')


def main() -> int:
    """Print what to change, or figures; return the exit code."""
    CheckRegistry().register_many(checks_of_proselint)
    names = [name for name in sys.argv[1:] if name != '--figures']
    pages = [Path(name).resolve() for name in names] if names else [*files(*PAGES)]
    texts = {os.path.relpath(page, ROOT): page.read_text(encoding='utf-8') for page in pages}
    if '--figures' in sys.argv:
        found = {name: [sentence for _, sentence in sentences(text)] for name, text in texts.items()}
        print(*(_figures(*page) for page in found.items() if page[1]), sep='\n')
        print(_figures('all', [*chain(*found.values())]))
        return 0
    wrong = [f'{name}:{line}: {text}' for name, page in texts.items() for line, text in findings(name, page)]
    print(*wrong, sep='\n', file=sys.stderr, end='\n' if wrong else '')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
