# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How files of tests are handed out to several processes."""

from typing import Any

import pytest
from xdist.scheduler import LoadFileScheduling


class FilesOnce(LoadFileScheduling):    # type: ignore[misc]  # it has no types
    """Whole files for each process; what one that died had not begun goes to another one.

    Its base class hands out what was done, too, and waits for ever for the end of nothing; it waits, too, for a process
    that has one test and begins with it when it knows of the next; it gives tests to a process that has not found them
    yet; and the test that ends a process would end another.
    """

    def _reschedule(self, node: Any) -> None:
        if node not in self.registered_collections:
            return
        super()._reschedule(node)
        if self._pending_of(self.assigned_work[node]) == 1:
            super()._reschedule(node)

    def remove_node(self, node: Any) -> str | None:
        begun = self.assigned_work.pop(node)
        left = [test for tests in begun.values() for test, is_done in tests.items() if not is_done]
        for test in left[1:]:
            self.workqueue.setdefault(self._split_scope(test), {})[test] = False
        for other in self.assigned_work:
            self._reschedule(other)
        return left[0] if left else None


def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> FilesOnce | None:
    return FilesOnce(config, log) if config.getoption('dist') == 'loadfile' else None
