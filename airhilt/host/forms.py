"""Forms with a file, as ``multipart/form-data`` (RFC 7578)."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from email.message import EmailMessage
from email.parser import BytesParser
from email.policy import HTTP
from typing import cast


def encoded_form(fields: Mapping[str, str | bytes]) -> tuple[bytes, str]:
    """Return a form and its content type. A field of bytes is a file, which is WAV."""
    digest = hashlib.sha256()
    for value in fields.values():
        digest.update(value if isinstance(value, bytes) else value.encode())
    boundary = digest.hexdigest()
    body = bytearray()
    for name, value in fields.items():
        head = f'--{boundary}\r\nContent-Disposition: form-data; name="{name}"'
        if isinstance(value, bytes):
            head += f'; filename="{name}.wav"\r\nContent-Type: audio/wav'
        body += f"{head}\r\n\r\n".encode()
        body += value if isinstance(value, bytes) else value.encode()
        body += b"\r\n"
    return bytes(body) + f"--{boundary}--\r\n".encode(), f"multipart/form-data; boundary={boundary}"


def decoded_form(body: bytes, content_type: str) -> dict[str, bytes]:
    """Return the fields of a form; of two of one name, the last. What is no form has none."""
    head = f"Content-Type: {content_type}\r\n\r\n".encode("latin-1", "replace")
    form = BytesParser(policy=HTTP).parsebytes(head + body)
    if form.get_content_type() != "multipart/form-data" or not form.is_multipart():
        return {}
    parts = cast("list[EmailMessage]", form.get_payload())
    return {
        str(name): cast("bytes", part.get_payload(decode=True))
        for part in parts
        if (name := part.get_param("name", header="content-disposition")) is not None
    }
