"""The numbers of a summary that a researcher quotes, as lines for people."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.host.text import counted
from airhilt.metrics.summary import RadioStatistics, Summary, VisionStatistics
from airhilt.units import FOOT, NAUTICAL_MILE

LEAST_STALE_SHARE = 0.01
"""Share of the time with stale evidence from which a row tells it."""
NOT_COUNTED = "not counted: cameras left exposures out"
"""Value of the nuisance alerts where adaptive cameras leave exposures out."""


def summary_rows(summary: Summary) -> Iterator[tuple[str, str]]:
    """Yield label and value of each number; what a run did not have has no row."""
    yield "scenario", f"{summary.scenario}, seed {summary.seed}"
    has_assistant = summary.assistant != "none"
    yield "assistant", summary.assistant if has_assistant else "none: nobody was warned"
    yield "outcome", summary.outcome
    speed = f"{factor(summary.real_time_factor)} x real time, {summary.cpu_s:.2f} s of CPU"
    yield "simulated", f"{summary.duration_s:.1f} s, {speed}"
    yield "conflict begins", _seconds(summary.t_conflict_s)
    yield "conflict window", _conflict_window(summary)
    yield "first warning", _seconds(summary.t_first_warning_s)
    yield "time to first warning", _seconds(summary.time_to_first_warning_s)
    yield "from the window on", _seconds(summary.time_to_first_warning_after_window_s)
    if (parts := summary.first_warning_parts) is not None:
        spans = {
            "speech": parts.speech_s,
            "recognition": parts.recognition_s,
            "evidence": parts.evidence_s,
            "decision": parts.decision_s,
            "voice": parts.voice_s,
        }
        yield "consists of", ", ".join(f"{name} {_seconds(span)}" for name, span in spans.items())
    yield "before closest approach", _seconds(summary.lead_before_closest_approach_s)
    ta, ra = summary.margin_over_tcas_ta_s, summary.margin_over_tcas_ra_s
    yield "before TCAS TA / RA", f"{_seconds(ta)} / {_seconds(ra)}"
    for each in summary.equipment:
        warning, action = _seconds(each.t_first_warning_s), _seconds(each.t_first_action_s)
        yield f"equipment {each.equipment}", f"warning {warning}, action {action}"
    yield from _separation_rows(summary)
    if summary.unassisted_as_declared is False:
        yield "as declared", "no: nobody was warned, and the declared outcome did not come about"
    yield "avoided", "-" if summary.avoided is None else _yes(summary.avoided)
    alerts = summary.nuisance_alerts
    yield "nuisance alerts", str(alerts) if alerts is not None else NOT_COUNTED
    yield from _cost_rows(summary)
    if dropped := [f"{count:,} on {what}" for what, count in summary.messages_dropped.items()]:
        yield "dropped messages", ", ".join(dropped)
    yield "radio", _radio(summary.radio)
    yield from _recognition_rows(summary)
    yield from _vision_rows(summary.vision)
    stale = [
        f"{modality} {each.stale_share:.0%} of the time, up to {each.max_s:.0f} s old"
        for modality, each in summary.evidence.items()
        if each.stale_share >= LEAST_STALE_SHARE
    ]
    if stale:
        yield "stale evidence", "; ".join(stale)
    yield "modalities", ", ".join(f"{name} {state}" for name, state in summary.modalities.items())
    for actor, cause in summary.ended_actors.items():
        yield f"{actor} ended", cause


def _conflict_window(summary: Summary) -> str:
    if summary.t_window_s is None or summary.t_conflict_end_s is None:
        return "none: the scenario declares no conflict, or its condition never came true"
    return f"{summary.t_window_s:.2f} to {summary.t_conflict_end_s:.2f} s"


def _separation_rows(summary: Summary) -> Iterator[tuple[str, str]]:
    """Yield rows on how near the pair came, and on runway incursions."""
    horizontal = _distance(summary.min_horizontal_separation_m)
    vertical = _height(summary.min_vertical_separation_m)
    yield (
        "least separation",
        f"horizontal {horizontal} while vertical was lost, "
        f"vertical {vertical} while horizontal was lost",
    )
    if (nearest := summary.closest_approach) is not None:
        apart = f"{_distance(nearest.horizontal_m)}, {_height(nearest.vertical_m)}"
        yield "closest approach", f"{apart} at {nearest.t_s:.1f} s"
    yield "loss of separation", _yes(summary.loss_of_separation)
    yield "NMAC", _yes(summary.nmac)
    yield "collision", _yes(summary.collision)
    for each in summary.runway_incursions:
        severity = each.category if each.category == "accident" else f"category {each.category}"
        way = f"in the way of {each.user}" if each.user else "nobody uses it"
        near = "" if each.closest_m is None else f", {each.closest_m:.0f} m apart"
        where = f"{each.intruder} on {each.runway} at {each.t_s:.1f} s"
        yield "runway incursion", f"{severity}: {where}, {way}{near}"


def _cost_rows(summary: Summary) -> Iterator[tuple[str, str]]:
    """Yield rows on what the run costs the people in it."""
    costs = summary.costs
    broken_off = counted(costs.go_arounds, "go-around")
    yield "broken off", f"{broken_off}, {counted(costs.rejected_takeoffs, 'rejected take-off')}"
    yield (
        "off the plan",
        f"level {costs.level_deviation_ft_s:,.0f} ft s, path {costs.path_deviation_nm_s:.2f} NM s",
    )
    if costs.advisories_per_hour is not None:
        rate = f"{costs.advisories_per_hour:.1f} an hour"
        yield "advisories", f"{rate}, spoken for {costs.advice_spoken_s:.1f} s"


def _radio(radio: RadioStatistics) -> str:
    """Return how many transmissions there were, and what was wrong with them."""
    wrong = {
        "blocked": radio.blocked,
        "carrier only": radio.stuck_microphone,
        "repeated": radio.repeats,
        "to say again or confirm": radio.clarifications,
        "misheard": radio.hearing.get("misheard", 0),
        "missed": radio.hearing.get("missed", 0),
        "without a transcript": radio.transcripts_missing or 0,
        "words of noise alone": radio.hallucinated or 0,
    }
    counts = [f"{count} {what}" for what, count in wrong.items() if count]
    on_air = f"{counted(radio.transmissions, 'transmission')} in {radio.occupied_s:.1f} s"
    return ", ".join([on_air, *counts])


def _recognition_rows(summary: Summary) -> Iterator[tuple[str, str]]:
    """Yield a row on speech recognition, if there was any.

    Where no callsign or no slot was said, there is no share of them.
    """
    radio, after_end = summary.radio, summary.latencies["asr_after_end"]
    if radio.wer is None:
        return
    shares = {
        "word error rate": radio.wer,
        "callsigns": radio.callsign_accuracy,
        "slots": radio.slot_accuracy,
    }
    parts = [f"{name} {_percent(share)}" for name, share in shares.items() if share is not None]
    if after_end.p95_s is not None:
        parts.append(f"p95 {latency(after_end.p95_s)} after the end")
    yield "recognition", ", ".join(parts)


def _vision_rows(vision: VisionStatistics) -> Iterator[tuple[str, str]]:
    """Yield rows on what cameras took and what was seen in it, if anything was."""
    if vision.taken is None:
        return
    parts = [counted(len(vision.cameras), "camera"), f"{vision.taken} pictures"]
    if vision.exposures_left_out:
        parts.append(f"{vision.exposures_left_out} exposures left out")
    if vision.looked_at is not None:
        parts += [
            f"{vision.looked_at} looked at",
            f"{vision.dropped} dropped",
            f"recall {_percent(vision.recall)} of {vision.sightings}",
            _false(vision),
        ]
    yield "vision", ", ".join(parts)
    if vision.missed:
        yield "missed", f"{vision.missed} pictures, the first: {vision.why_missed}"
    elif vision.looked_at == 0:
        yield "missed", "no picture had been looked at when the run ended"
    for first in vision.first_detections:
        where = f"{first.range_m:.0f} m off, {first.size_px:.0f} px long"
        yield "first seen", f"{first.actor} at {first.t_s:.1f} s by {first.camera}, {where}"


def _false(vision: VisionStatistics) -> str:
    """Return the rate of false detections, by picture where exposures were left out."""
    if vision.exposures_left_out:
        return f"{_percent(vision.false_per_picture)} false detections per picture"
    rate = vision.false_confirmed_per_minute
    return f"{'-' if rate is None else f'{rate:.2f}/min'} confirmed false"


def factor(times: float) -> str:
    """Return how many times faster than real time something is, in words."""
    return f"{times:.1f}" if times < 10.0 else f"{times:.0f}"


def _percent(share: float | None) -> str:
    return "-" if share is None else f"{100.0 * share:.1f} %"


def latency(seconds: float | None) -> str:
    """Return a time in the unit that suits it."""
    if seconds is None:
        return "-"
    if seconds < 1e-3:
        return f"{seconds * 1e6:.0f} us"
    return f"{seconds * 1e3:.3g} ms" if seconds < 1.0 else f"{seconds:.3g} s"


def _seconds(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f} s"


def _distance(value: float | None) -> str:
    return "never" if value is None else f"{value:.0f} m ({value / NAUTICAL_MILE:.2f} NM)"


def _height(value: float | None) -> str:
    return "never" if value is None else f"{value:.0f} m ({value / FOOT:.0f} ft)"


def _yes(value: bool) -> str:
    return "yes" if value else "no"
