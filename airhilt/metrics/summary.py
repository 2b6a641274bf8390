"""``summary.json``: the scores of a run, and the meaning of each field."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from airhilt.messages import ModalityState, NasaTlx, Severity
from airhilt.world.truth.runways import IncursionCategory

ConflictOutcome = Literal["avoided", "avoided_by_equipment", "lost", "missed", "no_conflict"]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True)


class LatencyStatistics(_Part):
    """Latencies of one stage, in s of simulation time."""

    n: int = Field(description="number of samples")
    min_s: float | None = Field(default=None, description="shortest")
    p50_s: float | None = Field(description="median")
    p95_s: float | None = Field(description="95th percentile")
    max_s: float | None = Field(description="longest")

    @classmethod
    def of(cls, samples_s: Sequence[float]) -> LatencyStatistics:
        """Return the statistics of samples; percentiles are interpolated linearly."""
        if not samples_s:
            return cls(n=0, p50_s=None, p95_s=None, max_s=None)
        p50, p95 = np.percentile(samples_s, [50.0, 95.0])
        return cls(
            n=len(samples_s),
            min_s=min(samples_s),
            p50_s=float(p50),
            p95_s=float(p95),
            max_s=max(samples_s),
        )


class ClosestApproach(_Part):
    """The closest approach of the pair of the conflict, in three dimensions."""

    t_s: float = Field(description="time of the closest approach")
    horizontal_m: float = Field(description="horizontal distance")
    vertical_m: float = Field(description="vertical distance")


class RunwayIncursion(_Part):
    """One actor in the way of a runway's user, or on the runway without permission."""

    t_s: float
    runway: str
    user: str | None = Field(description="actor that took off or landed; null: nobody did")
    intruder: str
    category: IncursionCategory
    closest_m: float | None = Field(
        description="least distance between the outlines, in three dimensions"
    )


class WarningParts(_Part):
    """The parts of the time to first warning, in s; their sum is that time."""

    speech_s: float = Field(description="the call that the warning rests on was still being said")
    recognition_s: float = Field(description="from the end of that call to its transcript")
    evidence_s: float = Field(
        description="the rest of the time until the evidence was complete (t_ready): waiting for "
        "that call to begin, or for other evidence; negative if it was complete before the "
        "conflict began"
    )
    decision_s: float = Field(description="t_dec - t_ready")
    voice_s: float = Field(description="from t_dec to t_tts; 0 if no voice speaks")


class AdvisorySummary(_Part):
    """One advisory over all its revisions."""

    id: str
    kind: str
    traffic: tuple[str, ...]
    t_first_s: float
    t_spoken_s: float | None = Field(description="its audio began; null: it was never spoken")
    severity: Severity = Field(description="highest severity of all revisions")
    revisions: int
    nuisance_to: tuple[str, ...] = Field(
        description="names of its traffic that were in no conflict; ``nobody`` if it names none"
    )
    unfounded: tuple[str, ...] = Field(
        default=(),
        description="calls, cameras and transponders that it says it rests on, and that were "
        "unknown, had not been delivered by then, or concern nobody whom it names",
    )


class EquipmentSummary(_Part):
    """Alerts of one piece of equipment of the world; null where there was none."""

    equipment: str
    t_first_warning_s: float | None = Field(
        description="first alert of CAUTION or above about the annotated conflict"
    )
    t_first_action_s: float | None = Field(
        description="first of these that told somebody what to do"
    )
    margin_s: float | None = Field(
        description="how long before t_first_warning_s the assistant's first warning came; "
        "negative if the equipment was first"
    )
    alerts: list[AdvisorySummary]


class Costs(_Part):
    """Costs of the run to the people in it, whoever caused them, by the truth and the radio.

    The radio has more: its transmissions, the time on the air, and clarifications.
    """

    go_arounds: int = Field(description="go-arounds, each aircraft as often as it begins one")
    rejected_takeoffs: int = Field(
        description="take-off rolls that were rejected, each aircraft as often as it rejects one"
    )
    level_deviation_ft_s: float = Field(
        description="distance from the planned altitude, integrated over the time en route, of "
        "all aircraft that begin the run en route; until the script gives them something else "
        "than levels, tracks and speeds"
    )
    path_deviation_nm_s: float = Field(
        description="likewise, lateral distance from the planned path; until the script gives them "
        "something else than levels and speeds"
    )
    advisories_per_hour: float | None = Field(
        description="advisories of any severity in an hour of simulated time"
    )
    advice_spoken_s: float = Field(
        description="time for which advisories were spoken, on the frequency or aside from it"
    )
    reversals: int = Field(
        default=0,
        description="times that an advisory told a crew to climb after a descent, or the other way "
        "round",
    )


