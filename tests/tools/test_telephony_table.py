"""The table of operators is compared with the page of the FAA."""

from __future__ import annotations

from telephony_table import published

PAGE = """
<table><tr><th>3-Ltr</th><th>Company</th><th>Country</th><th>Telephony</th></tr>
<tr><td>RPA</td><td>REPUBLIC AIRLINES, INC.</td><td>UNITED STATES</td><td>BRICKYARD</td></tr>
<tr><td>AAV</td><td>ASTRO AIR</td><td>PHILIPPINES</td><td>ASTRO-PHIL</td></tr>
<tr><td>AAU</td><td>AEROPA S.R.L.</td><td>ITALY</td><td></td></tr>
<tr><td>...</td><td>NOBODY</td><td>ITALY</td><td>NONE</td></tr></table>
"""


def test_operators_with_a_telephony_designator_are_read_from_the_page() -> None:
    told = {designator: row["telephony"] for designator, row in published(PAGE).items()}
    assert told == {"RPA": "brickyard", "AAV": "astro phil"}
