# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the environment says to ROS, checked before ROS is: its libraries end the process on what they dislike."""

import os
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from ...core.errors import InputError

_MAX_DOMAIN = 232    # beyond, DDS has no UDP ports
_VARIABLES = ('ROS_DOMAIN_ID', 'ROS_STATIC_PEERS', 'ROS_AUTOMATIC_DISCOVERY_RANGE', 'ROS_DISCOVERY_SERVER',
              'RMW_IMPLEMENTATION', 'FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE', 'CYCLONEDDS_URI')


def check_environment() -> None:
    """Raise InputError when ROS could not start with the variables that are set."""
    domain = os.environ.get('ROS_DOMAIN_ID', '')
    if domain and not (domain.isdecimal() and int(domain) <= _MAX_DOMAIN):
        raise InputError('ROS_DOMAIN_ID', domain, f'a whole number from 0 to {_MAX_DOMAIN}', 'set another, or unset it')
    middleware = os.environ.get('RMW_IMPLEMENTATION', '')
    there = _middlewares()
    if middleware and there and middleware not in there:
        raise InputError('RMW_IMPLEMENTATION', middleware, f'installed: {", ".join(there)}',
                         'install it, set another, or unset it')


@contextmanager
def refusing(name: str, value: object, *others: type[Exception]) -> Iterator[None]:
    """Turn what ROS does not accept at the start, and `others`, into an InputError about `name`."""
    refused: tuple[type[Exception], ...] = (RuntimeError, *others)    # the base of nearly all that rclpy raises there
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore', RuntimeWarning)    # rclpy warns of what it could not take back then
            yield
    except refused as error:
        reason = re.sub(r',? at /\S+', '', str(error))
        raise InputError(name, value, 'accepted by ROS', reason) from None


def variables() -> str:
    """Return the variables that ROS looks at."""
    return ' '.join(f'{name}={value}' for name, value in sorted(os.environ.items()) if name in _VARIABLES)


def _middlewares() -> list[str]:
    """Return the names of those that are installed; raises InputError without a workspace."""
    try:
        from ament_index_python import get_resources
        return sorted(set(get_resources('rmw_typesupport')) - {'rmw_implementation'})
    except (ImportError, OSError):
        raise InputError('AMENT_PREFIX_PATH', os.environ.get('AMENT_PREFIX_PATH', ''), 'that of a ROS 2 workspace',
                         'source its setup.bash') from None
