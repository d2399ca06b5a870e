#!/usr/bin/env python3
# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Turn a virtual environment that holds ROS 2 wheels into an underlay for colcon.

    .venv/bin/python underlay.py DISTRO

Two things are missing in the wheels.  Their exported CMake targets name include
directories of the machine that built them, and CMake refuses a target whose
include directories do not exist: such entries are dropped (what links to these
targets finds Python and numpy by itself).  And they bring no setup files: with
those, colcon takes the environment as an underlay, and sourcing the workspace's
install/setup.bash is all that a user does.
"""

import pathlib
import re
import shlex
import sys

INCLUDES = re.compile(r'(?<=INTERFACE_INCLUDE_DIRECTORIES ")[^"]*')

SETUP = """\
# Written by ros2_ws/underlay.py.
_underlay_prepend() {{
  eval "_underlay_rest=\\"\\${{$1:-}}\\""
  case ":$_underlay_rest:" in
    *":$2:"*) ;;
    *) export "$1=$2${{_underlay_rest:+:$_underlay_rest}}" ;;
  esac
  unset _underlay_rest
}}
{prepends}
unset -f _underlay_prepend
export ROS_VERSION=2 ROS_PYTHON_VERSION=3 ROS_DISTRO={distro}
# The libraries are found as it stands: the wheels need not restart Python for them.
export _ROS_WHEELS_BOOTSTRAP_COMPLETE=1
"""


def drop_stale_includes(prefix: pathlib.Path) -> int:
    """Remove include directories that do not exist; return the number of files changed."""
    changed = 0
    for path in prefix.glob('share/*/cmake/*Export.cmake'):
        text = path.read_text()
        fixed = INCLUDES.sub(lambda match: existing(match[0]), text)
        if fixed != text:
            path.write_text(fixed)
            changed += 1
    return changed


def existing(directories: str) -> str:
    """Return a CMake list without the absolute paths that lead nowhere."""
    return ';'.join(entry for entry in directories.split(';')
                    if not entry.startswith('/') or pathlib.Path(entry).exists())


def write_setup_files(prefix: pathlib.Path, distro: str) -> None:
    """Write {local_,}setup.{sh,bash,zsh}; they differ in name only."""
    wheel_libraries = sorted(prefix.glob('lib/python3*/site-packages/ros_*.libs'))
    entries = [('PATH', prefix / 'bin'),
               ('AMENT_PREFIX_PATH', prefix),
               *(('LD_LIBRARY_PATH', path) for path in [*wheel_libraries, prefix / 'lib'])]
    prepends = '\n'.join(f'_underlay_prepend {name} {shlex.quote(str(path))}'
                         for name, path in entries)
    text = SETUP.format(prepends=prepends, distro=distro)
    for name in ('local_setup', 'setup'):
        for shell in ('sh', 'bash', 'zsh'):
            (prefix / f'{name}.{shell}').write_text(text)


def main() -> None:
    """Finish the environment whose Python runs this."""
    if sys.prefix == sys.base_prefix or len(sys.argv) != 2:
        sys.exit('usage: .venv/bin/python underlay.py DISTRO')
    prefix = pathlib.Path(sys.prefix)
    drop_stale_includes(prefix)
    write_setup_files(prefix, sys.argv[1])


if __name__ == '__main__':
    main()
