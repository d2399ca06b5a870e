"""What the environment says to ROS, checked before ROS is: its libraries end the process on what they dislike."""

import os

from ament_index_python import get_resources

from ..errors import InputError

_MAX_DOMAIN = 232    # beyond, DDS has no UDP ports


def check_environment() -> None:
    """Raise InputError when ROS could not start with the variables that are set."""
    domain = os.environ.get('ROS_DOMAIN_ID', '')
    if domain and not (domain.isdecimal() and int(domain) <= _MAX_DOMAIN):
        raise InputError('ROS_DOMAIN_ID', domain, f'a whole number from 0 to {_MAX_DOMAIN}', 'set another, or unset it')
    middleware = os.environ.get('RMW_IMPLEMENTATION', '')
    there = sorted(set(get_resources('rmw_typesupport')) - {'rmw_implementation'})
    if middleware and there and middleware not in there:
        raise InputError('RMW_IMPLEMENTATION', middleware, f'installed: {", ".join(there)}',
                         'install it, set another, or unset it')