class PersonReaction(_Part):
    """Reaction of a person to one revision of an advisory; null where it does not apply."""

    advisory: str = Field(description="id of the advisory")
    revision: int = Field(description="revision of the advisory that reached the person")
    kind: str | None = Field(default=None, description="kind of the advisory")
    severity: Severity = Field(description="severity of this revision")
    advised: str | None = Field(description="action that it recommends")
    t_advisory_s: float = Field(description="it was published (t_dec)")
    t_seen_s: float | None = Field(description="the page of the seat drew it")
    t_heard_s: float | None = Field(description="its first sample was audible")
    voice_to_loudspeaker_s: float | None = Field(description="from t_tts to t_heard_s")
    counted_from: Literal["heard", "seen"] = Field(
        default="heard",
        description="where the reaction begins: heard, or seen if it was not heard, or if the "
        "person acted before it was audible",
    )
    first_action: str | None = Field(
        description="first action after that: spoken call, typed call, or the name of a command"
    )
    is_shared: bool = Field(
        default=False,
        description="true: that action is the reaction to another advisory, the first one "
        "perceived of those that advise it, or else of all before it",
    )
    is_real_time: bool = Field(
        default=True, description="false: the run was paused, slow or fast before that action"
    )
    reaction_time_s: float | None = Field(
        description="from t_heard_s or t_seen_s to that action; null if that is the reaction to "
        "another advisory, or if time did not pass as on the clock"
    )
    followed: bool | None = Field(description="true: the person did what it recommends within 30 s")


class PersonCall(_Part):
    """A call of a person; null where it does not apply, or is not known."""

    call: str | None = Field(
        default=None, description="id of its transmission; null: it never came on the air"
    )
    way: Literal["spoken", "typed"] = Field(description="by microphone or by keyboard")
    frequency_khz: int | None = None
    t_s: float = Field(description="the button was pressed, or the words came to the run")
    t_tx_s: float | None = Field(default=None, description="it began on the air")
    to_air_s: float | None = Field(
        default=None,
        description="from t_s to t_tx_s: of a typed call with the wait for a free frequency",
    )
    to_loudspeaker_s: float | None = Field(
        default=None,
        description="from t_s until its first sample was audible to another person; median over "
        "those who heard it so; null if time did not pass as on the clock",
    )
    heard_at: int | None = Field(
        default=None,
        description="seats of other people whose pages have sounded it from its beginning",
    )
    length_s: float | None = Field(default=None, description="time on the air")
    said: str | None = Field(default=None, description="words that were typed; null if spoken")
    recognised: str | None = Field(
        default=None, description="words that the first recogniser to answer found"
    )
    confidence: float | None = Field(default=None, description="confidence of these words")
    blocked: bool | None = Field(
        default=None, description="true: somebody else was on the air at the same time"
    )
    answer: str | None = Field(
        default=None, description="words of the answer of an automaton, or of the script"
    )
    answered_after_s: float | None = Field(
        default=None, description="from the end of the call to the beginning of that answer"
    )
    next_call: str | None = Field(
        default=None,
        description="id of the next transmission on the frequency, if another person made it "
        "within 30 s: perhaps the answer of that person",
    )
    next_call_after_s: float | None = Field(
        default=None, description="from the end of the call to the beginning of that transmission"
    )


class IsaRating(_Part):
    """An ISA question at a seat, and what was answered; null: nothing was."""

    t_s: float = Field(description="it was asked")
    rating: int | None = Field(description="1 under-utilised to 5 excessive")
    answered_after_s: float | None


class WorkloadSummary(_Part):
    """The workload of the person at one seat, as the person says; null: not asked or answered."""

    isa_mean: float | None = Field(description="over the questions that were answered")
    isa: list[IsaRating]
    nasa_tlx: NasaTlx | None = Field(description="0 to 100; performance: 100 is failure")
    raw_tlx: float | None = Field(description="mean of the six ratings")


