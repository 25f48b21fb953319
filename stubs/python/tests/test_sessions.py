"""The session scripts of level `session`, against the session of the runtime."""

from __future__ import annotations

import json
import unittest
from dataclasses import replace
from typing import Any

import fc_runtime as rt
from support import LIMITS, PROTOCOL, ROOT, holds, load

KINDS = {"command": PROTOCOL.command, "report": PROTOCOL.report, "stream": PROTOCOL.stream}


class Run:
    """One script. Its times are in milliseconds, the session's in seconds."""

    def __init__(self, given: dict[str, Any]) -> None:
        ack = given.get("ack", {"timeout": 2000, "retries": 3})
        protocol_limits = replace(LIMITS, in_flight=64)
        limits = replace(LIMITS, in_flight=given.get("in_flight", 64), queued_reports=given.get("queued_reports", 16))
        self.id_bits: int = given.get("id_bits", 32)
        protocol = replace(
            PROTOCOL,
            header=tuple(
                replace(one, size=self.id_bits // 8) if one.role is rt.HeaderRole.ID else one for one in PROTOCOL.header
            ),
            defaults=replace(PROTOCOL.defaults, limits=protocol_limits),
        )
        self.policies = {
            "command": (given.get("call_timeout", 3000), 0),
            "report": (ack["timeout"], ack["retries"]),
        }
        policy = rt.AckPolicy(timeout=ack["timeout"], retries=ack["retries"])
        self.session: rt.Session[str] = rt.Session(protocol, limits, policy, given["first_id"])
        self.now = 0
        self.requests: dict[str, rt.FrameId] = {}
        self.arrived: dict[str | None, tuple[rt.FrameId, bytes | None]] = {}
        # Ids of requests in flight.
        self.ids: set[int] = set()

    def steps(self, steps: list[dict[str, Any]], turn: int = 0) -> None:
        for number, step in enumerate(steps, 1):
            if "repeat" in step:
                for inner in range(step["repeat"]["times"]):
                    self.steps(step["repeat"]["steps"], inner)
                continue
            got = self.step(step, turn)
            expected = [self.filled(event) for event in step.get("expect", [])]
            assert sorted(map(json.dumps, got)) == sorted(map(json.dumps, expected)), (number, step, got)
            then, due = step.get("then", {}), self.session.next_due
            wait = None if due is None else due - self.now
            assert then.get("in_flight", self.session.in_flight) == self.session.in_flight, (number, step)
            assert then.get("next_due", wait) == wait, (number, step, wait)
            if "next_due_by" in then:
                assert wait is not None, (number, step)
                assert wait <= then["next_due_by"], (number, step, wait)

    def filled(self, event: Any) -> Any:
        """Returns an expected event with the id of its request."""
        for kind in {"sends", "again"}.intersection(event):
            return {kind: {"as": event[kind]["as"], "id": self.requests[event[kind]["as"]].id, **event[kind]}}
        return event

    def step(self, step: dict[str, Any], turn: int) -> list[Any]:
        session = self.session
        for verb, kind in (("call", "command"), ("report", "report")):
            if verb in step:
                said, (timeout, retries) = step[verb], self.policies[kind]
                policy = rt.AckPolicy(timeout=said.get("timeout", timeout), retries=said.get("retries", retries))
                try:
                    frame = session.open(KINDS[kind], said["code"], policy, self.now, said["as"])
                except rt.BusyFault:
                    return [{"busy": said["as"]}]
                assert frame.id not in self.ids, (step, "the id is in flight")
                self.ids.add(frame.id)
                self.requests[said["as"]] = frame
                return [{"sends": {"as": said["as"], "id": frame.id}}]
        if "receive" in step:
            return self.receive(dict(step["receive"]), turn)
        if "advance" in step:
            self.now += step["advance"]
            got: list[Any] = []
            while due := session.due(self.now):
                sent = {"again": {"as": due.token, "id": due.frame.id}}
                got.append(sent if due.again else {"expired": due.token})
                if not due.again:
                    self.ids.remove(due.frame.id)
            return got
        if "lose" in step:
            keeps = step["lose"].get("keeps", [])
            ended = session.end_if(lambda _, name: name not in keeps)
            self.ids -= {frame.id for frame, _ in ended}
            return [{"ended": name} for _, name in ended]
        if "cancel" in step:
            frame = self.requests[step["cancel"]]
            if not session.cancel(frame):
                return []
            self.ids.remove(frame.id)
            return [{"ended": step["cancel"]}]
        if "handed_on" in step:
            session.handed_on(*self.arrived[step["handed_on"]], self.now)
        else:
            assert "reconnect" in step, step
            session.reconnected()
        return []

    def receive(self, said: dict[str, Any], turn: int) -> list[Any]:
        data = said["data"].encode() if "data" in said else None
        if "answer_to" in said:
            asked = self.requests[said["answer_to"]]
            frame = rt.FrameId(
                True,
                KINDS[said["kind"]] if "kind" in said else asked.kind,
                said.get("code", asked.code),
                said.get("id", asked.id),
            )
        else:
            frame = rt.FrameId(False, KINDS[said["kind"]], said["code"], (said["id"] + turn) % 2**self.id_bits)
        self.arrived[said.get("as")] = frame, data
        meaning, token = self.session.receive(frame, data, self.now)
        if meaning is rt.Incoming.ANSWER:
            self.ids.remove(frame.id)
        return [{"answer": token} if meaning is rt.Incoming.ANSWER else meaning.value]


class Sessions(unittest.TestCase):
    def test_every_script(self) -> None:
        scripts = 0
        for path in sorted((ROOT / "conformance/sessions").glob("*.json")):
            contents = load(f"conformance/sessions/{path.name}")
            if contents["level"] != "session":
                continue
            for script in contents["scripts"]:
                with self.subTest(path.name, script=script["name"]):
                    Run(script["given"]).steps(script["steps"])
                    scripts += 1
                    holds("session")
        self.assertGreaterEqual(scripts, 60)


if __name__ == "__main__":
    unittest.main()
