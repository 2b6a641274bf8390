"""The wishes of a person, until the station has heard them."""

from __future__ import annotations

import pytest

from devtools import Page
from stations import seat_page

pytestmark = pytest.mark.browser
LOST = """import(new URL('page/wishes.js', location)).then(({ Wishes }) => {
    const told = [], sent = [];
    const wishes = new Wishes((message) => sent.push(message) > 0);
    const wish = (name) => wishes.send({ say: name },
        { heard: () => told.push(`${name} heard`), lost: () => told.push(`${name} lost`) });
    wish('at the former seat');
    %s
    wish('at the own seat');
    wishes.lost();
    return told;
})"""


@pytest.mark.parametrize(
    ("meanwhile", "told"),
    [
        ("", ["at the own seat lost", "at the former seat lost"]),
        ("wishes.forget();", ["at the own seat lost"]),
        ("wishes.answered(sent[1].echo);", ["at the former seat heard", "at the own seat lost"]),
    ],
    ids=["the seat is the same", "the seat is another one", "the wish was heard"],
)
def test_a_wish_of_a_seat_that_was_left_is_not_given_back_at_another_one(
    page: Page, meanwhile: str, told: list[str]
) -> None:
    with seat_page() as (_, url):
        page.open(url)
        assert page.evaluate(LOST % meanwhile) == told
        page.open("about:blank")
