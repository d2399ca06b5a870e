"""The fields of our messages, from the words of the simulation; stamps in ns."""

from .. import __version__
from ..words import Event, Sample
from .run import RunFacts

Fields = dict[str, object]


def time_message(nanoseconds: int) -> Fields:
    """Return the fields of builtin_interfaces/Time."""
    sec, nanosec = divmod(nanoseconds, 1_000_000_000)
    return {'sec': sec, 'nanosec': nanosec}


def header(stamp_ns: int) -> Fields:
    """Return the fields of std_msgs/Header, without a frame."""
    return {'stamp': time_message(stamp_ns), 'frame_id': ''}


def slider_state(step: int, sample: Sample, stamp_ns: int) -> Fields:
    """Return the fields of SliderState at the end of a step."""
    return {
        'header': header(stamp_ns),
        'step': step,
        'time': sample.time,
        'position': sample.position,
        'velocity': sample.velocity,
        'acceleration': sample.acceleration,
        'drive_position': sample.drive_position,
        'drive_velocity': sample.drive_velocity,
        'drive_force': sample.drive_force,
        'rest_time': sample.rest_time,
        'mode': int(sample.mode),
        'direction': sample.direction,
    }


def friction_force(step: int, sample: Sample, stamp_ns: int) -> Fields:
    """Return the fields of FrictionForce at the end of a step."""
    return {
        'header': header(stamp_ns),
        'step': step,
        'time': sample.time,
        'force': sample.friction_force,
        'coefficient': sample.friction_coefficient,
        'contact_deflection': sample.contact_deflection,
        'mode': int(sample.mode),
        'direction': sample.direction,
    }


def mode_event(step: int, event: Event, stamp_ns: int) -> Fields:
    """Return the fields of ModeEvent."""
    return {
        'header': header(stamp_ns),
        'step': step,
        'time': event.time,
        'kind': int(event.kind),
        'mode': int(event.mode),
        'direction': event.direction,
        'position': event.position,
        'velocity': event.velocity,
        'drive_force': event.drive_force,
        'friction_force': event.friction_force,
        'static_coefficient': event.static_coefficient,
        'rest_time': event.rest_time,
    }


def drive_velocity(velocity: float, stamp_ns: int) -> Fields:
    """Return the fields of DriveVelocity."""
    return {'header': header(stamp_ns), 'velocity': velocity}


def external_force(force: float, stamp_ns: int) -> Fields:
    """Return the fields of ExternalForce."""
    return {'header': header(stamp_ns), 'force': force}


def run_info(facts: RunFacts, stamp_ns: int, start_ns: int, bag_path: str) -> Fields:
    """Return the fields of RunInfo; `start_ns` is the stamp of simulation time 0."""
    return {
        'header': header(stamp_ns),
        'version': __version__,
        'scene': facts.scene,
        'scene_hash': facts.scene_hash,
        'solver': facts.solver,
        'seed': facts.seed,
        'bag_path': bag_path,
        'rate': facts.rate,
        'start_time': time_message(start_ns),
    }