class PersonSummary(_Part):
    """Words and actions of the person at one seat, or of those who had it one after another."""

    seat: str
    seat_time_s: float | None = Field(
        default=None, description="time of the run for which somebody had the seat"
    )
    consent: Literal["voice", "words", "none"] | None = Field(
        default=None,
        description="use to which the last person at the seat who has answered agreed at last: of "
        "voice and typed words, or of typed words alone; null: nobody has answered",
    )
    spoken_calls: int = Field(description="calls that the person spoke into the microphone")
    typed_calls: int = Field(description="calls that the person typed")
    commands: int = Field(description="commands that the person gave to the aircraft or vehicle")
    asked_to_say_again: int = Field(description="answers to the person that ask to say again")
    readback_errors: int = Field(
        default=0,
        description="readbacks of the person with another runway, level or other detail than the "
        "instruction; what was spoken counts as it was recognised",
    )
    readback_errors_heard: int = Field(
        default=0, description="likewise, in answer to instructions of the person"
    )
    press_to_transmit_s: float | None = Field(
        description="median time from pressing the button until the station had it"
    )
    press_to_loudspeaker_s: float | None = Field(
        default=None,
        description="median time from pressing the button until another person could hear it",
    )
    reaction_time_s: float | None = Field(description="median over the advisories")
    warning_to_press_s: float | None = Field(
        default=None,
        description="from the first caution or warning that the person saw or heard until the "
        "button was pressed next; null: there was none of them, or time did not pass as on the "
        "clock",
    )
    unperceived: int = Field(
        default=0,
        description="revisions of advisories to the person that no page has drawn or sounded",
    )
    calls: list[PersonCall] = Field(default=[], description="calls of the person, one by one")
    reactions: list[PersonReaction]
    workload: WorkloadSummary | None = Field(default=None, description="null: nothing was asked")


class RecognitionStatistics(_Part):
    """Recognition of the calls that had words and were not blocked."""

    snr_db: float | None = Field(
        description="signal-to-noise ratio; null: without noise, or not the same for all calls"
    )
    calls: int = Field(description="transcripts that were compared with what was said")
    words: int = Field(description="words said in these calls")
    wer: float | None = Field(
        description="word error rate: words that are wrong, left out or too many, over those said"
    )
    callsign_accuracy: float | None = Field(
        description="share of the calls naming a callsign of the roster whose transcript names it"
    )
    slot_accuracy: float | None = Field(
        description="share of the slots said (action, runway, altitude, heading, speed, frequency, "
        "point to hold short of) that the transcript has with the same value"
    )
    false_slots: int | None = Field(description="slots of transcripts that were not said")


class RadioStatistics(RecognitionStatistics):
    """The radio, and the recognition of all calls of the run; null: not measured."""

    transmissions: int = Field(description="transmissions, carriers without words included")
    blocked: int = Field(description="calls that another transmission was mixed with")
    stuck_microphone: int = Field(description="carriers without words")
    transcripts_missing: int | None = Field(
        description="calls received with sound and not blocked that have no transcript"
    )
    hallucinated: int | None = Field(
        description="transcripts that have words where there was only noise"
    )
    hearing: dict[str, int] = Field(
        description="number of calls with this outcome with the listener whom they were for"
    )
    occupied_s: float = Field(
        description="time for which somebody was on the air, summed over the frequencies; calls at "
        "the same time on one frequency count once"
    )
    say_agains: int = Field(description="calls that ask for another to be said again")
    clarifications: int = Field(
        description='calls that ask for words again or for confirmation, such as "say again" and '
        '"confirm"'
    )
    repeats: int = Field(description="calls made again")
    by_snr: list[RecognitionStatistics] = Field(
        description="recognition by signal-to-noise ratio, if a run has more than one"
    )


class SizeRecall(_Part):
    """Recall of the sightings of one size, by the longest side of the true box."""

    from_px: float
    to_px: float | None = Field(description="null: no upper limit")
    sightings: int
    recall: float | None


