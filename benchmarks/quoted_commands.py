# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Commands of the tool and what they print, as a page quotes them."""

import shlex
import subprocess
import sys

_WIDTH = 116


def shown(command: str, program: str) -> str:
    """Return a command as a user gives it, folded to the width of the page."""
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


def said(command: str, code: int = 0) -> str:
    """Return what a command prints, its line on standard error at the end; it must end with this exit code."""
    print(command, flush=True)
    done = subprocess.run([sys.executable, '-m', 'stickslip_sim', *shlex.split(command)], check=False, text=True,
                          capture_output=True)
    if done.returncode != code:
        raise SystemExit(f'exit code {done.returncode}: {done.stderr}')
    return done.stdout + done.stderr
