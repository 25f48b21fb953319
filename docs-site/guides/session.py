"""The session of the protocol, and the session scripts run against it. Needs nothing but Python 3.9."""

import json
from collections import namedtuple
from pathlib import Path

# region session
Frame = namedtuple("Frame", "answers kind code id")  # `answers`: it has the head of responses


class Session:
    """Which answer belongs to which request, what is due, what has been seen before. Time is in milliseconds."""

    def __init__(self, in_flight, remembers, remembered_for, first_id, id_bits=32):
        self.limit, self.remembers, self.remembered_for = in_flight, remembers, remembered_for
        self.next_id, self.ids, self.connection = first_id, 2**id_bits, 0
        self.open = {}  # id: [frame, due, timeout, retries left]
        self.seen = []  # [frame, digest, connection, when it last came], the oldest first

    def send(self, kind, code, timeout, retries, now):
        """The frame to send, or None if too many are in flight."""
        if len(self.open) >= self.limit:
            return None
        while self.next_id in self.open:
            self.next_id = (self.next_id + 1) % self.ids
        frame = Frame(False, kind, code, self.next_id)
        self.next_id = (self.next_id + 1) % self.ids
        self.open[frame.id] = [frame, now + timeout, timeout, retries]
        return frame

    def end(self, frame):
        """Whether the request was in flight; it no longer is."""
        request = self.open.get(frame.id)
        if not request or request[0] != frame._replace(answers=False):
            return False
        del self.open[frame.id]
        return True

    def receive(self, frame, digest, now):
        if frame.answers:
            return "answer" if self.end(frame) else "late"
        if frame.kind != "report":
            return frame.kind
        for entry in reversed(self.seen):
            before, known, connection, at = entry
            if before != frame:
                continue
            recent = now - at <= self.remembered_for
            if digest is None or known is None:
                same = recent
            else:
                same = digest == known or (recent and connection == self.connection)
            if same:
                self.seen.remove(entry)
                self.seen.append([frame, known, self.connection, now])
                return "repeated"
        return "report"

    def handed_on(self, report, digest, now):
        self.seen = (self.seen + [[report, digest, self.connection, now]])[-self.remembers:]

    def due(self, now):
        """What to send again, and what has ended without an answer."""
        again, expired = [], []
        for request in list(self.open.values()):
            frame, due, timeout, retries = request
            if due > now:
                continue
            if retries:
                request[1:] = now + timeout, timeout, retries - 1
                again.append(frame)
            else:
                del self.open[frame.id]
                expired.append(frame)
        return again, expired

    def next_due(self):
        return min((due for _, due, _, _ in self.open.values()), default=None)
# endregion session


# region runner
SCRIPTS = Path(__file__).resolve().parents[2] / "conformance" / "sessions"


class Run:
    def __init__(self, given):
        ack = given.get("ack", {"timeout": 2000, "retries": 3})
        limits = given.get("in_flight", 64), given.get("queued_reports", 16), 64
        self.policies = {
            "command": (given.get("call_timeout", 3000), 0),
            "report": (ack["timeout"], ack["retries"]),
        }
        remembered_for = 2 * ack["timeout"] * (ack["retries"] + 1)
        self.session = Session(limits[0], max(limits), remembered_for, given["first_id"], given.get("id_bits", 32))
        self.now, self.requests, self.names, self.arrived = 0, {}, {}, {}

    def steps(self, steps, turn=0):
        for number, step in enumerate(steps, 1):
            if "repeat" in step:
                for inner in range(step["repeat"]["times"]):
                    self.steps(step["repeat"]["steps"], inner)
                continue
            got = self.step(step, turn)
            expected = [self.filled(event) for event in step.get("expect", [])]
            assert sorted(map(json.dumps, got)) == sorted(map(json.dumps, expected)), (number, step, got)
            then, due = step.get("then", {}), self.session.next_due()
            due = None if due is None else due - self.now
            assert then.get("in_flight", len(self.session.open)) == len(self.session.open), (number, step)
            assert then.get("next_due", due) == due, (number, step, due)
            assert "next_due_by" not in then or due <= then["next_due_by"], (number, step, due)

    def filled(self, event):
        """An expected event with the id of its request."""
        for kind in {"sends", "again"}.intersection(event):
            return {kind: {"as": event[kind]["as"], "id": self.requests[event[kind]["as"]].id, **event[kind]}}
        return event

    def step(self, step, turn):
        session, now = self.session, self.now
        for verb, kind in (("call", "command"), ("report", "report")):
            if verb in step:
                said, (timeout, retries) = step[verb], self.policies[kind]
                timeout, retries = said.get("timeout", timeout), said.get("retries", retries)
                in_flight = set(session.open)
                frame = session.send(kind, said["code"], timeout, retries, now)
                if frame is None:
                    return [{"busy": said["as"]}]
                assert frame.id not in in_flight, (step, "the id is in flight")
                self.requests[said["as"]], self.names[frame] = frame, said["as"]
                return [{"sends": {"as": said["as"], "id": frame.id}}]
        if "receive" in step:
            said = dict(step["receive"])
            if "answer_to" in said:
                said = {**self.requests[said["answer_to"]]._asdict(), **said, "answers": True}
            elif turn:
                said["id"] = (said["id"] + turn) % 2**32
            frame = Frame(said.get("answers", False), said["kind"], said["code"], said["id"])
            self.arrived[said.get("as")] = frame, said.get("data")
            meaning = session.receive(frame, said.get("data"), now)
            return [{"answer": self.name(frame)} if meaning == "answer" else meaning]
        if "advance" in step:
            self.now += step["advance"]
            again, expired = session.due(self.now)
            sent = [{"again": {"as": self.name(frame), "id": frame.id}} for frame in again]
            return sent + [{"expired": self.name(frame)} for frame in expired]
        if "lose" in step:
            keeps = [self.requests[name] for name in step["lose"].get("keeps", [])]
            lost = [frame for frame, *_ in session.open.values() if frame not in keeps]
            return [{"ended": self.name(frame)} for frame in lost if session.end(frame)]
        if "cancel" in step:
            return [{"ended": step["cancel"]}] if session.end(self.requests[step["cancel"]]) else []
        if "handed_on" in step:
            session.handed_on(*self.arrived[step["handed_on"]], now)
        else:
            assert "reconnect" in step, step
            session.connection += 1
        return []

    def name(self, frame):
        return self.names[frame._replace(answers=False)]


def check():
    scripts = 0
    for file in sorted(SCRIPTS.glob("*.json")):
        contents = json.loads(file.read_text(encoding="utf-8"))
        if contents["level"] != "session":
            continue
        for script in contents["scripts"]:
            try:
                Run(script["given"]).steps(script["steps"])
            except AssertionError as error:
                raise AssertionError(file.name, script["name"], script["demands"]) from error
            scripts += 1
    return scripts
# endregion runner


if __name__ == "__main__":
    assert check() >= 60
    print("the session does what every script demands")