class DetectionStatistics(_Part):
    """Detections against the truth; null: not measured."""

    taken: int | None = Field(default=None, description="pictures taken")
    exposures_left_out: int | None = Field(
        default=None,
        description="exposures that adaptive exposure left out; 0 with the camera rate full",
    )
    looked_at: int | None = Field(
        default=None,
        description="pictures that a detector looked at, also those in which it found nothing",
    )
    dropped: int | None = Field(
        default=None, description="pictures that a newer one replaced before their turn"
    )
    missed: int | None = Field(
        default=None, description="pictures that a detector could not look at"
    )
    latency: LatencyStatistics = Field(description="t_vision - t_frame")
    detections: int | None = Field(default=None, description="boxes in all")
    sightings: int | None = Field(
        default=None,
        description="true boxes that count, in the pictures looked at: at least 8 px long, half of "
        "the actor visible, a tenth of its contrast left",
    )
    recall: float | None = Field(default=None, description="share of the sightings that were found")
    by_size: list[SizeRecall]
    labels_right: float | None = Field(
        default=None, description="share of the true detections that have the true class"
    )
    false_detections: int | None = Field(default=None, description="detections that match no actor")
    false_per_picture: float | None = Field(
        default=None, description="false detections per picture looked at"
    )
    false_per_minute: float | None = Field(
        default=None,
        description="false detections per minute and camera; null where exposures were left out",
    )
    false_confirmed_per_minute: float | None = Field(
        default=None,
        description="false detections of confirmed tracks per minute and camera; null where "
        "exposures were left out",
    )
    false_tracks: int | None = Field(
        default=None, description="confirmed tracks that never matched an actor"
    )


class CameraStatistics(DetectionStatistics):
    """Detections of one camera."""

    camera: str


class FirstDetection(_Part):
    """The first detection of an actor by any camera."""

    actor: str
    t_s: float = Field(description="t_vision")
    t_frame_s: float
    camera: str
    range_m: float
    size_px: float = Field(description="longest side of the true box")


class VisionStatistics(DetectionStatistics):
    """Detections of all cameras."""

    state: ModalityState = Field(description="state of vision at the end")
    cause: str = Field(description="reason why vision was lost or not evaluated")
    why_missed: str = Field(
        description="reason of the first missed picture; empty if none was missed"
    )
    cameras: list[CameraStatistics]
    first_detections: list[FirstDetection]


class LanguageModelStatistics(_Part):
    """The language model that an engine or a wording has asked."""

    model: str = Field(description="name of the model")
    questions: int = Field(description="questions that it was asked")
    failures: int = Field(
        description="questions without a usable answer: none in time, a refusal, or no JSON of the "
        "schema"
    )
    rejections: int = Field(
        description="messages or advisories in answers that were refused by the rules"
    )


STALE_S = 5.0
"""Age in s from which evidence is stale: ten times the interval of position reports; an arrival
flies 350 m in it. An assumption."""


class EvidenceAge(_Part):
    """Age of the newest evidence of a modality that decisions rested on; of calls, their delay."""

    mean_s: float = Field(description="mean")
    max_s: float = Field(description="greatest")
    stale_share: float = Field(description="share of the time in which it was above 5 s")


