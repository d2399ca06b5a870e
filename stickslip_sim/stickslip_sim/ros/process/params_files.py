# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Parameter files, looked at before ROS reads them: its parser needs minutes for what is long or deeply nested."""

from collections.abc import Iterator, Sequence
from pathlib import Path


def params_files(args: Sequence[str]) -> Iterator[str]:
    """Yield the parameter files among arguments, which stand between --ros-args and --."""
    is_of_ros = False
    for word, following in zip(args, [*args[1:], '']):
        if word in ('--ros-args', '--'):
            is_of_ros = word == '--ros-args'
        elif is_of_ros and word == '--params-file' and following:
            yield following


def check_params_files(args: Sequence[str]) -> None:
    """Raise InputError on a parameter file that is too long or deep, or no YAML as ROS reads it."""
    from ...config.ros_yaml import read_yaml
    from ...scene.load import named, read_text

    for path in params_files(args):
        with named(path):
            read_yaml(read_text(Path(path), 'parameter file'))
