# cython: language_level=3
# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The end of a process whose interpreter is kept: by a thread that does not need it."""

from libc.signal cimport raise_
from libc.string cimport strlen
from posix.unistd cimport _exit, usleep, write

DEF SLICE = 100_000   # us

cdef class Watch:
    """Ends the process when nothing `beat` for a time, with `text` on standard error and an exit code.

    The time is counted in slices in which the process ran: it may be stopped, and the machine asleep.
    """

    cdef bytes text
    cdef const char* words
    cdef volatile long beats
    cdef volatile int code
    cdef volatile bint is_over

    def say(self, bytes text, int code):
        """Have it end with this text and exit code from now on."""
        self.words, self.code = text, code
        self.text = text    # kept as long as its characters are

    def beat(self):
        """Let the time begin anew."""
        self.beats += 1

    def end(self):
        """Look no more."""
        self.is_over = True

    def look(self, double patience, int number):
        """Look for `patience` seconds without a beat; then write the text, raise a signal, end.  Returns after `end`."""
        cdef long seen = -1, slices = 0, limit = <long>(patience * 1_000_000 / SLICE)
        with nogil:
            while slices < limit and not self.is_over:
                usleep(SLICE)
                slices = slices + 1 if self.beats == seen else 0
                seen = self.beats
            if not self.is_over:
                write(2, self.words, strlen(self.words))
                raise_(number)
                _exit(self.code)