class Summary(_Part):
    """``summary.json``; null where a number does not apply."""

    scenario: str
    seed: int
    assistant: str
    outcome: str = Field(description="finished, or stopped and why")
    duration_s: float = Field(description="simulated time")
    conflict_actors: tuple[str, ...] = Field(
        default=(), description="the annotated pair; empty if the scenario declares no conflict"
    )
    t_conflict_s: float | None = Field(
        description="the event happened that begins the conflict, such as the start of a call"
    )
    t_window_s: float | None = Field(default=None, description="the conflict window opened")
    t_conflict_end_s: float | None = Field(
        description="the conflict window closed: the pair was past it, or the run ended"
    )
    t_first_warning_s: float | None = Field(
        description="first advisory of the conflict at or above the level that is spoken "
        "(CAUTION) reached a recipient: t_tts with speech, t_dec without"
    )
    time_to_first_warning_s: float | None = Field(
        description="t_first_warning - t_conflict; negative: before the conflict began"
    )
    time_to_first_warning_after_window_s: float | None = Field(
        default=None,
        description="t_first_warning - t_window, which is the paper's t_conflict; negative: "
        "before the conflict window opened",
    )
    time_to_first_warning_after_call_s: float | None = Field(
        default=None,
        description="t_first_warning less the end of the call that begins the conflict; negative: "
        "before it was said; null if no call begins it",
    )
    first_warning_parts: WarningParts | None = Field(
        default=None, description="what the time to first warning consists of"
    )
    lead_before_closest_approach_s: float | None = Field(
        description="from the first warning to the closest approach in the conflict window; null "
        "if nobody was warned before the window closed"
    )
    margin_over_tcas_ta_s: float | None = Field(
        description="how long before TCAS II would have given its traffic advisory, had nobody "
        "reacted, the first warning came"
    )
    margin_over_tcas_ra_s: float | None = Field(description="the same for its resolution advisory")
    min_horizontal_separation_m: float | None = Field(
        description="least while vertical separation was infringed; null if it never was"
    )
    min_vertical_separation_m: float | None = Field(
        description="least while horizontal separation was infringed; null if it never was"
    )
    closest_approach: ClosestApproach | None = Field(
        description="of the pair within the conflict window, from t_window to t_conflict_end; "
        "without an annotated conflict, of the pair that came nearest"
    )
    loss_of_separation: bool = Field(
        description="any two came closer than the minima of separation"
    )
    nmac: bool = Field(
        description="near mid-air collision: two aircraft in flight came closer than 500 ft "
        "horizontally and 100 ft vertically, or there was less than 100 ft between the outlines of "
        "an aircraft in flight and anything else, also on the ground"
    )
    collision: bool = Field(
        description="the outlines of two actors touched, other than two whose collision begins "
        "the conflict"
    )
    runway_incursions: list[RunwayIncursion]
    runway_incursion_category: IncursionCategory | None = Field(
        description="the most severe: accident, A, B, C, D; null if there was none"
    )
    avoided: bool | None = Field(
        description="somebody was warned of the annotated conflict, and neither of the pair lost "
        "separation from anybody, came to an NMAC or an incursion of category A or B, collided, or "
        "hit the ground; null "
        "if nobody was warned, or equipment of the world acted first, and nothing of that happened"
    )
    conflict_outcome: ConflictOutcome = Field(
        default="no_conflict",
        description="what became of the annotated conflict: avoided, as above; "
        "avoided_by_equipment: likewise, but equipment of the world acted first; lost: it came to "
        "harm all the same, or any two did where none is annotated; missed: nobody was warned, and "
        "its window opened or it came to harm; no_conflict: none of these",
    )
    unassisted_as_declared: bool | None = Field(
        default=None,
        description="without an assistant, the conflict window opened and the annotated pair came "
        "to the outcome that the scenario declares as unassisted, or to a more severe one; null "
        "with an assistant, without a conflict, or if equipment of the world averted it",
    )
    nuisance_alerts: int | None = Field(
        description="how often an advisory of CAUTION or above names somebody in no conflict; null "
        "if cameras left exposures out, because what is really there decided on them"
    )
    clarifications: int = Field(
        default=0, description="advisories that ask to confirm what was heard in doubt"
    )
    advisories: list[AdvisorySummary]
    equipment: list[EquipmentSummary] = Field(
        default=[], description="equipment of the world, which is no part of the assistant"
    )
    costs: Costs
    people: list[PersonSummary] = Field(
        default=[], description="people at seats; empty if there are none"
    )
    radio: RadioStatistics
    vision: VisionStatistics
    language_model: LanguageModelStatistics | None = Field(
        default=None, description="null: none was asked"
    )
    latencies: dict[str, LatencyStatistics] = Field(description="latency by stage")
    latency_sources: dict[str, str] = Field(
        default_factory=dict,
        description="what the latencies of each stage in the run came from, such as fixed",
    )
    too_slow: list[str] = Field(
        default=[],
        description="a sentence for each measured worker that the machine was too slow for: it "
        "dropped over 10 % of its inputs as out of date, and its median step took over three "
        "times as long as it declares",
    )
    inputs_dropped: dict[str, int]
    steps_missed: dict[str, int] = Field(
        default_factory=dict,
        description="steps without a result for an input, such as a call about which a service "
        "has failed, by worker; workers without any are left out",
    )
    messages_dropped: dict[str, int] = Field(
        default_factory=dict,
        description="messages of programs without grants that did not count because they were too "
        "large or too many, or were lost on the way as their senders number them, by kind of key "
        "and cause",
    )
    evidence: dict[str, EvidenceAge] = Field(
        default_factory=dict,
        description="age of what the assistant had to judge by, by modality; empty: nobody decided",
    )
    modalities: dict[str, ModalityState] = Field(description="state of the modality at the end")
    ended_actors: dict[str, str]
    real_time_factor: float
    cpu_s: float = Field(
        description="CPU time of the run in its own process and its children, such as the "
        "renderer, in s"
    )
