# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The CHANGELOG.rst of both packages, made from CHANGELOG.md, as bloom reads it (REP 132)."""

import re

from .files import ROOT

SOURCE = ROOT / 'CHANGELOG.md'
PACKAGES = 'stickslip_msgs', 'stickslip_sim'
_RELEASE = re.compile(r'^## (?:Unreleased|(\S+) - (\S+))$', re.MULTILINE)
_SUBJECT = re.compile(r'^### (.*)$', re.MULTILINE)
_LINK = re.compile(r'\[([^\]]+)\]\([^)\s]+\)')
_CODE = re.compile(r'\s*`[^`]+`\s*')
_CODE_OR_BOLD = re.compile(r'`[^`]+`|\*\*(?:`[^`]+`|[^*`])+\*\*')
_MARKUP = re.compile(r'(`[^`]+`|\*\*[^*`]+\*\*|^\* )', re.MULTILINE)
_READ_AS_MARKUP = re.compile(r'[\\*`|]|_(?!\w)')
_BEFORE, _AFTER = '\'"([{<-/: \n', '\'")]}>-/\\:.,;!? \n'    # what may stand beside markup


def changelog(package: str, markdown: str = '') -> str:
    """Return a package's changelog in reStructuredText; raises ValueError where the Markdown has no release."""
    _, *parts = _RELEASE.split(markdown or SOURCE.read_text(encoding='utf-8'))
    if not parts:
        raise ValueError(f'{SOURCE.name} has no heading "## X.Y.Z - YYYY-MM-DD"')
    title = f'Changelog for package {package}'
    rule = '^' * len(title)
    found = [f'{rule}\n{title}\n{rule}\n\n.. made by dev/changelog.py from {SOURCE.name}\n']
    for version, date, text in zip(parts[::3], parts[1::3], parts[2::3]):
        heading = f'{version} ({date})' if version else 'Forthcoming'
        found.append(f'{heading}\n{"-" * len(heading)}\n\n{rst(text.strip())}\n')
    return '\n'.join(found)


def rst(markdown: str) -> str:
    """Return the text of a release in reStructuredText: links become their text, and headings bold lines.

    catkin_pkg leaves out a section within that of a release, and the pages that links lead to are not in a package.
    """
    plain = _SUBJECT.sub(r'**\1**', _LINK.sub(r'\1', markdown))
    found, after_markup = '', False
    for part in filter(None, _MARKUP.split(_CODE_OR_BOLD.sub(_without_code_in_bold, plain))):
        is_markup = part[0] == '`' or part[:2] == '**'
        if (is_markup and found[-1:] not in _BEFORE) or (after_markup and part[0] not in _AFTER):
            found += '\\ '    # it separates, and is not seen
        found += f'`{part}`' if part[0] == '`' else part if is_markup or part == '* ' else _escaped(part)
        after_markup = is_markup
    return found


def _without_code_in_bold(match: re.Match[str]) -> str:
    """Return code as it is, and bold text with its code outside: RST nests none."""
    return match[0] if match[0][0] == '`' else _CODE.sub(r'**\g<0>**', match[0]).replace('****', '')


def _escaped(text: str) -> str:
    return _READ_AS_MARKUP.sub(r'\\\g<0>', text)
