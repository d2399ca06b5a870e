# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The pictures of docs/closed_loop.md, by the commands there: `python3 -m benchmarks.loop_pictures` (minutes)."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PAGE = Path('docs/closed_loop.md').read_text(encoding='utf-8')
PICTURES = {'gains.png': 'loop_gains.png', 'tune.png': 'loop_tune.png', 'runs/thousand/map.png': 'loop_map.png'}


def blocks(language: str) -> list[str]:
    """Return the blocks of the page in a language."""
    return re.findall(rf'^```{language}\n(.*?)^```$', PAGE, re.MULTILINE | re.DOTALL)


def page_commands() -> list[list[str]]:
    """Return the words of the commands of the page behind `stickslip`."""
    found = re.findall(r'^    stickslip ((?:.*\\\n)*.*)$', PAGE, re.MULTILINE)
    return [shlex.split(command.replace('\\\n', ' ')) for command in found]


def write_inputs(folder: Path) -> None:
    """Write the controller, the setpoint and the limits of the page into a folder."""
    for name, language in (('my_controller.py', 'python'), ('move.csv', 'csv'), ('limits.yaml', 'yaml')):
        (folder / name).write_text(blocks(language)[0], encoding='utf-8')


def main() -> None:
    """Run all in a folder that vanishes."""
    images = Path('docs/images').resolve()
    with tempfile.TemporaryDirectory() as name:
        write_inputs(Path(name))
        paths = os.pathsep.join(filter(None, map(os.path.abspath, sys.path)))
        for words in page_commands():
            subprocess.run([sys.executable, '-m', 'stickslip_sim', *words], cwd=name, check=False,
                           env={**os.environ, 'PYTHONPATH': paths})
        for made, picture in PICTURES.items():
            shutil.copy(Path(name) / made, images / picture)
            print(f'written: docs/images/{picture}')


if __name__ == '__main__':
    main()
