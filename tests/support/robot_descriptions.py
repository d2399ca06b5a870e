# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The robot descriptions that are shipped, expanded by the real xacro and read by the real urdfdom."""

import subprocess
import sys
from pathlib import Path

import xacro


def expanded(file: Path, *words: str) -> str:
    """Return the URDF that xacro makes of a file with the words of a command line."""
    options, name = xacro.process_args([str(file), *words])
    return str(xacro.process_file(name, **vars(options)).toxml())


def checked(urdf: str, folder: Path) -> str:
    """Return what check_urdf, with the parser of RViz and robot_state_publisher, reports of a URDF that it takes."""
    file = folder / 'robot.urdf'
    file.write_text(urdf, encoding='utf-8')
    done = subprocess.run([Path(sys.executable).with_name('check_urdf'), file], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout
