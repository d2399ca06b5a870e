# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The outcome as JUnit XML, which CI servers read: one test case for each limit."""

from collections.abc import Sequence
from xml.etree import ElementTree

from .check_report import line_of
from .judgement import LimitOutcome


def junit_text(name: str, outcomes: Sequence[LimitOutcome], verdict: str = '') -> str:
    """Return the file, valid against the schema of Jenkins; the suite has the name of what was checked.

    The verdict on its timing, if there is one, is a property of the suite.
    """
    failed = sum(not outcome.passed for outcome in outcomes)
    suite = ElementTree.Element('testsuite', name=name, tests=str(len(outcomes)), failures=str(failed), errors='0')
    if verdict:
        properties = ElementTree.SubElement(suite, 'properties')
        ElementTree.SubElement(properties, 'property', name='real time', value=verdict)
    for outcome in outcomes:
        case = ElementTree.SubElement(suite, 'testcase', name=outcome.name, classname=f'stickslip.check.{name}')
        if outcome.passed:
            ElementTree.SubElement(case, 'system-out').text = line_of(outcome)
        else:
            failure = ElementTree.SubElement(case, 'failure', type='limit', message=line_of(outcome))
            failure.text = line_of(outcome)
    ElementTree.indent(suite)
    document: bytes = ElementTree.tostring(suite, encoding='utf-8', xml_declaration=True)
    return document.decode() + '\n'
