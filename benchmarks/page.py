# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Parts of a page that a program writes, between `<!-- NAME: begin -->` and `<!-- NAME: end -->`; commands in them."""

import pathlib
import re
import shlex
import subprocess
import sys

_WIDTH = 116


def replaced(text: str, name: str, part: str) -> str:
    """Return the text of a page with another part of this name; raises ValueError where the page has none."""
    before, _, after = _split(text, name)
    return f'{before}\n\n{part}\n{after}'


def part_of(text: str, name: str) -> str:
    """Return the part of this name; raises ValueError where the page has none."""
    return _split(text, name)[1].strip('\n') + '\n'


def replace_generated(page: pathlib.Path, part: str, name: str = 'generated') -> None:
    """Write a part into a page."""
    page.write_text(replaced(page.read_text(encoding='utf-8'), name, part), encoding='utf-8')
    print(f'written: {page}, {name}')


def shown(command: str, program: str = 'stickslip') -> str:
    """Return a command as a page shows it, folded to the width of the page."""
    rows = [f'    {program}']
    for word in command.replace(' --', '\n--').split('\n'):   # an option stays with its value
        if len(rows[-1]) + len(word) > _WIDTH:
            rows[-1] += ' \\'
            rows.append('       ')
        rows[-1] += f' {word}'
    return '\n'.join(rows)


def quoted(text: str) -> str:
    """Return what a command printed as a part of a page."""
    return ''.join(f'    {line}'.rstrip() + '\n' for line in text.splitlines())


def excerpt(text: str, left_out: str) -> str:
    """Return what a command printed without times and progress, and "..." for lines that begin like `left_out`."""
    lines = []
    text = re.sub(r'^identifying: .*\n', '', text, flags=re.MULTILINE)    # progress, of a slow machine
    for line in re.sub(r'( simulations) in \S+ s$', r'\1', text, flags=re.MULTILINE).splitlines():
        if not re.match(left_out, line):
            lines.append(line)
        elif lines[-1:] != ['...']:
            lines.append('...')
    return '\n'.join(lines)


def said(command: str, code: int = 0) -> str:
    """Return what a command prints, its line on standard error at the end; it must end with this exit code."""
    print(command, flush=True)
    done = subprocess.run([sys.executable, '-m', 'stickslip_sim', *shlex.split(command)], check=False, text=True,
                          capture_output=True)
    if done.returncode != code:
        raise SystemExit(f'exit code {done.returncode}: {done.stderr}')
    return done.stdout + done.stderr


def _split(text: str, name: str) -> tuple[str, str, str]:
    """Return what stands before a part, with its marker, the part, and what stands after it, with its marker."""
    begin, end = f'<!-- {name}: begin -->', f'<!-- {name}: end -->'
    before, found, rest = text.partition(begin)
    part, closed, after = rest.partition(end)
    if not found or not closed:
        raise ValueError(f'the page lacks {begin} or {end}')
    return before + begin, part, end + after
