# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The schematic of the axis, with the directions in which motions and forces count positive, and its three contacts."""

from .svg import BLUE, GREY, INK, PALE, RED, Point, Sheet, Style

_GROUND = 230.0
_CONTACT = Style(16.0)
_FORCE = Style(20.0, color=RED)
_MOTION = Style(20.0, color=BLUE)
_NOTE = Style(15.0, color=GREY)


def picture() -> Sheet:
    """Return the picture."""
    sheet = Sheet(1000, 632, 'A slider on a slideway, driven through a spring and a damper')
    _ground(sheet, (40, _GROUND), 920)
    _drive(sheet)
    _coupling(sheet)
    _slider(sheet)
    _coordinates(sheet)
    _equations(sheet)
    _rigid(sheet, 30)
    _compliant(sheet, 350)
    _slip(sheet, 670)
    return sheet


def _drive(sheet: Sheet) -> None:
    for x in (78, 122):
        sheet.circle((x, _GROUND - 9), 9)
    sheet.rect((55, 110), (90, 102), fill=PALE)
    sheet.text((100, 166), 'drive', Style(17.0, 'middle'))
    sheet.arrow((70, 85), (150, 85), color=BLUE, width=3)
    sheet.text((70, 70), '$v(t)$', _MOTION)


def _coupling(sheet: Sheet) -> None:
    sheet.line((145, 161), (190, 161))
    sheet.line((190, 130), (190, 192))
    _spring(sheet, (190, 130), 300)
    _damper(sheet, (190, 192), 300)
    sheet.line((490, 130), (490, 192))
    sheet.line((490, 161), (530, 161))
    sheet.text((340, 106), 'spring $c$', Style(17.0, 'middle'))
    sheet.text((300, 172), 'damper $h$', Style(17.0, 'end'))


def _slider(sheet: Sheet) -> None:
    sheet.rect((530, 100), (200, _GROUND - 100), fill=PALE)
    sheet.text((655, 145), 'slider $m$', Style(17.0, 'middle'))
    sheet.arrow((630, 20), (630, 98), color=RED, width=3)
    sheet.text((644, 40), '$N$', _FORCE)
    sheet.text((666, 40), 'normal force', _NOTE)
    sheet.arrow((530, 178), (610, 178), color=RED, width=3)
    sheet.text((620, 184), '$F_d$', _FORCE)
    sheet.arrow((732, 145), (812, 145), color=RED, width=3)
    sheet.text((822, 151), '$F_e$', _FORCE)
    sheet.text((848, 151), 'external force', _NOTE)
    sheet.arrow((812, 216), (732, 216), color=RED, width=3)
    sheet.text((822, 220), '$F$', _FORCE)
    sheet.text((848, 220), 'from slideway', _NOTE)
    sheet.text((640, _GROUND + 36), 'slideway', _NOTE)


def _coordinates(sheet: Sheet) -> None:
    """Measure s and x from where the spring is unstretched at the start."""
    for zero, end, words in ((95, 145, '$s = s_0 + ∫ v dt$'), (480, 530, '$x$, $ẋ$, $ẍ$')):
        sheet.line((zero, 270), (zero, 302), color=BLUE, dashes='4 4')
        sheet.line((end, 214 if end < 500 else _GROUND), (end, 302), color=BLUE, dashes='4 4')
        sheet.arrow((zero, 290), (end, 290), color=BLUE)
        sheet.text((end + 14, 296), words, _MOTION)
    sheet.arrow((740, 290), (850, 290), color=BLUE, width=3)
    sheet.text((860, 297), '$+x$', _MOTION)
    sheet.text((740, 318), 'motions count positive this way', Style(13.0, color=GREY))


def _equations(sheet: Sheet) -> None:
    sheet.text((330, 360), '$m ẍ = F_d + F_e − F$', Style(22.0, 'middle'))
    sheet.text((680, 360), '$F_d = c (s − x) + h (v − ẋ)$', Style(22.0, 'middle'))
    sheet.text((500, 390), 'Forces count positive as drawn: $F_d$ and $F_e$ push the slider to the right, '
               '$F$ holds it back, to the left.', Style(16.0, 'middle'))


