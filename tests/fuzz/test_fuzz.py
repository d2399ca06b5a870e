# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Made-up input: read, or refused in one line; and made-up runs of the engine.  `make fuzz` makes up more."""

from collections.abc import Mapping

import pytest
from hypothesis import HealthCheck, given, settings

from tests.fuzz.targets import Target, targets

pytestmark = pytest.mark.slow

EXAMPLES = {'scene': 80, 'limits': 80, 'override': 80, 'bag': 40, 'distributions': 50, 'options': 50, 'study': 8,
            'engine': 15, 'reference': 3}
AT_EASE = settings(suppress_health_check=list(HealthCheck))


@pytest.fixture(scope='module')
def all_targets(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Target]:
    return targets(tmp_path_factory.mktemp('fuzz'))


@pytest.mark.parametrize('name', [*EXAMPLES])
def test_reading(name: str, all_targets: Mapping[str, Target]) -> None:
    target = all_targets[name]
    settings(AT_EASE, max_examples=EXAMPLES[name])(given(target.inputs)(target.read))()


def test_every_target_is_tried(all_targets: Mapping[str, Target]) -> None:
    assert set(all_targets) == set(EXAMPLES)
