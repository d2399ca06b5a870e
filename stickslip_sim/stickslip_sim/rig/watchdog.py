"""Notices that commands stop coming."""


class Watchdog:
    """Watches from the first command on; `timeout` in the unit of the clock it is asked with, 0: never."""

    def __init__(self, timeout: float) -> None:
        self._timeout = timeout
        self.forget()

    def forget(self) -> None:
        """Begin anew, as if no command had come."""
        self._heard, self._since, self._is_stale = 0, 0.0, False

    def wait_from(self, now: float) -> None:
        """Measure silence from now on, as after a pause."""
        self._since = now

    def silence(self, heard: int, now: float) -> float:
        """Return how long nothing came when that has just become too long, else 0; `heard` counts the commands."""
        if not self._timeout:
            return 0.0
        if heard != self._heard:
            self._heard, self._since, self._is_stale = heard, now, False
        elif heard and not self._is_stale and now - self._since > self._timeout:
            self._is_stale = True
            return now - self._since
        return 0.0