def _rigid(sheet: Sheet, x: float) -> None:
    _panel(sheet, x, 'Stick, rigid contact', (
        '$ẋ = 0$,   $F = F_d + F_e$', 'breaks away when $|F|$ reaches $N μ_s(t⁻)$'))
    _small_slider(sheet, x + 90)
    for tooth in range(6):
        left = x + 95 + 20 * tooth
        sheet.line((left, 518), (left + 5, 526), (left + 10, 518))


def _compliant(sheet: Sheet, x: float) -> None:
    _panel(sheet, x, 'Stick, compliant contact', (
        '$F = F_c = c_c δ + h_c ẋ$,   $δ\u0307 = ẋ$', 'breaks away when $|F_c|$ reaches $N μ_s(t⁻)$'))
    _small_slider(sheet, x + 40, 488)
    sheet.line((x + 60, 488), (x + 60, 520))
    _spring(sheet, (x + 60, 498), 130, 5)
    _damper(sheet, (x + 60, 518), 130, 5)
    sheet.line((x + 190, 492), (x + 190, 528), width=3)
    sheet.text((x + 200, 497), '$c_c$', _CONTACT)
    sheet.text((x + 200, 519), '$h_c$', _CONTACT)
    sheet.arrow((x + 165, 464), (x + 205, 464), color=BLUE)
    sheet.text((x + 212, 469), '$δ$', _MOTION)


def _slip(sheet: Sheet, x: float) -> None:
    _panel(sheet, x, 'Slip', (
        '$F = F_f$ opposes $ẋ$,   $|F_f| = N μ_k(|ẋ|)$', 'or more while accelerating; sticks at $ẋ = 0$'))
    _small_slider(sheet, x + 90)
    sheet.arrow((x + 215, 478), (x + 255, 478), color=BLUE, width=3)
    sheet.text((x + 262, 484), '$ẋ$', _MOTION)
    sheet.arrow((x + 255, 509), (x + 215, 509), color=RED, width=3)
    sheet.text((x + 262, 514), '$F_f$', _FORCE)


def _panel(sheet: Sheet, x: float, title: str, lines: tuple[str, str]) -> None:
    sheet.rect((x, 415), (300, 200), stroke='#bbbbbb', radius=8)
    sheet.text((x + 150, 442), title, Style(17.0, 'middle', weight='bold'))
    _ground(sheet, (x + 30, 528), 240)
    for i, line in enumerate(lines):
        sheet.text((x + 150, 572 + 26 * i), line, Style(13.0, 'middle'))


def _small_slider(sheet: Sheet, x: float, bottom: float = 528) -> None:
    sheet.rect((x, 460), (120, bottom - 460), fill=PALE)


def _ground(sheet: Sheet, start: Point, length: float) -> None:
    x, y = start
    sheet.line(start, (x + length, y), width=2.5)
    for step in range(int(length / 20)):
        left = x + 20 * step + 6
        sheet.line((left + 8, y + 1), (left, y + 11), color=GREY, width=1)


def _spring(sheet: Sheet, start: Point, length: float, height: float = 12) -> None:
    """Draw a zigzag with straight ends."""
    x, y = start
    lead, turns = 0.15 * length, 6
    pitch = (length - 2 * lead) / turns
    zigzag = [(x + lead + pitch * (i + share), y + side * height)
              for i in range(turns) for share, side in ((0.25, -1), (0.75, 1))]
    sheet.line(start, (x + lead, y), *zigzag, (x + length - lead, y), (x + length, y))


def _damper(sheet: Sheet, start: Point, length: float, height: float = 12) -> None:
    """Draw a pot, open to the right, and a piston in it."""
    x, y = start
    left, piston, right = x + 0.42 * length, x + 0.5 * length, x + 0.58 * length
    sheet.line(start, (left, y))
    sheet.line((right, y - height), (left, y - height), (left, y + height), (right, y + height))
    sheet.line((piston, y - 0.7 * height), (piston, y + 0.7 * height), width=3, color=INK)
    sheet.line((piston, y), (x + length, y))
