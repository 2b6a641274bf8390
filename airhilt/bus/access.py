"""Access control of a run's router: what programs of other processes may do, by their role.

It is that of Zenoh (https://zenoh.io/docs/manual/access-control): whatever no rule allows is
dropped. *In* is what comes from a program, *out* what goes to it. The session of the run itself is
not limited by it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any, Literal, get_args

Role = Literal["observer", "worker", "operator", "recorder"]
"""Role of a program of another process."""
ROLES: tuple[Role, ...] = get_args(Role)
WITHOUT_KEYS: tuple[Role, ...] = ("observer", "worker", "operator")
"""Roles of every program where no certificate says who it is: all but that which reads truth."""

CERTIFICATE_NAME = "airhilt-{}"
"""Common name of the certificate of a role."""
Subjects = Mapping[str | None, Collection[Role]]
"""Roles by the common name of a certificate; None stands for everybody."""
BY_CERTIFICATE: Subjects = {CERTIFICATE_NAME.format(role): (role,) for role in ROLES}
PUBLISHED: Mapping[Role, tuple[str, ...]] = {
    "observer": ("page",),
    "worker": ("advisory/*", "asr/*", "asr/*/partial", "vision/*", "tts/*"),
    "operator": ("command/*", "live/*", "page"),
    "recorder": (),
}
"""Keys on which a role may publish without a grant; a voice is heard, but refused."""
ANSWERED = ("worker/*/describe", "worker/*/step")
"""Keys on which workers answer the queries of the run."""
ASKED = ("clock", "briefing", "radar/*/info")
"""Keys on which the run answers queries of everybody."""
SEAT_STATES = ("seat/*",)
"""Keys on which it answers who may read seats."""
SEAT_ACTS = ("seat/*/do",)
"""Keys of the queries by which people act at seats."""
HOLDERS = "seat/*/holder/*"
"""Liveliness tokens of those who have a seat."""

_RULES: Mapping[str, tuple[str, tuple[str, ...], tuple[str, ...]]] = {
    "subscribe": (
        "ingress",
        ("declare_subscriber", "declare_liveliness_subscriber", "liveliness_query"),
        ("**",),
    ),
    "ask": ("ingress", ("query",), ASKED),
    "be answered": ("egress", ("declare_queryable", "reply"), ASKED),
    "receive": ("egress", ("put", "declare_subscriber"), ("**",)),
    "see who is there": ("egress", ("liveliness_token",), ("run", "worker/*")),
    "attach": ("ingress", ("liveliness_token",), ("worker/*",)),
    "read seats": ("ingress", ("query",), SEAT_STATES),
    "be told of seats": ("egress", ("declare_queryable", "reply"), SEAT_STATES),
    "hold a seat": ("ingress", ("liveliness_token",), (HOLDERS,)),
    "act at a seat": ("ingress", ("query",), SEAT_ACTS),
    "be answered at a seat": ("egress", ("declare_queryable", "reply"), SEAT_ACTS),
    "be asked": ("egress", ("query",), ANSWERED),
    "answer": ("ingress", ("declare_queryable", "reply"), ANSWERED),
    **{
        f"publish as {role}": ("ingress", ("put",), keys)
        for role, keys in PUBLISHED.items()
        if keys
    },
}
"""Direction, messages and keys below the run of each rule that allows something."""
_EVERYBODY = ("subscribe", "ask", "be answered", "receive", "see who is there")
_OF_ROLE: Mapping[Role, tuple[str, ...]] = {
    "observer": ("publish as observer",),
    "worker": ("attach", "be asked", "answer", "publish as worker"),
    "operator": (
        "publish as operator",
        "hold a seat",
        "act at a seat",
        "be answered at a seat",
        "read seats",
        "be told of seats",
    ),
    "recorder": ("read seats", "be told of seats"),
}
NO_TRUTH = "no truth"
"""Rule for all but recorders. It comes before those that allow something."""
NO_SEATS = "no seats"
"""Rule for all but operators and recorders, of the same rank."""
OF_SEATS = ("seat/**",)
"""Keys that the rule is about: tasks hold words of the script before they are said, and the sound
of a seat is what one person hears."""


def access_control(root: str, run: str, subjects: Subjects) -> Any:
    """Return the setting ``access_control`` of Zenoh for the router of a run.

    ``root`` is the first chunk of the keys of all runs; ``subjects`` may connect.
    """
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [
            *_allowing(root, run),
            _denying(NO_TRUTH, [f"{root}/{run}/truth/**"]),
            _denying(NO_SEATS, [f"{root}/{run}/{key}" for key in OF_SEATS]),
        ],
        "subjects": [
            {"id": name or "everybody"} | ({"cert_common_names": [name]} if name else {})
            for name in subjects
        ],
        "policies": [
            {"subjects": [name or "everybody"], "rules": list(_rules_of(roles))}
            for name, roles in subjects.items()
        ],
    }


def _allowing(root: str, run: str) -> Iterator[dict[str, Any]]:
    for name, (flow, messages, keys) in _RULES.items():
        # Who looks for the run does not know its name yet.
        prefix = f"{root}/*" if name == "ask" else f"{root}/{run}"
        yield {
            "id": name,
            "permission": "allow",
            "flows": [flow],
            "messages": messages,
            "key_exprs": ["**"] if name == "subscribe" else [f"{prefix}/{key}" for key in keys],
        }


def _denying(name: str, keys: list[str]) -> dict[str, Any]:
    return {
        "id": name,
        "permission": "deny",
        "flows": ["egress"],
        "messages": ["put"],
        "key_exprs": keys,
    }


def _rules_of(roles: Collection[Role]) -> Iterator[str]:
    """Yield the names of the rules of a program that has these roles."""
    yield from _EVERYBODY
    for role in roles:
        yield from _OF_ROLE[role]
    if "recorder" not in roles:
        yield NO_TRUTH
    if not {"operator", "recorder"} & set(roles):
        yield NO_SEATS
