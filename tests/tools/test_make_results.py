"""The page of results is made of what is in the work folder."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from types import SimpleNamespace

import pytest

import make_results
from airhilt.errors import AirhiltError
from airhilt.metrics.estimates import Estimate
from airhilt.sweep.evaluation.preset import Choice, Results, Row
from airhilt.sweep.evaluation.presets import FAMILY
from airhilt.sweep.evaluation.tables import Scatter, Table, number, share
from judge_encounters import CREWS, Counts
from results import record, sections
from results.page import IMAGES, Page
from results.record import Code
from results.sections import SECTIONS, ClosedLoop, PresetSection, Wanted

COMMIT = Code("a" * 40, is_dirty=False)
OTHER = Code("b" * 40, is_dirty=False)
RANKING = Table(
    name="ranking",
    title="Ranking",
    columns=("assistant", "given", "right", "time, s"),
    rows=(
        ("one", "all", share(Estimate(0.5, 0.2, 0.8, 8)), number(Estimate(7.66, 7.0, 8.0, 8), 2)),
        ("one", "asr", share(Estimate(1.0, 0.7, 1.0, 8)), number(Estimate(9.0, None, None, 1))),
    ),
    figure=Scatter(x="right", y="time, s"),
)
SECTION = PresetSection("paper")


def write_section(work: Path, name: str, tables: Sequence[Table], code: Code = COMMIT) -> None:
    """Write a section as if its runs had been made."""
    document = {
        "preset": name,
        "seeds": 3,
        "options": {"cameras": False},
        "sweeps": {"none": {"runs": 6, "rows": 6, "failed": 1, "table_sha256": "c0ffee"}},
        "tables": [table.model_dump(mode="json") for table in tables],
    }
    record.write_document(work / name, document)
    record.write_code(work / name, code)


def page_of(tmp_path: Path, text: str, shows_dirty: bool = False) -> str:
    """Return the pages of one section with a text."""
    texts = tmp_path / "texts"
    texts.mkdir(exist_ok=True)
    written = {"introduction": "{commit}\n\n{overview}", "paper": text, "rows": "{rows}"}
    for name, each in written.items():
        (texts / f"{name}.md").write_text(each)
    return "".join(Page.of([SECTION], tmp_path / "work", shows_dirty).texts(texts).values())


def flown(number: int, *_: object) -> list[Counts]:
    """Return an encounter with a near mid-air collision that no crews avoid, every second time."""
    close = number % 2
    counts = {"unassisted": close, "unresolved": close, "induced": 0, "alerts": 2, "reversals": 0}
    return [counts for _ in CREWS]


def flown_all(numbers: Iterable[int], *_: object) -> Iterator[list[Counts]]:
    return map(flown, numbers)


# --- the page ------------------------------------------------------------------------------------


def test_numbers_in_the_text_are_those_of_the_evaluation(tmp_path: Path) -> None:
    write_section(tmp_path / "work", "paper", [RANKING])
    text = page_of(
        tmp_path, "{paper.seeds} seeds: {paper.ranking.one, all.time, s} s\n\n{table paper.ranking}"
    )
    assert "3 seeds: 7.66 (7.00 to 8.00) s" in text
    assert RANKING.markdown().strip() in text
    assert f"All numbers are of commit `{COMMIT.commit}`" in text
    assert "| paper   | none  | 6    | 1      | `c0ffee`" in text


@pytest.mark.parametrize(
    "placeholder",
    [
        "paper.speed",
        "paper.ranking.two.right",
        "paper.ranking.one.right",
        "paper.ranking.one, all.left",
        "table paper.other",
        "figure paper.other",
        "nothing",
    ],
)
def test_a_placeholder_that_names_nothing_is_an_error_that_names_it(
    tmp_path: Path, placeholder: str
) -> None:
    write_section(tmp_path / "work", "paper", [RANKING])
    with pytest.raises(AirhiltError, match=rf"paper\.md: \{{{placeholder}\}} names nothing"):
        page_of(tmp_path, f"A {{{placeholder}}}.")


def test_a_note_that_tables_of_a_section_share_stands_under_the_first(tmp_path: Path) -> None:
    tables = [RANKING.model_copy(update={"name": name, "notes": ("Why.",)}) for name in "ab"]
    write_section(tmp_path / "work", "paper", tables)
    text = page_of(tmp_path, "{table paper.a}\n\n{table paper.b}")
    assert (text.count("Why."), text.count("| one ")) == (1, 4)


def test_what_was_not_run_is_named_as_missing(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    words = ["--page-only", "--work", str(tmp_path / "work"), "--page", str(page)]
    assert make_results.main(words) == 0
    assert "missing: its runs are not made" in page.read_text()
    text = (tmp_path / "results-paper.md").read_text()
    assert "**Missing: `comparison`, `variants`, `ranking`.** Its runs are not made" in text
    texts = [one.read_text() for one in tmp_path.glob("results-*.md")]
    assert len(texts) > len(SECTIONS)
    assert all("**Missing: " in each for each in texts)


def test_a_page_has_the_numbers_of_one_commit_unless_it_is_a_draft(tmp_path: Path) -> None:
    work = tmp_path / "work"
    write_section(work, "paper", [RANKING], Code(COMMIT.commit, is_dirty=True))
    assert "changes that were not committed: `python" in page_of(tmp_path, "{paper.seeds}")
    draft = page_of(tmp_path, "{paper.seeds}", shows_dirty=True)
    assert "**This page is a draft**" in draft
    assert f"of commit `{COMMIT.commit}` with changes that were not committed." in draft


def test_a_section_of_another_commit_is_missing(tmp_path: Path) -> None:
    work, page = tmp_path / "work", tmp_path / "page.md"
    write_section(work, "full", [], OTHER)
    made = json.loads((work / "full" / "code.json").read_text())
    (work / "full" / "code.json").write_text(json.dumps(made | {"made": "2000-01-01"}))
    write_section(work, "paper", preset_tables("paper"))
    Page.of(SECTIONS, work, shows_dirty=False).write(page)
    missing = (tmp_path / "results-full.md").read_text()
    assert "Its runs are of another commit, bbbbbbbb" in missing


def preset_tables(name: str) -> Sequence[Table]:
    """Return the tables of a preset that has no rows."""
    preset, choice = FAMILY.load(name), Choice(1, {"cameras": False})
    rows: dict[str, list[Row]] = {each: [] for each in preset.specifications(choice)}
    tables: Sequence[Table] = preset.tables(Results(choice, rows))
    return tables


def test_the_texts_name_what_the_sections_have_and_the_page_is_always_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sections, "closed_loop_counts", flown)
    monkeypatch.setattr(sections, "closed_loop_flights", flown_all)
    work, pages = tmp_path / "work", [tmp_path / "one" / "a.md", tmp_path / "two" / "a.md"]
    for section in SECTIONS:
        if isinstance(section, PresetSection):
            write_section(work, section.name, preset_tables(section.name))
    ClosedLoop().make(Wanted(work, COMMIT, encounters=4))
    flight = {"type": "737", "number": "climb_fpm", "flown": 2600.0}
    rows = [
        {**flight, "published": [2500.0, 3500.0, "assumed"]},
        {**flight, "published": [None, None, "published"]},
    ]
    published = sections.published_table(rows).model_dump(mode="json")
    record.write_document(work / "procedures", {"tables": [published]})
    for name in ("closed_loop", "procedures"):
        record.write_code(work / name, COMMIT)
    for page in pages:
        Page.of(SECTIONS, work, shows_dirty=False).write(page)
    one, two = (
        {path.name: path.read_text() for path in page.parent.glob("*.md")} for page in pages
    )
    assert one == two
    text = "".join(one.values())
    assert "Missing" not in text
    assert "| 737  | climb_fpm | 2500 to 3500 | assumed | 2600.0 |" in text
    assert "2 of 2 (34 to 100 %)" in text
    pictures = sorted((tmp_path / "one" / IMAGES).glob("*.svg"))
    assert [picture.stem for picture in pictures] == ["full_ranking", "roc_roc"]
    for picture in pictures:
        assert f"({IMAGES}/{picture.name})" in text
        assert (tmp_path / "two" / IMAGES / picture.name).read_bytes() == picture.read_bytes()


# --- the runs ------------------------------------------------------------------------------------


def test_changes_that_are_not_committed_are_refused_in_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "airhilt").mkdir()
    code = tmp_path / "airhilt" / "code.py"
    code.write_text("")
    who = ["-c", "user.name=a", "-c", "user.email=a@b"]
    for words in (["init", "-q"], ["add", "."], [*who, "commit", "-qm", "Begin"]):
        subprocess.run(["git", *words], cwd=tmp_path, check=True)
    monkeypatch.setattr(record, "ROOT", tmp_path)
    assert not record.current_code(allows_dirty=False).is_dirty
    code.write_text("changed = True\n")
    assert make_results.main(["--work", str(tmp_path / "work")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "airhilt/code.py: not committed" in line
    assert record.current_code(allows_dirty=True).is_dirty


def test_encounters_go_on_where_they_were_stopped_unless_the_code_has_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    numbers: list[int] = []

    def until_third(left: Iterable[int], *_: object) -> Iterator[list[Counts]]:
        for one in left:
            if len(numbers) == 2:
                raise KeyboardInterrupt
            yield from counted([one])

    def counted(left: Iterable[int], *_: object) -> Iterator[list[Counts]]:
        for one in left:
            numbers.append(one)
            yield flown(one)

    wanted = Wanted(tmp_path, COMMIT, encounters=4)
    monkeypatch.setattr(sections, "closed_loop_flights", until_third)
    with pytest.raises(KeyboardInterrupt):
        ClosedLoop().make(wanted)
    monkeypatch.setattr(sections, "closed_loop_flights", counted)
    assert ClosedLoop().make(wanted)
    assert numbers == [0, 1, 2, 3]
    ClosedLoop().make(Wanted(tmp_path, OTHER, encounters=2))
    assert numbers == [0, 1, 2, 3, 0, 1]


def test_twice_the_workers_take_half_the_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock_s = iter((0.0, 3.0, 10.0, 13.0))
    monkeypatch.setattr(sections, "closed_loop_counts", lambda *_: flown(0))
    monkeypatch.setattr(sections, "time", SimpleNamespace(monotonic=lambda: next(clock_s)))
    for workers, left_s in ((1, 12.0), (2, 6.0)):
        size = ClosedLoop().size(Wanted(tmp_path, COMMIT, encounters=4, workers=workers))
        assert (size.left, size.left_s) == (4, left_s)
