"""The radio that the options of a run ask for."""

from __future__ import annotations

from pydantic import ValidationError

from airhilt.errors import AirhiltError, first_problem
from airhilt.options import Options
from airhilt.scenario import Scenario
from airhilt.scenario.models import Radio


def with_requested_radio(options: Options, scenario: Scenario) -> Scenario:
    """Return a scenario with those settings of its radio that the options give.

    Raises
    ------
    AirhiltError
        The radio cannot have them.
    """
    given = {
        "snr_db": options.snr_db,
        "profile": options.radio_profile,
        "topology": options.topology,
    }
    changes = {name: value for name, value in given.items() if value is not None}
    if not changes:
        return scenario
    try:
        radio = Radio.model_validate(scenario.radio.model_dump() | changes)
    except ValidationError as error:
        raise AirhiltError(f"radio: {first_problem(error)}") from None
    return scenario.model_copy(update={"radio": radio})
