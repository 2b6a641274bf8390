"""A transmission opens, streams its audio while it lasts, and closes; then it comes as a whole."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import partial
from types import SimpleNamespace
from typing import Any, TypeVar, cast

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.audio.pcm import SAMPLE_BYTES, SAMPLE_RATE_HZ, Audio, from_pcm, to_pcm
from airhilt.errors import SpeechError
from airhilt.messages import (
    Message,
    SeatAudioChunk,
    SeatAudioClosed,
    SeatAudioOpened,
    SpokenTruth,
    Transmission,
    TransmissionChunk,
    TransmissionClosed,
    TransmissionOpened,
)
from airhilt.scenario.models import Radio
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio import receiver
from airhilt.sensors.radio.backends import FallbackRadio, RadioBackend, SoundRequest, TextRadio
from airhilt.sensors.radio.backends.audio import AudioRadio
from airhilt.sensors.radio.channel import VhfChannel
from airhilt.sensors.radio.frequency_arbiter import GAP_S, FrequencyArbiter
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sensors.radio.transmissions import Transmissions
from airhilt.sim import Director, Priority, Virtual
from airhilt.sim.streams import stream
from airhilt.units import SECOND_NS, seconds_to_ns
from airhilt.voices.engine import VoiceSpec
from conversations import radio_context

SEED = 7
SNR_DB = 10.0
RADIO = Radio(snr_db=SNR_DB)
KHZ = 118_300

M = TypeVar("M", bound=Message)


class Buzzing:
    """Voices that hum a text, 0.1 s for each of its letters."""

    name = "buzzing"
    version = "1"

    def voice_of(self, speaker: str) -> VoiceSpec:
        return VoiceSpec(speaker)

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        t = np.arange(len(text) * SAMPLE_RATE_HZ // 10) / SAMPLE_RATE_HZ
        hum = np.sin(2 * np.pi * (300 + 40 * len(voice.name)) * t) * np.sin(2 * np.pi * 2 * t) ** 2
        sound: Audio = (0.3 * hum).astype(np.float32)
        return sound


class Everywhere:
    """Stations that are in reach of each other, except those that are out of reach."""

    def __init__(self) -> None:
        self.out_of_reach: set[str] = set()

    def audible(self, speaker: str, listener: str) -> bool:
        return not self.out_of_reach & {speaker, listener}

    def keyed_by(self, speaker: str) -> str | None:
        return speaker if speaker == "Tower" else None

    def selectable(self, name: str) -> tuple[int, ...]:
        return (KHZ,)

    def background_of(self, name: str) -> str:
        return "tower" if name == "Tower" else "cockpit"


def audio_radio(profile: str = "vhf", radio: Radio = RADIO) -> AudioRadio:
    return AudioRadio(Buzzing(), VhfChannel(PROFILES[profile]), SEED, radio)


class Air:
    """The transmissions of a run, and what was published of them."""

    def __init__(
        self,
        backend: RadioBackend | None = None,
        radio: Radio = RADIO,
        seats: tuple[str, ...] = (),
    ) -> None:
        self.director = Director(Virtual())
        self.stations = Everywhere()
        self.published: list[tuple[str, Message, bytes]] = []
        backend = backend or audio_radio(radio=radio)
        context = radio_context(
            director=self.director,
            scenario=SimpleNamespace(radio=radio, roster=()),
            stations=self.stations,
            backend=backend,
            publish=self.publish,
            seats=[SimpleNamespace(seat=seat) for seat in seats],
        )
        self.transmissions = Transmissions(context)
        self.arbiter = FrequencyArbiter(
            self.director,
            backend.speak,
            self.stations.audible,
            began=self.transmissions.open,
            ended=self.transmissions.finish,
        )

    def publish(self, key: str, message: Message, *, raw: bytes | None = None) -> None:
        assert message.t_ns == self.director.now_ns
        self.published.append((key, message, raw or b""))

    def at(self, t_s: float, action: Callable[[], None]) -> Air:
        self.director.at(seconds_to_ns(t_s), action, Priority.SCRIPT)
        return self

    def say(
        self, t_s: float, name: str, seconds: float = 3.0, speaker: str = "", **more: Any
    ) -> Air:
        text = "x" * round(10 * seconds)
        said = Utterance(name, KHZ, speaker or name, None, text, **more)
        return self.at(t_s, partial(self.arbiter.say, said))

    def press(self, t_s: float, name: str, fed: list[tuple[float, Audio]], release_s: float) -> Air:
        """Press a button, feed samples at times, and release it."""
        on_air: list[OnAir] = []

        def begin() -> None:
            said = Utterance(name, KHZ, name, None, "")
            on_air.append(self.arbiter.press(said))

        self.at(t_s, begin)
        for at_s, samples in fed:
            self.at(at_s, lambda samples=samples: on_air[0].feed(samples))  # type: ignore[misc]
        return self.at(release_s, lambda: self.arbiter.release(on_air[0]))

    def run(self, until_s: float | None = None) -> Air:
        if until_s is not None:
            self.director.at(seconds_to_ns(until_s), self.director.stop, Priority.OBSERVE)
        self.director.run()
        for on_air in self.arbiter.close():
            self.transmissions.finish(on_air)
        return self

    def of(self, model: type[M], name: str) -> list[tuple[M, bytes]]:
        return [
            (message, raw)
            for _, message, raw in self.published
            if type(message) is model and message.id == name  # type: ignore[attr-defined]
        ]

    def chunks(self, name: str) -> list[tuple[TransmissionChunk, bytes]]:
        return self.of(TransmissionChunk, name)

    def streamed(self, name: str) -> bytes:
        return b"".join(pcm for _, pcm in self.chunks(name))

    def whole(self, name: str) -> tuple[Transmission, bytes]:
        (found,) = self.of(Transmission, name)
        return found

    def truth(self, name: str) -> SpokenTruth:
        ((found, _),) = self.of(SpokenTruth, name)
        return found

    def closed(self, name: str) -> TransmissionClosed:
        ((found, _),) = self.of(TransmissionClosed, name)
        return found


def spoken(seconds: float, frequency_hz: float = 440.0) -> Audio:
    t = np.arange(round(seconds * SAMPLE_RATE_HZ)) / SAMPLE_RATE_HZ
    return (0.3 * np.sin(2 * np.pi * frequency_hz * t)).astype(np.float32)


def packets(begin_s: float, audio: Audio, every_s: list[float]) -> list[tuple[float, Audio]]:
    """Return what a microphone gives, when: its sound since the last time, at irregular times."""
    fed, done, at_s = [], 0, begin_s
    for wait_s in every_s:
        at_s += wait_s
        until = min(round((at_s - begin_s) * SAMPLE_RATE_HZ), len(audio))
        fed.append((at_s, audio[done:until]))
        done = until
    return fed


def check_stream(air: Air, name: str) -> None:
    """Check what holds for every transmission that is received from beginning to end."""
    whole, pcm = air.whole(name)
    chunks = air.chunks(name)
    assert air.streamed(name) == pcm
    assert [chunk.seq for chunk, _ in chunks] == list(range(len(chunks)))
    first_sample = 0
    for chunk, raw in chunks:
        assert chunk.first_sample == first_sample
        assert len(raw) == SAMPLE_BYTES * chunk.samples <= SAMPLE_BYTES * SAMPLE_RATE_HZ // 2
        assert hashlib.sha256(raw).hexdigest() == chunk.sha256
        first_sample += chunk.samples
        if chunk.t_ns < whole.t_end_ns:  # The squelch tail comes with the end.
            assert chunk.t_ns >= whole.t_tx_ns + first_sample * SECOND_NS // SAMPLE_RATE_HZ
    closed = air.closed(name)
    assert closed.is_complete
    assert (closed.samples, closed.sha256) == (whole.samples, whole.sha256)
    assert (closed.t_tx_ns, closed.t_end_ns) == (whole.t_tx_ns, whole.t_end_ns)
    assert (closed.t_ns, closed.snr_db) == (whole.t_end_ns, whole.snr_db)


# --- calls of the script ------------------------------------------------------------------------


def test_a_call_opens_streams_half_seconds_and_closes() -> None:
    air = Air().say(10.0, "call", 1.8).run()
    ((opened, raw),) = air.of(TransmissionOpened, "call")
    assert (opened.t_ns, opened.t_tx_ns, raw) == (10 * SECOND_NS, 10 * SECOND_NS, b"")
    chunks = air.chunks("call")
    assert [chunk.t_ns / SECOND_NS for chunk, _ in chunks] == [10.5, 11.0, 11.5, 11.8]
    assert [chunk.samples for chunk, _ in chunks[:3]] == [8_000, 8_000, 8_000]
    check_stream(air, "call")
    kinds = [type(message).__name__ for _, message, _ in air.published]
    assert kinds == [
        "TransmissionOpened", *["TransmissionChunk"] * 3, "SpokenTruth", "TransmissionChunk",
        "TransmissionClosed", "Transmission",
    ]  # fmt: skip
    assert {key for key, *_ in air.published} == {
        f"radio/{KHZ}/audio", f"radio/{KHZ}/tx", "truth/radio/call",
    }  # fmt: skip


@pytest.mark.parametrize("profile", PROFILES)
def test_the_whole_is_what_the_channel_makes_of_the_whole_call(profile: str) -> None:
    air = Air(audio_radio(profile)).say(10.0, "call", 3.0)
    _, pcm = air.run().whole("call")
    voices = Buzzing()
    speech = voices.synthesise("x" * 30, voices.voice_of("call"))
    rng = stream(SEED, "channel/call")
    heard = VhfChannel(PROFILES[profile]).transmit(speech, SNR_DB, rng, (), "cockpit")
    assert pcm == to_pcm(heard)
    check_stream(air, "call")


def test_a_call_has_the_reception_of_its_line_then_of_its_speaker_then_of_the_radio() -> None:
    radio = Radio.model_validate({
        "snr_db": 20.0, "stations": {"AAL123": {"snr_db": 5.0, "wet": 0.5}},
        "lines": [{"id": "weak", "speaker": "AAL123", "frequency_khz": KHZ, "text": "x",
                   "snr_db": -3.0}],
    })  # fmt: skip
    air = Air(radio=radio).say(1.0, "weak", 1.0, speaker="AAL123", line="weak")
    air.say(10.0, "another", 1.0, speaker="AAL123").say(20.0, "other", 1.0, speaker="UAL7").run()
    ratios = {name: air.truth(name).snr_db for name in ("weak", "another", "other")}
    assert ratios == {"weak": -3.0, "another": 5.0, "other": 20.0}
    assert {name: air.whole(name)[0].snr_db for name in ratios} == ratios
    assert {name: air.closed(name).snr_db for name in ratios} == ratios
    voices = Buzzing()
    speech = voices.synthesise("x" * 10, voices.voice_of("AAL123"))
    rng = stream(SEED, "channel/weak")
    heard = VhfChannel(PROFILES["vhf"]).transmit(speech, -3.0, rng, (), "cockpit", 0.5)
    assert air.whole("weak")[1] == to_pcm(heard)


def test_one_station_below_the_squelch_is_not_received_and_others_are() -> None:
    radio = Radio.model_validate({"snr_db": 20.0, "stations": {"AAL123": {"snr_db": -20.0}}})
    air = Air(radio=radio).say(1.0, "weak", 1.0, speaker="AAL123")
    air.say(10.0, "strong", 1.0, speaker="UAL7").run()
    assert air.of(Transmission, "weak") == []
    assert air.whole("strong")[0].snr_db == 20.0


def test_what_was_given_out_does_not_tell_of_a_call_that_comes_over_it_later() -> None:
    alone, together = Air(), Air()
    for air in (alone, together):
        air.say(10.0, "first", 3.0)
    together.say(11.2, "second", 3.0, listens_first=False)
    alone.run()
    together.run()
    before = 2 * SAMPLE_BYTES * SAMPLE_RATE_HZ // 2
    assert together.streamed("first")[:before] == alone.streamed("first")[:before]
    assert together.streamed("first")[before:] != alone.streamed("first")[before:]
    assert together.truth("first").blocked_by == ("second",)
    for name in ("first", "second"):
        check_stream(together, name)


def test_two_calls_at_once_are_mixed_as_if_both_had_been_known_before(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    streamed, known = Air(), Air()
    for air in (streamed, known):
        air.say(10.0, "first", 3.0)
        air.say(11.2, "second", 3.0, listens_first=False)
    streamed.run()
    monkeypatch.setattr(receiver, "CHUNK_NS", 100 * SECOND_NS)
    known.run()
    for name in ("first", "second"):
        assert streamed.whole(name) == known.whole(name)


def test_nothing_is_streamed_of_a_speaker_who_is_out_of_reach() -> None:
    air = Air()
    air.stations.out_of_reach.add("far")
    air.say(10.0, "far").run()
    assert [type(message) for _, message, _ in air.published] == [SpokenTruth]


def test_a_speaker_who_is_lost_in_the_middle_of_a_call_leaves_what_was_heard_until_then() -> None:
    air = Air().say(10.0, "call", 3.0)
    air.at(11.2, lambda: air.stations.out_of_reach.add("call"))
    air.run()
    closed = air.closed("call")
    assert not closed.is_complete
    assert closed.t_ns == 11.5 * SECOND_NS
    assert closed.sha256 == hashlib.sha256(air.streamed("call")).hexdigest()
    assert closed.samples == SAMPLE_RATE_HZ
    assert not air.of(Transmission, "call")


def test_a_speaker_who_comes_into_reach_in_the_middle_of_a_call_is_received_as_a_whole() -> None:
    air = Air()
    air.stations.out_of_reach.add("call")
    air.say(10.0, "call", 3.0)
    air.at(11.2, lambda: air.stations.out_of_reach.clear())
    air.run()
    assert air.whole("call")[0].samples > 3 * SAMPLE_RATE_HZ
    assert not air.of(TransmissionOpened, "call")
    assert not air.chunks("call")


def test_a_stuck_microphone_is_streamed_like_any_transmission() -> None:
    air = Air()
    carrier = Utterance("stuck", KHZ, "AAL123", None, "")
    air.at(10.0, partial(air.arbiter.transmit_carrier, carrier, 8.0))
    air.say(12.0, "call", 3.0).run()
    assert air.truth("call").blocked_by == ("stuck",)
    assert air.whole("stuck")[0].samples > 8 * SAMPLE_RATE_HZ
    for name in ("call", "stuck"):
        check_stream(air, name)


# --- at a seat with a receiver of its own -------------------------------------------------------


BAD = Radio.model_validate({"snr_db": 20.0, "receivers": {"AAL123": {"snr_db": 3.0}}})


def at_seat(air: Air, name: str) -> bytes:
    return b"".join(pcm for _, pcm in air.of(SeatAudioChunk, name))


def others(air: Air) -> list[tuple[str, Message, bytes]]:
    """Return what is published of everything but the seats."""
    return [one for one in air.published if not one[0].startswith("seat/")]


def test_a_seat_with_a_receiver_of_its_own_hears_each_call_with_its_own_noise() -> None:
    air = Air(radio=BAD, seats=("AAL123", "UAL7")).say(10.0, "call", 1.8, speaker="Tower").run()
    voices = Buzzing()
    speech = voices.synthesise("x" * 18, voices.voice_of("Tower"))
    rng = stream(SEED, "channel@AAL123/call")
    heard = VhfChannel(PROFILES["vhf"]).transmit(speech, 3.0, rng, (), "tower")
    assert at_seat(air, "call") == to_pcm(heard)
    assert {key for key, *_ in air.published if key.startswith("seat/")} == {"seat/AAL123/audio"}


def test_the_stream_of_a_seat_opens_chunks_while_it_lasts_and_closes() -> None:
    air = Air(radio=BAD, seats=("AAL123",)).say(10.0, "call", 1.8, speaker="Tower").run()
    ((opened, _),) = air.of(SeatAudioOpened, "call")
    chunks = air.of(SeatAudioChunk, "call")
    ((closed, _),) = air.of(SeatAudioClosed, "call")
    assert (opened.seat, opened.t_ns, opened.keyed_by) == ("AAL123", 10 * SECOND_NS, None)
    assert [chunk.t_ns / SECOND_NS for chunk, _ in chunks] == [10.5, 11.0, 11.5, 11.8]
    assert [hashlib.sha256(pcm).hexdigest() for _, pcm in chunks] == [
        chunk.sha256 for chunk, _ in chunks
    ]
    assert closed.sha256 == hashlib.sha256(at_seat(air, "call")).hexdigest()
    assert (closed.snr_db, air.closed("call").snr_db) == (3.0, 20.0)


def test_the_receivers_of_seats_change_nothing_of_what_all_others_hear() -> None:
    airs = [
        Air(radio=RADIO),
        Air(radio=BAD.model_copy(update={"snr_db": SNR_DB}), seats=("AAL123",)),
    ]
    for air in airs:
        air.say(10.0, "first", 3.0, speaker="Tower")
        air.say(11.2, "second", 3.0, listens_first=False)
        air.press(20.0, "person", packets(20.0, spoken(2.0), [0.3] * 7), 22.2)
        air.run()
    assert others(airs[0]) == airs[0].published == others(airs[1])
    assert len(airs[1].published) > len(airs[0].published)


def test_nothing_is_heard_at_a_seat_below_its_squelch_or_out_of_its_reach() -> None:
    deaf = Radio.model_validate({"snr_db": 20.0, "receivers": {"AAL123": {"snr_db": -20.0}}})
    far = Air(radio=BAD, seats=("AAL123",))
    far.stations.out_of_reach.add("AAL123")
    for air in (far, Air(radio=deaf, seats=("AAL123",))):
        air.say(10.0, "call", 1.0, speaker="Tower")
        air.run()
        assert not [key for key, *_ in air.published if key.startswith("seat/")]
        check_stream(air, "call")


class Counting(AudioRadio):
    """A radio that notes whose receivers have asked it for samples."""

    def __init__(self, radio: Radio) -> None:
        super().__init__(Buzzing(), VhfChannel(PROFILES["vhf"]), SEED, radio)
        self.asked: set[str | None] = set()

    def receive(self, request: SoundRequest) -> bytes:
        self.asked.add(request.listener)
        return super().receive(request)


def test_a_seat_gets_nothing_of_a_call_into_whose_reach_it_comes_in_the_middle() -> None:
    """So that a replay has no need of samples that no message has told of."""
    backend = Counting(BAD)
    air = Air(backend, radio=BAD, seats=("AAL123",))
    air.stations.out_of_reach.add("AAL123")
    air.say(10.0, "call", 3.0, speaker="Tower")
    air.at(11.2, lambda: air.stations.out_of_reach.clear())
    air.run()
    assert not [key for key, *_ in air.published if key.startswith("seat/")]
    assert backend.asked == {None}


def test_a_seat_that_comes_out_of_reach_keeps_what_it_heard_until_then() -> None:
    air = Air(radio=BAD, seats=("AAL123",)).say(10.0, "call", 3.0, speaker="Tower")
    air.at(11.2, lambda: air.stations.out_of_reach.add("AAL123"))
    air.run()
    ((closed, _),) = air.of(SeatAudioClosed, "call")
    assert not closed.is_complete
    assert closed.samples == SAMPLE_RATE_HZ
    assert closed.sha256 == hashlib.sha256(at_seat(air, "call")).hexdigest()
    check_stream(air, "call")


def test_the_own_call_of_a_seat_comes_back_without_the_noise_of_its_receiver() -> None:
    air = Air(radio=BAD, seats=("AAL123",)).say(10.0, "call", 1.0, speaker="AAL123").run()
    ((closed, _),) = air.of(SeatAudioClosed, "call")
    assert closed.snr_db == 20.0


def test_without_sound_a_seat_is_told_when_its_frequency_is_busy() -> None:
    air = Air(TextRadio(160.0), radio=BAD, seats=("AAL123",))
    air.say(10.0, "call", 1.0, speaker="Tower").run()
    assert len(air.of(SeatAudioOpened, "call")) == len(air.of(SeatAudioClosed, "call")) == 1
    assert not air.of(SeatAudioChunk, "call")


# --- without sound ------------------------------------------------------------------------------


def test_without_sound_a_call_opens_and_closes_without_chunks() -> None:
    air = Air(TextRadio(160.0)).say(10.0, "call", 3.0).run()
    assert len(air.of(TransmissionOpened, "call")) == 1
    assert not air.chunks("call")
    closed = air.closed("call")
    assert (closed.samples, closed.sha256, closed.is_complete) == (0, "", True)
    assert air.whole("call")[0].samples == 0


class Failing(AudioRadio):
    """A radio whose channel fails once a time has come."""

    def __init__(self, at_s: float) -> None:
        super().__init__(Buzzing(), VhfChannel(PROFILES["vhf"]), SEED, RADIO)
        self._at_ns = seconds_to_ns(at_s)

    def receive(self, request: SoundRequest) -> bytes:
        if request.now_ns >= self._at_ns:
            raise SpeechError("worn out")
        return super().receive(request)


def test_a_call_in_which_the_sound_is_lost_has_no_samples_though_some_were_streamed() -> None:
    lost: list[str] = []
    air = Air(FallbackRadio(Failing(11.0), 160.0, lambda cause, _: lost.append(cause), lost.append))
    air.say(10.0, "first", 3.0).say(11.2, "second", 3.0, listens_first=False).run()
    assert lost == ["worn out"]
    assert len(air.chunks("first")) >= 2
    assert not air.closed("first").is_complete
    assert air.whole("first")[1] == b""
    assert not air.chunks("second")


class Mute(Buzzing):
    """Voices that fail."""

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        raise SpeechError("no voice")


def test_where_the_voices_fail_a_call_takes_the_time_of_its_words_and_has_no_sound() -> None:
    lost: list[str] = []
    mute = AudioRadio(Mute(), VhfChannel(PROFILES["vhf"]), SEED, RADIO)
    radio = FallbackRadio(mute, 150.0, lambda cause, _: lost.append(cause), lost.append)
    assert radio.has_sound
    for _ in range(2):
        speech, seconds = radio.speak("Tower", "hold short of runway")
        assert (speech, seconds) == (None, pytest.approx(4 / 150.0 * 60.0))
    assert (lost, radio.has_sound) == (["no voice"], False)


def test_what_ended_when_a_piece_of_a_persons_call_begins_is_not_heard_in_it() -> None:
    """The piece begins with its 32,002nd sample; the other call began between two samples."""
    sample_ns = SECOND_NS // SAMPLE_RATE_HZ
    first, begin = 2 * SAMPLE_RATE_HZ + 1, 4 * SAMPLE_RATE_HZ + 1
    said = Utterance("person", KHZ, "AAL1", None, "")
    person = OnAir(said, 0, 5 * SECOND_NS, spoken(5.0), is_open_ended=True)
    said = Utterance("other", KHZ, "Tower", None, "")
    begun_ns = SAMPLE_RATE_HZ * sample_ns + 3 * sample_ns // 2
    other = OnAir(said, begun_ns, first * sample_ns, spoken(1.0))

    def received(mixed_with: tuple[OnAir, ...]) -> bytes:
        request = SoundRequest(person, mixed_with, "none", begin, 5 * SECOND_NS)
        return audio_radio().receive(request)

    assert received((other,)) == received(())


@pytest.mark.parametrize(("begin_s", "context_s"), [(4.0, 2.0), (2.0, 2.0), (1.5, 1.5), (0.0, 0.0)])
def test_a_piece_of_a_persons_call_is_levelled_with_the_two_seconds_before_it(
    begin_s: float, context_s: float
) -> None:
    pieces: list[Audio] = []

    def transmit(piece: Audio, *_: Any) -> Audio:
        pieces.append(piece)
        return piece

    channel = cast(VhfChannel, SimpleNamespace(transmit=transmit))
    radio = AudioRadio(Buzzing(), channel, SEED, RADIO)
    said = Utterance("person", KHZ, "AAL1", None, "")
    person = OnAir(said, 0, 5 * SECOND_NS, spoken(5.0), is_open_ended=True)
    begin = round(begin_s * SAMPLE_RATE_HZ)
    given_out = radio.receive(SoundRequest(person, (), "none", begin, 5 * SECOND_NS))
    (piece,) = pieces
    assert len(piece) / SAMPLE_RATE_HZ == pytest.approx(5.0 - begin_s + context_s)
    assert len(given_out) == 2 * (5 * SAMPLE_RATE_HZ - begin)


# --- a person's microphone ----------------------------------------------------------------------

IRREGULAR_S = [0.02, 0.31, 0.05, 0.48, 0.02, 0.6, 0.1, 0.42]
"""Waiting times between packets of a microphone; 2 s together."""


def test_a_person_is_heard_while_speaking_and_as_a_whole_after_releasing_the_button() -> None:
    air = Air().press(10.0, "AAL123", packets(10.0, spoken(2.0), IRREGULAR_S), 12.0).run()
    whole, pcm = air.whole("AAL123")
    assert (whole.t_tx_ns, whole.t_end_ns) == (10 * SECOND_NS, 12 * SECOND_NS)
    check_stream(air, "AAL123")
    assert [chunk.t_ns / SECOND_NS for chunk, _ in air.chunks("AAL123")][:3] == [10.5, 11.0, 11.5]
    heard = from_pcm(pcm)[SAMPLE_RATE_HZ // 2 : 2 * SAMPLE_RATE_HZ]
    spectrum = np.abs(np.fft.rfft(heard))
    loudest_hz = np.fft.rfftfreq(len(heard), 1 / SAMPLE_RATE_HZ)[spectrum.argmax()]
    assert loudest_hz == pytest.approx(440.0, abs=2.0)


def test_a_persons_call_lasts_as_long_as_the_button_is_pressed_however_little_was_fed() -> None:
    air = Air().press(10.0, "AAL123", packets(10.0, spoken(0.5), [0.25, 0.25]), 13.0).run()
    assert air.whole("AAL123")[0].t_end_ns == 13 * SECOND_NS
    assert air.whole("AAL123")[0].samples > 3 * SAMPLE_RATE_HZ
    check_stream(air, "AAL123")


def test_a_persons_call_goes_on_until_all_that_was_fed_has_been_said() -> None:
    air = Air().press(10.0, "AAL123", [(10.1, spoken(2.0))], 10.5).run()
    assert air.whole("AAL123")[0].t_end_ns == 12 * SECOND_NS
    check_stream(air, "AAL123")


def test_a_button_that_is_only_touched_gives_a_call_without_words() -> None:
    air = Air().press(10.0, "AAL123", [], 10.0).run()
    assert air.whole("AAL123")[0].t_end_ns == 10 * SECOND_NS
    check_stream(air, "AAL123")


def test_who_hears_a_person_waits_until_the_button_is_released() -> None:
    air = Air().press(10.0, "AAL123", packets(10.0, spoken(2.0), IRREGULAR_S), 12.0)
    air.say(11.0, "Tower").run()
    assert air.truth("Tower").t_tx_ns == seconds_to_ns(12.0 + GAP_S)
    assert air.truth("Tower").blocked_by == ()


def test_a_person_who_presses_during_a_call_blocks_it_and_both_are_told() -> None:
    air = Air().say(10.0, "Tower", 3.0)
    air.press(11.2, "AAL123", packets(11.2, spoken(2.0), IRREGULAR_S), 13.2).run()
    assert air.truth("Tower").blocked_by == ("AAL123",)
    assert air.truth("AAL123").blocked_by == ("Tower",)
    for name in ("Tower", "AAL123"):
        check_stream(air, name)
    clear = Air()
    clear.say(10.0, "Tower", 3.0)
    alone = clear.run().whole("Tower")[1]
    mixed = air.whole("Tower")[1]
    assert mixed[: 2 * SAMPLE_RATE_HZ] == alone[: 2 * SAMPLE_RATE_HZ]
    assert mixed != alone


@settings(max_examples=15, deadline=None)
@given(
    calls=st.lists(
        st.tuples(st.floats(0.0, 8.0), st.integers(1, 40), st.booleans(), st.booleans()),
        min_size=1,
        max_size=4,
    ),
    waits_s=st.lists(st.floats(0.001, 0.7), max_size=6),
    until_s=st.floats(5.0, 20.0),
)
def test_whatever_is_on_the_air_the_chunks_are_the_whole(
    calls: list[tuple[float, int, bool, bool]], waits_s: list[float], until_s: float
) -> None:
    air = Air()
    for number, (at_s, tenths, listens, is_person) in enumerate(calls):
        name = f"call{number}"
        if is_person:
            fed = packets(at_s, spoken(tenths / 10), waits_s)
            air.press(at_s, name, fed, at_s + sum(waits_s) + 0.1)
        else:
            air.say(at_s, name, tenths / 10, listens_first=listens)
    air.run(until_s)
    opened = {
        message.id for _, message, _ in air.published if isinstance(message, TransmissionOpened)
    }
    closed = {
        message.id for _, message, _ in air.published if isinstance(message, TransmissionClosed)
    }
    for name in closed:
        check_stream(air, name)
    assert closed <= opened
