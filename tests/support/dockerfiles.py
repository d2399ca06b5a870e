# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A Dockerfile as a list of instructions."""

import json
from typing import NamedTuple

from tests.support.repository import ROOT


class Instruction(NamedTuple):
    """One instruction, continued lines joined."""

    name: str
    text: str

    @property
    def words(self) -> list[str]:
        """Its words; of the exec form the elements."""
        exec_form = self.text[self.text.index('['):] if '[' in self.text else ''
        return [str(word) for word in json.loads(exec_form)] if exec_form else self.text.split()


def instructions(file: str) -> list[Instruction]:
    lines = (ROOT / file).read_text(encoding='utf-8').splitlines()
    text = '\n'.join(line for line in lines if not line.lstrip().startswith('#')).replace('\\\n', ' ')
    return [Instruction(*line.split(maxsplit=1)) for line in text.splitlines() if line.strip()]


def stages(file: str) -> list[list[Instruction]]:
    """Return the instructions of each stage, from FROM on."""
    found: list[list[Instruction]] = []
    for instruction in instructions(file):
        if instruction.name == 'FROM':
            found.append([])
        if found:
            found[-1].append(instruction)
    return found
