"""How long to simulate when nobody says: until the cycles repeat often enough."""

from ..offline import run_offline
from ..scene import Scene

_CYCLES = 20
_SHORTEST, _LONGEST = 10.0, 320.0   # s


def default_duration(scene: Scene) -> float:
    """Return 10 s, doubled up to 320 s while there are fewer than 20 cycles; 10 s if there are none at all."""
    duration = _SHORTEST
    while True:
        cycles = run_offline(scene, duration).summary.cycles
        if cycles >= _CYCLES:
            return duration
        if duration >= _LONGEST:
            return _LONGEST if cycles else _SHORTEST
        duration *= 2.0
