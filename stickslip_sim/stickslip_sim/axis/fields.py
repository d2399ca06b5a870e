# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The fields of a record: numbers, records within it, and rows of either.

Every number is a float, modes, kinds, flags and counts too: a record is one row of numbers in memory, which a
checkpoint writes down as it stands, in the order of the fields.  The records serve plain Python; the compiled unit has
its own of the same names, fields and order, made from the files that use this one.
"""

from collections.abc import Iterable, Iterator
from dataclasses import fields
from typing import Any, NamedTuple


class RowOf(NamedTuple):
    """What annotates a field with so many numbers, or records, in a row."""

    length: int
    record: type[Any] | None = None


class RecordField(NamedTuple):
    """A field of a record: a number, another record, or so many of them in a row."""

    name: str
    record: type[Any] | None = None
    length: int = 0

    def value(self, numbers: Iterator[float]) -> Any:
        """Return the next value."""
        return [self._one(numbers) for _ in range(self.length)] if self.length else self._one(numbers)

    def _one(self, numbers: Iterator[float]) -> Any:
        return filled(self.record, numbers) if self.record else next(numbers)


def record_fields(record: type[Any]) -> Iterator[RecordField]:
    """Yield the fields that hold numbers, in order; a list whose length is not declared is none of them."""
    for one in fields(record):
        row = getattr(one.type, '__metadata__', (None,))[0]
        if row is not None:
            yield RecordField(one.name, row.record, row.length)
        elif one.type is float:
            yield RecordField(one.name)
        elif isinstance(one.type, type):
            yield RecordField(one.name, one.type)


def names_of(record: type[Any]) -> tuple[str, ...]:
    """Return the names of the numbers that a record itself has, in order."""
    return tuple(one.name for one in record_fields(record) if one.record is None and not one.length)


def places_of(record: type[Any]) -> tuple[str, ...]:
    """Return where each number of a record is, in order: `velocity`, `account.sums.drive`, `cache.last[2]`."""
    return tuple(_places(record))


def filled(record: type[Any], numbers: Iterator[float]) -> Any:
    """Return a record with the next numbers."""
    return record(*(one.value(numbers) for one in record_fields(record)))


def flat(record: Any) -> tuple[float, ...]:
    """Return the numbers of a record that has nothing else."""
    return tuple(getattr(record, name) for name in record.__slots__)


def numbers_in(values: Iterable[Any]) -> Iterator[float]:
    """Yield the numbers of numbers, records and lists of them."""
    for value in values:
        if isinstance(value, list):
            yield from numbers_in(value)
        elif isinstance(value, (float, int)):
            yield value
        else:
            yield from numbers_in(getattr(value, one.name) for one in record_fields(type(value)))


def zeros() -> Iterator[float]:
    """Yield zeros without an end."""
    while True:
        yield 0.0


def _places(record: type[Any]) -> Iterator[str]:
    for one in record_fields(record):
        for name in [f'{one.name}[{i}]' for i in range(one.length)] or [one.name]:
            yield from (f'{name}.{inner}' for inner in _places(one.record)) if one.record else (name,)
