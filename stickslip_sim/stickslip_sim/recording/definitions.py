# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The definitions of message types: those of the sourced workspace, and without ROS those that travel along.

`stickslip_msgs/` beside this file has copies of the .msg files of the package of that name; rosbags knows the
types of ROS 2 itself.  Types and hashes are the same, so that a bag made without ROS is one like any other.
"""

import os
from functools import cache
from pathlib import Path

from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.base import TypesysError
from rosbags.typesys.store import Typestore

from ..core.errors import RecordingError

OWN_PACKAGE = 'stickslip_msgs'
_OWN = Path(__file__).with_name(OWN_PACKAGE)


def definition(type_name: str) -> str:
    """Return the text that defines 'package/msg/Name', without what it depends on; raises RecordingError."""
    package, kind, name = type_name.split('/')
    files = [Path(prefix, 'share', package, kind, f'{name}.msg')
             for prefix in os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep) if prefix]
    if package == OWN_PACKAGE:
        files.append(_OWN / f'{name}.msg')
    for file in files:
        if file.is_file():
            return file.read_text(encoding='utf-8')
    try:
        text, _ = _types_of_ros().generate_msgdef(type_name, ros_version=2)
    except TypesysError:
        raise RecordingError(f'no definition of {type_name} in AMENT_PREFIX_PATH; source the setup.bash of the '
                             'workspace') from None
    return text.partition('=' * 80)[0]


@cache
def _types_of_ros() -> Typestore:
    return get_typestore(Stores.ROS2_JAZZY)
