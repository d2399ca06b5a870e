"""What goes into a controller: what is wanted, and what the two encoders of the axis say."""

from typing import NamedTuple


class Setpoint(NamedTuple):
    """Where the slider shall be, and how fast."""

    position: float  # m
    velocity: float  # m/s


class Measured(NamedTuple):
    """The slider as its scale measures it, and the drive end of the spring as the encoder of the drive does."""

    position: float        # m
    velocity: float        # m/s
    drive_position: float  # m
    drive_velocity: float  # m/s
