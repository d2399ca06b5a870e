# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What runs before a commit is what `make check` runs."""

import re

import yaml

from tests.support.repository import ROOT


def tool(command: str) -> str:
    """Return the program of a command, with the module that Python runs."""
    program, = re.findall(r'(?:\$\(TOOLS\)|ros2_ws/\.venv/bin)/(\S+(?: -m \S+)?)', command)
    return str(program)


def test_both_run_the_same_tools() -> None:
    recipe = (ROOT / 'Makefile').read_text(encoding='utf-8').partition('\ncheck:')[2].partition('\n\n')[0]
    hooks = yaml.safe_load((ROOT / '.pre-commit-config.yaml').read_text(encoding='utf-8'))['repos'][0]['hooks']
    assert [tool(hook['entry']) for hook in hooks] == [tool(line) for line in recipe.split('\n')[1:]]
    assert {hook['language'] for hook in hooks} == {'system'}
