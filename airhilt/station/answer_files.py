"""The answers of a participant to questionnaires, each in a file."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from airhilt.errors import RunFolderError, StationError, first_problem
from airhilt.host.files import make_folder, read_inside, replace_file
from airhilt.messages import NasaTlx
from airhilt.record import RunFolder
from airhilt.station.file_cache import FileCache
from airhilt.station.questionnaires import NASA_TLX, Answers, Questionnaire

LARGEST_ANSWERS_BYTES = 100_000
"""Size of the largest file with answers that is read."""
KEPT_ANSWERS = TypeAdapter(Answers)


class AnswerFiles:
    """Reads and writes what a participant has answered.

    Parameters
    ----------
    runs
        Folder of the run folders of the participant, or of the team.
    folder
        Folder of the answers: the same, or one in it.
    number
        Place of the participant among the people at the seats of a run.
    """

    def __init__(self, runs: Path, folder: Path, number: int) -> None:
        self._runs = runs
        self._folder = folder
        self._number = number
        self._kept = FileCache[Answers | None]()

    def read(self, questionnaire: Questionnaire, run: str = "") -> Answers | None:
        """Return what was answered, None if nothing was yet.

        Parameters
        ----------
        run
            Name of the run folder of a trial after which it is asked; empty: it is not asked after
            a trial.

        Raises
        ------
        RunFolderError
            The file of the answers cannot be read, or has an answer that the item does not take. An
            item without an answer is none: it may have come into the plan later.
        """
        read = partial(self._read, questionnaire, run)
        rated = RunFolder(self._runs / run).summary_path
        return self._kept.get(read, self._path(questionnaire, run), rated)

    def _read(self, questionnaire: Questionnaire, run: str) -> Answers | None:
        path = self._path(questionnaire, run)
        try:
            found = KEPT_ANSWERS.validate_json(read_inside(self._runs, path, LARGEST_ANSWERS_BYTES))
            asked = [item for item in questionnaire.items if item.name in found]
            for item in asked:
                item.check(found[item.name])
        except FileNotFoundError:
            return self._rated_at_seat(run) if questionnaire == NASA_TLX else None
        except OSError as error:
            raise _no_answers(path, str(error.strerror)) from None
        except ValidationError as error:
            raise _no_answers(path, first_problem(error)) from None
        except ValueError as error:
            raise _no_answers(path, str(error)) from None
        return {item.name: found[item.name] for item in asked}

    def _rated_at_seat(self, run: str) -> Answers | None:
        """Return the NASA-TLX ratings that were given at the seat, None if there are none.

        Raises
        ------
        RunFolderError
            The summary of the run cannot be read.
        """
        summary = RunFolder(self._runs / run).summary() or {}
        try:
            person = summary["people"][self._number]  # A finished run has the seats of the plan.
            return NasaTlx.model_validate(person["workload"]["nasa_tlx"]).model_dump()
        except (ValueError, LookupError, TypeError):
            return None

    def write(self, questionnaire: Questionnaire, answers: Answers, run: str = "") -> None:
        """Keep what was answered.

        Raises
        ------
        StationError
            The answers are not those that the questionnaire takes, or cannot be written.
        """
        path = self._path(questionnaire, run)
        try:
            questionnaire.check(answers)
            make_folder(path.parent)
            replace_file(path, json.dumps(answers, indent=2).encode())
        except ValueError as error:
            raise StationError(str(error)) from None
        except OSError as error:
            raise StationError(f"{path}: cannot be written: {error.strerror}") from None

    def _path(self, questionnaire: Questionnaire, run: str) -> Path:
        return self._folder / ".".join(filter(None, (run, questionnaire.name, "json")))


def _no_answers(path: Path, problem: str) -> RunFolderError:
    return RunFolderError(
        f"{path}: {problem}; expected answers to the questions of the plan, as the page writes "
        "them; move the file away to ask again"
    )
