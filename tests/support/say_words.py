# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""In front of a command: instead of running it, add its words to a file, a list in JSON a line.

python3 say_words.py FILE COMMAND...
"""

import json
import sys
from pathlib import Path

if __name__ == '__main__':
    with Path(sys.argv[1]).open('a', encoding='utf-8') as stream:
        stream.write(json.dumps(sys.argv[2:]) + '\n')
