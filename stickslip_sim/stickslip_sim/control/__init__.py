"""Controllers of the drive: cascade, compensation of friction, and the moves that they follow.  Pure; knows no ROS."""

from .cascade import Cascade
from .controller import AT_REST, Command, Controller, Memory
from .friction_branches import BranchCompensation, Slide
from .moves import Moves
from .signals import Measured, Setpoint

__all__ = [
    'AT_REST', 'BranchCompensation', 'Cascade', 'Command', 'Controller', 'Measured', 'Memory', 'Moves', 'Setpoint',
    'Slide',
]
