"""A language model decides, with the rules of the reference engine as guard.

The rules judge every step. The model is asked about their open alerts and the situation, and
`airhilt.assistant.decision.language.review` refuses what the rules do not allow. Where there is no
answer in time, the rules' alerts go out as they are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from airhilt.assistant.decision.alert_ledger import AlertLedger
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.engines.reference import ReferenceConfig, ReferenceEngine
from airhilt.assistant.decision.language.question import INSTRUCTIONS, QuestionContext
from airhilt.assistant.decision.language.review import Answer, Reviewed, judged, review
from airhilt.assistant.decision.slices import Slices
from airhilt.assistant.language_model import LanguageModel, LanguageModelSettings
from airhilt.engines import Engine
from airhilt.messages import Message, ModelExchange, Severity, Transcript
from airhilt.units import SECOND_NS

LEAST_PERIOD_NS = 2 * SECOND_NS
"""Least time between two questions."""
PERIOD_NS = 5 * SECOND_NS
"""Time after which the model is asked again while an alert is open, without news."""
AFTER_WARNING_NS = SECOND_NS // 10
"""Time after a WARNING of the rules at which the model is asked: the WARNING does not wait."""
HELD_NS = 2 * PERIOD_NS
"""Time for which what the model has answered holds if it does not answer any more."""


class LanguageModelAssistant:
    """Asks when a call was recognised, when the rules have news, and while they have an alert."""

    name = "llm"
    reads: tuple[type[Message], ...] = ReferenceEngine.reads
    inputs: Mapping[str, object] = ReferenceEngine.inputs

    def __init__(self, configuration: ReferenceConfig | None = None) -> None:
        self._rules = ReferenceEngine(configuration)
        self.configuration = self._rules.configuration
        self._slices = Slices()
        self._ledger = AlertLedger()
        self._model: LanguageModel | None = None
        self._open: dict[str, Alert] = {}
        self._reviewed = Reviewed({}, (), ())
        self._reviewed_ns = 0
        self._asked_ns: int | None = None
        self._has_news = False

    def use(self, settings: LanguageModelSettings) -> None:
        """Ask this language model."""
        self._model = LanguageModel(settings)

    def receive(self, received: ReceivedMessage) -> None:
        """Give one message to the rules, and keep it for the next question."""
        self._rules.receive(received)
        self._slices.receive(received)
        self._has_news = self._has_news or isinstance(received.message, Transcript)

    def decide(self, t_ns: int) -> Decision:
        """Return what is new, has changed, or is over."""
        ruled = self._rules.decide(t_ns)
        is_urgent = self._take(ruled.alerts)
        exchanges: tuple[ModelExchange, ...] = ()
        due_ns = self._due_ns(t_ns)
        if due_ns is not None and due_ns <= t_ns and not is_urgent:
            exchanges = self._ask(t_ns)
            due_ns = self._due_ns(t_ns)
        if t_ns - self._reviewed_ns > HELD_NS:
            self._reviewed = Reviewed({}, (), ())
        again = {alert.id for alert in ruled.alerts if alert.active}
        questions = [alert for alert in ruled.alerts if alert.kind == "clarification"]
        told = [
            self._slices.checks.marked(each, t_ns)
            for each in self._ledger.update(self._holding(), again)
        ]
        alerts = [*told, *questions]
        wakes = [each for each in (ruled.again_ns, due_ns) if each is not None]
        earliest_ns = t_ns + AFTER_WARNING_NS
        again_ns = max(min(wakes), earliest_ns) if wakes else None
        return Decision(alerts, again_ns, exchanges)

    def _take(self, alerts: Sequence[Alert]) -> bool:
        """Take in the news of the rules, and return whether a WARNING is among them."""
        for alert in alerts:
            if not alert.active:
                self._open.pop(alert.id, None)
            elif alert.kind != "clarification":
                self._open[alert.id] = alert
        self._has_news = self._has_news or bool(alerts)
        return any(alert.active and alert.severity is Severity.WARNING for alert in alerts)

    def _due_ns(self, t_ns: int) -> int | None:
        if self._model is None or not (self._has_news or self._open):
            return None
        if self._asked_ns is None:
            return t_ns
        period_ns = LEAST_PERIOD_NS if self._has_news else PERIOD_NS
        return max(self._asked_ns + period_ns, t_ns)

    def _ask(self, t_ns: int) -> tuple[ModelExchange, ...]:
        callsigns = self._slices.callsigns()
        request = self._slices.request(t_ns)
        self._has_news, self._asked_ns = False, t_ns
        if self._model is None or not callsigns:
            return ()
        situation = QuestionContext.of(request, callsigns, self._open)
        exchange = ModelExchange(
            model=self._model.name,
            task="decision",
            advisories=tuple(self._open),
            question=situation.question(),
            answer=None,
        )
        answer, exchange = self._model.answer_to(exchange, INSTRUCTIONS, situation.schema(), Answer)
        if answer is None:
            return (exchange,)
        runway_of = self._rules.runways.runway_in_use
        self._reviewed = review(answer, situation, runway_of)
        self._reviewed_ns = t_ns
        return (exchange.model_copy(update={"rejections": self._reviewed.rejections}),)

    def _holding(self) -> list[Alert]:
        """Return all alerts that hold now: those of the rules as judged, and the model's own.

        A WARNING stays one, and a severity that was told does not fall.
        """
        holding: list[Alert] = []
        told = self._ledger.holding()
        for alert in self._open.values():
            severity = self._reviewed.severities.get(alert.id, alert.severity)
            if alert.id in told and severity.rank < told[alert.id].severity.rank:
                severity = told[alert.id].severity
            if alert.severity is Severity.WARNING:
                holding.append(alert)
            elif severity is not Severity.INFO:
                holding.append(alert if severity is alert.severity else judged(alert, severity))
        return [*holding, *self._reviewed.advisories]


ENGINE = Engine(
    name="llm",
    summary="a language model, with the rules of reference as guard; asks the endpoint of --llm",
    create=lambda _, configuration: LanguageModelAssistant(configuration),
    configuration=ReferenceConfig,
    is_remote=True,
)
