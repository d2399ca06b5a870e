# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The outcome as JUnit XML, which CI servers read: one test case for each limit."""

from collections.abc import Sequence
from xml.etree import ElementTree

from .check_report import Checked, line_of, real_time_verdict


def junit_text(runs: Sequence[Checked]) -> str:
    """Return the file, valid against the schema of Jenkins: a suite for each run, with the name of what was checked.

    The verdict on its timing, if there is one, is a property of the suite.
    """
    suites = [_suite(checked) for checked in runs]
    root = suites[0] if len(suites) == 1 else ElementTree.Element('testsuites')
    root.extend(suites if len(suites) > 1 else ())
    ElementTree.indent(root)
    document: bytes = ElementTree.tostring(root, encoding='utf-8', xml_declaration=True)
    return document.decode() + '\n'


def _suite(checked: Checked) -> ElementTree.Element:
    name, run, outcomes = checked
    failed = sum(not outcome.passed for outcome in outcomes)
    suite = ElementTree.Element('testsuite', name=name, tests=str(len(outcomes)), failures=str(failed), errors='0')
    if verdict := real_time_verdict(run):
        properties = ElementTree.SubElement(suite, 'properties')
        ElementTree.SubElement(properties, 'property', name='real time', value=verdict)
    for outcome in outcomes:
        case = ElementTree.SubElement(suite, 'testcase', name=outcome.name, classname=f'stickslip.check.{name}')
        if outcome.passed:
            ElementTree.SubElement(case, 'system-out').text = line_of(outcome)
        else:
            failure = ElementTree.SubElement(case, 'failure', type='limit', message=line_of(outcome))
            failure.text = line_of(outcome)
    return suite
