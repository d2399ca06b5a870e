# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The mutants of `make mutants` apply, and the tests that kill them are there."""

import re

import pytest

from dev.mutants import Mutant, mutants
from tests.support.repository import ROOT

MUTANTS = mutants()


def test_there_are_enough_of_them() -> None:
    assert len(MUTANTS) >= 60
    assert len({(one.file, one.name) for one in MUTANTS}) == len(MUTANTS)


@pytest.mark.parametrize('mutant', MUTANTS, ids=lambda one: f'{one.file}: {one.name}')
def test_a_mutant_applies_once_and_names_its_test(mutant: Mutant) -> None:
    assert mutant.text is not None, f'{mutant.file} does not have exactly once: {mutant.old}'
    assert mutant.new != mutant.old
    compile(mutant.text, mutant.file, 'exec')
    file, *names = mutant.test.partition('[')[0].split('::')
    text = (ROOT / file).read_text(encoding='utf-8')
    assert all(re.search(rf'\b(def|class) {name}\b', text) for name in names)
