"""A browser for the tests of pages; without one they are skipped."""

from __future__ import annotations

import shutil
from collections.abc import Iterator

import pytest

from devtools import BROWSERS, Page, browser_page


@pytest.fixture(scope="module")
def browser() -> Iterator[Page]:
    executable = next((found for name in BROWSERS if (found := shutil.which(name))), None)
    if executable is None:
        pytest.skip("no Chromium on PATH: apt-get install chromium")
    with browser_page(executable) as page:
        yield page


@pytest.fixture
def page(browser: Page) -> Iterator[Page]:
    """A page that must have nothing to complain of."""
    browser.complaints.clear()
    yield browser
    assert browser.complaints == []
