# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The list of words that are not written: what it finds, and that the repository has none of them."""

import pytest

from dev.words import Fault, all_faults, faults, name_faults, rules

LISTED = rules([
    {'write': 'periodic report', 'not': ['second reports?']},
    {'write': 'input profile', 'not': ['courses?'], 'but': [r'drive\.course']},
    {'write': 'that is', 'not': [r'i\.e\.'], 'only': 'pages'},
    {'write': 'check', 'not': ['judges?'], 'right': ['tests/judges/']},
])


def test_the_repository_has_none() -> None:
    """As `make check` looks."""
    assert [f'{file}:{fault.line}: {fault.word}' for file, fault in all_faults()] == []


@pytest.mark.parametrize('text', ['the second report', 'from .second_report import', 'class SecondReports:',
                                  'Second reports'])
def test_names_are_read_as_the_words_in_them(text: str) -> None:
    assert [fault.write for fault in faults(text, LISTED)] == ['periodic report']


@pytest.mark.parametrize('file', ['second_report.py', 'second_reports/one.py', 'pictures/second_report.svg'])
def test_names_of_files_are_read_too(file: str) -> None:
    assert [fault.line for fault in name_faults(file, LISTED)] == [0]


def test_where_and_what() -> None:
    assert list(faults('a\nb i.e. c\n', LISTED)) == [Fault(2, 'i.e.', 'that is')]


@pytest.mark.parametrize('text', ['recourse', 'the seconds report', 'drive.course: a course', ''])
def test_parts_of_words_and_other_meanings_are_right(text: str) -> None:
    assert list(faults(text, LISTED)) == []


def test_another_meaning_is_one_of_its_line() -> None:
    assert [fault.line for fault in faults('drive.course\ncourse', LISTED)] == [2]


def test_a_word_may_be_right_in_some_files() -> None:
    assert list(faults('a judge', LISTED, 'tests/judges/one.py')) == []
    assert [fault.word for fault in faults('a judge', LISTED, 'tests/one.py')] == ['judge']


def test_an_entry_with_an_unknown_key_is_refused() -> None:
    with pytest.raises(ValueError, match='unknown: instead'):
        rules([{'write': 'a', 'not': ['b'], 'instead': 'c'}])


def test_an_entry_in_capitals_is_refused() -> None:
    """Texts are searched in lower case, so that it would find nothing."""
    with pytest.raises(ValueError, match='in lower case'):
        rules([{'write': 'a', 'not': ['Stribeck limit']}])


def test_a_line_has_all_its_faults() -> None:
    assert [(fault.line, fault.word) for fault in faults('a\nThe COURSE of secondReports\n', LISTED)] == [
        (2, 'second Reports'), (2, 'COURSE')]
