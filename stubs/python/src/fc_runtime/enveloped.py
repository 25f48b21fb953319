"""Messages together with the envelope's keys of requests and responses."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, TypeVar, cast

from .calls import Refusal
from .codec import Codec, check_key, codec_of
from .document import Entries, Json, parse_body, to_bytes, write_text, write_tree
from .errors import BodyError, BodyErrorKind

if TYPE_CHECKING:
    from .message import Message
    from .protocol import Limits, Protocol, ResultText

M = TypeVar("M", bound="Message")


def write_with_envelope(envelope: Message, cls: type[M] | None, message: M | None) -> bytes:
    """Writes an envelope, with a message if there is a type. Raises `BodyError`."""
    out: list[str] = []
    separator = codec_of(type(envelope)).write(envelope, out)
    if cls is not None:
        separator = codec_of(cls).write(cast("M", message), out, separator)
    out.append("}" if separator == "," else "{}")
    return to_bytes(out)


def _now_ms() -> int:
    return time.time_ns() // 1_000_000


def write_request(protocol: Protocol, cls: type[M], message: M) -> bytes:
    """Writes a request or report of a type. Raises `BodyError`."""
    return write_with_envelope(_request_envelope(protocol), cls, message)


def write_response(
    protocol: Protocol, result: ResultText, cls: type[M] | None = None, message: M | None = None
) -> bytes:
    """Writes a response of a type, or an acknowledgement. Raises `BodyError`."""
    return write_with_envelope(_response_envelope(protocol, result), cls, message)


def read_with_envelope(
    envelope: type[Message], cls: type[M] | None, data: bytes, limits: Limits
) -> tuple[Message, M | BodyError | None]:
    """Returns the envelope, and the message or its error. Raises `BodyError` for an error in the envelope."""
    entries = parse_body(data, limits.json_depth, limits.json_values)
    outer = codec_of(envelope)
    inner: Codec[M] | None = None if cls is None else codec_of(cls)
    of_envelope, of_message = outer.by_key, {} if inner is None else inner.by_key
    said: dict[str, Any] = {}
    values: dict[str, Any] = {}
    extra = Entries()
    fault: BodyError | None = None
    for key, tree in entries:
        slot = of_envelope.get(key)
        if slot is not None:
            slot.take(key, tree, said)
            continue
        slot = of_message.get(key)
        if slot is None:
            check_key(key)
        if inner is None or fault is not None:
            continue
        if slot is None:
            extra.append((key, tree))
            continue
        try:
            slot.take(key, tree, values)
        except BodyError as error:
            fault = error
    made = outer.finish(said, Entries())
    if inner is None or fault is not None:
        return made, fault
    try:
        return made, inner.finish(values, extra)
    except BodyError as error:
        return made, error


def read_request(protocol: Protocol, cls: type[M], data: bytes, limits: Limits) -> tuple[int | None, M]:
    """Returns the time of a request, in milliseconds since 1970, and the message. Raises `BodyError`."""
    envelope, message = read_with_envelope(protocol.request_envelope, cls, data, limits)
    if isinstance(message, BodyError):
        raise message
    assert message is not None
    at: int | None = getattr(envelope, protocol.request_roles.get("time", ""), None)
    return at, message


def read_response(protocol: Protocol, cls: type[M] | None, data: bytes, limits: Limits) -> M | None:
    """Returns the message of a response. Raises `Refusal` for a result other than success, and `BodyError`."""
    envelope, message = read_with_envelope(protocol.response_envelope, cls, data, limits)
    roles = protocol.response_roles
    code: int | None = getattr(envelope, roles.get("result_code", ""), None)
    if code is not None and code != protocol.results.success.code:
        raise Refusal(code, getattr(envelope, roles.get("result_text", ""), None) or "")
    if isinstance(message, BodyError):
        raise message
    return message


def write_raw_response(protocol: Protocol, result: ResultText, body: Json) -> bytes:
    """Writes a response with keys that are not a message's. Raises `BodyError`."""
    envelope = _response_envelope(protocol, result)
    known = codec_of(type(envelope)).by_key
    own = Entries((key, tree) for key, tree in _entries_of(body) if key not in known)
    return _write_entries(envelope, own)


def _entries_of(body: object) -> Entries:
    """Returns the keys of an object. Raises `BodyError` for any other value."""
    if not isinstance(body, Json):
        raise BodyError(BodyErrorKind.WRONG_TYPE, f"Json is wanted, not {type(body).__name__}")
    if not isinstance(body.tree, Entries):
        raise BodyError(BodyErrorKind.NOT_AN_OBJECT, "an object is wanted")
    return body.tree


def write_raw_request(protocol: Protocol, body: Json | None) -> bytes:
    """Writes a request with keys that are not a message's. An absent envelope is added."""
    entries = Entries() if body is None else _entries_of(body)
    known = codec_of(protocol.request_envelope).by_key
    has_envelope = any(key in known for key, _ in entries)
    return _write_entries(None if has_envelope else _request_envelope(protocol), entries)


def _write_entries(envelope: Message | None, entries: Entries) -> bytes:
    out: list[str] = []
    separator = "{" if envelope is None else codec_of(type(envelope)).write(envelope, out)
    for key, tree in entries:
        out.append(separator + write_text(key) + ":")
        separator = ","
        write_tree(tree, out)
    out.append("}" if separator == "," else "{}")
    return to_bytes(out)


def _request_envelope(protocol: Protocol) -> Message:
    roles = protocol.request_roles
    values: dict[str, Any] = {roles["time"]: _now_ms()} if "time" in roles else {}
    return protocol.request_envelope(**values)


def _response_envelope(protocol: Protocol, result: ResultText) -> Message:
    known = {"time": _now_ms(), "result_code": result.code, "result_text": result.text}
    values: dict[str, Any] = {attribute: known[role] for role, attribute in protocol.response_roles.items()}
    return protocol.response_envelope(**values)
