# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the environment says to ROS, checked before ROS is: its libraries end the process on what they dislike."""

import os
import re
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from ..core.errors import InputError, RefusedError

_MAX_DOMAIN = 232    # beyond, DDS has no UDP ports
_VARIABLES = ('ROS_DOMAIN_ID', 'ROS_STATIC_PEERS', 'ROS_AUTOMATIC_DISCOVERY_RANGE', 'ROS_DISCOVERY_SERVER',
              'RMW_IMPLEMENTATION', 'FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE', 'CYCLONEDDS_URI')
_SECURITY = 'ROS_SECURITY_'
_ENABLE, _STRATEGY, _KEYSTORE = (_SECURITY + word for word in ('ENABLE', 'STRATEGY', 'KEYSTORE'))


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
    _check_security()


def answer_of_node(service: str, request: Mapping[str, object], node: str, patience: float, duration: float = 0.0
                   ) -> Any:
    """Return the answer of a node, as `service_call.answer_of` does, in an environment and workspace that are right.

    Raises RefusedError when the node refuses.
    """
    check_environment()
    try:
        from .service_call import answer_of
    except ImportError as error:
        raise InputError('AMENT_PREFIX_PATH', os.environ.get('AMENT_PREFIX_PATH', ''),
                         f'that of a workspace with {error.name}', 'source its setup.bash') from None
    answer = answer_of(service, request, node, patience, duration)
    result = getattr(answer, 'result', None)    # of parameters that were set
    if not (result.successful if result else answer.success):
        raise RefusedError(result.reason if result else answer.message)
    return answer


def _check_security() -> None:
    """Raise InputError where ROS would run without the security that was meant: any other word is none for it."""
    enable, strategy = os.environ.get(_ENABLE, ''), os.environ.get(_STRATEGY, '')
    if enable not in ('', 'true', 'false'):
        raise InputError(_ENABLE, enable, 'true or false', 'ROS runs without security with any other word')
    if not _is_secure():
        return
    if strategy not in ('', 'Enforce', 'Permissive'):
        raise InputError(_STRATEGY, strategy, 'Enforce or Permissive', 'ROS is permissive with any other word')
    keystore = os.environ.get(_KEYSTORE, '')
    if strategy == 'Enforce' and not os.path.isdir(keystore):
        raise InputError(_KEYSTORE, keystore, 'the folder of the keys',
                         'make it with ros2 security create_keystore (docs/security.md)')


def _is_secure() -> bool:
    return os.environ.get(_ENABLE) == 'true'


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
        if _is_secure() and 'security' in reason.lower():
            raise InputError(_ENABLE, 'true', 'possible with the middleware, the keystore and the enclave',
                             f'{reason}; set: {variables(_SECURITY)}') from None
        raise InputError(name, value, 'accepted by ROS', reason) from None


def variables(*beginnings: str) -> str:
    """Return the variables that ROS looks at, or those with such a beginning."""
    return ' '.join(f'{name}={value}' for name, value in sorted(os.environ.items())
                    if name.startswith(beginnings or (*_VARIABLES, _SECURITY)))


def _middlewares() -> list[str]:
    """Return the names of those that are installed; raises InputError without a workspace."""
    try:
        from ament_index_python import get_resources
        return sorted(set(get_resources('rmw_typesupport')) - {'rmw_implementation'})
    except (ImportError, OSError):
        raise InputError('AMENT_PREFIX_PATH', os.environ.get('AMENT_PREFIX_PATH', ''), 'that of a ROS 2 workspace',
                         'source its setup.bash') from None
