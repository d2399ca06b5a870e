# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Tries made-up input and runs for as long as asked for: `python3 -m tests.fuzz --minutes 10`.

What fails is made as small as it goes, shown, kept in .hypothesis/ and tried first the next time.
"""

import argparse
import sys
import time
import traceback
from pathlib import Path
from tempfile import TemporaryDirectory

from hypothesis import HealthCheck, given, settings

from tests.support.time_and_memory import limit_memory

from .targets import Target, targets

_EXAMPLES = 100        # between two looks at the clock
_MEMORY = 1500         # MiB beyond those of the start


def main() -> int:
    """Fuzz all targets in turn; return 1 when one failed."""
    parser = argparse.ArgumentParser(prog='fuzz', description='Try made-up files and runs.')
    parser.add_argument('--minutes', type=float, default=10.0)
    end = time.monotonic() + 60.0 * parser.parse_args().minutes
    with TemporaryDirectory() as folder:
        waiting = targets(Path(folder))
        counts = dict.fromkeys(waiting, 0)
        limit_memory(_MEMORY)
        while time.monotonic() < end:
            for name, target in waiting.items():
                counts[name] += _EXAMPLES
                if not _passes(name, target):
                    return 1
    print('nothing found: ' + ', '.join(f'{name} {count}' for name, count in counts.items()))
    return 0


def _passes(name: str, target: Target) -> bool:
    """Try a number of new inputs."""
    profile = settings(max_examples=_EXAMPLES, deadline=None, print_blob=True, suppress_health_check=list(HealthCheck))
    try:
        profile(given(target.inputs)(target.read))()
    except Exception:
        traceback.print_exc()
        print(f'{name}: not as it should be', file=sys.stderr)
        return False
    return True


if __name__ == '__main__':
    sys.exit(main())
